// The sensors in the graph of a step: what the groups add to their patches, summed and noted. Used by tasks.cpp; tested in
// tests/src/sea/sph/sensors_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "src/sea/sph/step_recording.hpp"

namespace spindrift::sph {

template <int dim, class Real>
class SensorTasks {
 public:
  /// `moving_groups`: those that moving bodies may come into; empty where bodies stay. The recording, and this, must outlive the
  /// tasks.
  SensorTasks(StepRecording<dim, Real>& recording, bool bodies_move, const std::vector<int>& body_groups);
  SensorTasks(const SensorTasks&) = delete;
  SensorTasks& operator=(const SensorTasks&) = delete;

  /// Notes what sensors read at the last evaluation; nothing without them.
  void record();

 private:
  StepRecording<dim, Real>& recording_;
  std::vector<int> groups_;  // own groups that patches are in or near
  std::vector<runtime::Datum> partial_data_;
  runtime::Datum records_;
  std::vector<double> partial_, total_;  // by group: sums of all patches (sensors.hpp)
};

/// Outside of windows: those that have read nothing so far do, at the last evaluation. On all ranks of `comm` alike.
template <int dim, class Real>
void read_sensors(SeaState<dim, Real>& sea, MPI_Comm comm);

}  // namespace spindrift::sph
