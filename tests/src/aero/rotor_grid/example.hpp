// The turbine and the sizes that the tests of this folder share.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kernels/base/constants.hpp"
#include "src/aero/rotor_grid/quality.hpp"
#include "src/aero/rotor_grid/rotor_grid.hpp"

namespace spindrift::aero {

inline const Turbine& dtu() {
  static const Turbine turbine = read_turbine(std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/turbines/dtu_10mw.toml");
  return turbine;
}

/// A grid as one part, which counts all of its layers.
inline GridLayers one_part(const MultiBlockGrid& grid) {
  GridLayers part{.grid = grid, .first = std::vector<int>(grid.blocks.size(), 0), .count = {}};
  for (const Block& b : grid.blocks) part.count.push_back(b.nk);
  return part;
}

inline RotorGridSpec spec_of(double n, double first_cell_chords, double pitch_deg = 0.0, bool whole = false) {
  RotorGridSpec spec;
  spec.sizes = sizes_of(n), spec.first_cell_chords = first_cell_chords, spec.pitch = pitch_deg * radians_per_degree,
  spec.whole = whole;
  return spec;
}

/// The paper's: 166 cells round the section, 90 along the span.
inline RotorGridSizes paper_sizes() {
  return {.round = 166,
          .edge = 8,
          .box = 42,
          .layers = 44,
          .beside = 34,
          .upstream = 26,
          .downstream = 60,
          .span = 90,
          .outboard = 40};
}
inline RotorGridSizes medium_sizes() {
  return {.round = 120,
          .edge = 4,
          .box = 30,
          .layers = 32,
          .beside = 16,
          .upstream = 16,
          .downstream = 24,
          .span = 50,
          .outboard = 18};
}

inline const std::vector<std::string>& blade_walls() {
  static const std::vector<std::string> walls{"blade_"};
  return walls;
}

}  // namespace spindrift::aero
