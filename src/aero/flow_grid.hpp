// The grid of a resolved flow: a file (Plot3D with its neutral map, CGNS) or one of the generators of src/aero/grid, chosen in
// [aero.flow]. Options declared in flow_grid.cpp; called by src/run/flow_case.cpp and `spindrift check`.
// Tested in tests/src/aero/flow_grid_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "kernels/grid/naca.hpp"
#include "src/aero/grid/multi_block.hpp"

namespace spindrift::scene {
template <class Options>
class Section;
}  // namespace spindrift::scene

namespace spindrift::aero {

struct FlowOptions;

/// [aero.flow.generate]
struct GenerateOptions {
  std::string kind = "box";
  std::string coordinates;          ///< path: outline of an aerofoil
  std::optional<std::string> naca;  ///< or its digits
  TrailingEdge trailing_edge = TrailingEdge::closed;
  int refinement = 2;                   ///< flat plate, aerofoil, wing, bump
  int around = 96, outward = 64;        ///< cylinder
  double radius_m = 0.5, far_m = 50.0;  ///< cylinder; far_m also of the aerofoil
  double first_cell_m = 0.0;            ///< 0: the generator's own
  double span_m = 1.0;                  ///< wing
  int span_cells = 8;
  std::array<double, 3> cells{32.0, 1.0, 32.0};  ///< box, along x, y, z; one along y: planar
  std::array<double, 3> low_m{0.0, 0.0, 0.0}, high_m{1.0, 1.0, 1.0};
  std::vector<std::string> periodic;  ///< axes of a box
  // stretched box
  double cell_m = 1.0, growth = 1.2;
  std::array<double, 3> core_low_m{0.0, 0.0, 0.0}, core_high_m{1.0, 1.0, 1.0};
};
const scene::Section<GenerateOptions>& generate_section();

/// Of a box that is to be generated; nothing of other grids, which have to be read or made.
std::optional<Corners> box_corners(const FlowOptions& options);
/// Reads or makes the grid; it is sound, and has coarser ones where the scene asks for them. Throws scene::SceneError.
MultiBlockGrid flow_grid(const FlowOptions& options);
/// How many cells such a grid has, and the key that decides it: known before it is made.
struct GeneratedSize {
  double cells = 0.0;
  const char* key = "";
};
GeneratedSize generated_size(const GenerateOptions& options);
/// For people: "grid wing.cgns", "a flat plate of 6528 cells".
std::string describe_flow_grid(const FlowOptions& options);

}  // namespace spindrift::aero
