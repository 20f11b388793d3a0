// Which ranks of a run work on which part of it: every rank on all parts, or each on one, with a communicator for the ranks of a
// part and parcels from one part to everybody. Used by src/coupling (placement); tested in tests/runtime/parts_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/mpi/communicator.hpp"
#include "runtime/mpi/environment.hpp"
#include "runtime/mpi/exchange.hpp"

namespace spindrift::runtime {

class Parts {
 public:
  /// Every rank works on every part. The world's communicator is to outlive it.
  Parts(const World& world);
  /// This rank works on `part` of 0, 1, ... `parts` - 1 alone. Collective. Throws std::invalid_argument, on all ranks alike,
  /// where a part has no rank.
  Parts(const World& world, int parts, int part);

  bool split() const { return !first_rank_.empty(); }
  bool has(int part) const { return !split() || part == part_; }
  /// All ranks; split ones in the order of their parts.
  const World& world() const { return world_; }
  /// Those that work on the same part: all where not split.
  const World& mine() const { return mine_; }
  /// This rank's part; -1 where it has all.
  int part() const { return part_; }

  /// What the first rank of a part has, on every rank. Collective; where not split every rank keeps its own, without a message.
  Bytes share(int part, Bytes parcel) const;
  /// Wall time of this rank inside share(): for other parts to be done [ns].
  std::int64_t waited_ns() const { return waited_ns_; }

 private:
  World world_, mine_;
  int part_ = -1;
  std::vector<int> first_rank_;  ///< by part, in world(); empty where not split
  Communicator own_world_, own_;
  mutable std::int64_t waited_ns_ = 0;
};

/// Sums over all ranks, the same on each of them, added in the order of ranks. For reports.
std::vector<double> summed(MPI_Comm comm, const std::vector<double>& mine);

}  // namespace spindrift::runtime
