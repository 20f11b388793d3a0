// Numbers that each owned tile gives and that a reduction makes one of over all ranks. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace spindrift::aero {

struct TileSums {
  std::vector<double> partials;  ///< [tile][number], of owned tiles
  std::vector<double> result;    ///< [number], of all tiles of all ranks

  void resize(std::size_t owned, std::size_t numbers) { partials.resize(owned * numbers), result.resize(numbers); }
  /// Of one tile.
  std::span<double> of(std::size_t tile) { return std::span(partials).subspan(tile * result.size(), result.size()); }
  double one() const { return result[0]; }
};

}  // namespace spindrift::aero
