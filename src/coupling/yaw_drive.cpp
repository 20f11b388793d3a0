// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/yaw_drive.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "kernels/base/half_turn.hpp"
#include "src/scene/document.hpp"

namespace spindrift::coupling {

namespace {

using Row = std::array<double, YawDrive::memory_size>;

void store(const YawState& s, std::span<double> memory) { std::ranges::copy(std::bit_cast<Row>(s), memory.begin()); }

YawState stored(std::span<const double> memory) {
  Row row;
  std::ranges::copy(memory, row.begin());
  return std::bit_cast<YawState>(row);
}

}  // namespace

YawDrive::YawDrive(const aero::YawOptions& o, const bodies::NamedJoints& joints, const bodies::NamedBodies& bodies)
    : controller_{o.start_error, o.stop_error, o.filter_time_s, o.delay_s, o.rate} {
  const auto joint = std::ranges::find(joints, o.joint, &scene::Named<bodies::JointOptions>::name);
  law_.i = index_of(bodies, joint->options.bodies[0]), law_.j = index_of(bodies, joint->options.bodies[1]);
  law_.axis = joint->options.axis.normalized();
  law_.stiffness = o.stiffness_N_m_rad, law_.damping = o.damping_N_m_s_rad;
  up_ = law_.axis.z() > 0.0 ? 1.0 : -1.0;
  std::vector<Motion> start;
  for (const auto& body : bodies) start.push_back(start_motion(body.options));
  start_angle_ = up_ * law_.deflection(start).place;
  recall({});
}

double YawDrive::moment(double t, std::span<const Motion> bodies) const {
  const bodies::JointLaw::Deflection at = law_.deflection(bodies);
  return -law_.stiffness * within_half_turn(up_ * at.place - controller_.asked(state_, t)) -
         law_.damping * (up_ * at.rate - state_.turning * controller_.rate);
}

void YawDrive::add_loads(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches) const {
  law_.add(up_ * moment(t, bodies), bodies, wrenches);
}

YawDrive::Reading YawDrive::reading(double t, const aero::RotorLoads& rotor, std::span<const Motion> bodies) const {
  const Eigen::Vector3d axis = rotor.state(t, bodies).axis;
  return {up_ * law_.deflection(bodies).place, YawController::error(state_, axis.x(), axis.y()),
          state_.turning * controller_.rate, moment(t, bodies)};
}

void YawDrive::begin(double t, const aero::RotorLoads& rotor, std::span<const Motion> bodies, std::span<double> memory) const {
  const Eigen::Vector3d wind = rotor.wind().at(t, rotor.state(t, bodies).hub);
  store({t, wind.x(), wind.y(), 0.0, 0.0, start_angle_}, memory);
}

void YawDrive::recall(std::span<const double> memory) {
  state_ = memory.empty() ? YawState{.asked = start_angle_} : stored(memory);
}

void YawDrive::remember(double t, const aero::RotorLoads& rotor, std::span<const Motion> bodies, std::span<double> memory) const {
  const aero::RotorState now = rotor.state(t, bodies);
  const Eigen::Vector3d wind = rotor.wind().at(t, now.hub);
  store(controller_.advanced(stored(memory), t, wind.x(), wind.y(), now.axis.x(), now.axis.y()), memory);
}

}  // namespace spindrift::coupling
