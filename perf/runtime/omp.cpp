// The stencil of Task Bench by OpenMP's loops and tasks, beside our runtime: stencil.cpp. Run by perf/runtime/run with threads
// that wait awake and stay on their processors. SPDX-License-Identifier: Apache-2.0
#include "perf/runtime/task_bench.hpp"

namespace spindrift::perf {
namespace {

int omp_for(Points& x, long n, int steps) {
  x.begin();
#pragma omp parallel num_threads(threads)
  for (int s = 0; s < steps; ++s) {
#pragma omp for schedule(static)
    for (std::size_t i = 0; i < x.size(); ++i) x.work(s % 2, i, n);
  }
  x.require_right(steps);
  return steps;
}

/// The depend clauses take at most three neighbours.
int omp_depend(Points& x, long n, int steps) {
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
  return steps;
}

void peers(Group& group) {
  for (const int width : {64, 4}) {
    Points x(line(width));
    const struct {
      const char* name;
      Runner run;
      int steps;  ///< of a measurement of empty tasks
    } all[] = {{"omp_for", [&](long n, int s) { return omp_for(x, n, s); }, 8000},
               {"omp_task_depend", [&](long n, int s) { return omp_depend(x, n, s); }, 200}};
    for (const auto& peer : all) figures_of_peer(group, peer.name, peer.run, width, peer.steps);
  }
}

}  // namespace
}  // namespace spindrift::perf

int main(int argc, char** argv) {
  spindrift::perf::Group group("runtime_omp", argc, argv);
  spindrift::perf::peers(group);
}
