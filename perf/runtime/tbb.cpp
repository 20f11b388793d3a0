// The stencil of Task Bench by TBB's flow graph, beside our runtime: stencil.cpp. Run by perf/runtime/run: a program of its own,
// as binding OpenMP's threads binds those of TBB to one processor. SPDX-License-Identifier: Apache-2.0
#include <tbb/flow_graph.h>
#include <tbb/global_control.h>

#include <memory>

#include "perf/runtime/task_bench.hpp"

namespace spindrift::perf {
namespace {

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
  int operator()(long n, int steps) {
    n_ = n;
    x_.begin();
    int made = 0;
    for (; made < steps; made += depth_) {
      for (std::size_t i = 0; i < x_.size(); ++i) nodes_[i]->try_put(tbb::flow::continue_msg());
      graph_.wait_for_all();
    }
    x_.require_right(made);
    return made;
  }

 private:
  Points& x_;
  int depth_;
  long n_ = 0;
  tbb::flow::graph graph_;
  std::vector<std::unique_ptr<tbb::flow::continue_node<tbb::flow::continue_msg>>> nodes_;
};

void peers(Group& group) {
  constexpr int depth = 50, steps = 1000;
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  for (const int width : {64, 4}) {
    Points x(line(width));
    Tbb flow(x, depth);
    figures_of_peer(
        group, "tbb_flow_graph", [&](long n, int s) { return flow(n, s); }, width, steps);
  }
}

}  // namespace
}  // namespace spindrift::perf

int main(int argc, char** argv) {
  spindrift::perf::Group group("runtime_tbb", argc, argv);
  spindrift::perf::peers(group);
}
