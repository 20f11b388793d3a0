// Overhead per task, METG(50 %) and loss of our runtime on stencils. Two arrays take turns, so the recorded body holds two steps.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <memory>

#include "perf/runtime/groups.hpp"
#include "perf/runtime/task_bench.hpp"
#include "runtime/executor/executor.hpp"

namespace spindrift::perf {
namespace {

using runtime::Datum;
using runtime::Executor;
using runtime::Graph;
using runtime::reads;
using runtime::Uses;
using runtime::writes;

/// n^3 points, faces only.
Neighbours cube(int n) {
  Neighbours all;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        auto& mine = all.emplace_back();
        const auto add = [&](int a, int b, int c) {
          if (std::min({a, b, c}) >= 0 && std::max({a, b, c}) < n) mine.push_back((c * n + b) * n + a);
        };
        add(i, j, k), add(i - 1, j, k), add(i + 1, j, k), add(i, j - 1, k), add(i, j + 1, k), add(i, j, k - 1), add(i, j, k + 1);
      }
  return all;
}

/// A stencil replayed by the runtime; `n` iterations of work in each task.
class Replayed {
 public:
  Replayed(const Neighbours& neighbours, bool priorities) : of_(std::make_unique<State>(neighbours)) {
    Graph graph;
    const std::size_t points = neighbours.size();
    const std::array<std::vector<Datum>, 2> x = {graph.data(points), graph.data(points)};
    for (const int half : {0, 1})
      for (std::size_t i = 0; i < points; ++i) {
        Uses uses = {writes(x[std::size_t(half)][i])};
        for (const int j : neighbours[i]) uses.push_back(reads(x[std::size_t(1 - half)][std::size_t(j)]));
        graph.task("stencil/" + std::to_string(i), uses, [s = of_.get(), half, i] { s->points.work(half, i, s->n); });
      }
    executor_ = std::make_unique<Executor>(
        std::move(graph), runtime::ExecutorOptions{.threads = threads, .records = 1 << 20, .priorities = priorities});
  }
  int operator()(long n, int steps) {
    of_->n = n;
    of_->points.begin();
    executor_->clear_records();
    executor_->run(std::uint32_t(steps / 2));
    of_->points.require_right(steps);
    return steps;
  }

 private:
  struct State {
    explicit State(const Neighbours& neighbours) : points(neighbours) {}
    Points points;
    long n = 0;
  };
  std::unique_ptr<State> of_;
  std::unique_ptr<Executor> executor_;
};

}  // namespace

void stencils(Group& group) {
  const Neighbours blocks = cube(8);
  Replayed on_line(line(64), false), on_short_line(line(4), false), on_cube(blocks, false), on_cube_ranked(blocks, true);
  const auto runner = [](Replayed& replayed) { return [&](long n, int steps) { return replayed(n, steps); }; };

  group.at_most("overhead/stencil_1d", per_task(runner(on_line), 64, 0, 8000), "core-ns", 150, Ceiling::none,
                "empty tasks, traced, inputs checked, width 64");
  group.at_most("overhead/halo_7_point", per_task(runner(on_cube), 512, 0, 1000), "core-ns", 250, Ceiling::none,
                "512 blocks, traced");
  group.at_most("overhead/halo_7_point_priorities", per_task(runner(on_cube_ranked), 512, 0, 1000), "core-ns", 800, Ceiling::none,
                "512 blocks, traced");
  group.at_most("metg_50/width_64", metg_us(runner(on_line), 64, iteration_ns_of_threads), "us", 0.2, Ceiling::none,
                "stencil of Task Bench, inputs checked");
  group.at_most("metg_50/width_4", metg_us(runner(on_short_line), 4, iteration_ns_of_threads), "us", 0.5, Ceiling::none,
                "the same");
  group.at_most("loss_at_20_us", loss_at_20_us(runner(on_line)), "%", 2, Ceiling::none,
                "width 64, against the same work without tasks");
}

}  // namespace spindrift::perf
