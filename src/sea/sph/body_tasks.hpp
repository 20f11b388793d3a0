// The bodies in the graph of a step: their loads are summed group by group, one task moves them, their particles follow. Used by
// tasks.cpp; tested in tests/src/sea/sph/tasks_test.cpp, solids_test.cpp and contact_test.cpp there.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "src/sea/sph/step_recording.hpp"

namespace spindrift::sph {

template <int dim, class Real>
class BodyTasks {
 public:
  /// Has no group where the driver moves no bodies. Recording and driver must outlive the tasks, and this too.
  BodyTasks(StepRecording<dim, Real>& recording, const StepDriver& driver);
  BodyTasks(const BodyTasks&) = delete;
  BodyTasks& operator=(const BodyTasks&) = delete;

  /// Loads, motions, places; nothing without StepDriver::move_bodies.
  void record(Half half);
  /// Whether a body may soon leave groups(): record again before the next window.
  bool outdated() const;
  /// Own groups that bodies may come into before the next recording.
  const std::vector<int>& groups() const { return groups_; }

 private:
  void gather(int group, double* loads) const;
  void move(Half half, int step);
  double path_limit() const;

  StepRecording<dim, Real>& recording_;
  const StepDriver& driver_;
  double path_;  // of bodies when this was recorded [m]
  std::vector<int> groups_;
  std::vector<std::pair<int, int>> touching_;  // owners whose contacts are told to bodies
  std::vector<runtime::Datum> partial_data_;
  std::vector<double> partial_, total_;  // by own group, body and pair of owners: force, moment
  std::vector<Wrench> wrenches_;
  std::vector<Touch> contacts_;
  std::vector<Motion> motions_;
};

}  // namespace spindrift::sph
