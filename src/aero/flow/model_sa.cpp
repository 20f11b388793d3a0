// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_sa.hpp"

#include "src/aero/flow/sweep_model_of.hpp"

namespace spindrift::aero {

extern const Closure sa_closure{turbulence::Sa::name, "Spalart-Allmaras", one_equation_keys(), SweepsOf<turbulence::Sa>::table()};
extern const Closure sa_neg_closure{turbulence::SaNeg::name, "Spalart-Allmaras, negative variant", one_equation_keys(),
                                    SweepsOf<turbulence::SaNeg>::table()};

}  // namespace spindrift::aero
