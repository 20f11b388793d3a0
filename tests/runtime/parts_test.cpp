// Ranks dealt out to parts of the work: order of ranks, communicators of the parts, parcels from one part to all.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/mpi/parts.hpp"

#include <catch2/catch.hpp>

#include <stdexcept>
#include <utility>

using namespace spindrift::runtime;

namespace {

Bytes parcel_of(int value) {
  Packer packer;
  packer.put_one(value);
  return packer.take();
}
int value_in(const Bytes& parcel) { return Unpacker(parcel).one<int>(); }

}  // namespace

TEST_CASE("a world that is not split has all parts on every rank and sends nothing", "[runtime][fast]") {
  const Parts parts = World{MPI_COMM_SELF, 0, 1};
  CHECK_FALSE(parts.split());
  CHECK((parts.has(0) && parts.has(1)));
  CHECK(parts.mine().size == 1);
  CHECK(value_in(parts.share(1, parcel_of(7))) == 7);
  CHECK(parts.waited_ns() == 0);
}

TEST_CASE("split ranks stand in the order of their parts and hear the first rank of each", "[runtime][mpi2][mpi4]") {
  const int rank = rank_in(MPI_COMM_WORLD), ranks = ranks_in(MPI_COMM_WORLD);
  const World world{MPI_COMM_WORLD, rank, ranks};
  const Parts parts(world, 2, rank == 0 ? 1 : 0);  // the world's first rank alone has the last part
  CHECK(parts.split());
  CHECK(parts.part() == (rank == 0 ? 1 : 0));
  CHECK(parts.has(0) == (rank != 0));
  CHECK(parts.world().rank == (rank == 0 ? ranks - 1 : rank - 1));
  CHECK(parts.world().size == ranks);
  CHECK(parts.mine().size == (rank == 0 ? 1 : ranks - 1));
  CHECK(parts.mine().rank == (rank == 0 ? 0 : rank - 1));
  CHECK(rank_in(parts.mine().comm) == parts.mine().rank);
  CHECK(value_in(parts.share(0, parcel_of(100 + rank))) == 101);
  CHECK(value_in(parts.share(1, parcel_of(100 + rank))) == 100);
  CHECK(parts.share(1, rank == 0 ? Bytes(1000, std::byte(3)) : Bytes()).size() == 1000);
  const Parts moved = [&] { return Parts(world, 2, rank % 2); }();
  CHECK(moved.world().size == ranks);
}

TEST_CASE("a part without a rank is refused on all ranks", "[runtime][mpi2][mpi4]") {
  const World world{MPI_COMM_WORLD, rank_in(MPI_COMM_WORLD), ranks_in(MPI_COMM_WORLD)};
  CHECK_THROWS_AS(Parts(world, 2, 1), std::invalid_argument);
}

TEST_CASE("sums over ranks are the same on each of them", "[runtime][mpi2][mpi4]") {
  const int rank = rank_in(MPI_COMM_WORLD), ranks = ranks_in(MPI_COMM_WORLD);
  CHECK(summed(MPI_COMM_WORLD, {double(rank), 1.0}) == std::vector<double>{0.5 * ranks * (ranks - 1), double(ranks)});
}
