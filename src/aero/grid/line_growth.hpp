// How fast cells grow along a line that leaves a wall, as far as the boundary layer's steep part reaches. Called for grids before
// a run (src/aero/first_cells.cpp) and for tiles of a flow (src/aero/flow/loads.cpp); tested in
// tests/src/aero/first_cells_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace spindrift::aero {

/// How far from the wall growth counts, in units of its friction: to the end of the logarithmic layer of a section's flow.
inline constexpr double wall_layer_y_plus = 300.0;

/// [m], from the y+ of the first cell's centre and its distance from the wall.
inline double reach_of_growth(double y_plus, double distance) { return wall_layer_y_plus * distance / std::max(y_plus, 1e-12); }

/// Takes the heights of a line's cells from the wall on.
class LineGrowth {
 public:
  explicit LineGrowth(double reach) : reach_(reach) {}

  void add(double height) {
    if (before_ > 0.0 && height > 0.0) largest_ = std::max({largest_, height / before_, before_ / height});
    before_ = height, distance_ += height;
  }
  /// The cell after this one would begin beyond the reach.
  bool done() const { return distance_ > reach_; }
  /// Ratio of neighbouring heights, the larger over the smaller; 1 where there are no two.
  double largest() const { return largest_; }

 private:
  double reach_, before_ = 0.0, distance_ = 0.0, largest_ = 1.0;
};

}  // namespace spindrift::aero
