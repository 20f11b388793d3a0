// What one rank spends on laying out a resolved rotor that many share: memory at its largest, processor time. Of the paper's grid
// and of one with a hundred times its cells, as a rank of so many that each has some two tiles; simulated, for beside the look at
// all cells, which ranks share, one needs no other. Run by perf/run; what was measured: docs/developer/notes/runtime.md.
// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>

#include <cmath>
#include <cstdlib>
#include <ctime>
#include <string>

#include "perf/harness.hpp"
#include "runtime/mpi/environment.hpp"
#include "src/aero/resolved_rotor.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/scene/document.hpp"

using namespace spindrift;

namespace {

double peak_MB() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  return double(use.ru_maxrss) / 1024.0;
}

/// With `factor` times the cells along each direction.
aero::ResolvedRotorSetup paper(double factor) {
  scene::Document document = scene::load(SPINDRIFT_SOURCE_DIR "/inputs/leble_barakos/case3_paper.toml", {});
  aero::ResolvedRotorSetup setup = coupling::resolved_rotor_setup(coupling::read_scenario(document));
  aero::RotorGridOptions& g = setup.grid;
  for (auto* n : {&g.cells_round, &g.cells_trailing_edge, &g.cells_layers, &g.cells_span, &g.cells_outboard, &g.cells_beside,
                  &g.cells_upstream, &g.cells_downstream})
    if (factor > 1.0) *n = 4 * int(std::lround(**n * factor / 4.0));
  g.resolution *= factor;
  return setup;
}

void measure(perf::Group& group, const std::string& name, double factor, int ranks, int rank) {
  const aero::ResolvedRotorSetup setup = paper(factor);
  const std::clock_t begin = std::clock();
  const auto since = [](std::clock_t from) { return double(std::clock() - from) / CLOCKS_PER_SEC; };
  const auto made = aero::made_rotor_grid(setup);
  const double grid_s = since(begin);
  aero::ResolvedRotor rotor(setup, ranks, rank, 0, made);
  const std::string note = std::to_string(aero::resolved_rotor_size(setup).cells) + " cells, rank " + std::to_string(rank) +
                           " of " + std::to_string(ranks) + ", which has " + std::to_string(rotor.store().owned().size()) +
                           " of " + std::to_string(rotor.store().tiling().size()) + " tiles";
  group.figure(name + "_grid", grid_s, "core-s", "look at all cells, which ranks share: " + note);
  group.figure(name + "_tiles", since(begin) - grid_s, "core-s", "tiles, partition, wall distances, solver");
  group.at_most(name + "_memory", peak_MB(), "MB", 1000.0, perf::Ceiling::none, note);
}

}  // namespace

int main(int argc, char** argv) {
  int none = 0;
  char** nothing = nullptr;
  const runtime::MpiEnvironment mpi(none, nothing);
  perf::Group group("rotor_layout", argc, argv);
  measure(group, "paper", 1.0, 655, 100);
  measure(group, "hundredfold", std::cbrt(100.0), 65'536, 10'000);
}
