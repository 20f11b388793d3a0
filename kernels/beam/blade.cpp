// SPDX-License-Identifier: Apache-2.0
#include "kernels/beam/blade.hpp"

#include <cmath>

#include "kernels/linear/dense.hpp"

namespace spindrift::beam {

BladeModes::BladeModes(const BladeTable& table) : length_(table.position.back()) {
  const Eigen::Index plane = 2 * (elements + 1), free = 2 * (plane - 2);
  const double h = length_ / elements;
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(2 * plane, 2 * plane), stiffness = mass;
  const Table positions{table.position, table.mass, {}};
  for (int e = 0; e < elements; ++e)
    detail::integrate(positions, e * h, (e + 1) * h, [&](double at, double weight) {
      const detail::Hermite shape(at / h - e, h);
      const auto value = [&](const std::vector<double>& of) { return interpolate_linear(table.position, of, at); };
      const double c = std::cos(value(table.twist)), s = std::sin(value(table.twist));
      const double flap = value(table.flap), edge = value(table.edge);
      const Eigen::Matrix4d m = weight * value(table.mass) * shape.value * shape.value.transpose();
      const Eigen::Matrix4d k = weight * shape.curvature * shape.curvature.transpose();
      const Eigen::Index x = 2 * e, y = plane + 2 * e;
      mass.block<4, 4>(x, x) += m, mass.block<4, 4>(y, y) += m;
      stiffness.block<4, 4>(x, x) += (flap * c * c + edge * s * s) * k;
      stiffness.block<4, 4>(y, y) += (flap * s * s + edge * c * c) * k;
      stiffness.block<4, 4>(x, y) += (flap - edge) * s * c * k, stiffness.block<4, 4>(y, x) += (flap - edge) * s * c * k;
    });
  // Slopes in units of 1/h, so that the entries compare; the root's four are left out.
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 2; k < plane; ++k) kept.push_back(k);
  for (Eigen::Index k = 2; k < plane; ++k) kept.push_back(plane + k);
  Eigen::VectorXd unit(free);
  for (Eigen::Index k = 0; k < free; ++k) unit[k] = k % 2 ? 1.0 / h : 1.0;
  const auto scaled = [&](const Eigen::MatrixXd& full) -> Eigen::MatrixXd {
    return unit.asDiagonal() * Eigen::MatrixXd(full(kept, kept)) * unit.asDiagonal();
  };
  const dense::SymmetricEigenpairs eigen = dense::symmetric_eigenpairs(scaled(stiffness), scaled(mass));
  for (int k = 0; k <= elements; ++k) node_.push_back(k * h);
  nodal_.setZero(2 * plane, count);
  for (int k = 0; k < count; ++k) {
    omega_[std::size_t(k)] = std::sqrt(std::max(0.0, eigen.values[k]));
    const Eigen::VectorXd mode = unit.cwiseProduct(eigen.vectors.col(k));
    for (Eigen::Index i = 0; i < free; ++i) nodal_(kept[std::size_t(i)], k) = mode[i];
    const Eigen::Vector2d tip(nodal_(plane - 2, k), nodal_(2 * plane - 2, k));
    if ((std::abs(tip.x()) > std::abs(tip.y()) ? tip.x() : tip.y()) < 0.0) nodal_.col(k) *= -1.0;
  }
}

namespace {

/// Of the modes' nodal values, by Hermite shapes of the element at this distance.
template <class Of>
BladeModes::Shape sampled(std::span<const double> node, const Eigen::MatrixXd& nodal, double at, const Of& of) {
  const std::size_t e = interval(node, at);
  const double h = node[e + 1] - node[e];
  const detail::Hermite hermite((at - node[e]) / h, h);
  const Eigen::Index plane = nodal.rows() / 2, first = Eigen::Index(2 * e);
  BladeModes::Shape shape;
  shape.row(0) = of(hermite).transpose() * nodal.middleRows<4>(first);
  shape.row(1) = of(hermite).transpose() * nodal.middleRows<4>(plane + first);
  return shape;
}

}  // namespace

BladeModes::Shape BladeModes::value(double at) const {
  return sampled(node_, nodal_, at, [](const detail::Hermite& h) -> const Eigen::Vector4d& { return h.value; });
}

BladeModes::Shape BladeModes::slope(double at) const {
  return sampled(node_, nodal_, at, [](const detail::Hermite& h) -> const Eigen::Vector4d& { return h.slope; });
}

BladeModes::Square blade_shortening(const BladeModes& modes, double at) {
  const double h = modes.length() / BladeModes::elements;
  BladeModes::Square sum = BladeModes::Square::Zero();
  for (int e = 0; e < BladeModes::elements && e * h < at; ++e) {
    const double half = 0.5 * (std::min((e + 1) * h, at) - e * h);  // slopes are parabolas there: exact
    for (std::size_t g = 0; g < detail::gauss_point.size(); ++g) {
      const BladeModes::Shape slope = modes.slope(e * h + half * (1.0 + detail::gauss_point[g]));
      sum += half * detail::gauss_weight[g] * slope.transpose() * slope;
    }
  }
  return sum;
}

std::vector<BladePoint> blade_points(const BladeTable& table, const BladeModes& modes) {
  const Table positions{table.position, table.mass, {}};
  const double h = modes.length() / BladeModes::elements;
  std::vector<BladePoint> points;
  for (int e = 0; e < BladeModes::elements; ++e) {
    double m = 0.0, first = 0.0, second = 0.0;
    detail::integrate(positions, e * h, (e + 1) * h, [&](double at, double weight) {
      const double own = weight * interpolate_linear(table.position, table.mass, at);
      m += own, first += own * at, second += own * at * at;
    });
    const double middle = first / m, apart = std::sqrt(std::max(0.0, second / m - middle * middle));
    for (const double at : {middle - apart, middle + apart})
      points.push_back({at, 0.5 * m, modes.value(at), blade_shortening(modes, at)});
  }
  return points;
}

}  // namespace spindrift::beam
