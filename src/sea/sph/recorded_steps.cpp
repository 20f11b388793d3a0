// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/recorded_steps.hpp"

#include <omp.h>

#include <utility>

namespace spindrift::sph {

template <int dim, class Real>
RecordedSteps<dim, Real>::RecordedSteps(SeaState<dim, Real>& sea, const Sweeps<dim, Real>& sweeps,
                                        const runtime::Communicator& comm, const Resources& resources)
    : sea_(sea), sweeps_(sweeps), comm_(comm) {
  of_parts_ = {.threads = resources.threads > 0 ? resources.threads : omp_get_max_threads(),
               .random_schedule = resources.random_schedule};
  of_windows_ = of_parts_;
  of_windows_.records = resources.records;
}

/// Records where that has not been done, runs, and throws what the numerics found wrong.
template <int dim, class Real>
template <class Record>
void RecordedSteps<dim, Real>::run(std::unique_ptr<Program>& program, Record&& record) {
  if (!program) {
    runtime::Graph graph(comm_.get());
    auto tasks = std::make_unique<StepTasks<dim, Real>>(sea_, sweeps_, driver_, graph, of_parts_.threads);
    record(*tasks);
    const runtime::ExecutorOptions& options = &program == &window_ ? of_windows_ : of_parts_;
    program.reset(new Program{std::move(tasks), runtime::Executor(std::move(graph), options)});
  }
  program->executor.run();
  if (sea_.plan.failure) throw NumericalFailure(*sea_.plan.failure);
}

template <int dim, class Real>
void RecordedSteps<dim, Real>::sort() {
  run(sort_, [](StepTasks<dim, Real>& tasks) { tasks.sort(); });
}

template <int dim, class Real>
void RecordedSteps<dim, Real>::begin() {
  run(begin_, [](StepTasks<dim, Real>& tasks) {
    tasks.evaluate(Half::begin);
    tasks.limits();
  });
}

template <int dim, class Real>
void RecordedSteps<dim, Real>::middle() {
  run(middle_, [](StepTasks<dim, Real>& tasks) { tasks.evaluate(Half::middle); });
}

template <int dim, class Real>
void RecordedSteps<dim, Real>::end() {
  run(end_, [](StepTasks<dim, Real>& tasks) {
    tasks.correct();
    tasks.filters();
  });
}

template <int dim, class Real>
void RecordedSteps<dim, Real>::window() {
  run(window_, [](StepTasks<dim, Real>& tasks) { tasks.window(); });
  if (window_->tasks->outdated()) window_ = nullptr;
}

template <int dim, class Real>
void RecordedSteps<dim, Real>::forget() {
  for (auto* program : {&sort_, &begin_, &middle_, &end_, &window_}) program->reset();
}

template <int dim, class Real>
void RecordedSteps<dim, Real>::drive(StepDriver driver) {
  driver_ = std::move(driver);
  window_ = nullptr;
}

template class RecordedSteps<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>;

}  // namespace spindrift::sph
