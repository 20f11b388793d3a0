// The stencil of Task Bench by plain MPI, beside our runtime: each rank has a piece of the line and sends its ends on after each
// step. Run by perf/runtime/run on two ranks. SPDX-License-Identifier: Apache-2.0
#include <mpi.h>

#include <memory>

#include "perf/runtime/task_bench.hpp"

namespace spindrift::perf {
namespace {

/// A rank's points and, beside them, one of each neighbour's.
struct Piece {
  Points& x;
  int rank;
  std::size_t first() const { return x.size() * std::size_t(rank) / threads; }
  std::size_t end() const { return x.size() * std::size_t(rank + 1) / threads; }

  void exchange(int half) {
    MPI_Request requests[4];
    int n = 0;
    const auto with = [&](int other, std::size_t mine, std::size_t theirs) {
      MPI_Irecv(&x.cell(half, theirs), int(sizeof(Points::Cell)), MPI_BYTE, other, 0, MPI_COMM_WORLD, &requests[n++]);
      MPI_Isend(&x.cell(half, mine), int(sizeof(Points::Cell)), MPI_BYTE, other, 0, MPI_COMM_WORLD, &requests[n++]);
    };
    if (rank > 0) with(rank - 1, first(), first() - 1);
    if (rank + 1 < threads) with(rank + 1, end() - 1, end());
    MPI_Waitall(n, requests, MPI_STATUSES_IGNORE);
  }
  int operator()(long n, int steps) {
    x.begin();
    MPI_Barrier(MPI_COMM_WORLD);
    for (int s = 0; s < steps; ++s) {
      for (std::size_t i = first(); i < end(); ++i) x.work(s % 2, i, n);
      exchange(s % 2);
    }
    MPI_Barrier(MPI_COMM_WORLD);
    x.require_right(steps, first(), end());
    return steps;
  }
};

/// Of rank 0, on all: so that all take the same decisions.
double common(double value) {
  MPI_Bcast(&value, 1, MPI_DOUBLE, 0, MPI_COMM_WORLD);
  return value;
}

/// Nanoseconds of an iteration of grain with all ranks at it.
double iteration_ns() {
  std::vector<double> times;
  for (int sample = 0; sample < 9; ++sample) {
    MPI_Barrier(MPI_COMM_WORLD);
    times.push_back(seconds([] { grain(2'000'000); }) / 2e6 * 1e9);
  }
  return common(quantile(times, 0.5));
}

}  // namespace
}  // namespace spindrift::perf

int main(int argc, char** argv) {
  using namespace spindrift::perf;
  MPI_Init(&argc, &argv);
  int rank = 0, ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank), MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks != threads) {
    std::fprintf(stderr, "perf_runtime_mpi: runs on %d ranks\n", threads);
    MPI_Abort(MPI_COMM_WORLD, 2);
  }
  const auto group = rank == 0 ? std::make_unique<Group>("runtime_mpi", argc, argv) : nullptr;
  for (const int width : {64, 4}) {
    Points x(line(width));
    Piece piece{x, rank};
    const auto run = [&](long n, int steps) { return piece(n, steps); };
    const double us = metg_us(run, x.size(), iteration_ns, common);
    if (group) group->figure("metg_50/width_" + std::to_string(width) + "/mpi", us, "us");
  }
  MPI_Finalize();
}
