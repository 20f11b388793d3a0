// Both sides of a coupled window, moved as its scheme asks: bodies to a tick, the air to a time, or both at once; and why one did
// not come there. Used by window.cpp; tested through tests/src/coupling/window_test.cpp and tests/coupled/schemes_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "src/coupling/output_task.hpp"
#include "src/coupling/rotor_interface.hpp"
#include "src/coupling/sides.hpp"
#include "src/coupling/window_tasks.hpp"

namespace spindrift::coupling {

class WindowSides {
 public:
  /// The floating system outlives them; the engineering rotor, and the bodies, where none are given. `comm`: of the ranks that
  /// share their tasks.
  WindowSides(FloatingSystem& floating, Sides sides, MPI_Comm comm, std::size_t records);

  /// Bodies alone from `state` to the tick `end`; false where they fail.
  bool move(bodies::BodiesState& state, std::int64_t end);
  /// Air alone over `dt` seconds that end at `t` with the hub moving so; the load's rows are not finite where it fails.
  Vector air_load(double t, double dt, const Vector& motion);
  /// Both at once, on a motion that is extrapolated as a task.
  std::pair<bool, Vector> move_beside_air(bodies::BodiesState& state, std::int64_t end, double t, double dt,
                                          const std::function<Vector()>& motion);

  /// Before the window of this number, of so many: blocks of both fluids go to other ranks where that pays.
  void balance(std::int64_t window, std::int64_t windows);
  void take_snapshot(AirSide::Snapshot slot);
  /// What went wrong since is forgotten, but not that a side is to stop.
  void return_to(AirSide::Snapshot slot, Run sides);
  /// A window begins, with the steps of this retry.
  void begin_window(int retry);
  /// Given up since the run is to stop.
  bool stopped() const { return air_failure_.stopped || bodies_failure_.stopped; }
  /// Why a side did not come to the end; empty where both did, or were stopped.
  const std::string& trouble() const { return air_failure_.what.empty() ? bodies_failure_.what : air_failure_.what; }
  /// Whether smaller steps may mend that.
  bool mendable() const { return !trouble().empty() && !air_failure_.lasting; }

  AirSide& air() const { return *air_; }
  BodySide& bodies() const { return *bodies_; }
  const WindowTasks& tasks() const { return tasks_; }
  /// Is written beside the next window.
  OutputTask& output() { return output_; }
  std::int64_t rotor_calls() const { return rotor_calls_; }

  /// Empty where rotor and bodies exchange nothing.
  const std::optional<RotorInterface> interface;

 private:
  struct Failure {
    std::string what;
    bool lasting = false, stopped = false;
  };
  bool take_motion(bodies::BodiesState& state);
  Vector take_load();

  std::unique_ptr<AirSide> air_;
  std::unique_ptr<BodySide> bodies_;
  OutputTask output_;
  WindowTasks tasks_;
  Failure air_failure_, bodies_failure_;
  std::int64_t rotor_calls_ = 0;
};

/// Of rows that a side has not come to.
Vector not_finite(Eigen::Index rows);

}  // namespace spindrift::coupling
