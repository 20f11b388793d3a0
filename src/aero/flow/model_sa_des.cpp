// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_sa_des.hpp"

#include "src/aero/flow/sweep_model_of.hpp"

namespace spindrift::aero {

extern const Closure des97_closure{turbulence::Des97::name, "detached eddies by Spalart-Allmaras, 1997", one_equation_keys(),
                                   SweepsOf<turbulence::Des97>::table()};
extern const Closure ddes_closure{turbulence::Ddes::name,
                                  "delayed detached eddies by Spalart-Allmaras, 2006: boundary layers stay modelled",
                                  one_equation_keys(), SweepsOf<turbulence::Ddes>::table()};

}  // namespace spindrift::aero
