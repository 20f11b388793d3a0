// The sides of a window as one task graph: air and bodies at once, so that what one leaves idle the other fills, or one of them
// where a scheme wants it alone. Each selection of sides is a program of its own: recorded once, replayed. Between runs a side is
// given what to do and asked for the result; within one nothing but data orders.
// Used by window.cpp; tested through tests/coupled. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "runtime/executor/executor.hpp"
#include "src/coupling/air_side.hpp"
#include "src/coupling/body_side.hpp"

namespace spindrift::coupling {

/// Sides of a window that run together.
enum class Run { air, bodies, both };
constexpr bool has_air(Run run) { return run != Run::bodies; }
constexpr bool has_bodies(Run run) { return run != Run::air; }

class WindowTasks {
 public:
  /// `options`: but for the threads.
  WindowTasks(AirSide& air, BodySide& bodies, MPI_Comm comm, const runtime::ExecutorOptions& options);

  /// @pre the sides named have been given what to do (AirSide::prepare, BodySide::prepare). @post their tasks have run; their
  /// results are to be asked for.
  void run(Run sides);

  /// The executor that tells most of where time went: of both sides, else of one; null where none has run.
  const runtime::Executor* executor() const;
  /// Core-seconds of tasks whose labels begin so, on this rank.
  double core_seconds(std::string_view module) const;
  double wall_seconds() const { return 1e-9 * double(wall_ns_); }

 private:
  struct Program {
    std::unique_ptr<runtime::Executor> executor;
    bool recorded = false;
  };
  void drop();

  AirSide& air_;
  BodySide& bodies_;
  MPI_Comm comm_;
  runtime::ExecutorOptions options_;
  std::array<Program, 3> programs_;  ///< by Run
  std::array<double, 2> dropped_{};  ///< core-seconds of executors that are gone: of the air, of the sea
  std::int64_t wall_ns_ = 0;
};

}  // namespace spindrift::coupling
