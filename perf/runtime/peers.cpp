// The stencil of Task Bench by OpenMP's loops and tasks and by TBB's flow graph, beside our runtime: stencil.cpp. Run by
// perf/runtime/run with the settings that are best for them. SPDX-License-Identifier: Apache-2.0
#include <tbb/flow_graph.h>
#include <tbb/global_control.h>

#include <memory>

#include "perf/runtime/task_bench.hpp"

namespace spindrift::perf {
namespace {

void omp_for(Points& x, long n, int steps) {
  x.begin();
#pragma omp parallel num_threads(threads)
  for (int s = 0; s < steps; ++s) {
#pragma omp for schedule(static)
    for (std::size_t i = 0; i < x.size(); ++i) x.work(s % 2, i, n);
  }
  x.require_right(steps);
}

/// The depend clauses take at most three neighbours.
void omp_depend(Points& x, long n, int steps) {
  x.begin();
#pragma omp parallel num_threads(threads)
#pragma omp single
  for (int s = 0; s < steps; ++s) {
    const int half = s % 2;
    for (std::size_t i = 0; i < x.size(); ++i) {
      [[maybe_unused]] Points::Cell &before = x.cell(1 - half, std::size_t(x.neighbours()[i].front())),
                                    &own = x.cell(1 - half, i), &after = x.cell(1 - half, std::size_t(x.neighbours()[i].back())),
                                    &to = x.cell(half, i);
#pragma omp task depend(in : before, own, after) depend(out : to) shared(x)
      x.work(half, i, n);
    }
  }
  x.require_right(steps);
}

/// A flow graph of `depth` steps, made once; its nodes count their predecessors anew after each run.
class Tbb {
 public:
  Tbb(Points& points, int depth) : x_(points), depth_(depth) {
    using Node = tbb::flow::continue_node<tbb::flow::continue_msg>;
    for (int s = 0; s < depth; ++s)
      for (std::size_t i = 0; i < x_.size(); ++i)
        nodes_.push_back(
            std::make_unique<Node>(graph_, [this, half = s % 2, i](const tbb::flow::continue_msg&) { x_.work(half, i, n_); }));
    for (int s = 1; s < depth; ++s)
      for (std::size_t i = 0; i < x_.size(); ++i)
        for (const int j : x_.neighbours()[i])
          tbb::flow::make_edge(*nodes_[std::size_t(s - 1) * x_.size() + std::size_t(j)], *nodes_[std::size_t(s) * x_.size() + i]);
  }
  /// Whole depths of steps: as many as asked for, or the next.
  void operator()(long n, int steps) {
    n_ = n;
    x_.begin();
    int made = 0;
    for (; made < steps; made += depth_) {
      for (std::size_t i = 0; i < x_.size(); ++i) nodes_[i]->try_put(tbb::flow::continue_msg());
      graph_.wait_for_all();
    }
    x_.require_right(made);
  }

 private:
  Points& x_;
  int depth_;
  long n_ = 0;
  tbb::flow::graph graph_;
  std::vector<std::unique_ptr<tbb::flow::continue_node<tbb::flow::continue_msg>>> nodes_;
};

void peers(Group& group) {
  constexpr int depth = 50;
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  for (const int width : {64, 4}) {
    Points x(line(width));
    Tbb flow(x, depth);
    const struct {
      const char* name;
      Runner run;
      int steps;  ///< of a measurement of empty tasks
    } all[] = {{"omp_for", [&](long n, int s) { omp_for(x, n, s); }, 8000},
               {"omp_task_depend", [&](long n, int s) { omp_depend(x, n, s); }, 200},
               {"tbb_flow_graph", [&](long n, int s) { flow(n, (s + depth - 1) / depth * depth); }, 1000}};
    for (const auto& peer : all) {
      const auto name = [&](const std::string& what) { return what + "/" + peer.name; };
      const std::string of_width = "metg_50/width_" + std::to_string(width);
      group.figure(name(of_width), metg_us(peer.run, x.size(), iteration_ns_of_threads), "us");
      if (width != 64) continue;
      group.figure(name("overhead/stencil_1d"), per_task(peer.run, x.size(), 0, peer.steps), "core-ns");
      group.figure(name("loss_at_20_us"), loss_at_20_us(peer.run), "%");
    }
  }
}

}  // namespace
}  // namespace spindrift::perf

int main(int argc, char** argv) {
  spindrift::perf::Group group("runtime_peers", argc, argv);
  spindrift::perf::peers(group);
}
