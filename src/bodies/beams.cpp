// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/beams.hpp"

#include <algorithm>

namespace spindrift::bodies {

namespace {

beam::End start_of(const Beam& b, std::span<const Motion> motions) {
  if (b.i == earth) return {Eigen::Vector3d::Zero(), b.start, b.start_axes};
  const Motion& m = motions[std::size_t(b.i)];
  return {m.position, m.point(b.start), m.attitude.toRotationMatrix() * b.start_axes, m.velocity, m.omega_earth()};
}

beam::End end_of(const Beam& b, std::span<const Motion> motions) {
  const Motion& m = motions[std::size_t(b.j)];
  return {m.position, m.point(b.end), m.attitude.toRotationMatrix() * b.end_axes, m.velocity, m.omega_earth()};
}

/// Bodies that joints tie to body j; j alone where they lead to the earth or to the beam's start.
std::vector<int> carried(int i, int j, std::span<const Joint> joints) {
  std::vector<int> found{j};
  for (std::size_t n = 0; n < found.size(); ++n)
    for (const Joint& joint : joints) {
      if (joint.i != found[n] && joint.j != found[n]) continue;
      const int other = joint.i == found[n] ? joint.j : joint.i;
      if (other == earth || other == i) return {j};
      if (std::find(found.begin(), found.end(), other) == found.end()) found.push_back(other);
    }
  return found;
}

}  // namespace

Beam make_beam(std::string name, int i, int j, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
               const Eigen::Vector3d& across, const beam::Properties& properties, const std::array<double, 2>& damping,
               std::span<const Body> bodies, std::span<const Joint> joints) {
  Eigen::Matrix3d axes;
  axes.col(2) = (end - start).normalized();
  axes.col(0) = (across - across.dot(axes.col(2)) * axes.col(2)).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  beam::LinkEnd tip{.x = {}, .y = {}, .damping = damping};
  for (const int b : carried(i, j, joints)) {
    const Body& body = bodies[std::size_t(b)];
    const Eigen::Matrix3d turn = axes.transpose() * body.initial.attitude.toRotationMatrix();
    const Eigen::Matrix3d inertia = turn * body.inertia * turn.transpose();
    const Eigen::Vector3d arm = axes.transpose() * (body.initial.position - end);
    const Eigen::Vector3d square = arm.cwiseProduct(arm);
    tip.x.mass += body.mass, tip.y.mass += body.mass;
    tip.x.first_moment += body.mass * arm.z(), tip.y.first_moment += body.mass * arm.z();
    tip.x.inertia += inertia(1, 1) + body.mass * (square.x() + square.z());
    tip.y.inertia += inertia(0, 0) + body.mass * (square.y() + square.z());
    tip.inertia_z += inertia(2, 2) + body.mass * (square.x() + square.y());
  }
  Beam beam{.name = std::move(name),
            .i = i,
            .j = j,
            .start = start,
            .end = end,
            .start_axes = axes,
            .end_axes = axes,
            .link = beam::make_modal_link(properties, tip)};
  const auto into = [&](int b, Eigen::Vector3d& point, Eigen::Matrix3d& own) {
    if (b == earth) return;
    const Motion& m = bodies[std::size_t(b)].initial;
    point = m.attitude.conjugate() * (point - m.position);
    own = m.attitude.toRotationMatrix().transpose() * own;
  };
  into(i, beam.start, beam.start_axes);
  into(j, beam.end, beam.end_axes);
  return beam;
}

LoadSource beam_source(std::vector<Beam> beams, const Eigen::Vector3d& gravity) {
  LoadSource source{.name = "beams", .loads = {}, .added_mass = {}};
  InertialCoupling coupling;
  for (const Beam& b : beams)
    if (b.i != earth) coupling.pairs.push_back({b.i, b.j});
  source.loads = [beams, gravity](double, std::span<const Motion> motions, std::span<Wrench> wrenches) {
    for (const Beam& b : beams) {
      const beam::Vector12 loads = dynamics(b.link, start_of(b, motions), end_of(b, motions), gravity).loads;
      const auto add = [&](int body, Eigen::Index first) {
        wrenches[std::size_t(body)].force += loads.segment<3>(first);
        wrenches[std::size_t(body)].moment += loads.segment<3>(first + 3);
      };
      if (b.i != earth) add(b.i, 0);
      add(b.j, 6);
    }
  };
  source.added_mass = [beams, gravity](double, std::span<const Motion> motions, std::span<Matrix6> added) {
    for (const Beam& b : beams) {
      const beam::Matrix12 mass = dynamics(b.link, start_of(b, motions), end_of(b, motions), gravity).mass;
      if (b.i != earth) added[std::size_t(b.i)] += mass.topLeftCorner<6, 6>();
      added[std::size_t(b.j)] += mass.bottomRightCorner<6, 6>();
    }
  };
  coupling.blocks = [beams, gravity](double, std::span<const Motion> motions, std::span<Matrix6> blocks) {
    std::size_t pair = 0;
    for (const Beam& b : beams)
      if (b.i != earth)
        blocks[pair++] += dynamics(b.link, start_of(b, motions), end_of(b, motions), gravity).mass.topRightCorner<6, 6>();
  };
  if (!coupling.pairs.empty()) source.coupling = std::move(coupling);
  return source;
}

BeamReading read_beam(const Beam& b, std::span<const Motion> motions, std::span<const Eigen::Vector3d> acceleration,
                      std::span<const Eigen::Vector3d> angular_acceleration, const Eigen::Vector3d& gravity) {
  const beam::End start = start_of(b, motions), end = end_of(b, motions);
  const beam::Deformation d = deformation(b.link, start, end);
  const beam::LinkDynamics dynamic = dynamics(b.link, start, end, gravity);
  beam::Vector12 rates = beam::Vector12::Zero();
  if (b.i != earth) rates.head<6>() << acceleration[std::size_t(b.i)], angular_acceleration[std::size_t(b.i)];
  rates.tail<6>() << acceleration[std::size_t(b.j)], angular_acceleration[std::size_t(b.j)];
  const beam::Vector12 loads = dynamic.loads - dynamic.mass * rates;
  const Eigen::Vector3d on_start = loads.head<3>(), on_end = loads.segment<3>(6);
  const Eigen::Vector3d about_start = loads.segment<3>(3) - (start.point - start.centre).cross(on_start),
                        about_end = loads.tail<3>() - (end.point - end.centre).cross(on_end);
  return {d.value.head<3>(),
          d.value.tail<3>(),
          start.axes.transpose() * on_start,
          start.axes.transpose() * about_start,
          -(end.axes.transpose() * on_end),
          -(end.axes.transpose() * about_end)};
}

double beam_energy(const Beam& b, std::span<const Motion> motions, const Eigen::Vector3d& gravity) {
  const beam::End start = start_of(b, motions), end = end_of(b, motions);
  return elastic_energy(b.link, deformation(b.link, start, end)) + kinetic_energy(b.link, start, end) +
         potential_energy(b.link, start, end, gravity);
}

}  // namespace spindrift::bodies
