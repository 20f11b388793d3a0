// The sides of a window as one task graph: air and bodies at once, so that what one leaves idle the other fills, or one of them
// where a scheme wants it alone. Each selection of sides is a program of its own: recorded once, replayed. First the sides are
// given what to do (exchange/extrapolate), at the end the result of each is taken (exchange/hub_motion, exchange/rotor_load);
// between them only data orders the tasks. What outputs of the last window have handed on
// is written beside them (output_task.hpp). Used by window_sides.cpp; tested through tests/coupled. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "runtime/executor/executor.hpp"
#include "src/coupling/air_side.hpp"
#include "src/coupling/body_side.hpp"

namespace spindrift::coupling {

/// Sides of a window that run together.
enum class Run { air, bodies, both };
constexpr bool has_air(Run run) { return run != Run::bodies; }
constexpr bool has_bodies(Run run) { return run != Run::air; }

/// What a run exchanges with its sides.
struct Exchange {
  std::function<void()> give;         ///< AirSide::prepare, BodySide::prepare for those that run
  std::function<void()> take_motion;  ///< BodySide::finish; beside the air, which may not have come to its end
  std::function<void()> take_load;    ///< AirSide::load_at_end; likewise beside the bodies
};

class WindowTasks {
 public:
  /// `options`: but for the threads.
  WindowTasks(AirSide& air, BodySide& bodies, OutputTask& output, MPI_Comm comm, const runtime::ExecutorOptions& options);

  /// Gives the sides named what to do, runs their tasks and takes their results. What `exchange` leaves out is the caller's,
  /// before or after it.
  void run(Run sides, const Exchange& exchange = {});

  /// A window begins.
  void begin_window() { ++windows_; }
  /// Executors that have replayed so many windows, this rank's since the last drop().
  std::vector<const runtime::Executor*> executors() const;
  std::int64_t windows() const { return windows_; }
  /// Sides keep what their tasks refer to until all executors are gone: now they are, and sides may change.
  void drop();

  /// The executor whose record covers most: that of both sides, else of one; null where none has run.
  const runtime::Executor* executor() const;
  /// Core-seconds of tasks whose labels begin so, on this rank.
  double core_seconds(std::string_view module) const;
  double wall_seconds() const { return 1e-9 * double(wall_ns_); }

 private:
  using Program = std::unique_ptr<runtime::Executor>;
  Program record(Run sides);

  AirSide& air_;
  BodySide& bodies_;
  OutputTask& output_;
  MPI_Comm comm_;
  runtime::ExecutorOptions options_;
  const Exchange* exchange_ = nullptr;  ///< of the present run
  std::array<Program, 3> programs_;     ///< by Run
  std::array<double, 2> dropped_{};     ///< core-seconds of executors that are gone: of the air, of the sea
  std::int64_t wall_ns_ = 0, windows_ = 0;
};

}  // namespace spindrift::coupling
