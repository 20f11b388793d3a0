// SPDX-License-Identifier: Apache-2.0
#include "runtime/mpi/exchange.hpp"

#include <algorithm>
#include <utility>

#include "runtime/mpi/gather.hpp"

namespace spindrift::runtime {
namespace {

constexpr int tag = 1;
constexpr std::size_t largest_message = std::size_t(1) << 30;   // MPI counts are int
constexpr std::size_t largest_gathered = std::size_t(1) << 28;  // of all ranks: in memory twice for a moment

}  // namespace

int rank_in(MPI_Comm comm) {
  if (comm == MPI_COMM_SELF) return 0;
  int rank;
  MPI_Comm_rank(comm, &rank);
  return rank;
}
int ranks_in(MPI_Comm comm) {
  if (comm == MPI_COMM_SELF) return 1;
  int ranks;
  MPI_Comm_size(comm, &ranks);
  return ranks;
}

std::vector<Bytes> exchange(MPI_Comm comm, const std::vector<Bytes>& to) {
  const int ranks = ranks_in(comm), self = rank_in(comm);
  std::vector<Bytes> from(to.size());
  from[std::size_t(self)] = to[std::size_t(self)];
  if (ranks == 1) return from;
  std::vector<unsigned long long> sizes(to.size()), coming(to.size());
  for (int r = 0; r < ranks; ++r) sizes[std::size_t(r)] = to[std::size_t(r)].size();
  MPI_Alltoall(sizes.data(), 1, MPI_UNSIGNED_LONG_LONG, coming.data(), 1, MPI_UNSIGNED_LONG_LONG, comm);
  std::vector<MPI_Request> requests;
  const auto in_pieces = [&](std::size_t size, auto&& post) {
    for (std::size_t at = 0; at < size; at += largest_message) {
      requests.emplace_back();
      post(at, int(std::min(largest_message, size - at)), &requests.back());
    }
  };
  for (int r = 0; r < ranks; ++r) {
    if (r == self) continue;
    Bytes& bytes = from[std::size_t(r)];
    bytes.resize(coming[std::size_t(r)]);
    in_pieces(bytes.size(), [&](std::size_t at, int count, MPI_Request* request) {
      MPI_Irecv(bytes.data() + at, count, MPI_BYTE, r, tag, comm, request);
    });
  }
  for (int r = 0; r < ranks; ++r) {
    if (r == self) continue;
    const Bytes& bytes = to[std::size_t(r)];
    in_pieces(bytes.size(), [&](std::size_t at, int count, MPI_Request* request) {
      MPI_Isend(bytes.data() + at, count, MPI_BYTE, r, tag, comm, request);
    });
  }
  MPI_Waitall(int(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  return from;
}

std::vector<Bytes> gather_from_all(MPI_Comm comm, const Bytes& mine, std::size_t at_once) {
  const auto ranks = std::size_t(ranks_in(comm));
  if (ranks == 1) return {mine};
  const unsigned long long own = mine.size();
  std::vector<unsigned long long> sizes(ranks);
  MPI_Allgather(&own, 1, MPI_UNSIGNED_LONG_LONG, sizes.data(), 1, MPI_UNSIGNED_LONG_LONG, comm);
  std::vector<Bytes> from(ranks);
  for (std::size_t r = 0; r < ranks; ++r) from[r].reserve(sizes[r]);
  const std::size_t most = std::max<std::size_t>(1, at_once / ranks), longest = *std::max_element(sizes.begin(), sizes.end());
  std::vector<int> counts(ranks), starts(ranks);
  Bytes gathered;
  for (std::size_t done = 0; done < longest; done += most) {
    int total = 0;
    for (std::size_t r = 0; r < ranks; ++r) {
      counts[r] = int(sizes[r] > done ? std::min<std::size_t>(most, sizes[r] - done) : 0);
      starts[r] = std::exchange(total, total + counts[r]);
    }
    gathered.resize(std::size_t(total));
    MPI_Allgatherv(done < own ? mine.data() + done : nullptr, counts[std::size_t(rank_in(comm))], MPI_BYTE, gathered.data(),
                   counts.data(), starts.data(), MPI_BYTE, comm);
    for (std::size_t r = 0; r < ranks; ++r) {
      const auto first = gathered.begin() + starts[r];
      from[r].insert(from[r].end(), first, first + counts[r]);
    }
  }
  return from;
}

std::vector<Bytes> exchange_all(MPI_Comm comm, const Bytes& mine) { return gather_from_all(comm, mine, largest_gathered); }

}  // namespace spindrift::runtime
