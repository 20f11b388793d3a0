// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/statics.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "kernels/linear/dense.hpp"
#include "src/bodies/linearise.hpp"

namespace spindrift::bodies {

namespace {

constexpr double chart_difference = 1e-6;  // of the reference length, or radians

/// Forces and stiffness at the centre of an open chart, in coordinates y = G^T x with mass = G G^T: then stiffness is in 1/s2.
struct Balance {
  Eigen::VectorXd force;
  Eigen::MatrixXd stiffness, cholesky;
  double all_loads = 0.0;
};

bool evaluate(System& system, double t, Balance& b) {
  const Eigen::Index n = system.freedoms();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd mass, unused;
  Eigen::VectorXd ahead, behind;
  b.stiffness.resize(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::VectorXd step = chart_difference * Eigen::VectorXd::Unit(n, k);
    if (!system.forces_at_rest(t, step, ahead, unused) || !system.forces_at_rest(t, -step, behind, unused)) return false;
    b.stiffness.col(k) = (behind - ahead) / (2.0 * chart_difference);
  }
  if (!system.forces_at_rest(t, zero, b.force, mass, &b.all_loads)) return false;
  const Eigen::LLT<Eigen::MatrixXd> llt(mass);
  if (llt.info() != Eigen::Success) return false;
  b.cholesky = llt.matrixL();
  const auto lower = b.cholesky.triangularView<Eigen::Lower>();
  lower.solveInPlace(b.force);
  lower.solveInPlace(b.stiffness);
  b.stiffness = lower.solve(b.stiffness.transpose()).transpose().eval();
  return true;
}

/// Length of the correction that the stiffness of the chart's centre asks for at x. It, and not the force left over, says whether
/// a step was one for the better (natural monotonicity, Deuflhard 2011, Newton Methods for Nonlinear Problems, section 3.3): a
/// platform that heels leaves the stiff tower on it stretched by a hair, which is a large force and nothing to correct.
double correction_left(System& system, double t, const Eigen::VectorXd& x, const Balance& b, const dense::SingularValues& svd,
                       Eigen::Index rank) {
  Eigen::VectorXd force;
  Eigen::MatrixXd mass;
  if (!system.forces_at_rest(t, x, force, mass)) return INFINITY;
  b.cholesky.triangularView<Eigen::Lower>().solveInPlace(force);
  return (svd.left.leftCols(rank).transpose() * force).cwiseQuotient(svd.values.head(rank)).norm();
}

/// Of all bodies, over what one iteration may move them.
double largest_way(const System& system, const Eigen::VectorXd& x, const EquilibriumOptions& options) {
  const double most = std::max(options.shift_limit_m, options.turn_limit * system.reference_length());
  const Eigen::VectorXd motion = system.motion_of_freedoms() * x;
  double way = 0.0;
  for (Eigen::Index b = 0; b < motion.size() / 6; ++b)
    way = std::max({way, motion.segment<3>(6 * b).norm() / most, motion.segment<3>(6 * b + 3).norm() / options.turn_limit});
  return way;
}

}  // namespace

Equilibrium find_equilibrium(System& system, const BodiesState& start, double t_s, const EquilibriumOptions& options) {
  Equilibrium result;
  result.state = start;
  for (Motion& m : result.state.motions) m.velocity.setZero(), m.omega.setZero();
  if (start.motions.empty()) return result;
  Balance b;
  for (;; ++result.iterations) {
    const StepReport opened = system.open_chart(result.state, t_s);
    if (!opened.ok() || !evaluate(system, t_s, b)) {
      result.problem = "statics: " + system.describe(opened.ok() ? system.chart_report() : opened);
      return result;
    }
    const Eigen::Index n = system.freedoms();
    if (n == 0) break;
    const dense::SingularValues svd = dense::singular_values(b.stiffness);
    const double stiffest = svd.values[0];
    Eigen::Index rank = 0;
    while (rank < n && svd.values[rank] > options.free_fraction * stiffest) ++rank;
    const Eigen::MatrixXd stiff = svd.left.leftCols(rank);

    const auto name = [&](const Eigen::VectorXd& y) {
      return direction_name(system, result.state, b.cholesky.transpose().triangularView<Eigen::Upper>().solve(y));
    };
    result.free_directions.clear();
    for (Eigen::Index k = rank; k < n; ++k) {
      const double load = std::abs(svd.left.col(k).dot(b.force));
      result.free_directions.push_back(name(svd.right.col(k)));
      if (load > options.load_tolerance * b.all_loads && result.iterations > 0) {
        result.problem = "statics: no equilibrium: " + result.free_directions.back() + " has no stiffness and carries " +
                         fmt::format("{:.3g}", load / b.all_loads) + " of the loads";
        return result;
      }
    }

    const dense::SymmetricEigenpairs symmetric = dense::symmetric_eigenpairs(0.5 * (b.stiffness + b.stiffness.transpose()));
    const double softest = symmetric.values[0];
    const bool indefinite = softest < -options.free_fraction * stiffest;
    const Eigen::VectorXd balance = stiff.transpose() * b.force;
    result.residual = b.all_loads > 0.0 ? balance.norm() / b.all_loads : 0.0;
    // Newton, least norm over the stiff directions; where the stiffness is not positive, shifted until it is.
    Eigen::VectorXd y = svd.right.leftCols(rank) * balance.cwiseQuotient(svd.values.head(rank));
    const double newton_size = b.cholesky.transpose().triangularView<Eigen::Upper>().solve(y).cwiseAbs().maxCoeff();
    if (rank == 0 || newton_size <= options.step_tolerance) {
      // Not by the symmetric part, which a moment fixed in space makes indefinite on a heeled float that stays.
      const dense::Eigenpairs pairs = dense::eigenpairs(b.stiffness);
      Eigen::Index least;
      if (pairs.values.real().minCoeff(&least) < -options.free_fraction * stiffest)
        result.unstable = name(pairs.vectors.col(least).real());
      for (Eigen::Index k = rank; k < n; ++k)
        if (std::abs(svd.left.col(k).dot(b.force)) > options.load_tolerance * b.all_loads)
          result.problem = "statics: no equilibrium: " + name(svd.right.col(k)) + " has no stiffness and carries a load";
      break;
    }
    if (result.iterations == options.iterations) {
      result.problem = "statics: not converged in " + std::to_string(options.iterations) + " iterations; unbalanced load " +
                       fmt::format("{:.3g}", result.residual) + " of all loads, last correction " +
                       fmt::format("{:.3g}", newton_size) + ", mostly " + name(y);
      return result;
    }
    if (indefinite) {
      const Eigen::MatrixXd shifted = b.stiffness - 2.0 * softest * Eigen::MatrixXd::Identity(n, n);
      y = dense::solve(shifted, stiff * balance);
    }
    Eigen::VectorXd x = b.cholesky.transpose().triangularView<Eigen::Upper>().solve(y);
    x *= std::min(1.0, 1.0 / largest_way(system, x, options));
    if (!indefinite) {
      const double now = balance.cwiseQuotient(svd.values.head(rank)).norm();
      for (int halving = 0; halving < 6 && correction_left(system, t_s, x, b, svd, rank) > now; ++halving) x *= 0.5;
    }
    if (!system.close_chart(t_s, x, Eigen::VectorXd::Zero(n), result.state)) {
      result.problem = "statics: " + system.describe(system.chart_report());
      return result;
    }
  }
  // Drivers may move bodies: velocities consistent with them, everything independent at rest.
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.freedoms());
  system.close_chart(t_s, zero, zero, result.state);
  return result;
}

}  // namespace spindrift::bodies
