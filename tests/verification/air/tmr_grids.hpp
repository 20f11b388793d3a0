// Grids of NASA's Turbulence Modeling Resource round a NACA 0012 aerofoil, as inputs/validation/naca0012 has them.
// Used by tests/verification/air and perf/air. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "src/aero/grid/neutral_map.hpp"
#include "src/aero/grid/plot3d.hpp"

namespace spindrift::aero::testing {

/// The C grid `name` ("tmr_112x32"): wake cut, aerofoil ("wall") and far field ("far"). `source`: the top of the project.
inline MultiBlockGrid tmr_c_grid(const std::string& source, const std::string& name) {
  const std::filesystem::path stem = std::filesystem::path(source) / "inputs/validation/naca0012" / name;
  MultiBlockGrid grid = read_plot3d(stem.string() + ".p3d");
  read_neutral_map(grid, stem.string() + ".nmf");
  for (Boundary& b : grid.boundaries) b.patch = b.patch == "viscous_solid" ? "wall" : "far";
  return grid;
}

}  // namespace spindrift::aero::testing
