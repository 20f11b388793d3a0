// The parts of a step as graphs of their own, each recorded when it is first run, and whole windows as one. Used by SeaSph for a
// sea that drives itself; tested in tests/src/sea/sph/tasks_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/executor/executor.hpp"
#include "runtime/mpi/communicator.hpp"
#include "src/sea/sph/tasks.hpp"

namespace spindrift::sph {

/// Where a sea runs. All that a sea does is to be asked for by all ranks of `comm` alike.
struct Resources {
  MPI_Comm comm = MPI_COMM_SELF;
  int threads = 0;  ///< 0: as OMP_NUM_THREADS says
  std::optional<std::uint64_t> random_schedule = {};
  std::size_t records = 0;           ///< per thread, of the window's executor, for its trace
  double repartition_above = 1.2;    ///< imbalance (most loaded rank over the mean) above which groups change ranks
  std::vector<int> rank_of_group{};  ///< at the start; empty: by the counted costs of the groups
};

/// Every run throws the NumericalFailure that it leaves in the plan.
template <int dim, class Real>
class RecordedSteps {
 public:
  /// Sea, sweeps and communicator must outlive this.
  RecordedSteps(SeaState<dim, Real>& sea, const Sweeps<dim, Real>& sweeps, const runtime::Communicator& comm,
                const Resources& resources);
  RecordedSteps(const RecordedSteps&) = delete;  // its tasks refer to it
  RecordedSteps& operator=(const RecordedSteps&) = delete;

  void sort();    ///< where plan.sort is set
  void begin();   ///< rates at n and the limits
  void middle();  ///< rates at n + 1/2
  void end();     ///< to n + 1, filters
  void window();  ///< plan.left seconds; bodies are moved by the driver

  /// Groups or what is in them have changed: record again.
  void forget();
  /// Who drives the following windows.
  void drive(StepDriver driver);
  const StepDriver& driver() const { return driver_; }
  /// Of the last window: its costs and records.
  const runtime::Executor* window_executor() const { return window_ ? &window_->executor : nullptr; }

 private:
  struct Program {
    std::unique_ptr<StepTasks<dim, Real>> tasks;
    runtime::Executor executor;
  };
  template <class Record>
  void run(std::unique_ptr<Program>& program, Record&& record);

  SeaState<dim, Real>& sea_;
  const Sweeps<dim, Real>& sweeps_;
  const runtime::Communicator& comm_;
  runtime::ExecutorOptions of_parts_, of_windows_;
  StepDriver driver_;
  std::unique_ptr<Program> sort_, begin_, middle_, end_, window_;
};

}  // namespace spindrift::sph
