// No window between rotor and bodies. SPDX-License-Identifier: Apache-2.0
#include "src/coupling/scheme.hpp"

namespace spindrift::coupling {

extern const CouplingScheme monolithic_scheme{
    .name = "monolithic", .help = "the rotor is asked in every evaluation of the bodies: exact, no window between them"};

}  // namespace spindrift::coupling
