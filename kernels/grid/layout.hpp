// Where the number at (k, j, i) of a box of cells, faces or nodes lies in memory: structure of arrays, component-major, i
// fastest. Rows are padded so that i = 0 of every row and component starts on a 64-byte line and a Wide load may run over the end
// of a row. Called by src/aero (store, sweeps); tested in tests/kernels/grid/layout_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace spindrift {

inline constexpr int row_lanes = 8;      ///< doubles of a 64-byte line: rows and components start at multiples of it
inline constexpr int load_overrun = 16;  ///< numbers that may be read past the last one of a component

constexpr int round_up(int n, int multiple) { return (n + multiple - 1) / multiple * multiple; }

/// A box of ni x nj x nk with ghost layers on both sides of each direction (ghosts[0] of i, ...). The ghosts below i = 0 use the
/// padding of the row before, so no row is longer than its contents rounded up. Edges and corners have room but are never filled.
struct BoxLayout {
  int ni = 0, nj = 0, nk = 0;
  std::array<int, 3> ghosts{};
  std::ptrdiff_t row = 0;        ///< from j to j + 1
  std::ptrdiff_t plane = 0;      ///< from k to k + 1
  std::ptrdiff_t origin = 0;     ///< of (0, 0, 0)
  std::ptrdiff_t component = 0;  ///< from one component to the next

  BoxLayout() = default;
  constexpr BoxLayout(int ni, int nj, int nk, std::array<int, 3> ghosts = {}) : ni(ni), nj(nj), nk(nk), ghosts(ghosts) {
    row = round_up(ni + 2 * ghosts[0], row_lanes);
    plane = row * (nj + 2 * ghosts[1]);
    origin = plane * ghosts[2] + row * ghosts[1] + round_up(ghosts[0], row_lanes);
    component = plane * (nk + 2 * ghosts[2]) + round_up(ghosts[0], row_lanes);
  }
  constexpr std::ptrdiff_t at(int k, int j, int i) const { return origin + k * plane + j * row + i; }
  constexpr std::ptrdiff_t stride(int direction) const { return direction == 0 ? 1 : direction == 1 ? row : plane; }
  /// Numbers to allocate for this many components.
  constexpr std::size_t size(int components) const { return std::size_t(component) * components + load_overrun; }
  constexpr std::size_t interior() const { return std::size_t(ni) * nj * nk; }
};

/// A box of one or more components seen as c(component, k, j, i); does not own.
template <class T>
struct BoxView {
  T* data = nullptr;
  BoxLayout layout;
  T& operator()(int c, int k, int j, int i) const { return data[c * layout.component + layout.at(k, j, i)]; }
  T* row(int c, int k, int j) const { return data + c * layout.component + layout.at(k, j, 0); }
  operator BoxView<const T>() const { return {data, layout}; }
};

}  // namespace spindrift
