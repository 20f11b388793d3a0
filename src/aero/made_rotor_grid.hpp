// The grid of a scene's resolved rotor as all solvers on it find it: described, looked through, without nodes. Each rank looks
// through its share of the layers, and all know what was seen. Made where a resolved rotor is, and by `spindrift check`; tested
// in tests/src/aero/made_rotor_grid_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "runtime/mpi/exchange.hpp"
#include "src/aero/flow_options.hpp"
#include "src/aero/grid/tiling.hpp"
#include "src/aero/grid/wall_distance.hpp"
#include "src/aero/resolved_rotor_setup.hpp"
#include "src/aero/rotor_grid/layout.hpp"
#include "src/aero/rotor_grid/rotor_grid.hpp"
#include "src/aero/rotor_grid/stations.hpp"
#include "src/aero/turbine.hpp"

namespace spindrift::aero {

/// In the rotor's frame. Nodes are nowhere all at once: a solver has those of its own tiles made again.
struct MadeRotorGrid {
  Turbine turbine;
  RotorGridSpec spec;
  std::shared_ptr<const RotorGridMaker> maker;
  MultiBlockGrid grid;        ///< without nodes
  std::vector<double> radii;  ///< of the surfaces of nodes from the hub on [m]
  EdgeLengths edges;
  std::vector<WallSurface::Face> walls;             ///< of the patches that the gas sticks to
  std::vector<std::vector<BladeStation>> stations;  ///< by blade
  std::array<double, 3> moments{};                  ///< of the nodes: their number and two sums, which tell grids apart
  /// Left by a solver for the next one: five core-seconds for a million cells. Of this rank.
  std::shared_ptr<WallDistances> distances = std::make_shared<WallDistances>();

  int blades() const { return int(stations.size()); }                       ///< that it has, one where it is of one sector
  int span_cells() const { return spec.sizes.span >> spec.coarsen; }        ///< from hub to tip
  int radial_cells() const { return spec.sizes.radial() >> spec.coarsen; }  ///< from hub to outer radius
  int layers_at_once() const;                                               ///< that a rank holds of it while it is made
};

/// Throws scene::SceneError, on all ranks alike, where the scene does not make a grid fit for use. Collective; the same for any
/// number of ranks, but for which of equally bad cells is named.
std::shared_ptr<const MadeRotorGrid> made_rotor_grid(const ResolvedRotorSetup& setup, MPI_Comm comm = MPI_COMM_SELF,
                                                     const GridProgress& told = {});

/// How the grid of a rotor is cut into tiles: lines of cells from the blades stay whole.
Tiling rotor_tiling(const FlowOptions& flow, const MultiBlockGrid& grid, const EdgeLengths& edges);

/// With conditions for patches that the scene does not name: blades are as asked for (slip without friction), the hub slips, the
/// rest is the far field.
FlowOptions with_default_patches(FlowOptions options, const MultiBlockGrid& grid);

}  // namespace spindrift::aero
