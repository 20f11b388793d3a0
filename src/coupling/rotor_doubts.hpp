// Doubts about a rotor as a part of its scene: its place, its body, its files, its speed against windows and cells. Called by
// doubts.cpp, the load of a standing rotor by src/app/rotor_start.cpp too; tested by the blunders of
// tests/extremes/blunders.toml. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <string>

#include "src/coupling/start.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::coupling {

/// Of one of by_rotor; `carried`: the weight of all bodies [N].
scene::Doubts rotor_doubts(const Scenario& scenario, const RotorSource& rotor, const Start& start, double carried);
/// Of its files that are not among those told of, which become so.
scene::Doubts rotor_file_doubts(const Scenario& scenario, std::set<std::string>& told);
/// At the start, of a rotor that stands in resolved air, by blade elements; absent where its turbine has no polars.
std::optional<aero::RotorLoad> standing_rotor_load(const Scenario& scenario);
/// A tower that the thrust on its top bends, clamped at its foot: towers of steel lean by 0.3 to 1.5 % of their length at rated
/// thrust, and yield at some 3 %.
scene::Doubts lean_doubts(const FloatingSystem& floating, const aero::RotorLoads& rotor, const Start& start);
/// Rotors that would touch, and those in the wake of others, which no engineering model has: wakes spread by about a tenth of the
/// way (Jensen 1983, Risoe-M-2411, with a wake decay of 0.1).
scene::Doubts wake_doubts(const FloatingSystem& floating, const Start& start);
/// Of a rotor that no body carries.
scene::Doubts standing_rotor_doubts(const Scenario& scenario);

}  // namespace spindrift::coupling
