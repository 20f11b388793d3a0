// What running both fluids at once gains, on the paper's case 3 as a demo: a window of air and sea as one graph on two threads,
// against each alone on two threads, against each on a core of its own, and what the exchange between windows takes. Windows of
// the three kinds in turns, each going on from where the last one of its kind left air and sea. Two threads whatever
// OMP_NUM_THREADS says. Run by perf/run coupling; what was measured is in docs/developer/machine.md. SPDX-License-Identifier:
// Apache-2.0
#include <omp.h>

#include <cstdio>

#include "perf/harness.hpp"
#include "runtime/mpi/environment.hpp"
#include "runtime/trace/efficiency.hpp"
#include "runtime/trace/trace_of.hpp"
#include "src/coupling/start.hpp"
#include "src/coupling/window.hpp"
#include "src/scene/document.hpp"

using namespace spindrift;
using namespace spindrift::coupling;

namespace {

/// The sides of a machine, advanced by whole windows with the rotor going on as it does and bodies under the water's loads alone.
struct Sides {
  explicit Sides(Machine& m)
      : machine(m),
        state(make_start(m).state),
        air(make_air(m, m.rotor()->state(0.0, state.motions), {MPI_COMM_SELF, 0, 1})),
        bodies(make_body_side(m)) {
    air->begin(0.0, m.rotor()->state(0.0, state.motions));
    rotor = m.rotor()->state(0.0, state.motions);
  }
  double window(WindowTasks& tasks, bool with_air, bool with_bodies) {
    const double dt = machine.timeline().window_s();
    if (with_air) rotor.azimuth += rotor.speed * dt, air->aim(air_time += dt, dt, rotor);
    if (with_bodies) bodies->keep(0), bodies->aim(state, state.tick + machine.timeline().steps_per_window());
    const double s = perf::seconds([&] { tasks.run(with_air, with_bodies); });
    if (with_air) air->answer();
    if (with_bodies) state = bodies->finish();
    return s;
  }
  Machine& machine;
  bodies::BodiesState state;
  std::unique_ptr<AirSide> air;
  std::unique_ptr<BodySide> bodies;
  aero::RotorState rotor;
  double air_time = 0.0;
};

}  // namespace

int main(int argc, char** argv) {
  perf::Group group("coupling", argc, argv);
  int none = 0;
  char** nothing = nullptr;
  const runtime::MpiEnvironment mpi(none, nothing);
  omp_set_num_threads(2);
  scene::Document document = scene::load(SPINDRIFT_SOURCE_DIR "/inputs/leble_barakos/case3_demo.toml", {"start.air_steps=40"});
  Machine machine(read_scenario(document));
  machine.fill_sea(make_start(machine).state.motions, {MPI_COMM_SELF, 0, 1});
  {
    Sides sides(machine);
    WindowTasks two(sides.air.get(), *sides.bodies, MPI_COMM_SELF, std::size_t(1) << 20),
        one(sides.air.get(), *sides.bodies, MPI_COMM_SELF, 0);
    // Executors take the number of threads that stands when they first run.
    sides.window(two, true, true), sides.window(two, true, false), sides.window(two, false, true);
    omp_set_num_threads(1);
    sides.window(one, true, false), sides.window(one, false, true);
    omp_set_num_threads(2);
    constexpr int rounds = 7;
    std::vector<double> both, air, sea, air_one, sea_one, sum_ratio;
    for (int n = 0; n < rounds; ++n) {
      air.push_back(sides.window(two, true, false)), sea.push_back(sides.window(two, false, true));
      both.push_back(sides.window(two, true, true));
      air_one.push_back(sides.window(one, true, false)), sea_one.push_back(sides.window(one, false, true));
      sum_ratio.push_back(both.back() / (air.back() + sea.back()));
    }
    const auto median = [](const std::vector<double>& v) { return perf::quantile(v, 0.5); };
    group.figure("air_alone", 1e3 * median(air), "ms/window", "2 threads");
    group.figure("sea_alone", 1e3 * median(sea), "ms/window", "2 threads");
    group.figure("both", 1e3 * median(both), "ms/window", "2 threads");
    group.figure("air_alone_one_core", 1e3 * median(air_one), "ms/window");
    group.figure("sea_alone_one_core", 1e3 * median(sea_one), "ms/window");
    group.at_most("coupled_to_sum", median(sum_ratio), "-", 1.05, perf::Ceiling::none, "each alone on 2 threads");
    const double a = median(air_one), b = median(sea_one), ideal = 2.0 * std::max(a, b) / (a + b);
    group.at_least("gain_to_ideal", std::max(a, b) / median(both) / ideal, "-", 0.9, perf::Ceiling::none,
                   "gain over a core for each fluid");
    const runtime::RankTrace trace = runtime::trace_of(*two.executor());
    std::fputs((runtime::efficiency_table(runtime::efficiency_of(std::span(&trace, 1))) + "\n").c_str(), stderr);
  }
  {
    const Start start = make_start(machine);
    machine.fill_sea(start.state.motions, {MPI_COMM_SELF, 0, 1});
    bodies::BodiesState state = start.state;
    CoupledWindow window(machine, make_air(machine, machine.rotor()->state(0.0, state.motions), {MPI_COMM_SELF, 0, 1}));
    window.begin(state);
    window.advance(state);  // records
    const double before = window.tasks().wall_seconds(), kept_before = 1e-9 * double(window.totals().keep_ns);
    constexpr int windows = 4;
    const double wall = perf::seconds([&] {
      for (int n = 0; n < windows; ++n) window.advance(state);
    });
    const double tasks = window.tasks().wall_seconds() - before, kept = 1e-9 * double(window.totals().keep_ns) - kept_before;
    group.at_most("exchange_of_window", 100.0 * (wall - tasks - kept) / wall, "%", 0.1, perf::Ceiling::none,
                  "all that is neither tasks nor snapshot");
    group.figure("snapshot_of_window", 100.0 * kept / wall, "%", "so that a window that fails is saved as it began");
  }
}
