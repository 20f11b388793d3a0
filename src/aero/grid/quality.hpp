// How good a grid is: the figures that tell whether schemes and solvers will do well on it, the worst of each and where it is.
// Called by the program's `grid` and `check`, by generators' tests; tested in tests/src/aero/grid/checks_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <string>

#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

/// An extreme value and the cell that has it.
struct Extreme {
  double value = 0.0;
  int block = -1, k = 0, j = 0, i = 0;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< centre [m]
};

struct GridQuality {
  long cells = 0;
  double volume = 0.0;             ///< [m3]
  Extreme min_volume, max_volume;  ///< [m3]
  Extreme aspect_ratio;            ///< longest over shortest mean edge of a cell
  Extreme skewness;                ///< largest departure of a face's angle from 90 degrees, over 90
  Extreme scaled_jacobian;         ///< smallest; 1 is a box, <= 0 a folded corner
  Extreme non_orthogonality;       ///< [deg] largest, between a face's vector and the line of the centres on both its sides
  Extreme stretch;                 ///< largest ratio of neighbouring edges along a line, within blocks
  Extreme volume_ratio;            ///< largest, of neighbours in a block
};

/// Volumes need not be positive; a planar grid's k is left out.
GridQuality grid_quality(const MultiBlockGrid& grid);
/// Of the layers that a part counts; cells have their numbers in the whole.
GridQuality grid_quality(const GridLayers& part);
/// Adds what another part has.
void merge(GridQuality& all, const GridQuality& part);

/// A table for the terminal, one figure a line with its place.
std::string describe(const GridQuality& quality, const MultiBlockGrid& grid);

}  // namespace spindrift::aero
