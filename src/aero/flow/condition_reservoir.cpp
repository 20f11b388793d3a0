// Inflow from a reservoir, where the wind would be at rest. SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/boundary.hpp"

namespace spindrift::aero {

extern const BoundaryCondition reservoir_condition{
    .name = "reservoir",
    .help = "stagnation pressure and temperature of the wind and its direction given, speed from inside",
    .ghosts =
        [](const BoundaryFace& at) {
          const BoundarySetting& s = at.setting;
          const bool one = s.profile.uniform() && s.wind.steady();
          const auto q = gas::inflow_reservoir(s.gas, at.inside, one ? s.reservoir : reservoir_of(s.gas, at.stream()));
          return Ghosts{q, q};
        },
    // At constant entropy and total enthalpy dh = dp / rho = -u du; in scaled unknowns at the stream's speed the factors are
    // these.
    .fold =
        [](const FoldedFace& at) {
          at.follow(0, 1.0f, 0), at.follow(4, 1.0f, 0);
          for (int c = 0; c < 3; ++c) at.follow(c + 1, float(-at.wind[std::size_t(c)]), 0);
        }};

}  // namespace spindrift::aero
