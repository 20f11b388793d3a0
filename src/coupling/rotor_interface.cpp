// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/rotor_interface.hpp"

#include <cmath>

#include "kernels/base/constants.hpp"

namespace spindrift::coupling {

RotorInterface::RotorInterface(FloatingSystem& floating)
    : floating_(floating), pitches_(floating.rotor()->control() ? floating.rotor()->control()->blades() : 0) {
  // Loads in accelerations of the whole floating system, lengths in hub heights over its centre of mass: rows then compare.
  double mass = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  std::vector<Motion> start;
  for (const auto& [name, body] : floating.scenario().bodies) {
    start.push_back(described_motion(body));
    mass += body.mass_kg, centre += body.mass_kg * body.centre_m;
  }
  length_ = std::max(1.0, (floating.rotor()->state(0.0, start).hub - centre / mass).norm());
  force_ = mass;
}

Vector RotorInterface::motion(double t, const bodies::BodiesState& bodies, double near) const {
  if (pitches_ > 0) floating_.multibody().recall(bodies);
  const aero::RotorState s = floating_.rotor()->state(t, bodies.motions);
  Vector m(motion_rows());
  m.head<hub_rows>() << s.hub / length_, s.hub_velocity / length_, s.omega - s.speed * s.axis, s.axis, s.up,
      near + std::remainder(s.azimuth - near, 2 * pi), s.speed;
  if (pitches_ > 0)
    m.tail(Eigen::Index(pitches_)) = Eigen::Map<const Vector>(floating_.rotor()->drive().pitch.data(), Eigen::Index(pitches_));
  return m;
}

Vector RotorInterface::turned(const Vector& motion, double dt) {
  Vector m = motion;
  m[15] += dt * motion[16];
  return m;
}

Vector RotorInterface::carried_on(const Vector& motion, double dt) {
  Vector m = turned(motion, dt);
  m.segment<3>(0) += dt * m.segment<3>(3);
  return m;
}

aero::RotorState RotorInterface::state(double t, const Vector& m) const {
  aero::RotorState s;
  s.hub = length_ * m.segment<3>(0), s.hub_velocity = length_ * m.segment<3>(3);
  s.axis = m.segment<3>(9).normalized();
  const Eigen::Vector3d up = m.segment<3>(12);
  s.up = (up - up.dot(s.axis) * s.axis).normalized();
  const double turns = m[15] / (2 * pi);
  s.azimuth = 2 * pi * (turns - std::floor(turns));
  s.speed = m[16];
  s.omega = m.segment<3>(6) + s.speed * s.axis;
  s.pitches.assign(m.data() + hub_rows, m.data() + m.size());
  s.relative_wind = aero::relative_wind(floating_.rotor()->wind(), t, s.hub, s.hub_velocity, s.axis);
  return s;
}

Vector RotorInterface::rows(const aero::RotorLoad& load) const {
  Vector rows(load_rows);
  rows << load.force / force_, load.moment / (force_ * length_);
  return rows;
}

aero::HubLoad RotorInterface::load(const Vector& rows) const {
  return {force_ * rows.head<3>(), force_ * length_ * rows.tail<3>()};
}

}  // namespace spindrift::coupling
