// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/coarsen.hpp"

#include <fmt/format.h>

#include "src/aero/grid/index_map.hpp"

namespace spindrift::aero {

namespace {

int stride(int cells) { return cells == 1 ? 1 : 2; }

std::string odd_edge(const MultiBlockGrid& grid, const Window& w) {
  const Block& b = grid.blocks[std::size_t(w.block)];
  for (int n = 0; n < 2; ++n)
    for (const int edge : {w.low[std::size_t(n)], w.high[std::size_t(n)]})
      if (const int s = stride(b.cells()[std::size_t(along(w.side)[std::size_t(n)])]); edge % s != 0)
        return fmt::format("block {} has a window that begins or ends at cell {} along {}", b.name, edge,
                           "ijk"[along(w.side)[std::size_t(n)]]);
  return {};
}

Window halved(const MultiBlockGrid& grid, Window w) {
  for (std::size_t n = 0; n < 2; ++n) {
    const int s = stride(grid.blocks[std::size_t(w.block)].cells()[std::size_t(along(w.side)[n])]);
    w.low[n] /= s, w.high[n] /= s;
  }
  return w;
}

}  // namespace

std::string why_not_halved(const MultiBlockGrid& grid) {
  for (const Block& b : grid.blocks)
    for (std::size_t d = 0; d < 3; ++d)
      if (const int n = b.cells()[d]; n % stride(n) != 0 || (n > 1 && n < 4))
        return fmt::format("block {} has {} cells along {}", b.name, n, "ijk"[d]);
  const auto first_of = [&](std::string&& found, std::string&& other) {
    return found.empty() ? std::move(other) : std::move(found);
  };
  std::string why;
  for (const Connection& c : grid.connections)
    why = first_of(std::move(why), first_of(odd_edge(grid, c.from), odd_edge(grid, c.to)));
  for (const Boundary& b : grid.boundaries) why = first_of(std::move(why), odd_edge(grid, b.where));
  return why;
}

MultiBlockGrid halved(const MultiBlockGrid& grid) {
  MultiBlockGrid coarse;
  coarse.planar = grid.planar;
  for (const Block& b : grid.blocks) {
    const int si = stride(b.ni), sj = stride(b.nj), sk = stride(b.nk);
    Block c{.name = b.name, .ni = b.ni / si, .nj = b.nj / sj, .nk = b.nk / sk, .nodes = {}};
    for (int k = 0; k <= c.nk; ++k)
      for (int j = 0; j <= c.nj; ++j)
        for (int i = 0; i <= c.ni; ++i) c.nodes.push_back(b.nodes[b.node(k * sk, j * sj, i * si)]);
    coarse.blocks.push_back(std::move(c));
  }
  for (Connection c : grid.connections) {
    c.from = halved(grid, c.from), c.to = halved(grid, c.to);
    coarse.connections.push_back(std::move(c));
  }
  for (Boundary b : grid.boundaries) {
    b.where = halved(grid, b.where);
    coarse.boundaries.push_back(std::move(b));
  }
  return coarse;
}

}  // namespace spindrift::aero
