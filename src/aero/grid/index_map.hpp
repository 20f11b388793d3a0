// Integer maps between the index spaces of blocks and tiles: a signed permutation of the directions and an offset.
// Used by tiling, checks, files; tested in tests/src/aero/grid/tiling_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>

#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

using Index = std::array<int, 3>;  ///< (i, j, k)

/// Walking along direction d of the source is walking along |axes[d]| - 1 of the target, backwards where negative:
/// target[|axes[d]| - 1] = offset[|axes[d]| - 1] + sign(axes[d]) source[d].
struct IndexMap {
  Index axes{1, 2, 3};
  Index offset{};

  int target(int d) const { return std::abs(axes[d]) - 1; }
  int sign(int d) const { return axes[d] > 0 ? 1 : -1; }
  Index operator()(const Index& source) const {
    Index result = offset;
    for (int d = 0; d < 3; ++d) result[target(d)] += sign(d) * source[d];
    return result;
  }
  /// The side of the target that this side of the source becomes.
  Side operator()(Side side) const {
    const int d = direction_of(side);
    return Side(2 * target(d) + (at_end(side) == (sign(d) > 0) ? 1 : 0));
  }
  IndexMap inverse() const {
    IndexMap back;
    for (int d = 0; d < 3; ++d) {
      back.axes[target(d)] = sign(d) * (d + 1);
      back.offset[d] = -sign(d) * offset[target(d)];
    }
    return back;
  }
  /// First `before`, then this.
  IndexMap after(const IndexMap& before) const {
    IndexMap both;
    both.offset = (*this)(before.offset);
    for (int d = 0; d < 3; ++d) both.axes[d] = before.sign(d) * axes[before.target(d)];
    return both;
  }
  /// +1 where right-handed stays right-handed.
  int handedness() const {
    const int a = target(0), b = target(1), c = target(2);
    const int even = ((b - a + 3) % 3 == 1 && (c - b + 3) % 3 == 1) ? 1 : -1;
    return even * sign(0) * sign(1) * sign(2);
  }
};

/// Cells low <= index < high.
struct Box {
  Index low{}, high{};
  bool empty() const { return low[0] >= high[0] || low[1] >= high[1] || low[2] >= high[2]; }
  long cells() const { return empty() ? 0 : long(high[0] - low[0]) * (high[1] - low[1]) * (high[2] - low[2]); }
};
inline Box intersection(const Box& a, const Box& b) {
  Box both;
  for (int d = 0; d < 3; ++d) both.low[d] = std::max(a.low[d], b.low[d]), both.high[d] = std::min(a.high[d], b.high[d]);
  return both;
}
/// The box of the images of a box's cells.
inline Box image(const IndexMap& map, const Box& box) {
  Index last = box.high;
  for (int& n : last) --n;
  const Index a = map(box.low), b = map(last);
  Box result;
  for (int d = 0; d < 3; ++d) result.low[d] = std::min(a[d], b[d]), result.high[d] = std::max(a[d], b[d]) + 1;
  return result;
}

/// The two directions along a side, lower first.
inline std::array<int, 2> along(Side side) {
  const int d = direction_of(side);
  return {d == 0 ? 1 : 0, d == 2 ? 1 : 2};
}
/// The layer of cells under a window; `outside` the layer beyond it.
inline Box cells_at(const Window& window, const Index& cells, bool outside) {
  const int d = direction_of(window.side);
  const auto [a, b] = along(window.side);
  Box box;
  box.low[a] = window.low[0], box.high[a] = window.high[0];
  box.low[b] = window.low[1], box.high[b] = window.high[1];
  box.low[d] = at_end(window.side) ? cells[d] - (outside ? 0 : 1) : (outside ? -1 : 0);
  box.high[d] = box.low[d] + 1;
  return box;
}

/// From the cell indices of `from.block`, continued beyond its side, to those of `to.block`.
IndexMap cell_map(const Connection& connection, const MultiBlockGrid& grid);

}  // namespace spindrift::aero
