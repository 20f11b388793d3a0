// Overhead per task and METG(50 %) of Task Bench's stencils (Slaughter et al., SC 2020): each step, a point reads itself and its
// neighbours of the step before. Two arrays take turns, so the recorded body holds two steps.
// METG(50 %): time per task and core at which half of it is work.
// SPDX-License-Identifier: Apache-2.0
#include <tbb/flow_graph.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>

#include "perf/runtime/grain.hpp"
#include "perf/runtime/groups.hpp"
#include "runtime/executor/executor.hpp"

namespace spindrift::perf {
namespace {

using runtime::Datum;
using runtime::Executor;
using runtime::Graph;
using runtime::reads;
using runtime::Uses;
using runtime::writes;

constexpr int threads = 2;

/// Neighbours of each point, itself among them.
using Neighbours = std::vector<std::vector<int>>;

Neighbours line(int n) {
  Neighbours all(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i)
    for (int j = std::max(0, i - 1); j <= std::min(n - 1, i + 1); ++j) all[std::size_t(i)].push_back(j);
  return all;
}

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
  Replayed(const Neighbours& neighbours, bool priorities) : n_(std::make_unique<long>(0)), points_(neighbours.size()) {
    Graph graph;
    const std::array<std::vector<Datum>, 2> x = {graph.data(points_), graph.data(points_)};
    for (const std::size_t half : {0, 1})
      for (std::size_t i = 0; i < points_; ++i) {
        Uses uses = {writes(x[1 - half][i])};
        for (const int j : neighbours[i]) uses.push_back(reads(x[half][std::size_t(j)]));
        graph.task("stencil/" + std::to_string(i), uses, [n = n_.get()] { grain(*n); });
      }
    executor_ = std::make_unique<Executor>(
        std::move(graph), runtime::ExecutorOptions{.threads = threads, .records = 1 << 20, .priorities = priorities});
  }
  void operator()(long n, int steps) {
    *n_ = n;
    executor_->clear_records();
    executor_->run(std::uint32_t(steps / 2));
  }

 private:
  std::unique_ptr<long> n_;
  std::size_t points_;
  std::unique_ptr<Executor> executor_;
};

void omp_for(std::size_t points, long n, int steps) {
#pragma omp parallel num_threads(threads)
  for (int s = 0; s < steps; ++s) {
#pragma omp for schedule(static)
    for (std::size_t i = 0; i < points; ++i) grain(n);
  }
}

/// One datum per point and parity; the depend clauses take at most three neighbours (the line).
void omp_depend(const Neighbours& neighbours, long n, int steps) {
  const std::size_t points = neighbours.size();
  std::vector<char> x(2 * points);
#pragma omp parallel num_threads(threads)
#pragma omp single
  for (int s = 0; s < steps; ++s) {
    [[maybe_unused]] char* const from = x.data() + (s % 2) * points;
    [[maybe_unused]] char* const to = x.data() + (1 - s % 2) * points;
    for (std::size_t i = 0; i < points; ++i) {
      const auto a = std::size_t(neighbours[i].front()), b = std::size_t(neighbours[i].back());
#pragma omp task depend(in : from[a], from[i], from[b]) depend(out : to[i])
      grain(n);
    }
  }
}

/// A flow graph of `depth` steps, made once; its nodes count their predecessors anew after each run.
class Tbb {
 public:
  Tbb(const Neighbours& neighbours, int depth) : n_(std::make_unique<long>(0)), points_(neighbours.size()), depth_(depth) {
    using Node = tbb::flow::continue_node<tbb::flow::continue_msg>;
    for (int s = 0; s < depth; ++s)
      for (std::size_t i = 0; i < points_; ++i)
        nodes_.push_back(std::make_unique<Node>(graph_, [n = n_.get()](const tbb::flow::continue_msg&) { grain(*n); }));
    for (int s = 1; s < depth; ++s)
      for (std::size_t i = 0; i < points_; ++i)
        for (const int j : neighbours[i])
          tbb::flow::make_edge(*nodes_[std::size_t(s - 1) * points_ + std::size_t(j)], *nodes_[std::size_t(s) * points_ + i]);
  }
  void operator()(long n, int steps) {
    *n_ = n;
    for (int s = 0; s < steps; s += depth_) {
      for (std::size_t i = 0; i < points_; ++i) nodes_[i]->try_put(tbb::flow::continue_msg());
      graph_.wait_for_all();
    }
  }

 private:
  std::unique_ptr<long> n_;
  std::size_t points_;
  int depth_;
  tbb::flow::graph graph_;
  std::vector<std::unique_ptr<tbb::flow::continue_node<tbb::flow::continue_msg>>> nodes_;
};

using Runner = std::function<void(long n, int steps)>;

/// Core-nanoseconds per task.
double per_task(const Runner& run, std::size_t points, long n, int steps, int samples = 7) {
  run(n, steps);
  std::vector<double> times;
  for (int s = 0; s < samples; ++s) times.push_back(seconds([&] { run(n, steps); }));
  return quantile(times, 0.5) * threads / double(points) / steps * 1e9;
}

/// Core-nanoseconds of an iteration of grain with all threads at it.
double iteration_ns() {
  const auto all = [] {
#pragma omp parallel num_threads(threads)
    grain(2'000'000);
  };
  return measure(all, {.samples = 9, .warm_ups = 2, .sample_s = 0.001}).median / 2e6 * 1e9;
}

/// Time per task and core at half efficiency [us]: bisection in the logarithm of the work.
double metg_us(const Runner& run, std::size_t points) {
  const double ns = iteration_ns();
  double low = 1, high = 1e5, at_half = 0;
  for (int n = 0; n < 9; ++n) {
    const double work = std::sqrt(low * high);
    const auto iterations = std::max(1L, std::lround(work));
    const int steps = 2 * std::max(50, int(4e6 / (double(points) * (ns * double(iterations) + 500))));
    const double time = per_task(run, points, iterations, steps, 5);
    const double efficiency = double(iterations) * ns / time;
    (efficiency < 0.5 ? low : high) = work;
    at_half = time;
  }
  return at_half / 1000;
}

}  // namespace

void stencils(Group& group) {
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  const Neighbours width_64 = line(64), blocks = cube(8);
  Replayed on_line(width_64, false), on_cube(blocks, false), on_cube_ranked(blocks, true);
  Tbb tbb_line(width_64, 50);
  const Runner ours = [&](long n, int s) { on_line(n, s); };
  const Runner loop = [&](long n, int s) { omp_for(64, n, s); };
  const Runner depend = [&](long n, int s) { omp_depend(width_64, n, s); };
  const Runner flow = [&](long n, int s) { tbb_line(n, s); };

  group.at_most("overhead/stencil_1d", per_task(ours, 64, 0, 8000), "core-ns", 150, Ceiling::none,
                "empty tasks, traced, width 64");
  group.at_most("overhead/halo_7_point", per_task([&](long n, int s) { on_cube(n, s); }, 512, 0, 1000), "core-ns", 250,
                Ceiling::none, "512 blocks, traced");
  group.at_most("overhead/halo_7_point_priorities", per_task([&](long n, int s) { on_cube_ranked(n, s); }, 512, 0, 1000),
                "core-ns", 800, Ceiling::none, "512 blocks, traced");
  group.figure("overhead/stencil_1d/omp_for", per_task(loop, 64, 0, 8000), "core-ns");
  group.figure("overhead/stencil_1d/omp_task_depend", per_task(depend, 64, 0, 200), "core-ns");
  group.figure("overhead/stencil_1d/tbb_flow_graph", per_task(flow, 64, 0, 1000), "core-ns");

  group.at_most("metg_50/stencil_1d", metg_us(ours, 64), "us", 0.3, Ceiling::none, "width 64");
  group.figure("metg_50/stencil_1d/omp_for", metg_us(loop, 64), "us");
  group.figure("metg_50/stencil_1d/omp_task_depend", metg_us(depend, 64), "us");
  group.figure("metg_50/stencil_1d/tbb_flow_graph", metg_us(flow, 64), "us");

  // Against the same work without a runtime, in alternating order: the clock rate drifts.
  const long n = grain_of(20000);
  const auto bare = [&] {
#pragma omp parallel num_threads(threads)
    for (int i = 0; i < 32 * 40; ++i) grain(n);
  };
  const auto loss = [&](const Runner& run) { return 100 * (paired_ratio([&] { run(n, 40); }, bare, 15).median - 1); };
  group.at_most("loss_at_20_us/stencil_1d", loss(ours), "%", 2, Ceiling::none, "against the same work without tasks");
  group.figure("loss_at_20_us/stencil_1d/omp_for", loss(loop), "%");
  group.figure("loss_at_20_us/stencil_1d/omp_task_depend", loss(depend), "%");
  group.figure("loss_at_20_us/stencil_1d/tbb_flow_graph", loss(flow), "%");
}

}  // namespace spindrift::perf
