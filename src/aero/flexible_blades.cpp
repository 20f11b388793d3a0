// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flexible_blades.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "kernels/base/interpolation.hpp"
#include "kernels/beam/oscillator.hpp"
#include "kernels/linear/dense.hpp"
#include "src/scene/columns.hpp"

namespace spindrift::aero {

namespace {

using Eigen::Vector3d;

beam::BladeTable table_of(const BladeStructure& s) {
  beam::BladeTable table{s.masses.span, s.masses.mass, s.flap, s.edge, s.twist};
  for (double& at : table.position) at -= s.masses.span.front();
  return table;
}

/// What modes of amplitude q displace.
Vector3d turned(const BladeAxes& axes, const beam::BladeModes::Shape& shape, const Vector3d& q) {
  const Eigen::Vector2d d = shape * q;
  return d.x() * axes.x + d.y() * axes.y;
}

/// Force on the modes of a force at a point.
Vector3d projected(const BladeAxes& axes, const beam::BladeModes::Shape& shape, const Vector3d& force) {
  return shape.transpose() * Eigen::Vector2d(force.dot(axes.x), force.dot(axes.y));
}

}  // namespace

BladeStructure read_blade_structure(const Turbine& turbine, const std::string& path) {
  const scene::Columns file = scene::read_columns(path);
  file.allow_only({"span_m", "mass_kg_m", "flap_N_m2", "edge_N_m2", "twist_deg"});
  BladeStructure s;
  s.masses = blade_masses_of(turbine, file);
  const auto flap = file["flap_N_m2"], edge = file["edge_N_m2"], twist = file["twist_deg"];
  for (std::size_t n = 0; n < flap.size(); ++n) {
    if (s.masses.mass[n] <= 0.0) file.fail(int(n), fmt::format("mass_kg_m = {} must be positive", s.masses.mass[n]));
    if (flap[n] <= 0.0) file.fail(int(n), fmt::format("flap_N_m2 = {} must be positive", flap[n]));
    if (edge[n] <= 0.0) file.fail(int(n), fmt::format("edge_N_m2 = {} must be positive", edge[n]));
    s.flap.push_back(flap[n]), s.edge.push_back(edge[n]), s.twist.push_back(twist[n] * radians_per_degree);
  }
  return s;
}

FlexibleBlades::FlexibleBlades(const Turbine& turbine, const BladeStructure& structure, std::span<const double> damping)
    : blades_(turbine.blades),
      precone_(turbine.precone),
      root_(turbine.hub_radius),
      modes_(table_of(structure)),
      points_(blade_points(table_of(structure), modes_)) {
  const Planform& p = turbine.planform;
  const auto point = [&](double at) { return beam::BladePoint{at, 0.0, modes_.value(at), beam::blade_shortening(modes_, at)}; };
  for (const beam::BladePoint& at : points_) {
    mass_ += at.mass;
    prebend_.push_back(interpolate_linear(p.span, p.prebend, along(at.at)));
  }
  for (const BladePiece& piece : blade_pieces(turbine)) {
    const double at = std::clamp(piece.span - root_, 0.0, modes_.length());
    sections_.push_back({modes_.value(at), modes_.slope(at), point(at).shortening});
  }
  for (const double span : BladeRoots::stations(structure.masses)) root_points_.push_back(point(span - root_));
  by_turning_ = beam::tension_stiffness(points_, [this](double at) { return along(at); });
  by_weight_ = beam::tension_stiffness(points_, [](double) { return 1.0; });
  for (int k = 0; k < modes; ++k) damping_[k] = 2.0 * damping[std::size_t(k)] * omega()[std::size_t(k)];
}

FlexibleBlades::Modal FlexibleBlades::squared() const { return Eigen::Map<const Modal>(omega().data()).array().square(); }

std::array<double, FlexibleBlades::modes> FlexibleBlades::omega_turning(double speed) const {
  const double c = std::cos(precone_);
  beam::BladeModes::Square k = speed * speed * c * c * by_turning_;
  k.diagonal() += squared();
  for (const beam::BladePoint& p : points_)  // the pull of what has gone ahead, at a pitch of zero
    k -= speed * speed * p.mass * p.value.row(1).transpose() * p.value.row(1);
  const dense::SymmetricEigenpairs eigen = dense::symmetric_eigenpairs(k);
  std::array<double, modes> found{};
  for (int m = 0; m < modes; ++m) found[std::size_t(m)] = std::sqrt(std::max(0.0, eigen.values[m]));
  return found;
}

BentBlades FlexibleBlades::bent(const Bending& b) const { return {precone_, sections_, b.amplitudes, b.rates}; }

BladeAxes FlexibleBlades::axes(const DiscMotion& rotor, int blade) const {
  return blade_axes(rotor, blade_direction(rotor, blade, blades_), precone_, rotor.pitch(blade));
}

Eigen::Vector2d FlexibleBlades::tip(const DiscMotion& rotor, int blade, const Bending& b) const {
  const double c = std::cos(rotor.pitch(blade)), s = std::sin(rotor.pitch(blade));
  const Eigen::Vector2d d = modes_.value(modes_.length()) * b.amplitude(blade);
  return {c * d.x() - s * d.y(), s * d.x() + c * d.y()};
}

double FlexibleBlades::sag(double gravity) const {
  Eigen::Matrix<double, 2, modes> weight = Eigen::Matrix<double, 2, modes>::Zero();
  for (const beam::BladePoint& p : points_) weight += p.mass * gravity * p.value;
  double most = 0.0;
  for (int direction = 0; direction < 2; ++direction) {
    const Modal amplitude = weight.row(direction).transpose().cwiseQuotient(squared());
    most = std::max(most, (modes_.value(modes_.length()) * amplitude).norm());
  }
  return most;
}

FlexibleBlades::Modal FlexibleBlades::inertial_force(const BladeAxes& axes, const HubField& hub, const Modal& amplitude,
                                                     const Modal& rate) const {
  Modal force = Modal::Zero();
  for (std::size_t n = 0; n < points_.size(); ++n) {
    const beam::BladePoint& p = points_[n];
    const Vector3d arm = along(p.at) * axes.along + prebend_[n] * axes.x;
    const Vector3d acceleration = hub.omega_rate.cross(arm) +
                                  hub.omega.cross(hub.omega.cross(arm + turned(axes, p.value, amplitude))) +
                                  2.0 * hub.omega.cross(turned(axes, p.value, rate));
    force += p.mass * projected(axes, p.value, hub.gravity - acceleration);
  }
  const double across = hub.omega.squaredNorm() - std::pow(hub.omega.dot(axes.along), 2);
  return force - (across * by_turning_ + hub.gravity.dot(axes.along) * by_weight_) * amplitude;
}

Eigen::Matrix<double, 6, FlexibleBlades::modes> FlexibleBlades::participation(const BladeAxes& axes) const {
  Eigen::Matrix<double, 6, modes> p = Eigen::Matrix<double, 6, modes>::Zero();
  for (std::size_t n = 0; n < points_.size(); ++n) {
    const beam::BladePoint& at = points_[n];
    const Vector3d arm = along(at.at) * axes.along + prebend_[n] * axes.x;
    Eigen::Matrix<double, 3, modes> moved = at.mass * (axes.x * at.value.row(0) + axes.y * at.value.row(1));
    p.topRows<3>() += moved;
    for (int k = 0; k < modes; ++k) p.col(k).tail<3>() += arm.cross(Vector3d(moved.col(k)));
  }
  return p;
}

FlexibleBlades::Modal FlexibleBlades::restoring(const Modal& amplitude, const Modal& rate) const {
  return squared().cwiseProduct(amplitude) + damping_.cwiseProduct(rate);
}

Eigen::Matrix<double, 6, 1> FlexibleBlades::reaction(const DiscMotion& rotor, const HubField& hub, const Bending& bending,
                                                     std::span<const double> air) const {
  Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
  for (int b = 0; b < blades_; ++b) {
    const BladeAxes axes = this->axes(rotor, b);
    const Modal q = bending.amplitude(b), rate = bending.rate(b);
    const Modal driving =
        Eigen::Map<const Modal>(air.data() + modes * b) + inertial_force(axes, hub, q, rate) - restoring(q, rate);
    sum -= participation(axes) * driving;
    for (std::size_t n = 0; n < points_.size(); ++n) {  // weight and turning of masses that have moved
      const beam::BladePoint& p = points_[n];
      const Vector3d arm = along(p.at) * axes.along + prebend_[n] * axes.x, moved = turned(axes, p.value, q);
      const Vector3d force =
          -p.mass * (hub.omega.cross(hub.omega.cross(moved)) + 2.0 * hub.omega.cross(turned(axes, p.value, rate)));
      sum.head<3>() += force;
      sum.tail<3>() += arm.cross(force) + moved.cross(Vector3d(p.mass * (hub.gravity - hub.omega.cross(hub.omega.cross(arm)))));
    }
  }
  return sum;
}

Eigen::Matrix<double, 6, 6> FlexibleBlades::added_mass(const DiscMotion& rotor) const {
  Eigen::Matrix<double, 6, 6> a = Eigen::Matrix<double, 6, 6>::Zero();
  for (int b = 0; b < blades_; ++b) {
    const Eigen::Matrix<double, 6, modes> p = participation(axes(rotor, b));
    a -= p * p.transpose();
  }
  return a;
}

void FlexibleBlades::settle(const DiscMotion& rotor, const HubField& hub, std::span<const double> air, Bending& bending) const {
  for (int b = 0; b < blades_; ++b) {
    const BladeAxes axes = this->axes(rotor, b);
    const double across = hub.omega.squaredNorm() - std::pow(hub.omega.dot(axes.along), 2);
    beam::BladeModes::Square k = across * by_turning_ + hub.gravity.dot(axes.along) * by_weight_;
    const Modal q = bending.amplitude(b);
    const Modal force = Eigen::Map<const Modal>(air.data() + modes * b) + inertial_force(axes, hub, q, Modal::Zero()) + k * q;
    k.diagonal() += squared();
    bending.amplitude(b) = k.ldlt().solve(force);
    bending.rate(b).setZero();
  }
}

FlexibleBlades::Row FlexibleBlades::row(std::span<double> memory, int blade) const {
  double* at = memory.data() + head + std::size_t(4 * modes * blade);
  return {Eigen::Map<Modal>(at), Eigen::Map<Modal>(at + modes), Eigen::Map<Modal>(at + 2 * modes),
          Eigen::Map<Modal>(at + 3 * modes)};
}

void FlexibleBlades::begin(double t, const DiscMotion& rotor, const HubField& hub, const Bending& bending,
                           std::span<const double> air, std::span<double> memory) const {
  std::ranges::fill(memory, 0.0);
  memory[0] = t;
  Eigen::Map<Vector3d>(memory.data() + 2) = rotor.hub_velocity;
  Eigen::Map<Vector3d>(memory.data() + 5) = rotor.omega;
  for (int b = 0; b < blades_; ++b) {
    Row now = row(memory, b);
    now.amplitude = bending.amplitude(b), now.rate = bending.rate(b);
    now.force = Eigen::Map<const Modal>(air.data() + modes * b) + inertial_force(axes(rotor, b), hub, now.amplitude, now.rate);
    now.acceleration = now.force - restoring(now.amplitude, now.rate);
  }
}

FlexibleBlades::Bending FlexibleBlades::predicted(std::span<const double> memory, double t) const {
  Bending b;
  const double h = t - memory[0];
  for (int blade = 0; blade < blades_; ++blade)
    for (int k = 0; k < modes; ++k) {
      const double* at = memory.data() + head + std::size_t(4 * modes * blade + k);
      b.amplitude(blade)[k] = at[0] + h * (at[modes] + 0.5 * h * at[2 * modes]);
      b.rate(blade)[k] = at[modes] + h * at[2 * modes];
    }
  return b;
}

void FlexibleBlades::advance(double t, double h, const DiscMotion& rotor, const HubField& hub, std::span<const double> air,
                             std::span<double> memory) const {
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  Eigen::Map<Vector6> before(memory.data() + 2), last(memory.data() + 8);
  Vector6 now, mean;
  now << rotor.hub_velocity, rotor.omega;
  mean = (now - before) / h;
  mean.tail<3>() -= hub.omega_rate;
  const Vector6 at_end = memory[1] > 0.0 ? Vector6(1.5 * mean - 0.5 * last) : mean;
  const Bending end = predicted(memory, t);
  DiscMotion start = rotor;
  start.azimuth -= h * rotor.sense * rotor.omega.dot(rotor.axis);
  for (int b = 0; b < blades_; ++b) {
    Row state = row(memory, b);
    const BladeAxes axes = this->axes(rotor, b);
    const auto with = participation(axes);
    const Modal force =
        Eigen::Map<const Modal>(air.data() + modes * b) + inertial_force(axes, hub, end.amplitude(b), end.rate(b));
    const Modal from = state.force - participation(this->axes(start, b)).transpose() * mean, to = force - with.transpose() * mean;
    for (int k = 0; k < modes; ++k) {
      const beam::Oscillator mode{omega()[std::size_t(k)], damping_[k]};
      const auto [x, v] = mode.advance({state.amplitude[k], state.rate[k]}, from[k], to[k], h);
      state.amplitude[k] = x, state.rate[k] = v;
    }
    state.force = force;
    state.acceleration = force - with.transpose() * at_end - restoring(state.amplitude, state.rate);
  }
  memory[0] = t, memory[1] += 1.0;
  before = now, last = mean;
}

std::vector<MassMotion> FlexibleBlades::mass_motions(const DiscMotion& rotor, int blade, const HubField& field,
                                                     const Eigen::Matrix<double, 6, 1>& hub, const Bending& bending,
                                                     std::span<const double> air) const {
  const BladeAxes axes = this->axes(rotor, blade);
  const Modal q = bending.amplitude(blade), rate = bending.rate(blade);
  const Modal acceleration = Eigen::Map<const Modal>(air.data() + modes * blade) + inertial_force(axes, field, q, rate) -
                             restoring(q, rate) - participation(axes).transpose() * hub;
  std::vector<MassMotion> motions;
  for (const beam::BladePoint& p : root_points_)
    motions.push_back({turned(axes, p.value, q) - 0.5 * q.dot(p.shortening * q) * axes.along,
                       turned(axes, p.value, acceleration) + 2.0 * field.omega.cross(turned(axes, p.value, rate))});
  return motions;
}

}  // namespace spindrift::aero
