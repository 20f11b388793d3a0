// Where a rotor sits on the bodies of a scene, and what of its state follows from their motions. Used by rotor_loads.cpp; tested
// in tests/src/aero/rotor_loads_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "kernels/rigid/motion.hpp"
#include "kernels/rigid/wrench.hpp"

namespace spindrift::aero {

/// How the rotor sits in the scene at the start: from its bearing, or from [rotor] itself where it names no joint.
struct RotorPlacement {
  static constexpr int earth = -1;
  int body = 0;                ///< index of the body that takes the load
  std::optional<int> support;  ///< what it turns against (a body or `earth`); without one it turns by [rotor] speed_rpm
  Eigen::Vector3d hub = Eigen::Vector3d::Zero();    ///< earth coordinates [m]
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< downwind, earth frame; normalised on use
  double sense = 1.0;  ///< it turns about the axis, clockwise seen from upwind; -1: the other way, its blades mirrored
};

/// Motion of the rotor. Azimuth and speed are positive the way that its blades are made for.
struct RotorState {
  double azimuth = 0.0;               ///< of blade 1 from its upright position, in [0, 2 pi) [rad]
  double speed = 0.0;                 ///< [rad/s]
  Eigen::Vector3d hub, hub_velocity;  ///< earth frame [m], [m/s]
  Eigen::Vector3d axis, up;           ///< unit, earth frame; blade 1 is along `up` at azimuth zero
  Eigen::Vector3d omega;              ///< of the blades, earth frame [rad/s]
  double relative_wind = 0.0;         ///< along the axis, relative to the hub [m/s]
  std::vector<double> pitches = {};   ///< of each blade [rad], for air that is not asked by RotorLoads; none: as [rotor] has it
  double sense = 1.0;                 ///< as RotorPlacement has it

  /// About which it turns.
  Eigen::Vector3d shaft() const { return sense * axis; }
  /// Turning of what carries it [rad/s].
  Eigen::Vector3d carrier_omega() const { return omega - speed * shaft(); }

  bool operator==(const RotorState&) const = default;
};

/// The angle in [0, 2 pi).
double whole_turns_off(double angle);

class RotorBearing {
 public:
  /// `azimuth`: where the bodies are at the `start`.
  RotorBearing(const RotorPlacement& placement, double azimuth, std::span<const Motion> start);

  /// Index of the body that takes the load.
  std::size_t body() const { return std::size_t(placement_.body); }
  /// That of what carries the rotor: the same where it turns by itself, none where the earth does.
  std::optional<std::size_t> carrier() const;
  /// Whether a body turns the rotor; else it turns by itself, of which state() is told.
  bool is_turned() const { return placement_.support.has_value(); }
  /// But for the wind. `azimuth`, `speed`: of a rotor that turns by itself.
  RotorState state(std::span<const Motion> bodies, double azimuth, double speed) const;
  /// Adds a load about the hub to the body's wrench.
  void add_load(std::span<const Motion> bodies, std::span<Wrench> wrenches, const Eigen::Vector3d& force,
                const Eigen::Vector3d& moment) const;

 private:
  /// Attitude of what carries azimuth zero.
  Eigen::Quaterniond support_attitude(std::span<const Motion> bodies) const;

  RotorPlacement placement_;
  double start_azimuth_;
  Eigen::Vector3d hub_, axis_;                 ///< axes of the rotor's body, from its centre of mass
  Eigen::Vector3d support_axis_, support_up_;  ///< axes of what carries azimuth zero: the support, the earth, or the body itself
  Eigen::Quaterniond start_turn_;              ///< attitude of the body relative to the support at the start
};

}  // namespace spindrift::aero
