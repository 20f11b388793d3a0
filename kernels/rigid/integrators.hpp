// One step of the integrators a scene may choose, for x' = X(x, u), u' = A(t, x, u) with X(0, u) = u: coordinates that start each
// step at zero (the charts of the bodies' step). Pure: the result depends on the arguments alone.
// rk4: classical Runge-Kutta. explicit_euler: forward Euler (both: Leble & Barakos 2016, section 2.2). symplectic: the
// kick-drift-kick (velocity Verlet, leapfrog) form, Leimkuhler, Reich & Skeel (1996); forces that depend on velocity see the
// predicted u + h u' at the second kick, which keeps second order for them (with the half-step velocity it would be first order).
// Used by src/bodies/system.cpp; orders and stability limits tested in tests/kernels/rigid and tests/src/bodies.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string_view>

namespace spindrift {

enum class Integrator { rk4, explicit_euler, symplectic };
inline constexpr std::array<std::string_view, 3> integrator_names{"rk4", "explicit_euler", "symplectic"};
inline constexpr std::string_view name(Integrator i) { return integrator_names[std::size_t(i)]; }
inline constexpr std::optional<Integrator> integrator_named(std::string_view name) {
  for (std::size_t i = 0; i < integrator_names.size(); ++i)
    if (integrator_names[i] == name) return Integrator(i);
  return std::nullopt;
}

/// What each evaluation of a step counts for, in the order in which a step asks for them: the weights by which the step
/// integrates u' over h. Anything that depends on x, u and u' alone (power) is integrated by them to the step's own order.
inline std::span<const double> evaluation_weights(Integrator integrator) {
  static constexpr double rk4[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0}, forward[] = {1.0}, ends[] = {0.5, 0.5};
  switch (integrator) {
    case Integrator::explicit_euler:
      return forward;
    case Integrator::symplectic:
      return ends;
    case Integrator::rk4:
      break;
  }
  return rk4;
}

/// Vectors that a step needs; resized once, so that steps do not allocate.
struct IntegratorWork {
  Eigen::VectorXd x, u, x_sum, u_sum, x_rate, u_rate, u_rate_before, bend;
  /// Of the last step, by rk4 only: what two evaluations at its middle differ by in u', over u' at its start: (h |lambda| / 2)^2
  /// of the stiffest mode that moves, whatever its phase (after Hairer & Wanner 1996, Solving ODEs II, IV.2). Beyond 2 the step
  /// is unstable. 0 where they differ by less than `least_change` of velocity in the step.
  double stiffness = 0.0;
  /// Likewise: what u' bends by within the step, u'1 - u'2 - u'3 + u'4 of its evaluations, times h over the velocity (10
  /// least_change at least), where one of them is ten times another: a load that sets in or ends within the step. Of an
  /// oscillator that passes its rest (h omega)^4 / 4.
  double onset = 0.0;
  static constexpr double least_change = 0.05;  // 1/s
  void resize(Eigen::Index n) {
    for (auto* v : {&x, &u, &x_sum, &u_sum, &x_rate, &u_rate, &u_rate_before, &bend}) v->resize(n);
  }
};

/// Advances u (and x, from zero) by h. rates(t, x, u, x_rate, u_rate) -> bool returns false when it cannot evaluate;
/// the step then stops at once and returns false. On success w.x and `u` hold the new values.
template <class Rates>
bool step_rk4(Rates&& rates, double t, double h, Eigen::VectorXd& u, IntegratorWork& w) {
  w.x.setZero();
  w.u = u;
  if (!rates(t, w.x, w.u, w.x_rate, w.u_rate)) return false;
  w.x_sum = w.x_rate;
  w.u_sum = w.bend = w.u_rate;
  constexpr double least_change = IntegratorWork::least_change;
  const double first = w.u_rate.norm(), speed = std::max(u.norm(), 10.0 * least_change);
  double least = first, most = first;
  constexpr double node[3] = {0.5, 0.5, 1.0}, weight[3] = {2.0, 2.0, 1.0}, bending[3] = {-1.0, -1.0, 1.0};
  for (int stage = 0; stage < 3; ++stage) {
    w.x = (node[stage] * h) * w.x_rate;
    w.u = u + (node[stage] * h) * w.u_rate;
    if (stage == 1) w.u_rate_before = w.u_rate;
    if (!rates(t + node[stage] * h, w.x, w.u, w.x_rate, w.u_rate)) return false;
    if (stage == 1) {
      const double difference = (w.u_rate - w.u_rate_before).norm();
      w.stiffness = h * difference > least_change ? difference / first : 0.0;
    }
    least = std::min(least, w.u_rate.norm()), most = std::max(most, w.u_rate.norm());
    w.x_sum += weight[stage] * w.x_rate;
    w.u_sum += weight[stage] * w.u_rate;
    w.bend += bending[stage] * w.u_rate;
  }
  if (most > 10.0 * least) w.onset = h * w.bend.norm() / speed;
  w.x = (h / 6.0) * w.x_sum;
  u += (h / 6.0) * w.u_sum;
  return true;
}

template <class Rates>
bool step_explicit_euler(Rates&& rates, double t, double h, Eigen::VectorXd& u, IntegratorWork& w) {
  w.x.setZero();
  if (!rates(t, w.x, u, w.x_rate, w.u_rate)) return false;
  w.x = h * w.x_rate;
  u += h * w.u_rate;
  return true;
}

template <class Rates>
bool step_symplectic(Rates&& rates, double t, double h, Eigen::VectorXd& u, IntegratorWork& w) {
  w.x.setZero();
  if (!rates(t, w.x, u, w.x_rate, w.u_rate)) return false;
  w.u_sum = u + (0.5 * h) * w.u_rate;  // first kick
  w.x = h * w.u_sum;                   // drift
  w.u = u + h * w.u_rate;              // velocity predicted for the end of the step
  if (!rates(t + h, w.x, w.u, w.x_rate, w.u_rate)) return false;
  u = w.u_sum + (0.5 * h) * w.u_rate;  // second kick
  return true;
}

template <class Rates>
bool step(Integrator integrator, Rates&& rates, double t, double h, Eigen::VectorXd& u, IntegratorWork& w) {
  w.stiffness = w.onset = 0.0;
  switch (integrator) {
    case Integrator::explicit_euler:
      return step_explicit_euler(rates, t, h, u, w);
    case Integrator::symplectic:
      return step_symplectic(rates, t, h, u, w);
    case Integrator::rk4:
      break;
  }
  return step_rk4(rates, t, h, u, w);
}

}  // namespace spindrift
