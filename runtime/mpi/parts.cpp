// SPDX-License-Identifier: Apache-2.0
#include "runtime/mpi/parts.hpp"

#include <stdexcept>
#include <string>

#include "runtime/trace/clock.hpp"
#include "runtime/trace/ledger.hpp"

namespace spindrift::runtime {

Parts::Parts(const World& world) : world_(world), mine_(world) {}

Parts::Parts(const World& world, int parts, int part) : part_(part) {
  std::vector<int> ranks(std::size_t(parts), 0);
  ranks.at(std::size_t(part)) = 1;
  MPI_Allreduce(MPI_IN_PLACE, ranks.data(), parts, MPI_INT, MPI_SUM, world.comm);
  int before = 0;
  for (int p = 0; p < parts; before += ranks[std::size_t(p++)]) {
    if (ranks[std::size_t(p)] == 0) throw std::invalid_argument("part " + std::to_string(p) + " has no rank");
    first_rank_.push_back(before);
  }
  own_world_ = Communicator::split(world.comm, 0, part * world.size + world.rank);
  own_ = Communicator::split(own_world_.get(), part, own_world_.rank());
  world_ = {own_world_.get(), own_world_.rank(), own_world_.size()};
  mine_ = {own_.get(), own_.rank(), own_.size()};
}

Bytes Parts::share(int part, Bytes parcel) const {
  if (!split()) return parcel;
  const Span span("run/other part", Span::Kind::wait);
  const std::int64_t begin = Clock::now_ns();
  const int root = first_rank_.at(std::size_t(part));
  unsigned long long size = parcel.size();
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG_LONG, root, world_.comm);
  parcel.resize(size);
  MPI_Bcast(parcel.data(), int(size), MPI_BYTE, root, world_.comm);
  waited_ns_ += Clock::now_ns() - begin;
  return parcel;
}

std::vector<double> summed(MPI_Comm comm, const std::vector<double>& mine) {
  std::vector<double> all(mine.size() * std::size_t(ranks_in(comm)));
  MPI_Allgather(mine.data(), int(mine.size()), MPI_DOUBLE, all.data(), int(mine.size()), MPI_DOUBLE, comm);
  std::vector<double> sums(mine.size(), 0.0);
  for (std::size_t n = 0; n < all.size(); ++n) sums[n % mine.size()] += all[n];
  return sums;
}

}  // namespace spindrift::runtime
