// The processor time of posting a reduction: that of the thread alone, so that ranks which share a core do not count.
// perf/reductions/run starts it on 64 ranks and counts the messages. Makes 220 reductions (20 to warm up) of each kind: one
// component and eight, from one part and from 64. SPDX-License-Identifier: Apache-2.0
#include <mpi.h>

#include <ctime>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "perf/harness.hpp"
#include "runtime/mpi/allreduce.hpp"
#include "runtime/mpi/environment.hpp"

namespace {

using namespace spindrift;

/// Of a thread, whoever else runs on its core.
double thread_microseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * double(now.tv_sec) + 1e-3 * double(now.tv_nsec);
}

/// Of asking for the time itself [us].
double clock_time() {
  std::vector<double> times;
  for (int n = 0; n < 1000; ++n) {
    const double begin = thread_microseconds();
    times.push_back(thread_microseconds() - begin);
  }
  return perf::spread(times).median;
}

constexpr int warm_ups = 20, reductions = 200;

/// Median over reductions and ranks of the processor time of a post [us], on rank 0.
double post_time(const runtime::World& world, std::size_t components, std::size_t parts) {
  std::vector<double> partials(components * parts), sums(components);
  std::iota(partials.begin(), partials.end(), double(world.rank));
  runtime::Allreduce reduction("perf/reductions", {.partials = partials, .result = sums}, world.comm, world.size);
  std::vector<double> posts;
  for (int n = -warm_ups; n < reductions; ++n) {
    MPI_Request request;
    const double begin = thread_microseconds();
    reduction.post(request);
    const double end = thread_microseconds();
    MPI_Wait(&request, MPI_STATUS_IGNORE);
    reduction.finish();
    if (n >= 0) posts.push_back(end - begin);
  }
  reduction.release();
  std::vector<double> all(posts.size() * std::size_t(world.size));
  MPI_Gather(posts.data(), int(posts.size()), MPI_DOUBLE, all.data(), int(posts.size()), MPI_DOUBLE, 0, world.comm);
  return world.rank == 0 ? perf::spread(all).median : 0.0;
}

}  // namespace

int main(int argc, char** argv) {
  runtime::MpiEnvironment mpi(argc, argv);
  const runtime::World& world = mpi.world();
  std::optional<perf::Group> group;
  if (world.rank == 0) group.emplace("reductions", argc, argv);
  const double clock = clock_time();
  const std::string ranks = std::to_string(world.size) + " ranks";
  for (const std::size_t components : {1, 8}) {
    const double one = post_time(world, components, 1), many = post_time(world, components, 64);
    if (!group) continue;
    const std::string of = "sum_of_" + std::to_string(components);
    group->at_most(of + "/post", one - clock, "us", 3.0, perf::Ceiling::none, ranks + ", one part: processor time, median");
    group->figure(of + "/post_64_parts", many - clock, "us", ranks);
  }
}
