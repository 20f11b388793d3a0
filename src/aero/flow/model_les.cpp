// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_les.hpp"

#include "src/aero/flow/sweep_model_of.hpp"

namespace spindrift::aero {

extern const Closure les_wale_closure{
    turbulence::Wale::name, "large eddies, WALE; three dimensions only", {}, ClosuresOf<turbulence::Wale>::table(), true};
extern const Closure les_smagorinsky_closure{turbulence::Smagorinsky::name,
                                             "large eddies, Smagorinsky; three dimensions only",
                                             {},
                                             ClosuresOf<turbulence::Smagorinsky>::table(),
                                             true};

}  // namespace spindrift::aero
