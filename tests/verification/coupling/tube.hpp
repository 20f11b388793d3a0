// The flexible tube of Degroote, Bruggeman, Haelterman & Vierendeels (2008), the benchmark of strongly coupled schemes: a
// pressure pulse runs through a tube whose wall is light beside the fluid. Flow: one-dimensional, incompressible, collocated,
// first-order upwind momentum with pressure stabilisation; wall: a ring with bending and inertia; both backward Euler;
// discretised as the solvers tube_flow and tube_structure of the public code pyfsi/coconut (own implementation). Used by
// tube_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "kernels/coupling/extrapolation.hpp"
#include "kernels/coupling/solve_window.hpp"

namespace spindrift::coupling::test {

/// Solves A x = b by Gaussian elimination with row exchanges; A has `low` diagonals below and `up` above. Overwrites both.
class Banded {
 public:
  Banded(int n, int low, int up) : n_(n), low_(low), up_(up + low), a_(Matrix::Zero(low + up_ + 1, n)) {}
  double& at(int i, int j) { return a_(j - i + low_, i); }
  void clear() { a_.setZero(); }
  void solve(Vector& b) {
    for (int k = 0; k < n_; ++k) {
      const int last = std::min(n_ - 1, k + low_), right = std::min(n_ - 1, k + up_);
      int pivot = k;
      for (int i = k + 1; i <= last; ++i)
        if (std::abs(at(i, k)) > std::abs(at(pivot, k))) pivot = i;
      if (pivot != k) {
        for (int j = k; j <= right; ++j) std::swap(at(k, j), at(pivot, j));
        std::swap(b[k], b[pivot]);
      }
      for (int i = k + 1; i <= last; ++i) {
        const double factor = at(i, k) / at(k, k);
        if (factor == 0.0) continue;
        for (int j = k; j <= right; ++j) at(i, j) -= factor * at(k, j);
        b[i] -= factor * b[k];
      }
    }
    for (int k = n_ - 1; k >= 0; --k) {
      for (int j = k + 1; j <= std::min(n_ - 1, k + up_); ++j) b[k] -= at(k, j) * b[j];
      b[k] /= at(k, k);
    }
  }

 private:
  int n_, low_, up_;
  Matrix a_;  // row by row, band from the left
};

struct TubeProblem {
  double length = 0.05, diameter = 0.01, thickness = 0.001;
  double youngs_modulus = 3e5, poisson = 0.3, wall_density = 1200.0, fluid_density = 1000.0;
  int cells = 100;
  double step = 1e-4, reference_speed = 1.0;
  double pulse_Pa = 1333.2, pulse_s = 3e-3;
};

/// Velocity and kinematic pressure, two ghost cells included, and cross-section.
struct FlowState {
  Vector u, p, a;
};

class TubeFlow {
 public:
  explicit TubeFlow(const TubeProblem& problem) : p_(problem), m_(problem.cells), dz_(problem.length / problem.cells) {
    const double area = 0.25 * pi * p_.diameter * p_.diameter;
    alpha_ = area / (p_.reference_speed + dz_ / p_.step);
    state_ = now_ = {Vector::Zero(m_ + 2), Vector::Zero(m_ + 2), Vector::Constant(m_ + 2, area)};
  }
  /// Pressure on the wall [Pa] at the end of step n (from 1) for radial displacements [m]; from the state last accepted.
  Vector operator()(const Vector& displacement, int n) {
    now_ = state_;
    now_.a.segment(1, m_) = (0.25 * pi * (p_.diameter + 2.0 * displacement.array()).square()).matrix();
    now_.a[0] = now_.a[1], now_.a[m_ + 1] = now_.a[m_];
    const double inlet = double(n) * p_.step <= p_.pulse_s * (1.0 + 1e-9) ? p_.pulse_Pa / p_.fluid_density : 0.0;
    Vector f = residual(inlet);
    const double first = f.norm();
    Banded jacobian(2 * m_ + 4, 4, 4);
    for (int k = 0; k < 20 && f.norm() > 1e-12 * first; ++k) {
      fill(jacobian);
      jacobian.solve(f);
      for (int i = 0; i < m_ + 2; ++i) now_.u[i] -= f[2 * i], now_.p[i] -= f[2 * i + 1];
      f = residual(inlet);
    }
    return p_.fluid_density * now_.p.segment(1, m_);
  }
  void accept() { state_ = now_; }

 private:
  // Unknowns interleaved: u_i at 2 i, p_i at 2 i + 1. Ghosts: velocity extrapolated linearly, pressure given.
  Vector residual(double inlet) const {
    const Vector &u = now_.u, &p = now_.p, &a = now_.a;
    Vector f(2 * m_ + 4);
    f[0] = (u[0] - (2.0 * u[1] - u[2])) * alpha_;
    f[1] = (p[0] - inlet) * alpha_;
    for (int i = 1; i <= m_; ++i) {
      const double ar = 0.5 * (a[i] + a[i + 1]), al = 0.5 * (a[i] + a[i - 1]);
      const double flow_r = 0.5 * (u[i] + u[i + 1]) * ar, flow_l = 0.5 * (u[i] + u[i - 1]) * al;
      const double up_r = u[i] > 0.0 ? u[i] : u[i + 1], up_l = u[i] > 0.0 ? u[i - 1] : u[i];
      f[2 * i] = dz_ / p_.step * (a[i] - state_.a[i]) + flow_r - flow_l - alpha_ * (p[i + 1] - 2.0 * p[i] + p[i - 1]);
      f[2 * i + 1] = dz_ / p_.step * (u[i] * a[i] - state_.u[i] * state_.a[i]) + up_r * flow_r - up_l * flow_l +
                     0.5 * ((p[i + 1] - p[i]) * ar + (p[i] - p[i - 1]) * al);
    }
    f[2 * m_ + 2] = (u[m_ + 1] - (2.0 * u[m_] - u[m_ - 1])) * alpha_;
    f[2 * m_ + 3] = p[m_ + 1] * alpha_;
    return f;
  }
  void fill(Banded& j) const {
    const Vector &u = now_.u, &a = now_.a;
    j.clear();
    const auto set = [&](int row, int column, double value) { j.at(row, column) = value; };
    set(0, 0, alpha_), set(0, 2, -2.0 * alpha_), set(0, 4, alpha_);
    set(1, 1, alpha_);
    for (int i = 1; i <= m_; ++i) {
      const double ar = 0.5 * (a[i] + a[i + 1]), al = 0.5 * (a[i] + a[i - 1]);
      const bool right = u[i] > 0.0;
      const double flow_r = 0.5 * (u[i] + u[i + 1]) * ar, flow_l = 0.5 * (u[i] + u[i - 1]) * al;
      const double up_r = right ? u[i] : u[i + 1], up_l = right ? u[i - 1] : u[i];
      const int mass = 2 * i, momentum = 2 * i + 1, l = 2 * (i - 1), c = 2 * i, r = 2 * (i + 1);
      set(mass, l, -0.5 * al), set(mass, c, 0.5 * (ar - al)), set(mass, r, 0.5 * ar);
      set(mass, l + 1, -alpha_), set(mass, c + 1, 2.0 * alpha_), set(mass, r + 1, -alpha_);
      set(momentum, l, -0.5 * up_l * al - (right ? flow_l : 0.0));
      set(momentum, c, dz_ / p_.step * a[i] + 0.5 * up_r * ar - 0.5 * up_l * al + (right ? flow_r : -flow_l));
      set(momentum, r, 0.5 * up_r * ar + (right ? 0.0 : flow_r));
      set(momentum, l + 1, -0.5 * al), set(momentum, c + 1, 0.5 * (al - ar)), set(momentum, r + 1, 0.5 * ar);
    }
    const int u_out = 2 * m_ + 2;
    set(u_out, u_out, alpha_), set(u_out, 2 * m_, -2.0 * alpha_), set(u_out, 2 * m_ - 2, alpha_);
    set(u_out + 1, u_out + 1, alpha_);
  }

  TubeProblem p_;
  int m_;
  double dz_, alpha_;
  FlowState state_, now_;
};

class TubeWall {
 public:
  explicit TubeWall(const TubeProblem& problem)
      : p_(problem), m_(problem.cells), displacement_(Vector::Zero(m_)), rate_(displacement_) {
    const double dz = p_.length / m_, radius = 0.5 * p_.diameter;
    const double plate = p_.thickness * p_.youngs_modulus / (1.0 - p_.poisson * p_.poisson);
    const double bending = plate * p_.thickness * p_.thickness / 12.0, b1 = bending / std::pow(dz, 4);
    const double b2 = 2.0 * p_.poisson * bending / (radius * radius * dz * dz), b3 = plate / (radius * radius);
    inertia_ = p_.wall_density * p_.thickness / (p_.step * p_.step);
    Matrix stiffness = Matrix::Zero(m_, m_);  // ends clamped: displacement zero in the two cells beyond
    for (int i = 0; i < m_; ++i)
      for (int k = -2; k <= 2; ++k) {
        constexpr double fourth[3] = {6.0, -4.0, 1.0}, second[3] = {-2.0, 1.0, 0.0};
        if (i + k >= 0 && i + k < m_) stiffness(i, i + k) = b1 * fourth[std::abs(k)] - b2 * second[std::abs(k)];
      }
    stiffness.diagonal().array() += inertia_ + b3;
    flexibility_ = stiffness.inverse();
  }
  /// Radial displacement [m] under the pressure [Pa].
  Vector operator()(const Vector& pressure) {
    now_ = flexibility_ * (pressure + inertia_ * (displacement_ + p_.step * rate_));
    return now_;
  }
  void accept() {
    rate_ = (now_ - displacement_) / p_.step;
    displacement_ = now_;
  }
  const Vector& displacement() const { return displacement_; }

 private:
  TubeProblem p_;
  int m_;
  double inertia_;
  Matrix flexibility_;
  Vector displacement_, rate_, now_;
};

/// One step of the tube as a window: x is the displacement.
class TubeWindow {
 public:
  explicit TubeWindow(const TubeProblem& problem) : flow_(problem), wall_(problem), past_(1), step_(problem.step) {
    past_.add(0.0, wall_.displacement());
  }
  Vector first(const Vector& x) { return flow_(x, step_number_ + 1); }
  Vector second(const Vector& y) { return wall_(y); }
  Vector evaluate(const Vector& x) { return evaluate_serial(*this, x); }
  Vector guess() const { return past_.at((step_number_ + 1) * step_); }
  void accept() {
    flow_.accept(), wall_.accept();
    ++step_number_;
    past_.add(step_number_ * step_, wall_.displacement());
    done_ = true;
  }
  bool done() const { return done_; }
  bool halve() const { return false; }
  void next() { done_ = false; }
  double largest() const { return wall_.displacement().cwiseAbs().maxCoeff(); }

 private:
  TubeFlow flow_;
  TubeWall wall_;
  Extrapolation past_;
  double step_;
  int step_number_ = 0;
  bool done_ = false;
};

struct TubeRun {
  double mean_evaluations = 0.0;  ///< iterates, probes apart
  double mean_with_probes = 0.0;
  double largest = 0.0;  ///< displacement [m] at the end
  int steps = 0;         ///< done
  Bound bound = Bound::relative;
};

template <Scheme S>
TubeRun run_tube(const TubeProblem& problem, S scheme, int steps = 100, int max_evaluations = 200) {
  TubeWindow window(problem);
  TubeRun run;
  const IterationLimits limits{.relative = 1e-6, .absolute = 1e-18, .max_evaluations = max_evaluations, .fallback_steps = 0};
  for (; run.steps < steps; ++run.steps) {
    window.next();
    const WindowLog log = solve_window(window, scheme, limits);
    run.bound = log.bound;
    run.mean_evaluations += (log.evaluations - log.probes), run.mean_with_probes += log.evaluations;
    if (!log.ok()) break;
  }
  const double windows = std::max(1, std::min(run.steps + 1, steps));
  run.mean_evaluations /= windows, run.mean_with_probes /= windows;
  run.largest = window.largest();
  return run;
}

}  // namespace spindrift::coupling::test
