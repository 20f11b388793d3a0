// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/coarsen.hpp"

#include <fmt/format.h>

#include "kernels/base/failure.hpp"

namespace spindrift::aero {

namespace {

int half(int n, const MultiBlockGrid& grid, int block) {
  const Block& b = grid.blocks[std::size_t(block)];
  if (n % 2 != 0)
    throw NumericalFailure(fmt::format("grid cannot be coarsened: block {} ({} x {} x {} cells) has an edge at the odd index {}",
                                       b.name, b.ni, b.nj, b.nk, n),
                           b.name, 0, 0.0);
  return n / 2;
}

Window half(Window w, const MultiBlockGrid& grid) {
  for (int d = 0; d < 2; ++d)
    w.low[std::size_t(d)] = half(w.low[std::size_t(d)], grid, w.block),
    w.high[std::size_t(d)] = half(w.high[std::size_t(d)], grid, w.block);
  return w;
}

}  // namespace

MultiBlockGrid coarsened(const MultiBlockGrid& fine) {
  MultiBlockGrid grid;
  for (int n = 0; n < int(fine.blocks.size()); ++n) {
    const Block& f = fine.blocks[std::size_t(n)];
    Block c{.name = f.name, .ni = half(f.ni, fine, n), .nj = half(f.nj, fine, n), .nk = half(f.nk, fine, n)};
    for (int k = 0; k <= c.nk && !f.nodes.empty(); ++k)
      for (int j = 0; j <= c.nj; ++j)
        for (int i = 0; i <= c.ni; ++i) c.nodes.push_back(f.nodes[f.node(2 * k, 2 * j, 2 * i)]);
    grid.blocks.push_back(std::move(c));
  }
  for (Connection c : fine.connections) {
    c.from = half(c.from, fine), c.to = half(c.to, fine);
    grid.connections.push_back(c);
  }
  for (const Boundary& b : fine.boundaries) grid.boundaries.push_back({half(b.where, fine), b.patch});
  return grid;
}

}  // namespace spindrift::aero
