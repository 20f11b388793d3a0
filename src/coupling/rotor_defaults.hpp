// Defaults of a resolved rotor that follow from the rest of its scene: whether one sector stands for all, how its walls are
// treated, how its march goes. Called by scenario.cpp before [aero] is read; tested in tests/coupled/rotor_defaults_test.py.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace spindrift::scene {
class Document;
}

namespace spindrift::coupling {

/// Gives keys of [aero.grid] and [aero.flow] that the scene leaves out the values of docs/user/air.md, "What a rotor has
/// by default"; nothing in a scene without a resolved rotor.
void add_rotor_defaults(scene::Document& document);

}  // namespace spindrift::coupling
