// The bodies' side of a window: bodies and moorings in their own steps, with an engineering sea, which they ask as they go, or
// with one of particles, whose substeps are tasks that may run beside those of the air. A pure function of the state at its
// start. Used by window_tasks.cpp and window_sides.cpp; implemented here and in sea_window.cpp; tested in tests/coupled.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "runtime/graph/graph.hpp"
#include "src/bodies/state.hpp"
#include "src/coupling/tasks.hpp"

namespace spindrift::coupling {

class FloatingSystem;

class BodySide {
 public:
  virtual ~BodySide() = default;

  /// Before a window, and before its snapshot: particles go to other ranks where that pays.
  virtual void balance() {}
  /// The next window: from this state to the end tick.
  virtual void prepare(const bodies::BodiesState& from, std::int64_t end_tick) = 0;
  /// Records the tasks that do it.
  virtual Tasks record(runtime::Graph&) { return Tasks::none; }
  /// Once they have run: the state at the end. Throws NumericalFailure, and runtime::StopAsked where the work was given up.
  virtual bodies::BodiesState finish() = 0;
  /// With the steps of this retry from here on (retries.hpp).
  virtual void ease(int /*retry*/) {}
  /// Whether the recorded tasks are outdated; once their executors are gone, forget_tasks() and record again.
  virtual bool outdated() const { return false; }
  virtual void forget_tasks() {}

  // What is not in the bodies' state (particles) is saved and restored; numbered as AirSide::Snapshot.
  virtual void take_snapshot(int) {}
  virtual void return_to(int) {}

  std::int64_t steps() const { return steps_; }    ///< of the bodies, or substeps of the sea, so far
  std::int64_t own_ns() const { return own_ns_; }  ///< spent on the bodies and all that they ask

 protected:
  std::int64_t steps_ = 0, own_ns_ = 0;
};

/// The floating system outlives it. Of a floating system with particles: after FloatingSystem::fill_sea.
std::unique_ptr<BodySide> make_body_side(FloatingSystem& floating);

}  // namespace spindrift::coupling
