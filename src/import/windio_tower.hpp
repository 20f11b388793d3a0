// The tower of a windIO 1.x turbine: what the wind meets, and what bends. Used by windio.cpp; tested in
// tests/src/import/windio_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/import/windio_file.hpp"

namespace spindrift::decks {

/// [aero.tower] of a scene, from components.tower.outer_shape_bem. Its notes go to `left_out`.
std::string tower_in_the_air(const Key& tower, std::vector<std::string>& left_out);

/// The properties of a beam ([beams.NAME]) from the foot up: distance_m, mass_kg_m, stiffness_x_N_m2, stiffness_y_N_m2, axial_N,
/// torsion_N_m2; of the file's `materials` and of components.tower, whose layers lie inside each other from the outside inwards.
std::string tower_table(const Key& top);

}  // namespace spindrift::decks
