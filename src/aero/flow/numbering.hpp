// Global numbers of points that tiles hold (cells, or groups of cells), process after process as sparse rows want them; who is
// the neighbour of whom across tiles; and values of points that other processes hold. No communication but for the latter. Used
// by poisson.cpp and coarse_correction.cpp; tested through them in tests/src/aero/flow. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include "runtime/mpi/exchange.hpp"

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "src/aero/grid/store.hpp"

namespace spindrift::aero {

struct Numbering {
  std::vector<int> first;          ///< by tile of the tiling: number of its first point
  std::vector<int> first_of_rank;  ///< by rank, and their end
  int begin = 0, end = 0;          ///< of this process
  bool here(int number) const { return number >= begin && number < end; }
  int rank_of(int number) const;
};
/// `points` says how many a tile has; the same on all processes.
Numbering number_points(const GridStore& grid, const std::function<int(const Tile&)>& points);

/// Calls body(link, side, inside, donor) for each face through which a tile meets another (or itself): the cell on this side and,
/// in the indices of tile link.from, that beyond.
template <class Body>
void for_neighbours(const Tiling& tiling, int tile, Body&& body) {
  const Index cells = tiling.tiles[std::size_t(tile)].cells();
  for (const GhostLink& link : tiling.into(tile)) {
    const int across = direction_of(link.side);
    const auto [a, b] = along(link.side);
    for (int v = link.low[1]; v < link.high[1]; ++v)
      for (int u = link.low[0]; u < link.high[0]; ++u) {
        Index inside{};
        inside[std::size_t(a)] = u, inside[std::size_t(b)] = v;
        inside[std::size_t(across)] = at_end(link.side) ? cells[std::size_t(across)] - 1 : 0;
        Index ghost = inside;
        ghost[std::size_t(across)] += at_end(link.side) ? 1 : -1;
        body(link, inside, link.donor(ghost));
      }
  }
}

/// Values of points of other processes, by position; asked for once, fetched often.
class OutsideValues {
 public:
  /// Position that the values of a point of another process will have.
  int want(int number);
  /// Values of all wanted points, `width` of each, from those that the processes hold. Collective.
  void fetch(const Numbering& numbering, std::span<const double> mine, int width, std::vector<double>& values, MPI_Comm comm);

 private:
  std::vector<std::pair<int, int>> wanted_;  ///< number, position; sorted once all are known
  int count_ = 0;
  bool agreed_ = false;
  std::vector<std::vector<int>> given_, taken_;  ///< by rank: offsets of points here, positions there
};

}  // namespace spindrift::aero
