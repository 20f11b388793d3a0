// Cells whose own bounds shorten an update: in how many updates there were any, how many at most, where the worst were. Kept by
// src/run/flow_simulation.cpp and src/coupling/air_march.cpp; tested in tests/src/aero/flow/update_limits_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

namespace spindrift::aero {

/// Where an update was shortened most, and by what.
struct LimitPlace {
  double fraction = 1.0;  ///< that was left of it; 1: nowhere
  std::string text;       ///< part of a sentence
};

/// Of the mean flow's updates, which are shortened as a whole, and of turbulence's, cell by cell.
struct LimitPlaces {
  LimitPlace mean, model;

  /// Both, as far as they are anywhere.
  std::string text() const;
  /// Keeps the worse ones of others: they were `when`.
  void keep_worse(const LimitPlaces& others, const std::string& when);
};

/// "12 cells (0.07 %) of the mean flow and 1 cell (0.006 %) of turbulence", of so many; empty where none has a limit.
std::string limited_update(double limited, double clipped, long cells);

class UpdateLimits {
 public:
  /// An update with so many cells beyond the mean flow's bounds, and so many in which turbulence was kept above its own.
  void count(double limited, double clipped) {
    shortened_ += limited > 0.0, clipped_ += clipped > 0.0, ++counted_;
    most_limited_ = std::max(most_limited_, limited), most_clipped_ = std::max(most_clipped_, clipped);
  }
  std::int64_t counted() const { return counted_; }
  std::int64_t shortened() const { return shortened_; }  ///< updates
  std::int64_t clipped() const { return clipped_; }      ///< likewise
  /// `updates`: which were counted, "300 pseudo-steps"; `cells`: of the grid. Empty where none had a limit.
  std::string text(const std::string& updates, long cells, const LimitPlaces& worst) const;

 private:
  std::int64_t counted_ = 0, shortened_ = 0, clipped_ = 0;
  double most_limited_ = 0.0, most_clipped_ = 0.0;
};

}  // namespace spindrift::aero
