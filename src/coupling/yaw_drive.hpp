// The drive that turns a nacelle into the wind, [control.yaw]: a moment about the yaw bearing, towards the angle that the
// controller of kernels/rotor/controller_yaw.hpp asks for. A source of load of the bodies, with a memory (bodies::Memory). Built
// by floating_system.cpp; tested in tests/coupled/yaw_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kernels/rotor/controller_yaw.hpp"
#include "src/aero/rotor_loads.hpp"
#include "src/bodies/loads.hpp"
#include "src/bodies/options.hpp"

namespace spindrift::coupling {

class YawDrive {
 public:
  /// Of options that passed the scene's rules.
  YawDrive(const aero::YawOptions& options, const bodies::NamedJoints& joints, const bodies::NamedBodies& bodies);

  /// What history has of it: angles about +z.
  struct Reading {
    double angle, error,
        rate;       ///< of the nacelle since the scene's position [rad]; of the filtered wind [rad]; asked for [rad/s]
    double moment;  ///< on the nacelle, towards +z [N m]
  };
  Reading reading(double t, const aero::RotorLoads& rotor, std::span<const Motion> bodies) const;

  int carrier() const { return law_.i; }
  int nacelle() const { return law_.j; }
  void add_loads(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches) const;

  // What it remembers, as bodies::Memory has it. Without values the drive holds the angle of the start.
  static constexpr std::size_t memory_size = sizeof(YawState) / sizeof(double);
  void begin(double t, const aero::RotorLoads& rotor, std::span<const Motion> bodies, std::span<double> memory) const;
  void recall(std::span<const double> memory);
  void remember(double t, const aero::RotorLoads& rotor, std::span<const Motion> bodies, std::span<double> memory) const;

 private:
  double moment(double t, std::span<const Motion> bodies) const;

  bodies::JointLaw law_;
  YawController controller_;
  double up_;           ///< 1 where the bearing's axis points up, -1 where down
  double start_angle_;  ///< about +z [rad]
  YawState state_;
};

}  // namespace spindrift::coupling
