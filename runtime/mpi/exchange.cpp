// SPDX-License-Identifier: Apache-2.0
#include "runtime/mpi/exchange.hpp"

#include <algorithm>

namespace spindrift::runtime {
namespace {

constexpr int tag = 1;
constexpr std::size_t largest_message = std::size_t(1) << 30;  // MPI counts are int

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

std::vector<Bytes> exchange_all(MPI_Comm comm, const Bytes& mine) {
  return runtime::exchange(comm, std::vector<Bytes>(std::size_t(ranks_in(comm)), mine));
}

}  // namespace spindrift::runtime
