// SPDX-License-Identifier: Apache-2.0
#include "src/aero/tile_balance.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "kernels/base/release.hpp"
#include "runtime/mpi/exchange.hpp"
#include "runtime/partition/partition.hpp"
#include "src/aero/flow/tasks.hpp"

namespace spindrift::aero {

std::vector<int> ranks_by_cells(const Tiling& tiling, int ranks) {
  if (ranks == 1) return std::vector<int>(std::size_t(tiling.size()), 0);
  return runtime::partition_blocks(tile_graph(tiling), {.ranks = ranks}).rank_of_block;
}

std::vector<double> seconds_of_tiles(const GridStore& store, std::span<const runtime::Executor* const> executors) {
  std::vector<double> of_tile(std::size_t(store.tiling().size()), 0.0), seconds;
  for (const runtime::Executor* executor : executors) {
    const std::span<const runtime::Node> nodes = executor->graph().nodes();
    for (std::uint32_t n = 0; n < nodes.size(); ++n)
      if (const int tile = tile_of(nodes[n]); tile >= 0)
        of_tile.at(std::size_t(tile)) += 1e-9 * double(executor->cost(n).total_ns);
  }
  for (const int tile : store.owned()) seconds.push_back(of_tile[std::size_t(tile)]);
  return seconds;
}

std::optional<TileMove> better_ranks(const GridStore& store, std::span<const double> seconds, const MoveTerms& terms,
                                     MPI_Comm comm, double above) {
  const int ranks = runtime::ranks_in(comm);
  const std::span<const int> rank_of_tile = store.rank_of_tile();
  runtime::Packer mine;
  mine.put_one(terms), mine.put(seconds);
  std::vector<std::vector<double>> of_rank;
  MoveTerms worst = terms;
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take())) {
    runtime::Unpacker from(bytes);
    const auto theirs = from.one<MoveTerms>();
    worst = {std::max(worst.move_s, theirs.move_s), std::min(worst.ahead, theirs.ahead), std::max(worst.threads, theirs.threads)};
    of_rank.push_back(from.many<double>());
  }
  runtime::BlockGraph graph = tile_graph(store.tiling());
  std::vector<std::size_t> next(std::size_t(ranks), 0);
  for (std::size_t t = 0; t < graph.cost.size(); ++t) {
    const auto rank = std::size_t(rank_of_tile[t]);
    graph.cost[t] = of_rank[rank].at(next[rank]++);
  }
  const std::vector<int> present(rank_of_tile.begin(), rank_of_tile.end());
  const double now = runtime::partition_quality(graph, present, ranks).imbalance[0];
  if (now <= above) return std::nullopt;
  runtime::Partition better = runtime::partition_blocks(graph, {.ranks = ranks}, comm);
  const double then = better.quality.imbalance[0];
  const double mean_s = std::accumulate(graph.cost.begin(), graph.cost.end(), 0.0) / ranks / worst.threads;
  if (better.quality.empty_ranks > 0 || then > 0.9 * now || (now - then) * mean_s * worst.ahead <= worst.move_s)
    return std::nullopt;
  return TileMove{std::move(better.rank_of_block), now, then};
}

FlowSnapshot send_tiles(FlowSnapshot mine, std::span<const int> owned, std::span<const int> rank_of_tile, MPI_Comm comm) {
  const bool notes = !mine.set_up.tiles.empty();
  std::vector<runtime::Packer> packers(std::size_t(runtime::ranks_in(comm)));
  for (std::size_t n = 0; n < owned.size(); ++n) {
    runtime::Packer& to = packers[std::size_t(rank_of_tile[std::size_t(owned[n])])];
    to.put_one(owned[n]), to.put(std::span<const double>(std::exchange(mine.tiles[n], {})));
    to.put(std::span<const double>(notes ? std::exchange(mine.set_up.tiles[n], {}) : std::vector<double>()));
  }
  std::vector<runtime::Bytes> parcels;
  for (runtime::Packer& packer : packers) parcels.push_back(packer.take());
  struct Values {
    std::vector<double> state, note;
  };
  std::map<int, Values> by_tile;
  std::vector<runtime::Bytes> came = runtime::exchange(comm, parcels);
  parcels.clear();
  for (runtime::Bytes& bytes : came) {
    for (runtime::Unpacker from(bytes); !from.done();) {
      Values& values = by_tile[from.one<int>()];
      values.state = from.many<double>(), values.note = from.many<double>();
    }
    release(bytes);
  }
  FlowSnapshot theirs{.tiles = {}, .march = std::move(mine.march), .set_up = {}};
  for (auto& [tile, values] : by_tile) {
    theirs.tiles.push_back(std::move(values.state));
    if (!values.note.empty()) theirs.set_up.tiles.push_back(std::move(values.note));
  }
  return theirs;
}

}  // namespace spindrift::aero
