// More threads or ranks than processors: no collapse. With threads that spin, 4 threads on 2 cores take 10 to 100 times as long.
// SPDX-License-Identifier: Apache-2.0
#include <sched.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <numeric>

#include "runtime/executor/executor.hpp"

using namespace spindrift::runtime;

namespace {

void work() {
  volatile double x = 1;
  for (int n = 0; n < 10000; ++n) x = x * 0.999 + 0.001;
}

/// Seconds of 200 steps of a chain of blocks, each waiting for its neighbours, dealt to the ranks of `comm`. Best of three.
double chain_seconds(MPI_Comm comm, int threads) {
  constexpr int blocks = 16;
  int rank, ranks;
  MPI_Comm_rank(comm, &rank), MPI_Comm_size(comm, &ranks);
  const auto owner = [&](int b) { return b * ranks / blocks; };
  std::vector<double> halo(2 * blocks);
  Graph g(comm);
  const auto u = g.data(blocks), v = g.data(blocks);
  for (int b = 0; b < blocks; ++b)
    for (const int other : {b - 1, b + 1}) {
      if (other < 0 || other >= blocks || owner(other) == owner(b)) continue;
      const auto s = std::size_t(b);
      const int tag = 2 * b + (other > b);
      if (owner(b) == rank) g.send("send", {reads(u[s])}, {owner(other), tag, buffer_of(std::span(&halo[s], 1))});
      if (owner(other) == rank) g.receive("receive", {writes(u[s])}, {owner(b), tag, buffer_of(std::span(&halo[blocks + s], 1))});
    }
  for (int b = 0; b < blocks; ++b) {
    if (owner(b) != rank) continue;
    const auto s = std::size_t(b), left = s == 0 ? s : s - 1, right = s + 1 == blocks ? s : s + 1;
    g.task("relax", {reads(u[left]), reads(u[s]), reads(u[right]), writes(v[s])}, work);
  }
  for (int b = 0; b < blocks; ++b)
    if (owner(b) == rank) g.task("move", {reads(v[std::size_t(b)]), writes(u[std::size_t(b)])}, [] {});
  Executor executor(std::move(g), {.threads = threads});
  double best = 1e9;
  for (int n = 0; n < 3; ++n) {
    MPI_Barrier(comm);
    const auto start = std::chrono::steady_clock::now();
    executor.run(200);
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  MPI_Allreduce(MPI_IN_PLACE, &best, 1, MPI_DOUBLE, MPI_MAX, comm);
  return best;
}

int processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  sched_getaffinity(0, sizeof set, &set);
  return CPU_COUNT(&set);
}

}  // namespace

TEST_CASE("twice as many threads as processors take less than three times as long", "[runtime][nightly]") {
  const int n = std::max(2, processors());
  const double as_many = chain_seconds(MPI_COMM_SELF, n), twice = chain_seconds(MPI_COMM_SELF, 2 * n);
  INFO(as_many << " s with " << n << " threads, " << twice << " s with " << 2 * n);
  CHECK(twice < 3 * as_many);
}

TEST_CASE("four ranks on two processors take less than three times as long as two", "[runtime][mpi4][nightly]") {
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm two;
  MPI_Comm_split(MPI_COMM_WORLD, rank < 2 ? 0 : MPI_UNDEFINED, 0, &two);
  double with_two = 0;
  if (two != MPI_COMM_NULL) {
    with_two = chain_seconds(two, 1);
    MPI_Comm_free(&two);
  }
  MPI_Bcast(&with_two, 1, MPI_DOUBLE, 0, MPI_COMM_WORLD);
  const double with_four = chain_seconds(MPI_COMM_WORLD, 1);
  INFO(with_two << " s with 2 ranks, " << with_four << " s with 4");
  CHECK(with_four < 3 * with_two);
}

TEST_CASE("four ranks of four threads on two processors end", "[runtime][mpi4]") { CHECK(chain_seconds(MPI_COMM_WORLD, 4) < 60); }
