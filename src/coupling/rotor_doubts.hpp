// Doubts about a rotor as a part of its scene: its place, its body, its files, its speed against windows and cells. Called by
// doubts.cpp; tested by the blunders of tests/extremes/blunders.toml. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "src/coupling/start.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::coupling {

/// Of one of by_rotor; `carried`: the weight of all bodies [N].
scene::Doubts rotor_doubts(const Scenario& scenario, const RotorSource& rotor, const Start& start, double carried);
/// Of its files that are not among those told of, which become so.
scene::Doubts rotor_file_doubts(const Scenario& scenario, std::set<std::string>& told);
/// Of a rotor that no body carries.
scene::Doubts standing_rotor_doubts(const Scenario& scenario);

}  // namespace spindrift::coupling
