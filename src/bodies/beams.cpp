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

/// What hangs on a beam's end.
struct Carried {
  std::vector<int> bodies;
  std::vector<const BeamPlan*> beams;
};

/// What joints and other beams tie to the end's body; that body alone where they lead to the earth or to the beam's start.
Carried carried_by(const BeamPlan& plan, const std::vector<BeamPlan>& all, std::span<const Joint> joints) {
  Carried found{{plan.j}, {}};
  bool leads_back = false;
  const auto follow = [&](int from, int i, int j) {
    if (i != from && j != from) return false;
    const int other = i == from ? j : i;
    leads_back |= other == earth || other == plan.i;
    if (std::find(found.bodies.begin(), found.bodies.end(), other) == found.bodies.end()) found.bodies.push_back(other);
    return true;
  };
  for (std::size_t n = 0; n < found.bodies.size() && !leads_back; ++n) {
    const int from = found.bodies[n];
    for (const Joint& joint : joints) follow(from, joint.i, joint.j);
    for (const BeamPlan& beam : all)
      if (&beam != &plan && follow(from, beam.i, beam.j) &&
          std::find(found.beams.begin(), found.beams.end(), &beam) == found.beams.end())
        found.beams.push_back(&beam);
  }
  return leads_back ? Carried{{plan.j}, {}} : found;
}

/// What a beam's modes see at its end.
class Tip {
 public:
  Tip(const Eigen::Vector3d& at, const Eigen::Matrix3d& axes) : at_(at), axes_(axes) {}

  void add(const Body& body) {
    add(body.mass, body.initial.position);
    const Eigen::Matrix3d turn = axes_.transpose() * body.initial.attitude.toRotationMatrix();
    const Eigen::Vector3d inertia = (turn * body.inertia * turn.transpose()).diagonal();
    end_.x.inertia += inertia.y(), end_.y.inertia += inertia.x(), end_.inertia_z += inertia.z();
  }
  /// Straight and rigid: between rows its mass is linear, so three points by Simpson's rule have its moments.
  void add(const BeamPlan& beam) {
    const std::vector<double>&at = beam.properties.position, &mass = beam.properties.mass;
    const Eigen::Vector3d along = (beam.end - beam.start).normalized();
    for (std::size_t n = 1; n < at.size(); ++n) {
      const double sixth = (at[n] - at[n - 1]) / 6.0, middle = 0.5 * (mass[n - 1] + mass[n]);
      add(sixth * mass[n - 1], beam.start + (at[n - 1] - at[0]) * along);
      add(4.0 * sixth * middle, beam.start + (0.5 * (at[n - 1] + at[n]) - at[0]) * along);
      add(sixth * mass[n], beam.start + (at[n] - at[0]) * along);
    }
  }
  const beam::LinkEnd& with(const std::array<double, 2>& damping) {
    end_.damping = damping;
    return end_;
  }

 private:
  void add(double mass, const Eigen::Vector3d& place) {
    const Eigen::Vector3d arm = axes_.transpose() * (place - at_), square = arm.cwiseProduct(arm);
    end_.x.mass += mass, end_.y.mass += mass;
    end_.x.first_moment += mass * arm.z(), end_.y.first_moment += mass * arm.z();
    end_.x.inertia += mass * (square.x() + square.z());
    end_.y.inertia += mass * (square.y() + square.z());
    end_.inertia_z += mass * (square.x() + square.y());
  }
  Eigen::Vector3d at_;
  Eigen::Matrix3d axes_;
  beam::LinkEnd end_{.x = {}, .y = {}};
};

Beam make_beam(const BeamPlan& plan, const std::vector<BeamPlan>& all, std::span<const Body> bodies,
               std::span<const Joint> joints) {
  Eigen::Matrix3d axes;
  axes.col(2) = (plan.end - plan.start).normalized();
  axes.col(0) = (plan.across - plan.across.dot(axes.col(2)) * axes.col(2)).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  Tip tip(plan.end, axes);
  const Carried carried = carried_by(plan, all, joints);
  for (const int b : carried.bodies) tip.add(bodies[std::size_t(b)]);
  for (const BeamPlan* beam : carried.beams) tip.add(*beam);
  Beam beam{.name = plan.name,
            .i = plan.i,
            .j = plan.j,
            .start = plan.start,
            .end = plan.end,
            .start_axes = axes,
            .end_axes = axes,
            .link = beam::make_modal_link(plan.properties, tip.with(plan.damping))};
  const auto into = [&](int b, Eigen::Vector3d& point, Eigen::Matrix3d& own) {
    if (b == earth) return;
    const Motion& m = bodies[std::size_t(b)].initial;
    point = m.attitude.conjugate() * (point - m.position);
    own = m.attitude.toRotationMatrix().transpose() * own;
  };
  into(plan.i, beam.start, beam.start_axes);
  into(plan.j, beam.end, beam.end_axes);
  return beam;
}

}  // namespace

std::vector<Beam> make_beams(const std::vector<BeamPlan>& plans, std::span<const Body> bodies, std::span<const Joint> joints) {
  std::vector<Beam> beams;
  for (const BeamPlan& plan : plans) beams.push_back(make_beam(plan, plans, bodies, joints));
  return beams;
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
