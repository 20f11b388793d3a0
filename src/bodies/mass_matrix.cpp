// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/mass_matrix.hpp"

#include <algorithm>

namespace spindrift::bodies {

MassMatrix::MassMatrix(std::span<const Body> bodies, std::span<const LoadSource> sources)
    : bodies_(bodies), sources_(sources), added_(bodies.size()), mass_(bodies.size()) {
  for (const LoadSource& source : sources) {
    has_added_mass_ |= bool(source.added_mass);
    if (source.coupling) pairs_.insert(pairs_.end(), source.coupling->pairs.begin(), source.coupling->pairs.end());
  }
  between_.resize(pairs_.size());
  between_chart_.resize(pairs_.size());
}

void MassMatrix::gather(double t, std::span<const Motion> motions, const Mechanism& mechanism) {
  const double l = mechanism.length();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    mass_[b].setZero();
    mass_[b].topLeftCorner<3, 3>().diagonal().setConstant(bodies_[b].mass * l * l);
    mass_[b].bottomRightCorner<3, 3>() = bodies_[b].inertia;
  }
  if (has_added_mass_) gather_added(t, motions, mechanism);
  if (!pairs_.empty()) gather_couplings(t, motions, mechanism);
}

/// Added mass joins the body's own, angular velocities being in body axes.
void MassMatrix::gather_added(double t, std::span<const Motion> motions, const Mechanism& mechanism) {
  const double l = mechanism.length();
  for (Matrix6& a : added_) a.setZero();
  for (const LoadSource& source : sources_)
    if (source.added_mass) source.added_mass(t, motions, added_);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Eigen::Matrix3d& axes = mechanism.solved().poses[b].axes;
    mass_[b].topLeftCorner<3, 3>() += l * l * added_[b].topLeftCorner<3, 3>();
    mass_[b].topRightCorner<3, 3>() += l * added_[b].topRightCorner<3, 3>() * axes;
    mass_[b].bottomLeftCorner<3, 3>() += l * axes.transpose() * added_[b].bottomLeftCorner<3, 3>();
    mass_[b].bottomRightCorner<3, 3>() += axes.transpose() * added_[b].bottomRightCorner<3, 3>() * axes;
  }
}

void MassMatrix::gather_couplings(double t, std::span<const Motion> motions, const Mechanism& mechanism) {
  const double l = mechanism.length();
  std::size_t first = 0;
  for (Matrix6& block : between_) block.setZero();
  for (const LoadSource& source : sources_) {
    if (!source.coupling) continue;
    source.coupling->blocks(t, motions, std::span(between_).subspan(first, source.coupling->pairs.size()));
    first += source.coupling->pairs.size();
  }
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const Eigen::Matrix3d &i = mechanism.solved().poses[std::size_t(pairs_[p][0])].axes,
                          &j = mechanism.solved().poses[std::size_t(pairs_[p][1])].axes;
    between_chart_[p].topLeftCorner<3, 3>() = l * l * between_[p].topLeftCorner<3, 3>();
    between_chart_[p].topRightCorner<3, 3>() = l * between_[p].topRightCorner<3, 3>() * j;
    between_chart_[p].bottomLeftCorner<3, 3>() = l * i.transpose() * between_[p].bottomLeftCorner<3, 3>();
    between_chart_[p].bottomRightCorner<3, 3>() = i.transpose() * between_[p].bottomRightCorner<3, 3>() * j;
  }
}

/// out += (couplings between bodies) in, over rows of all coordinates.
template <class In, class Out>
void MassMatrix::add_coupled(const In& in, Out& out) const {
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const Eigen::Index i = 6 * pairs_[p][0], j = 6 * pairs_[p][1];
    out.template middleRows<6>(i).noalias() += between_chart_[p] * in.template middleRows<6>(j);
    out.template middleRows<6>(j).noalias() += between_chart_[p].transpose() * in.template middleRows<6>(i);
  }
}

void MassMatrix::multiply(const Eigen::VectorXd& a, Eigen::VectorXd& out) const {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const auto k = Eigen::Index(6 * b);
    out.segment<6>(k).noalias() = mass_[b] * a.segment<6>(k);
  }
  add_coupled(a, out);
}

const Eigen::MatrixXd& MassMatrix::condense(const Eigen::MatrixXd& tangent) {
  mass_tangent_.resize(tangent.rows(), tangent.cols());
  condensed_.resize(tangent.cols(), tangent.cols());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const auto k = Eigen::Index(6 * b);
    mass_tangent_.middleRows<6>(k).noalias() = mass_[b] * tangent.middleRows<6>(k);
  }
  add_coupled(tangent, mass_tangent_);
  condensed_.noalias() = tangent.transpose() * mass_tangent_;
  return condensed_;
}

double MassMatrix::added_mass_power(std::span<const Motion> motions, std::span<const Vector6> rates) const {
  const auto velocity_of = [&](std::size_t b) {
    Vector6 velocity;
    velocity << motions[b].velocity, motions[b].omega_earth();
    return velocity;
  };
  double power = 0.0;
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const auto i = std::size_t(pairs_[p][0]), j = std::size_t(pairs_[p][1]);
    power -= velocity_of(i).dot(between_[p] * rates[j]) + velocity_of(j).dot(between_[p].transpose() * rates[i]);
  }
  if (!has_added_mass_) return power;
  for (std::size_t b = 0; b < bodies_.size(); ++b) power -= velocity_of(b).dot(added_[b] * rates[b]);
  return power;
}

void MassMatrix::add_reactions(double t, std::span<const Motion> motions, std::span<const Vector6> rates,
                               std::span<std::vector<Wrench>> by_source) {
  const bool one_source = std::ranges::count_if(sources_, [](const LoadSource& s) { return bool(s.added_mass); }) == 1;
  std::size_t pair = 0;
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    const auto react = [&](int on, const Matrix6& block, int by) {
      const Vector6 reaction = block * rates[std::size_t(by)];
      by_source[s][std::size_t(on)].force -= reaction.head<3>();
      by_source[s][std::size_t(on)].moment -= reaction.tail<3>();
    };
    if (const auto& coupling = sources_[s].coupling)
      for (const auto [i, j] : coupling->pairs) {
        react(i, between_[pair], j);
        react(j, between_[pair].transpose(), i);
        ++pair;
      }
    if (!sources_[s].added_mass) continue;
    if (!one_source) {
      of_one_source_.assign(bodies_.size(), Matrix6::Zero());
      sources_[s].added_mass(t, motions, of_one_source_);
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) react(int(b), one_source ? added_[b] : of_one_source_[b], int(b));
  }
}

}  // namespace spindrift::bodies
