// A synthetic coupling window: an implicit solver, whose iterations end in global reductions, and an explicit one of 100 substeps
// without barriers, then an exchange between them. What does it cost to run both at once?
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "perf/runtime/grain.hpp"
#include "perf/runtime/groups.hpp"
#include "runtime/executor/executor.hpp"

namespace spindrift::perf {
namespace {

using namespace spindrift::runtime;

struct Window {
  bool air = true, sea = true;
  int threads = 2;
  double air_ms = 10, sea_ms = 10;  ///< of work in a window, on one core
};

constexpr int tiles = 5, iterations = 25, columns = 16, substeps = 100;

void record_air(Graph& graph, Datum load, Datum motion, long grains) {
  const auto p = graph.data(tiles), q = graph.data(tiles);
  const Datum alpha = graph.datum(), beta = graph.datum();
  const auto phase = [&](const char* name, std::size_t i, const Uses& uses) {
    graph.task(std::string("air/") + name + "/" + std::to_string(i), uses, [grains] { grain(grains); });
  };
  graph.task("air/boundary", {reads(motion), updates(p)}, [] {});
  graph.loop("air/krylov", {.min = iterations, .max = iterations, .urgency = 1}, [&] {
    for (std::size_t i = 0; i < tiles; ++i)
      phase("matvec", i, {reads(p[i]), reads(p[(i + 1) % tiles]), reads(p[(i + tiles - 1) % tiles]), reads(beta), writes(q[i])});
    graph.task("air/dot", {reads(q), writes(alpha)}, [] {});
    for (std::size_t i = 0; i < tiles; ++i) phase("update", i, {reads(alpha), reads(q[i]), updates(p[i])});
    graph.task("air/norm", {reads(p), writes(beta)}, [] {});
  });
  graph.task("air/load", {reads(p), writes(load)}, [] {});
}

void record_sea(Graph& graph, Datum load, Datum motion, long grains) {
  const auto x = graph.data(columns), f = graph.data(columns);
  graph.task("sea/boundary", {reads(motion), updates(x)}, [] {});
  graph.repeat("sea/substeps", substeps, [&] {
    for (std::size_t i = 0; i < columns; ++i)
      graph.task("sea/force/" + std::to_string(i),
                 {reads(x[i]), reads(x[(i + 1) % columns]), reads(x[(i + columns - 1) % columns]), writes(f[i])},
                 [grains] { grain(grains); });
    for (std::size_t i = 0; i < columns; ++i)
      graph.task("sea/move/" + std::to_string(i), {reads(f[i]), updates(x[i])}, [grains] { grain(grains / 8); });
  });
  graph.task("sea/load", {reads(x), writes(load)}, [] {});
}

std::unique_ptr<Executor> window(const Window& w, double grains_per_ms) {
  Graph graph;
  const Datum air_load = graph.datum(), sea_load = graph.datum(), motion = graph.datum();
  if (w.air) record_air(graph, air_load, motion, long(w.air_ms * grains_per_ms / (2 * tiles * iterations)));
  if (w.sea) record_sea(graph, sea_load, motion, long(w.sea_ms * grains_per_ms / (1.125 * columns * substeps)));
  graph.task("coupling/motion", {reads(air_load), reads(sea_load), updates(motion)}, [] {});
  return std::make_unique<Executor>(std::move(graph), ExecutorOptions{.threads = w.threads, .records = 1 << 16});
}

/// Medians of windows of several graphs, taken in turns, [s].
std::vector<double> in_turns(const std::vector<Window>& windows, double grains_per_ms, int rounds) {
  std::vector<std::unique_ptr<Executor>> executors;
  for (const Window& w : windows) executors.push_back(window(w, grains_per_ms));
  for (auto& e : executors)
    for (int n = 0; n < 3; ++n) e->run();  // priorities come from measured costs
  std::vector<std::vector<double>> times(windows.size());
  for (int r = 0; r < rounds; ++r)
    for (std::size_t e = 0; e < executors.size(); ++e)
      executors[e]->clear_records(), times[e].push_back(seconds([&] { executors[e]->run(2); }) / 2);
  std::vector<double> medians;
  for (const auto& t : times) medians.push_back(quantile(t, 0.5));
  return medians;
}

}  // namespace

void two_physics(Group& group) {
  const double grains_per_ms = double(grain_of(1e6));
  for (const double ratio : {1.0, 2.0, 4.0})
    for (const bool sea_larger : {false, true}) {
      if (ratio == 1 && sea_larger) continue;
      const double air_ms = sea_larger ? 10 : 10 * ratio, sea_ms = sea_larger ? 10 * ratio : 10;
      const Window both{.air_ms = air_ms, .sea_ms = sea_ms};
      Window air = both, sea = both, air_one = both, sea_one = both;
      air.sea = air_one.sea = sea.air = sea_one.air = false;
      air_one.threads = sea_one.threads = 1;
      const auto t = in_turns({both, air, sea, air_one, sea_one}, grains_per_ms, 15);
      const std::string name = "two_physics/" + std::to_string(int(air_ms / 10)) + "_to_" + std::to_string(int(sea_ms / 10));
      group.at_most(name + "/coupled_to_sum", t[0] / (t[1] + t[2]), "-", 1.03, Ceiling::none, "each alone on 2 threads");
      const double ideal = 2 * std::max(t[3], t[4]) / (t[3] + t[4]);
      group.at_least(name + "/gain_to_ideal", std::max(t[3], t[4]) / t[0] / ideal, "-", 0.95, Ceiling::none,
                     "gain over one core for each");
    }
}

}  // namespace spindrift::perf
