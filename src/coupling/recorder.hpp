// What a run writes down at the end of each window: columns of history.csv for the bodies, their loads by source, the joints, the
// rotor, the moorings and the waves that a scene has. Names and signs: docs/user/outputs.md and conventions.md.
// Used by src/run; tested in tests/src/coupling/recorder_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "src/bodies/system.hpp"
#include "src/coupling/machine.hpp"
#include "src/io/history.hpp"

namespace spindrift::coupling {

/// Motion of the reference point of a body and of the body round it, as it is written.
struct ReferenceMotion {
  Eigen::Vector3d displacement, velocity, acceleration;  ///< of the point, earth axes [m], [m/s], [m/s2]
  Eigen::Vector3d angles;                                ///< roll, pitch, yaw since the start [rad]
  Eigen::Vector3d omega, omega_rate;                     ///< earth axes [rad/s], [rad/s2]
};

/// `point`: the reference point in body axes from the centre of mass; accelerations as System::evaluate gives them.
ReferenceMotion reference_motion(const Motion& now, const Motion& initial, const Eigen::Vector3d& point,
                                 const Eigen::Vector3d& acceleration, const Eigen::Vector3d& omega_rate);

class Recorder {
 public:
  /// Declares the columns in `history`. The machine outlives the recorder.
  Recorder(Machine& machine, io::History& history);

  /// Fills the row of time t [s].
  void fill(std::span<double> row, const bodies::BodiesState& state, double t);

 private:
  struct Load {
    std::size_t source, body, column;
  };
  Machine& machine_;
  std::vector<std::size_t> body_columns_;  ///< first of each body
  std::vector<Load> loads_;
  std::vector<std::size_t> joint_columns_, mooring_columns_;
  void declare_particles(io::History& history);
  void put_particles(std::span<double> row, double t) const;
  std::size_t rotor_column_ = 0, control_column_ = 0, wave_column_ = 0, particle_column_ = 0;
};

}  // namespace spindrift::coupling
