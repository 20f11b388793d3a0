// Parcels of any size between ranks come as they went.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/mpi/exchange.hpp"

#include <catch2/catch.hpp>

#include <utility>

#include "runtime/mpi/gather.hpp"

using namespace spindrift::runtime;

namespace {
int sent = 0;  ///< messages from this rank to another one
}
// In place of MPI's own, which PMPI_Isend still is: counts.
extern "C" int MPI_Isend(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request* request) {
  ++sent;
  return PMPI_Isend(data, count, type, to, tag, comm, request);
}

TEST_CASE("values and arrays come out of a parcel as they went in, and not more of them", "[runtime][fast]") {
  Packer packer;
  CHECK(packer.empty());
  packer.put_one(3.5);
  packer.put(std::span<const int>(std::vector<int>{1, 2, 3}));
  packer.put(std::span<const double>());
  const Bytes bytes = packer.take();
  Unpacker unpacker(bytes);
  CHECK(unpacker.one<double>() == 3.5);
  CHECK(unpacker.many<int>() == std::vector<int>{1, 2, 3});
  CHECK(unpacker.many<double>().empty());
  CHECK(unpacker.done());
  CHECK_THROWS(unpacker.one<char>());
  CHECK(exchange(MPI_COMM_SELF, {bytes}) == std::vector<Bytes>{bytes});
}

TEST_CASE("each rank gets what every other one addressed to it", "[runtime][mpi2][mpi4]") {
  const int rank = rank_in(MPI_COMM_WORLD), ranks = ranks_in(MPI_COMM_WORLD);
  std::vector<Bytes> to{std::size_t(ranks), Bytes{}};
  for (int r = 0; r < ranks; ++r) to[std::size_t(r)] = Bytes(std::size_t(1000 * rank + r), std::byte(10 * rank + r));
  const auto from = exchange(MPI_COMM_WORLD, to);
  REQUIRE(int(from.size()) == ranks);
  for (int r = 0; r < ranks; ++r) CHECK(from[std::size_t(r)] == Bytes(std::size_t(1000 * r + rank), std::byte(10 * r + rank)));
  const auto all = exchange_all(MPI_COMM_WORLD, Bytes(std::size_t(rank), std::byte(7)));
  for (int r = 0; r < ranks; ++r) CHECK(all[std::size_t(r)].size() == std::size_t(r));
}

TEST_CASE("a parcel for all ranks comes whole, in however many rounds, with as few calls of MPI on any number of ranks",
          "[runtime][mpi2][mpi4]") {
  const int rank = rank_in(MPI_COMM_WORLD), ranks = ranks_in(MPI_COMM_WORLD);
  const auto parcel_of = [](int r) {
    Bytes parcel(std::size_t(r % 2 == 0 ? 1000 * r : 0));  // the first of none, others of more than a round has
    for (std::size_t n = 0; n < parcel.size(); ++n) parcel[n] = std::byte((n + std::size_t(r)) % 251);
    return parcel;
  };
  const std::size_t at_once = GENERATE(1, 64, 1000, 1 << 20);
  sent = 0;
  const auto all = gather_from_all(MPI_COMM_WORLD, parcel_of(rank), at_once);
  CHECK(sent == 0);
  REQUIRE(int(all.size()) == ranks);
  for (int r = 0; r < ranks; ++r) CHECK(all[std::size_t(r)] == parcel_of(r));
}
