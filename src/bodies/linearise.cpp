// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/linearise.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <limits>

#include "kernels/base/constants.hpp"
#include "kernels/linear/dense.hpp"
#include "kernels/rigid/stability.hpp"

namespace spindrift::bodies {

namespace {

// Differences of half this size either side: round-off of accelerations of order 1 then leaves about 1e-10 1/s2.
constexpr double position_difference = 1e-5;  // of the reference length, or radians
constexpr double velocity_difference = 1e-5;  // of the reference length a second, or rad/s
// Eigenvalues below this fraction of the largest are free directions: the square root of the differences' round-off.
constexpr double free_fraction = 1e-4;
// 1/s; so are those below this, of periods of 17 hours: that round-off of 1e-10 1/s2 leaves rates of 1e-5, of weights some more.
constexpr double free_rate = 1e-4;

}  // namespace

double Mode::period_s() const {
  return eigenvalue.imag() == 0.0 ? std::numeric_limits<double>::infinity() : 2.0 * pi / std::abs(eigenvalue.imag());
}
double Mode::damping_ratio() const { return eigenvalue == 0.0 ? 0.0 : -eigenvalue.real() / std::abs(eigenvalue); }

std::string direction_name(const System& system, const BodiesState& state, const Eigen::VectorXd& chart_direction) {
  const Eigen::VectorXd velocity = system.motion_of_freedoms() * chart_direction;
  double most = -1.0;
  std::string name;
  for (std::size_t b = 0; b < system.bodies().size(); ++b) {
    const Body& body = system.bodies()[b];
    const Eigen::Quaterniond& q = state.motions[b].attitude;
    const Eigen::Matrix3d axes = q.toRotationMatrix(), inertia = axes * body.inertia * axes.transpose();
    const Eigen::Vector3d linear = velocity.segment<3>(Eigen::Index(6 * b)),
                          spin = axes * velocity.segment<3>(Eigen::Index(6 * b + 3));
    for (int k = 0; k < 6; ++k) {
      const double energy = k < 3 ? body.mass * linear[k] * linear[k] : inertia(k - 3, k - 3) * spin[k - 3] * spin[k - 3];
      if (energy > most * (1.0 + 1e-9)) {
        most = energy;
        name = std::string(freedom_names[std::size_t(k)]) + " of " + body.name;
      }
    }
  }
  return name;
}

double mobility(System& system, const BodiesState& state, std::span<const Pull> pulls) {
  if (!system.open_chart(state, 0.0).ok() || system.freedoms() == 0) return 0.0;
  const Eigen::Index n = system.freedoms();
  Eigen::VectorXd force(n), along = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd mass(n, n);
  if (!system.forces_at_rest(0.0, Eigen::VectorXd::Zero(n), force, mass)) return 0.0;
  const Eigen::MatrixXd motion = system.motion_of_freedoms();
  for (const Pull& pull : pulls) {
    const Motion& m = state.motions[pull.body];
    const auto row = Eigen::Index(6 * pull.body);
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Vector3d linear = motion.col(k).segment<3>(row),
                            spin = m.attitude * Eigen::Vector3d(motion.col(k).segment<3>(row + 3));
      along[k] += (linear + spin.cross(pull.point - m.position)).dot(pull.direction);
    }
  }
  return along.dot(mass.llt().solve(along));
}

Linearisation linearise(System& system, const BodiesState& state, double t_s) {
  Linearisation result;
  result.report = system.open_chart(state, t_s);
  if (!result.report.ok()) return result;
  const Eigen::Index n = system.freedoms();
  result.matrix.setZero(2 * n, 2 * n);
  result.matrix.topRightCorner(n, n).setIdentity();
  const Eigen::VectorXd u0 = system.chart_velocity();
  Eigen::VectorXd ahead(n), behind(n);
  for (Eigen::Index column = 0; column < 2 * n; ++column) {
    const bool position = column < n;
    const double difference = position ? position_difference : velocity_difference;
    Eigen::VectorXd step = Eigen::VectorXd::Unit(n, position ? column : column - n) * (0.5 * difference);
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n);
    const Eigen::VectorXd dx = position ? step : zero, du = position ? zero : step;
    if (!system.rates(t_s, dx, u0 + du, ahead) || !system.rates(t_s, -dx, u0 - du, behind)) {
      result.report = system.chart_report();
      return result;
    }
    result.matrix.col(column).tail(n) = (ahead - behind) / difference;
  }
  if (n == 0) return result;
  system.open_chart(state, t_s);  // direction names need the tangent at the state
  const dense::Eigenpairs eigen = dense::eigenpairs(result.matrix);
  const double largest = eigen.values.cwiseAbs().maxCoeff();
  for (Eigen::Index k = 0; k < 2 * n; ++k) {
    std::complex<double> lambda = eigen.values[k];
    if (lambda.imag() < 0.0) continue;
    if (std::abs(lambda) <= std::max(free_rate, free_fraction * largest)) lambda = 0.0;
    const Eigen::VectorXcd shape = eigen.vectors.col(k).head(n);
    Eigen::Index leading;
    shape.cwiseAbs().maxCoeff(&leading);
    const Eigen::VectorXd real_shape = (shape / shape[leading]).real();
    result.modes.push_back({lambda, direction_name(system, state, real_shape)});
  }
  std::stable_sort(result.modes.begin(), result.modes.end(),
                   [](const Mode& a, const Mode& b) { return std::abs(a.eigenvalue) > std::abs(b.eigenvalue); });
  return result;
}

Eigen::Index Linearisation::freedoms_without_stiffness() const {
  const Eigen::Index n = matrix.rows() / 2;
  if (modes.empty()) return 0;
  const Eigen::VectorXd stiffness = dense::singular_values(matrix.bottomLeftCorner(n, n)).values;
  const double none = std::max(
      free_rate * free_rate, free_fraction * free_fraction * std::max(std::norm(modes.front().eigenvalue), stiffness.maxCoeff()));
  return (stiffness.array() <= none).count();
}

StepLimit step_limit(Integrator integrator, const Linearisation& linearisation) {
  StepLimit limit{std::numeric_limits<double>::infinity(), "", 0.0};
  for (const Mode& mode : linearisation.modes) {
    const double step = stability_limit(integrator, mode.eigenvalue);
    if (step < limit.step_s) limit = {step, mode.name, mode.eigenvalue};
  }
  return limit;
}

}  // namespace spindrift::bodies
