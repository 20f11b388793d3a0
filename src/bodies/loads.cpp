// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/loads.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/base/half_turn.hpp"
#include "kernels/base/interpolation.hpp"

namespace spindrift::bodies {

LoadSource gravity_source(std::span<const Body> bodies, double gravity_m_s2, const Eigen::Vector3d& down) {
  std::vector<Eigen::Vector3d> weight;
  for (const Body& body : bodies) weight.push_back(body.mass * gravity_m_s2 * down.normalized());
  return {"gravity",
          [weight](double, std::span<const Motion>, std::span<Wrench> wrenches) {
            for (std::size_t b = 0; b < wrenches.size(); ++b) wrenches[b].force += weight[b];
          },
          {}};
}

LoadSource point_load_source(std::string name, std::vector<PointLoad> loads) {
  return {std::move(name),
          [loads = std::move(loads)](double, std::span<const Motion> bodies, std::span<Wrench> wrenches) {
            for (const PointLoad& load : loads) {
              const Motion& m = bodies[std::size_t(load.body)];
              Wrench& w = wrenches[std::size_t(load.body)];
              w.add_force(load.follows_body ? Eigen::Vector3d(m.attitude * load.force) : load.force, m.point(load.point));
              w.add_moment(load.follows_body ? Eigen::Vector3d(m.attitude * load.moment) : load.moment);
            }
          },
          {}};
}

namespace {

const Motion& motion_of(std::span<const Motion> bodies, int body) {
  static const Motion still;
  return body == earth ? still : bodies[std::size_t(body)];
}

}  // namespace

JointLaw::Deflection JointLaw::deflection(std::span<const Motion> bodies) const {
  const Motion &a = motion_of(bodies, i), &b = motion_of(bodies, j);
  const Eigen::Vector3d along = a.attitude * axis;
  if (turns) {
    const Eigen::Quaterniond turned = a.attitude.conjugate() * b.attitude;
    return {within_half_turn(2.0 * std::atan2(turned.vec().dot(axis), turned.w())),
            (b.omega_earth() - a.omega_earth()).dot(along)};
  }
  const Eigen::Vector3d apart = b.point(point_j) - a.point(point_i);
  return {apart.dot(along),
          (b.point_velocity(point_j) - a.point_velocity(point_i)).dot(along) + apart.dot(a.omega_earth().cross(along))};
}

double JointLaw::load(const Deflection& at) const {
  // A spring that turned past half a turn pulls back the other way: over a whole turn it does no work.
  const double off = turns ? within_half_turn(at.place - rest) : at.place - rest;
  double load = -stiffness * off - (damping + quadratic_damping * std::abs(at.rate)) * at.rate -
                friction * at.rate / std::max(std::abs(at.rate), creep_rate);
  if (!places.empty()) load += interpolate_linear(places, loads, at.place);
  return load;
}

void JointLaw::add(double load, std::span<const Motion> bodies, std::span<Wrench> wrenches) const {
  const Eigen::Vector3d along = load * (motion_of(bodies, i).attitude * axis);
  const Eigen::Vector3d at = motion_of(bodies, j).point(point_j);
  for (const auto& [body, sign] : {std::pair{i, -1.0}, std::pair{j, 1.0}}) {
    if (body == earth) continue;
    if (turns)
      wrenches[std::size_t(body)].add_moment(sign * along);
    else
      wrenches[std::size_t(body)].add_force(sign * along, at);
  }
}

LoadSource joint_law_source(std::vector<JointLaw> laws) {
  return {"joint_laws",
          [laws = std::move(laws)](double, std::span<const Motion> bodies, std::span<Wrench> wrenches) {
            for (const JointLaw& law : laws) law.add(law.load(law.deflection(bodies)), bodies, wrenches);
          },
          {}};
}

}  // namespace spindrift::bodies
