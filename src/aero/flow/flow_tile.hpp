// What the solver keeps for one tile: state, residual, gradients, the past, the matrix and the Krylov vectors, each allocated
// only where the scene needs it. Bytes per cell are added up in docs/developer/notes/air.md. Unknowns are p u v w T above the
// references of the gas, then those of the turbulence model; residuals in the order rho mx my mz E. Called by the sweeps and
// tasks of src/aero/flow; tested through tests/src/aero/flow. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "kernels/grid/layout.hpp"
#include "kernels/linear/stencil_matrix.hpp"
#include "kernels/turbulence/wall_law.hpp"
#include "src/aero/flow/condition.hpp"
#include "src/aero/flow/physical_time.hpp"
#include "src/aero/grid/aligned.hpp"
#include "src/aero/grid/store.hpp"
#include "src/aero/grid/tiling.hpp"

namespace spindrift::aero {

inline constexpr int mean_unknowns = 5;
/// Of the mean flow: 532 bytes a cell in place of the 832 of floats, and a third less to read for each Krylov vector.
using MeanMatrix = linear::StencilMatrix<mean_unknowns, linear::ShortFloat>;

/// A window of the tile where a condition acts.
struct FlowBoundary {
  TileBoundary where;
  const BoundaryCondition* condition = nullptr;
  bool loads = false;                      ///< counts towards forces
  std::optional<double> temperature = {};  ///< that a no-slip wall is held at [K]; unset: adiabatic
};

/// The cell of a tile that limits its update most, and by what.
struct UpdateLimit {
  double fraction = 1.0;  ///< of the update that it allows; -1: none, a matrix was singular
  Index cell{};
  const char* what = "";
};

/// Numbers of the faces on one side of a tile, see open_row; empty where nothing there asks for them.
struct SideFaces {
  AlignedArray<double> open;     ///< where there are walls: 1 where the flux scheme acts, 0 on wall faces
  AlignedArray<double> law;      ///< where one has a wall function: 1 on its faces
  AlignedArray<double> through;  ///< where there are other boundaries: mass fluxes in the residual evaluated last [kg/s], along
                                 ///< the direction of the index
};

struct FlowTile {
  TileGeometry* geometry = nullptr;
  int index = 0;                     ///< in the tiling
  int turbulence = 0;                ///< number of its unknowns
  bool eddies = false;               ///< a closure gives an eddy viscosity; with or without unknowns
  int directions = 3;                ///< 2 where planar
  std::array<bool, 3> along_wall{};  ///< as in Tile
  std::array<bool, 6> ends_along_wall{};
  BoxLayout cells;         ///< of states: two ghosts
  BoxLayout gradient_box;  ///< one ghost
  BoxLayout inner;         ///< no ghosts
  linear::CellBox box;
  std::vector<FlowBoundary> boundaries;
  const turbulence::WallLaw* wall_law = nullptr;  ///< of the closure; where a boundary has it

  AlignedArray<double> state;  ///< unknowns
  AlignedArray<double> trial;  ///< perturbed state of matrix-free products; between pseudo-steps the state before the last one
  AlignedArray<double> gradients;  ///< 3 each of u v w T and the turbulence unknowns, then closures
  AlignedArray<double> residual;
  std::array<AlignedArray<double>, most_levels> past;  ///< conserved times volume one, two ... steps ago, as many as time needs
  AlignedArray<double> source;  ///< added to the rate of change of conserved amounts per volume; empty but under body forces and
                                ///< in manufactured solutions
  AlignedArray<double>
      driving;                ///< of a wind that changes: acceleration [m/s2] and a power [W/kg], flow_residual.cpp; else empty
  AlignedArray<double> rate;  ///< V / pseudo-time step [m3/s]
  std::array<SideFaces, 6> sides;

  AlignedArray<float> mean_matrix, turbulence_matrix;
  AlignedArray<float> direction;                     ///< with one ghost: what the operator is applied to
  std::vector<AlignedArray<float>> vectors;          ///< of the Krylov cycle: [cell][5], then [cell][turbulence]
  std::vector<AlignedArray<float>> directions_kept;  ///< of flexible GMRES and GCG

  UpdateLimit limit, clip;              ///< of the last update: of the mean flow's, of turbulence's
  UpdateLimit worst_limit, worst_clip;  ///< likewise, since the tile was made
  long limited = 0, clipped = 0;        ///< cells with a limit in the last update: of the mean flow, of turbulence
  double noise = 0.0;                   ///< squared norm of what round-off leaves of its balances

  int unknowns() const { return mean_unknowns + turbulence; }
  std::size_t vector_size() const { return std::size_t(box.count()) * unknowns(); }
  BoxView<double> state_view() { return {state.data(), cells}; }
  BoxView<double> trial_view() { return {trial.data(), cells}; }
  BoxView<double> gradient_view() { return {gradients.data(), gradient_box}; }
  BoxView<float> direction_view() { return {direction.data(), gradient_box}; }
  MeanMatrix mean() { return {mean_matrix.data(), box, directions}; }
  template <int n>
  linear::StencilMatrix<n> model() {
    return {turbulence_matrix.data(), box, directions};
  }
  std::size_t bytes() const;
};

/// Calls body(k, j, i) for the cell inside of each face of a window, low directions innermost, and its ordinal.
template <class Body>
void for_window(const FlowTile& tile, Side side, std::array<int, 2> low, std::array<int, 2> high, Body&& body) {
  const int d = direction_of(side);
  const int extent[3] = {tile.box.ni, tile.box.nj, tile.box.nk};
  const auto [a, b] = along(side);
  int at[3];
  at[d] = at_end(side) ? extent[d] - 1 : 0;
  for (at[b] = low[1]; at[b] < high[1]; ++at[b])
    for (at[a] = low[0]; at[a] < high[0]; ++at[a]) body(at[2], at[1], at[0]);
}

}  // namespace spindrift::aero
