// How good a grid round walls is, beyond the shared report: lines that leave walls, first cells, interfaces, weak cells counted;
// and a stop where a stated limit is broken. Definitions: docs/theory/rotor_grid.md. Used by the generators of this folder and by
// `spindrift grid`; tested in tests/src/aero/rotor_grid/quality_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "src/aero/grid/quality.hpp"

namespace spindrift::aero {

/// What the shared report (src/aero/grid/quality.hpp) says, and what matters on grids round walls.
struct RotorGridQuality {
  GridQuality general;
  long folded = 0;                         ///< cells with a corner Jacobian that is not positive
  long skewed = 0;                         ///< cells with a scaled Jacobian below 0.4
  std::array<Extreme, 3> stretch;          ///< largest ratio of sizes of neighbours inside a block, along i, j, k
  Extreme wall_growth;                     ///< the same along the lines that leave walls
  Extreme wall_orthogonality;              ///< largest angle [deg] between a wall face's normal and the line to the opposite face
  double wall_orthogonality_median = 0.0;  ///< [deg]; zero where there is no wall
  double first_cell_low = 0.0, first_cell_high = 0.0;  ///< heights of wall cells [m]
  double interface_gap = 0.0;  ///< largest distance of nodes that a connection says are one [m]; periodic ones mapped
  double reach = 0.0;          ///< largest coordinate [m]
};

/// Walls are the patches whose names begin with one of `walls`. Same bits for any number of threads.
RotorGridQuality rotor_grid_quality(const MultiBlockGrid& grid, const std::vector<std::string>& walls);
/// Of the layers that a part counts: all but growth along lines that leave it, and the median angle at walls.
RotorGridQuality rotor_grid_quality(const GridLayers& part, const std::vector<std::string>& walls);
/// Adds what another part has.
void merge(RotorGridQuality& all, const RotorGridQuality& part);

/// What a grid must hold to be used.
struct QualityLimits {
  double scaled_jacobian = 0.01;    ///< at least
  double non_orthogonality = 88.0;  ///< at most [deg]
  double stretch = 20.0;            ///< at most
  double interface_gap = 1e-11;     ///< at most, over the largest coordinate; periodic maps round
};

/// Throws NumericalFailure naming limit, value, block and cell. The grid need not have nodes.
void require_quality(const MultiBlockGrid& grid, const RotorGridQuality& quality, const QualityLimits& limits = {});

/// Both reports as text, one line a measure with the worst cell.
std::string describe_quality(const MultiBlockGrid& grid, const RotorGridQuality& quality);

}  // namespace spindrift::aero
