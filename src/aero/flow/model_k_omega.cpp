// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_k_omega.hpp"

#include "src/aero/flow/sweep_model_of.hpp"

namespace spindrift::aero {

extern const Closure k_omega_closure{turbulence::KOmega::name, "k-omega of Wilcox 2006", two_equation_keys(),
                                     SweepsOf<turbulence::KOmega>::table()};
extern const Closure k_omega_1988_closure{turbulence::KOmega1988::name, "k-omega of Wilcox 1988; depends on the stream's omega",
                                          two_equation_keys(), SweepsOf<turbulence::KOmega1988>::table()};

}  // namespace spindrift::aero
