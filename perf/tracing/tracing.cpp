// What records of tasks cost: the same work with and without them, in turns, on one thread; processor time, which others on the
// machine hardly change. A stencil of tasks of 20 us, as the shortest of the program are, and windows of the paper's case 3 as a
// demo, of two floating systems that do the same step by step. Run by perf/run tracing; what was measured is in
// docs/developer/notes/runtime.md. SPDX-License-Identifier: Apache-2.0
#include <mpi.h>
#include <omp.h>

#include <array>
#include <memory>

#include "perf/harness.hpp"
#include "perf/runtime/task_bench.hpp"
#include "runtime/executor/executor.hpp"
#include "runtime/mpi/environment.hpp"
#include "runtime/mpi/parts.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/scenario.hpp"
#include "src/coupling/start.hpp"
#include "src/coupling/window.hpp"
#include "src/scene/document.hpp"

using namespace spindrift;

namespace {

constexpr std::size_t records = std::size_t(1) << 20;

/// One-dimensional, of 64 points, two arrays in turns.
class Stencil {
 public:
  explicit Stencil(std::size_t kept) : points_(std::make_unique<perf::Points>(perf::line(64))) {
    runtime::Graph graph;
    const std::array<std::vector<runtime::Datum>, 2> x = {graph.data(points_->size()), graph.data(points_->size())};
    for (const int half : {0, 1})
      for (std::size_t i = 0; i < points_->size(); ++i) {
        runtime::Uses uses = {writes(x[std::size_t(half)][i])};
        for (const int j : points_->neighbours()[i]) uses.push_back(reads(x[std::size_t(1 - half)][std::size_t(j)]));
        graph.task("stencil/" + std::to_string(i), uses,
                   [points = points_.get(), n = n_.get(), half, i] { points->work(half, i, *n); });
      }
    executor_ = std::make_unique<runtime::Executor>(std::move(graph), runtime::ExecutorOptions{.threads = 1, .records = kept});
  }
  void run(long n, int steps) {
    *n_ = n;
    points_->begin();
    executor_->clear_records();
    executor_->run(std::uint32_t(steps / 2));
    points_->require_right(steps);
  }

 private:
  std::unique_ptr<perf::Points> points_;
  std::unique_ptr<long> n_ = std::make_unique<long>(0);
  std::unique_ptr<runtime::Executor> executor_;
};

/// What records add [%], by pairs.
double added(const perf::Spread& ratio) { return 100.0 * (ratio.median - 1.0); }

void stencils(perf::Group& group) {
  Stencil with(records), without(0);
  for (const double us : {20.0, 5.0}) {
    const long n = perf::grain_of(1e3 * us);
    const int steps = 2 * int(100 / us);
    const perf::Spread ratio =
        perf::paired_ratio([&] { with.run(n, steps); }, [&] { without.run(n, steps); }, 401, perf::processor_seconds);
    if (us == 20.0)
      group.at_most("stencil_20_us", added(ratio), "%", 1.0, perf::Ceiling::none,
                    "processor time, records on over off, median of 401");
    else
      group.figure("stencil_5_us", added(ratio), "%", "the same");
  }
}

/// The coupled run's own window.
struct System {
  System(scene::Document document, std::size_t kept)
      : world(runtime::World{MPI_COMM_SELF, 0, 1}),
        floating(coupling::read_scenario(document)),
        state(coupling::make_start(floating).state) {
    floating.fill_sea(state.motions, world.mine());
    window = std::make_unique<coupling::CoupledWindow>(floating, coupling::make_sides(floating, state.motions, world),
                                                       MPI_COMM_SELF, kept);
    window->begin(state);
  }
  void advance() { window->advance(state); }
  runtime::Parts world;
  coupling::FloatingSystem floating;
  bodies::BodiesState state;
  std::unique_ptr<coupling::CoupledWindow> window;
};

void windows(perf::Group& group) {
  const scene::Document document =
      scene::load(SPINDRIFT_SOURCE_DIR "/inputs/leble_barakos/case3_demo.toml", {"start.air_steps=5"});
  System with(document, records), without(document, 0);
  const perf::Spread ratio = perf::paired_ratio([&] { with.advance(); }, [&] { without.advance(); }, 9, perf::processor_seconds);
  group.at_most("window_of_case3_demo", added(ratio), "%", 1.0, perf::Ceiling::none,
                "processor time, records on over off, median of 9");
}

}  // namespace

int main(int argc, char** argv) {
  int none = 0;
  char** nothing = nullptr;
  const runtime::MpiEnvironment mpi(none, nothing);
  omp_set_num_threads(1);
  perf::Group group("tracing", argc, argv);
  stencils(group);
  windows(group);
}
