// What running both fluids at once gains, on the paper's case 3 as a demo: a window of air and sea as one graph on two threads
// (placement shared), against each alone on two threads, against two ranks of which each has a fluid (placement split, one thread
// each), and what the exchange between windows takes. Windows of all kinds in turns, each going on from where the last one of its
// kind left air and sea. Starts itself again as two ranks: rank 0 measures, rank 1 is the air's of split windows and sleeps
// otherwise. Threads whatever OMP_NUM_THREADS says. Run by perf/run coupling; what was measured is in
// docs/developer/notes/coupled_system.md. SPDX-License-Identifier: Apache-2.0
#include <mpi.h>
#include <omp.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "perf/coupling/alone.hpp"
#include "perf/harness.hpp"
#include "runtime/mpi/environment.hpp"
#include "runtime/trace/efficiency.hpp"
#include "runtime/trace/trace_of.hpp"
#include "src/coupling/window.hpp"
#include "src/scene/document.hpp"

using namespace spindrift;
using namespace spindrift::coupling;

namespace {

/// All ranks come together; who waits leaves the core to the others.
void meet() {
  MPI_Request request;
  MPI_Ibarrier(MPI_COMM_WORLD, &request);
  for (int done = 0; !done; usleep(done ? 0 : 200)) MPI_Test(&request, &done, MPI_STATUS_IGNORE);
}

/// The coupled run's own window, placed as given.
struct Coupled {
  Coupled(scene::Document document, const runtime::Parts& p)
      : parts(p), floating(read_scenario(document)), state(make_start(floating).state) {
    if (parts.has(sea_part)) floating.fill_sea(state.motions, parts.mine());
    window = std::make_unique<CoupledWindow>(floating, make_sides(floating, state.motions, parts), parts.mine().comm);
    window->begin(state);
  }
  double advance(int threads) {
    omp_set_num_threads(threads);
    return perf::seconds([&] { window->advance(state); });
  }
  const runtime::Parts& parts;
  FloatingSystem floating;
  bodies::BodiesState state;
  std::unique_ptr<CoupledWindow> window;
};

scene::Document demo() {
  return scene::load(SPINDRIFT_SOURCE_DIR "/inputs/leble_barakos/case3_demo.toml", {"start.air_steps=40"});
}

constexpr int rounds = 7;

/// Rank 1: the air of the split windows.
void air_of_split(const runtime::Parts& parts) {
  omp_set_num_threads(1);
  meet();
  Coupled split(demo(), parts);
  for (int n = 0; n <= rounds; ++n) meet(), split.advance(1);
}

void measure(perf::Group& group, const runtime::Parts& parts) {
  const auto median = [](const std::vector<double>& v) { return perf::quantile(v, 0.5); };
  omp_set_num_threads(2);
  const runtime::Parts alone = runtime::World{MPI_COMM_SELF, 0, 1};
  scene::Document document = demo();
  FloatingSystem floating(read_scenario(document));
  floating.fill_sea(make_start(floating).state.motions, alone.mine());
  Alone sides(floating);
  WindowTasks two(*sides.air, *sides.bodies, sides.output, MPI_COMM_SELF, {.records = std::size_t(1) << 20}),
      one(*sides.air, *sides.bodies, sides.output, MPI_COMM_SELF, {});
  // Executors take the number of threads that stands when they first run.
  sides.window(two, Run::both), sides.window(two, Run::air), sides.window(two, Run::bodies);
  omp_set_num_threads(1);
  sides.window(one, Run::air), sides.window(one, Run::bodies);
  omp_set_num_threads(2);
  Coupled shared(demo(), alone);
  shared.advance(2);  // records
  omp_set_num_threads(1);
  meet();
  Coupled split(demo(), parts);
  meet(), split.advance(1);

  const double tasks_before = shared.window->sides().tasks().wall_seconds(),
               kept_before = 1e-9 * double(shared.window->totals().snapshot_ns);
  std::vector<double> both, air, sea, air_one, sea_one, sum_ratio, in_shared, in_split, gain;
  for (int n = 0; n < rounds; ++n) {
    omp_set_num_threads(2);
    air.push_back(sides.window(two, Run::air)), sea.push_back(sides.window(two, Run::bodies));
    both.push_back(sides.window(two, Run::both));
    sum_ratio.push_back(both.back() / (air.back() + sea.back()));
    omp_set_num_threads(1);
    air_one.push_back(sides.window(one, Run::air)), sea_one.push_back(sides.window(one, Run::bodies));
    in_shared.push_back(shared.advance(2));
    meet();
    in_split.push_back(split.advance(1));
    gain.push_back(in_split.back() / in_shared.back());
  }
  group.figure("air_alone", 1e3 * median(air), "ms/window", "2 threads");
  group.figure("sea_alone", 1e3 * median(sea), "ms/window", "2 threads");
  group.figure("both", 1e3 * median(both), "ms/window", "2 threads");
  group.figure("air_alone_one_core", 1e3 * median(air_one), "ms/window");
  group.figure("sea_alone_one_core", 1e3 * median(sea_one), "ms/window");
  group.at_most("coupled_to_sum", median(sum_ratio), "-", 1.05, perf::Ceiling::none, "each alone on 2 threads");
  group.figure("window_shared", 1e3 * median(in_shared), "ms/window", "1 process of 2 threads, exchange and snapshot included");
  group.figure("window_split", 1e3 * median(in_split), "ms/window", "2 ranks of 1 thread, exchange and snapshot included");
  const double a = median(air_one), b = median(sea_one), ideal = 2.0 * std::max(a, b) / (a + b);
  group.figure("gain_over_split", median(gain), "-", "time of a split window over that of a shared one, each next to the other");
  group.at_least("gain_to_ideal", median(gain) / ideal, "-", 0.9, perf::Ceiling::none,
                 "ideal: 2 max(a, b) / (a + b) of one core each");
  const runtime::RankTrace trace = runtime::trace_of(*two.executor());
  std::fputs((runtime::efficiency_table(runtime::efficiency_of(std::span(&trace, 1))) + "\n").c_str(), stderr);

  double wall = 0.0;
  for (const double s : in_shared) wall += s;
  const double tasks = shared.window->sides().tasks().wall_seconds() - tasks_before,
               kept = 1e-9 * double(shared.window->totals().snapshot_ns) - kept_before;
  group.at_most("exchange_of_window", 100.0 * (wall - tasks - kept) / wall, "%", 0.1, perf::Ceiling::none,
                "all that is neither tasks nor snapshot");
  group.figure("snapshot_of_window", 100.0 * kept / wall, "%", "so that a window that fails is saved as it began");
}

}  // namespace

int main(int argc, char** argv) {
  if (!std::getenv("OMPI_COMM_WORLD_SIZE")) {  // not yet under mpirun
    std::vector<char*> command{const_cast<char*>(SPINDRIFT_SOURCE_DIR "/ci/mpirun"), const_cast<char*>("2")};
    command.insert(command.end(), argv, argv + argc);
    command.push_back(nullptr);
    execv(command[0], command.data());
    std::perror("ci/mpirun");
    return 4;
  }
  int none = 0;
  char** nothing = nullptr;
  const runtime::MpiEnvironment mpi(none, nothing);
  const runtime::Parts parts(mpi.world(), 2, mpi.rank() == 0 ? sea_part : air_part);
  if (mpi.rank() != 0) {
    air_of_split(parts);
  } else {
    perf::Group group("coupling", argc, argv);
    measure(group, parts);
  }
}
