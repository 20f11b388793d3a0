// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/load_balance.hpp"

#include <utility>

#include "runtime/mpi/stop_request.hpp"
#include "runtime/partition/partition.hpp"

namespace spindrift::sph {

namespace {

/// Of the groups of all ranks.
template <int dim, class Real>
std::vector<GroupCount> count_groups(const SeaState<dim, Real>& sea, const runtime::Communicator& comm) {
  runtime::Packer mine;
  for (const int g : sea.subdomain.own) {
    const Group& group = sea.store.groups[std::size_t(g)];
    mine.put_one(GroupCount{g, int(group.solid - group.fluid), int(group.end - group.solid)});
  }
  std::vector<GroupCount> all;
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm.get(), mine.take()))
    for (runtime::Unpacker from(bytes); !from.done();) all.push_back(from.one<GroupCount>());
  return all;
}

}  // namespace

template <int dim>
std::vector<int> first_ranks(const Columns<dim>& columns, const SeedStream<dim>& seeds, const runtime::Communicator& comm) {
  std::vector<GroupCount> counts(std::size_t(columns.groups()));
  const int ranks = comm.size();
  if (ranks == 1) return std::vector<int>(counts.size(), 0);
  for (int g = 0; g < columns.groups(); ++g) counts[std::size_t(g)] = {g, 0, 0};
  runtime::give_up_together(comm.get(), [&] {
    seeds.for_each_of_rank(comm.rank(), ranks, [&](std::size_t, const Seed<dim>& seed) {
      if (!columns.domain().contains(seed.position)) return;
      GroupCount& count = counts[std::size_t(columns.group(seed.position))];
      ++(seed.owner == 0 ? count.water : count.solid);
    });
  });
  runtime::Packer mine;
  for (GroupCount& c : counts)
    if (const GroupCount own = std::exchange(c, {c.group, 0, 0}); own.water > 0 || own.solid > 0) mine.put_one(own);
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm.get(), mine.take()))
    for (runtime::Unpacker from(bytes); !from.done();) {
      const auto of_rank = from.one<GroupCount>();
      counts[std::size_t(of_rank.group)].water += of_rank.water, counts[std::size_t(of_rank.group)].solid += of_rank.solid;
    }
  for (GroupCount& c : counts)
    c.water = (c.water + cluster_size - 1) / cluster_size, c.solid = (c.solid + cluster_size - 1) / cluster_size;
  return runtime::partition_blocks(block_graph(columns, counts), {.ranks = ranks}, comm.get()).rank_of_block;
}

template <int dim, class Real>
double imbalance(const SeaState<dim, Real>& sea, const runtime::Communicator& comm) {
  return runtime::partition_quality(block_graph(sea.columns, count_groups(sea, comm)), sea.subdomain.rank_of_group, comm.size())
      .imbalance[0];
}

template <int dim, class Real>
std::optional<std::vector<int>> better_ranks(const SeaState<dim, Real>& sea, double repartition_above,
                                             const runtime::Communicator& comm) {
  const runtime::BlockGraph graph = block_graph(sea.columns, count_groups(sea, comm));
  const int ranks = comm.size();
  const auto now = runtime::partition_quality(graph, sea.subdomain.rank_of_group, ranks);
  if (now.imbalance[0] <= repartition_above) return std::nullopt;
  const runtime::Partition better = runtime::partition_blocks(graph, {.ranks = ranks}, comm.get());
  if (better.quality.imbalance[0] > 0.9 * now.imbalance[0]) return std::nullopt;  // not worth the move
  return better.rank_of_block;
}

template <int dim, class Real>
std::vector<Saved<dim>> send_groups(const SeaState<dim, Real>& sea, const std::vector<int>& rank_of_group,
                                    const runtime::Communicator& comm) {
  std::vector<runtime::Bytes> parcels;
  for (int r = 0; r < comm.size(); ++r) {
    std::vector<int> theirs;
    for (const int g : sea.subdomain.own)
      if (rank_of_group.at(std::size_t(g)) == r) theirs.push_back(g);
    runtime::Packer packer;
    save_groups(sea, theirs).put(packer);
    parcels.push_back(packer.take());
  }
  std::vector<Saved<dim>> pieces;
  for (const runtime::Bytes& bytes : runtime::exchange(comm.get(), parcels)) {
    runtime::Unpacker from(bytes);
    pieces.push_back(Saved<dim>::take(from));
  }
  return pieces;
}

// One dimension and one precision at a time: SPINDRIFT_SPH_DIM and _REAL come from CMakeLists.txt, which compiles this file for
// each.
using Sea = SeaState<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>;
template std::vector<int> first_ranks(const Columns<SPINDRIFT_SPH_DIM>&, const SeedStream<SPINDRIFT_SPH_DIM>&,
                                      const runtime::Communicator&);
template double imbalance(const Sea&, const runtime::Communicator&);
template std::optional<std::vector<int>> better_ranks(const Sea&, double, const runtime::Communicator&);
template std::vector<Saved<SPINDRIFT_SPH_DIM>> send_groups(const Sea&, const std::vector<int>&, const runtime::Communicator&);

}  // namespace spindrift::sph
