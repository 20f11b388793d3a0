// How good a multi-block grid is: volumes, corner Jacobians, angles, sizes; the worst cell of each by block and index; and a stop where a
// stated limit is broken. Definitions: docs/theory/rotor_grid.md. Used by the generators of this folder and by `spindrift grid`; tested in
// tests/src/aero/rotor_grid/quality_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

struct Extreme {
  double value = 0.0;
  int block = -1, k = 0, j = 0, i = 0;  ///< of the cell
};

struct GridQuality {
  long cells = 0;
  long folded = 0;                ///< cells with a corner Jacobian that is not positive
  long skewed = 0;                ///< cells with a scaled Jacobian below 0.4
  Extreme volume;                 ///< smallest [m3]
  Extreme scaled_jacobian;        ///< smallest: of a cell's eight corners, the volume of the unit edges there; 1 is a box
  Extreme orthogonality;          ///< largest angle [rad] between a face and the line through its two cells' centres, off its normal
  Extreme aspect_ratio;           ///< largest ratio of a cell's longest edge to its shortest
  std::array<Extreme, 3> stretch; ///< largest ratio of sizes of neighbours inside a block, along i, j, k; along i of blocks at walls: growth
  Extreme wall_growth;            ///< the same along the lines that leave walls
  Extreme wall_orthogonality;     ///< largest angle [rad] between a wall face's normal and the line to the opposite face
  double wall_orthogonality_median = 0.0;     ///< [rad]; zero where there is no wall
  double first_cell_low = 0.0, first_cell_high = 0.0;  ///< heights of wall cells [m]
  double interface_gap = 0.0;     ///< largest distance of nodes that a connection says are one [m]; periodic ones mapped
  double volume_total = 0.0;      ///< [m3]
};

/// Walls are the patches whose names begin with one of `walls`. Same bits for any number of threads.
GridQuality measure_quality(const MultiBlockGrid& grid, const std::vector<std::string>& walls);

/// What a grid must hold to be used.
struct QualityLimits {
  double scaled_jacobian = 0.01;         ///< at least
  double orthogonality = 1.536;          ///< at most [rad]: 88 deg
  double stretch = 20.0;                 ///< at most
  double interface_gap = 1e-11;          ///< at most, over the largest coordinate; periodic maps round
};

/// Throws NumericalFailure naming limit, value, block and cell.
void require_quality(const MultiBlockGrid& grid, const GridQuality& quality, const QualityLimits& limits = {});

/// The report as text, one line a measure with the worst cell.
std::string describe_quality(const MultiBlockGrid& grid, const GridQuality& quality);

}  // namespace spindrift::aero
