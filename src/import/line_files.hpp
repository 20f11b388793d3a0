// Lines of a deck: files of MAP++ and MoorDyn as plain values. Tested in tests/src/import/openfast_moorings_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "src/import/deck.hpp"

namespace spindrift::decks {

struct ImportedLine {
  Eigen::Vector3d anchor, fairlead;
  double length = 0.0, diameter = 0.0, mass_per_m = 0.0, axial_stiffness = 0.0, bed_friction = 0.0;
  bool meets_bed = true;  ///< at the level of its anchor, if it has one; false: MAP++'s OMIT_CONTACT
  /// Of MoorDyn's lines, which are dynamic: keys beyond those above, as a scene has them.
  struct Dynamics {
    int segments = 20;
    double damping_ratio = 1.0, drag = 0.0, axial_drag = 0.0, added_mass = 0.0, axial_added_mass = 0.0;
    double bed_stiffness = 3e6, bed_damping = 3e5;
  };
  std::optional<Dynamics> dynamics{};
  std::string at_anchor{}, at_fairlead{};  ///< names of junctions; empty: the bed, the platform
};
/// A point free in the water at which lines end.
struct ImportedJunction {
  std::string name;
  Eigen::Vector3d at;
  double mass = 0.0, volume = 0.0, drag_area = 0.0, added_mass = 0.0;
};
struct ImportedMoorings {
  std::vector<ImportedLine> lines;
  std::vector<ImportedJunction> junctions;
};
/// Lines of MAP++ are in rest at all times.
ImportedMoorings read_map(const Deck& file, double water_depth, std::vector<std::string>& left_out);
/// A file without its comments.
ImportedMoorings read_moordyn(const Deck& file, double water_depth, std::vector<std::string>& left_out);

}  // namespace spindrift::decks
