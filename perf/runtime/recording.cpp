// What it costs to record a graph, to make it ready to run, and to run a million empty tasks; with the memory that stays.
// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include "perf/runtime/groups.hpp"
#include "runtime/executor/executor.hpp"

namespace spindrift::perf {
namespace {

using namespace spindrift::runtime;

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  double pages = 0, resident = 0;
  statm >> pages >> resident;
  return resident * 4096 / 1e6;
}

/// Tasks with labels and the accesses of a 1-D stencil, `steps` of them over `width` points.
Graph record(int width, int steps) {
  Graph graph;
  const std::vector<Datum> x[2] = {graph.data(std::size_t(width)), graph.data(std::size_t(width))};
  for (int s = 0; s < steps; ++s)
    for (int i = 0; i < width; ++i) {
      const auto& from = x[s % 2];
      graph.task("synthetic/stencil/point/" + std::to_string(i),
                 {reads(from[std::size_t(std::max(0, i - 1))]), reads(from[std::size_t(i)]),
                  reads(from[std::size_t(std::min(width - 1, i + 1))]), writes(x[1 - s % 2][std::size_t(i)])},
                 [] {});
    }
  return graph;
}

}  // namespace

void recording(Group& group) {
  const int width = 100, steps = 1000;
  const Spread time =
      measure([&] { Executor(record(width, steps), {.threads = 2, .watchdog_s = 0}); }, {.samples = 7, .sample_s = 0.05});
  group.at_most("recording", time.median / (width * steps) * 1e6, "us/task", 2, Ceiling::none,
                "labels, accesses, edges and the executable form");

  Executor executor(record(width, 100), {.threads = 2, .watchdog_s = 0});
  executor.run(1);
  const double before = resident_mb();
  const double run = seconds([&] { executor.run(100); });
  group.at_most("million_empty_tasks", run * 1e6 / 1e6, "us/task", 1, Ceiling::none, "10 000 recorded, 100 replays");
  group.at_most("million_empty_tasks/memory_growth", resident_mb() - before, "MB", 1);
}

}  // namespace spindrift::perf
