// SPDX-License-Identifier: Apache-2.0
#include "kernels/beam/modal_link.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "kernels/rigid/rotation.hpp"

namespace spindrift::beam {

namespace {

struct Reduced {
  Plane plane;
  Modes modes;
  Eigen::Matrix2d from_end;  ///< amplitudes of the modes for (deflection, slope)
};

/// shape^T shape summed over slopes from the start to `to`.
Eigen::Matrix2d shortening(const Reduced& r, const Table& table, double to) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  double from = 0.0;
  for (std::size_t n = 1; n < r.modes.node.size() && from < to; ++n) {
    const double end = std::min(r.modes.node[n], to);
    detail::integrate(table, from, end, [&](double at, double weight) {
      const Eigen::Vector2d s(slope(r.modes.node, r.modes.shapes.col(0), at), slope(r.modes.node, r.modes.shapes.col(1), at));
      sum += weight * s * s.transpose();
    });
    from = end;
  }
  return r.from_end.transpose() * sum * r.from_end;
}

Reduced reduce(const Table& table, const EndBody& tip, const std::array<double, 2>& damping) {
  Reduced r;
  Problem problem;
  problem.tip = tip;
  r.modes = modes(table, problem, 2);
  const Eigen::Matrix2d end = r.modes.shapes.bottomRows<2>();
  r.from_end = end.inverse();
  r.plane.to_modes = r.from_end;
  r.plane.omega = {r.modes.omega[0], r.modes.omega[1]};
  Eigen::Vector2d stiffness, rate;
  for (int k = 0; k < 2; ++k) {
    stiffness[k] = r.modes.omega[std::size_t(k)] * r.modes.omega[std::size_t(k)];
    rate[k] = 2.0 * damping[std::size_t(k)] * r.modes.omega[std::size_t(k)];
  }
  r.plane.stiffness = r.from_end.transpose() * stiffness.asDiagonal() * r.from_end;
  r.plane.damping = r.from_end.transpose() * rate.asDiagonal() * r.from_end;
  r.plane.shortening = shortening(r, table, table.length());
  return r;
}

}  // namespace

ModalLink make_modal_link(const Properties& properties, const LinkEnd& end) {
  const Table x = properties.plane_x(), y = properties.plane_y();
  const Reduced in_x = reduce(x, end.x, end.damping), in_y = reduce(y, end.y, end.damping);
  ModalLink link;
  link.length = x.length();
  link.x = in_x.plane;
  link.y = in_y.plane;
  const auto compliance = [&](const std::vector<double>& stiffness, double to) {
    double sum = 0.0;
    detail::integrate(
        x, 0.0, to, [&](double at, double weight) { sum += weight / interpolate_linear(x.position, stiffness, x.start() + at); });
    return sum;
  };
  const double soft = compliance(properties.axial, link.length);
  link.axial_stiffness = 1.0 / soft;
  link.torsion_stiffness = 1.0 / compliance(properties.torsion, link.length);
  double mass = 0.0;
  constexpr int parts = 12;  // two points in each keep its mass, first and second moment
  for (int p = 0; p < parts; ++p) {
    double m0 = 0.0, m1 = 0.0, m2 = 0.0;
    const double from = p * link.length / parts, to = (p + 1) * link.length / parts;
    detail::integrate(x, from, to, [&](double at, double weight) {
      const double m = weight * interpolate_linear(x.position, x.mass, x.start() + at);
      m0 += m, m1 += m * (at - from), m2 += m * (at - from) * (at - from);
    });
    mass += m0;
    const double centre = m1 / m0, arm = std::sqrt(m2 / m0 - centre * centre);
    for (const double at : {from + centre - arm, from + centre + arm}) {
      const auto rows = [at](const Reduced& r) -> Eigen::Vector2d {
        return r.from_end.transpose() * Eigen::Vector2d(deflection(r.modes.node, r.modes.shapes.col(0), at),
                                                        deflection(r.modes.node, r.modes.shapes.col(1), at));
      };
      link.stations.push_back({0.5 * m0, at, compliance(properties.axial, at) / soft, rows(in_x), rows(in_y),
                               shortening(in_x, x, at), shortening(in_y, y, at)});
    }
  }
  link.axial_damping = 2.0 * end.damping[1] * std::sqrt(link.axial_stiffness * (end.x.mass + mass / 3.0));
  link.torsion_damping = 2.0 * end.damping[1] * std::sqrt(link.torsion_stiffness * end.inertia_z);
  return link;
}

namespace {

/// The coefficient c(a2) of T(theta)^-1 = 1 + theta x / 2 + c theta x theta x, and its derivative over a2 (|theta| < 1).
std::array<double, 2> inverse_rate_coefficient(double a2) {
  constexpr double c[] = {1.0 / 12, 1.0 / 720, 1.0 / 30240, 1.0 / 1209600, 1.0 / 47900160, 691.0 / 1307674368000};
  double value = 0.0, derivative = 0.0;
  for (int k = 5; k >= 0; --k) derivative = derivative * a2 + value, value = value * a2 + c[k];
  return {value, derivative};
}

}  // namespace

Deformation deformation(const ModalLink& link, const End& start, const End& end) {
  using Eigen::Matrix3d, Eigen::Vector3d;
  Deformation d;
  const Vector3d a = start.point - start.centre, b = end.point - end.centre, r = end.point - start.point;
  const Matrix3d to_start = start.axes.transpose(), to_end = end.axes.transpose();
  const Eigen::AngleAxisd turned(Matrix3d(to_start * end.axes));
  const Vector3d theta = turned.angle() * turned.axis();
  const Vector3d displacement = to_start * r - link.length * Vector3d::UnitZ();
  d.value << displacement, theta;
  const auto [c, c_rate] = inverse_rate_coefficient(theta.squaredNorm());
  const Matrix3d s = skew(theta), inverse = Matrix3d::Identity() + 0.5 * s + c * (s * s);
  d.of << -to_start, to_start * (skew(a) + skew(r)), to_start, -to_start * skew(b),  //
      Matrix3d::Zero(), -inverse * to_end, Matrix3d::Zero(), inverse * to_end;
  Vector12 motion;
  motion << start.velocity, start.spin, end.velocity, end.spin;
  d.rate = d.of * motion;
  const Vector3d &w = start.spin, &v = end.spin, theta_rate = d.rate.tail<3>(), relative = to_end * (v - w);
  d.bias.head<3>() = to_start * (v.cross(v.cross(b)) - w.cross(w.cross(a + r)) - 2.0 * w.cross(start.axes * d.rate.head<3>()));
  const Vector3d once = theta.cross(relative);
  d.bias.tail<3>() = inverse * (to_end * v.cross(w)) + 0.5 * theta_rate.cross(relative) +
                     2.0 * c_rate * theta.dot(theta_rate) * theta.cross(once) +
                     c * (theta_rate.cross(once) + theta.cross(theta_rate.cross(relative)));
  return d;
}

Extension extension(const ModalLink& link, const Deformation& d) {
  const Eigen::Vector2d gx = link.x.shortening * d.x(), gy = link.y.shortening * d.y();
  Extension e{d.value[2] + 0.5 * d.x().dot(gx) + 0.5 * d.y().dot(gy), Vector6::Zero()};
  e.of << gx[0], gy[0], 1.0, -gy[1], gx[1], 0.0;
  return e;
}

double elastic_energy(const ModalLink& link, const Deformation& d) {
  const double e = extension(link, d).value;
  return 0.5 * (d.x().dot(link.x.stiffness * d.x()) + d.y().dot(link.y.stiffness * d.y()) + link.axial_stiffness * e * e +
                link.torsion_stiffness * d.value[5] * d.value[5]);
}

StationPlace station_place(const ModalLink& link, const Station& s, const Deformation& d, const Extension& e) {
  const Eigen::Vector2d gx = s.shortening_x * d.x(), gy = s.shortening_y * d.y();
  StationPlace p;
  p.place = {s.x.dot(d.x()), s.y.dot(d.y()), s.height + s.stretch * e.value - 0.5 * d.x().dot(gx) - 0.5 * d.y().dot(gy)};
  p.of.row(0) << s.x[0], 0, 0, 0, s.x[1], 0;
  p.of.row(1) << 0, s.y[0], 0, -s.y[1], 0, 0;
  p.of.row(2) = s.stretch * e.of.transpose();
  p.of.row(2) -= Eigen::Matrix<double, 1, 6>(gx[0], gy[0], 0.0, -gy[1], gx[1], 0.0);
  const Eigen::Vector2d qx = d.x_rate(), qy = d.y_rate();
  p.bias = s.stretch * (qx.dot(link.x.shortening * qx) + qy.dot(link.y.shortening * qy)) - qx.dot(s.shortening_x * qx) -
           qy.dot(s.shortening_y * qy);
  return p;
}

LinkDynamics dynamics(const ModalLink& link, const End& start, const End& end, const Eigen::Vector3d& gravity) {
  using Eigen::Vector3d;
  const Deformation d = deformation(link, start, end);
  const Extension e = extension(link, d);
  const double axial = link.axial_stiffness * e.value + link.axial_damping * e.of.dot(d.rate);
  const Eigen::Vector2d fx = link.x.stiffness * d.x() + link.x.damping * d.x_rate(),
                        fy = link.y.stiffness * d.y() + link.y.damping * d.y_rate();
  Vector6 elastic;
  elastic << fx[0], fy[0], 0.0, -fy[1], fx[1], link.torsion_stiffness * d.value[5] + link.torsion_damping * d.rate[5];
  elastic += axial * e.of;
  // Over (velocity and spin of the start's body, rate of deformation).
  Vector12 loads = Vector12::Zero();
  loads.tail<6>() = -elastic;
  Matrix12 mass = Matrix12::Zero();
  Eigen::Matrix<double, 3, 12> of;
  of.leftCols<3>().setIdentity();
  const Vector3d& w = start.spin;
  for (const Station& s : link.stations) {
    const StationPlace p = station_place(link, s, d, e);
    const Vector3d from_start = start.axes * p.place, arm = start.point - start.centre + from_start;
    of.middleCols<3>(3) = -skew(arm);
    of.rightCols<6>().noalias() = start.axes * p.of;
    const Vector3d rate = start.axes * (p.of * d.rate);
    const Vector3d bias = w.cross(w.cross(arm)) + 2.0 * w.cross(rate) + start.axes * (p.of * d.bias + p.bias * Vector3d::UnitZ());
    loads.noalias() += of.transpose() * (s.mass * (gravity - bias));
    mass.noalias() += of.transpose() * (s.mass * of);
  }
  Matrix12 to = Matrix12::Zero();
  to.topLeftCorner<6, 6>().setIdentity();
  to.bottomRows<6>() = d.of;
  return {to.transpose() * loads, to.transpose() * mass * to};
}

double kinetic_energy(const ModalLink& link, const End& start, const End& end) {
  Vector12 motion;
  motion << start.velocity, start.spin, end.velocity, end.spin;
  return 0.5 * motion.dot(dynamics(link, start, end, Eigen::Vector3d::Zero()).mass * motion);
}

double potential_energy(const ModalLink& link, const End& start, const End& end, const Eigen::Vector3d& gravity) {
  const Deformation d = deformation(link, start, end);
  const Extension e = extension(link, d);
  double energy = 0.0;
  for (const Station& s : link.stations)
    energy -= s.mass * gravity.dot(start.point + start.axes * station_place(link, s, d, e).place);
  return energy;
}

}  // namespace spindrift::beam
