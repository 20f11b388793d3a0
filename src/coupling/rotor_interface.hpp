// What the rotor and the rest of the floating system exchange, as rows of numbers of comparable size: motion of the hub to the
// rotor, load at the hub to bodies. Motion: hub, its velocity (over the reference length), angular velocity of what carries the
// rotor, rotor axis and its upright (as unit vectors: no angle to wrap), azimuth with whole turns, rate; under control the pitch
// of each blade. Load: force over weight-like scale, moment over that and the length. Used by window.cpp; tested in
// tests/src/coupling/window_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kernels/coupling/scheme.hpp"
#include "src/coupling/floating_system.hpp"

namespace spindrift::coupling {

class RotorInterface {
 public:
  static constexpr Eigen::Index load_rows = 6;

  /// The floating system has a rotor, and outlives this.
  explicit RotorInterface(FloatingSystem& floating);

  Eigen::Index motion_rows() const { return hub_rows + Eigen::Index(pitches_); }
  /// `near`: an azimuth [rad] within half a turn of the true one, whole turns counted. What the state remembers is recalled.
  Vector motion(double t, const bodies::BodiesState& bodies, double near) const;
  /// The motion after `dt` of standing still with the rotor turning on.
  static Vector turned(const Vector& motion, double dt);
  /// The motion after `dt` of going on at its velocity.
  static Vector carried_on(const Vector& motion, double dt);
  static double azimuth(const Vector& motion) { return motion[15]; }
  static double rate(const Vector& motion) { return motion[16]; }

  /// The rotor that moves so, and its load as rows.
  aero::RotorState state(double t, const Vector& motion) const;
  Vector rows(const aero::RotorLoad& load) const;
  aero::HubLoad load(const Vector& rows) const;

 private:
  static constexpr Eigen::Index hub_rows = 17;

  FloatingSystem& floating_;
  std::size_t pitches_;                ///< blades that a controller pitches
  double length_ = 1.0, force_ = 1.0;  ///< scales [m], [N]
};

}  // namespace spindrift::coupling
