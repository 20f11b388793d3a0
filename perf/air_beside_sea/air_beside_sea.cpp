// What a thread that is inside hypre leaves to the others: case 3 of the paper as a demo, air whose preconditioner is an
// algebraic multigrid and a sea of particles as one graph on two threads. Of the time of all calls of hypre (set-up and cycles:
// the collective tasks of the air), the part in which the other thread ran no task; runtime and polling count as idle. Windows
// need more work of the sea than hypre takes: the figure beside says how much more there is. Threads whatever OMP_NUM_THREADS
// says. Run by perf/run; what was measured: docs/developer/notes/air_linear.md. SPDX-License-Identifier: Apache-2.0
#include <omp.h>

#include <map>

#include "perf/coupling/alone.hpp"
#include "runtime/mpi/environment.hpp"
#include "runtime/trace/intervals.hpp"
#include "runtime/trace/trace_of.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/scene/document.hpp"

using namespace spindrift;
using namespace spindrift::coupling;

namespace {

constexpr int threads = 2, warm_ups = 3, windows = 6;

struct Seen {
  double hypre_s = 0.0, idle_s = 0.0, sea_s = 0.0;
  long calls = 0;
};
/// Of the records that begin after `from`.
Seen seen_in(const runtime::RankTrace& trace, std::int64_t from) {
  std::vector<std::vector<runtime::Interval>> tasks(threads);
  std::vector<std::pair<int, runtime::Interval>> calls;
  Seen seen;
  for (const runtime::Record& r : trace.records) {
    if (r.activity != runtime::Activity::task || r.begin_ns < from) continue;
    const runtime::TraceNode& node = trace.nodes[r.task];
    tasks[r.thread].push_back({r.begin_ns, r.end_ns});
    const std::string_view module = runtime::module_of(node.label);
    if (module == "sea") seen.sea_s += 1e-9 * double(r.end_ns - r.begin_ns);
    if (module == "aero" && node.kind == runtime::NodeKind::collective)
      calls.emplace_back(r.thread, runtime::Interval{r.begin_ns, r.end_ns});
  }
  for (auto& of_thread : tasks) of_thread = runtime::united(std::move(of_thread));
  for (const auto& [thread, call] : calls) {
    const std::int64_t busy = runtime::overlap(call, tasks[std::size_t(1 - thread)]);
    seen.hypre_s += 1e-9 * double(call.end - call.begin), seen.idle_s += 1e-9 * double(call.end - call.begin - busy);
    seen.calls += call.end - call.begin > 10'000;  // others had nothing to solve
  }
  return seen;
}

void measure(perf::Group& group, const std::string& form, const std::vector<std::string>& settings) {
  std::vector<std::string> all{"start.air_steps=20"};
  all.insert(all.end(), settings.begin(), settings.end());
  scene::Document document = scene::load(SPINDRIFT_SOURCE_DIR "/inputs/leble_barakos/case3_demo.toml", all);
  FloatingSystem floating(read_scenario(document));
  floating.fill_sea(make_start(floating).state.motions, runtime::World{MPI_COMM_SELF, 0, 1});
  Alone sides(floating);
  WindowTasks tasks(*sides.air, *sides.bodies, sides.output, MPI_COMM_SELF, {.records = std::size_t(1) << 20});
  for (int n = 0; n < warm_ups; ++n) sides.window(tasks, Run::both);  // priorities follow measured costs
  const std::int64_t from = runtime::Clock::now_ns();
  double wall_s = 0.0;
  for (int n = 0; n < windows; ++n) wall_s += sides.window(tasks, Run::both);
  const Seen seen = seen_in(runtime::trace_of(*tasks.executor()), from);
  const std::string note = "2 threads, case3_demo, " + std::to_string(windows) + " windows";
  group.figure(form + "_calls", double(seen.calls) / windows, "per window", "of hypre, longer than 10 us");
  group.figure(form + "_hypre", 1e3 * seen.hypre_s / windows, "ms/window",
               "inside them, of " + std::to_string(int(1e3 * wall_s / windows)) + " ms by the clock");
  group.figure(form + "_sea_over_hypre", seen.sea_s / seen.hypre_s, "-",
               "core-seconds of the sea's tasks over seconds inside hypre");
  group.at_most(form + "_idle_beside_hypre", 100.0 * seen.idle_s / seen.hypre_s, "%", 5.0, perf::Ceiling::none, note);
}

}  // namespace

int main(int argc, char** argv) {
  int none = 0;
  char** nothing = nullptr;
  const runtime::MpiEnvironment mpi(none, nothing);
  omp_set_num_threads(threads);
  perf::Group group("air_beside_sea", argc, argv);
  measure(group, "coarse_amg", {"aero.flow.preconditioner='coarse'", "aero.flow.group_cells=4", "aero.flow.direct_groups=0"});
}
