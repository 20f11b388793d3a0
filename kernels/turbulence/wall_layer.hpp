// A closure's own law of the wall: the layer of constant stress, (1 + nu_t+) du+/dy+ = 1, with the closure's transport equations
// in wall units, solved on points that are equally far apart in log y+ (0.05 to 1e4). A wall function that is to give the
// friction of the resolved wall must hold that law (Kalitzin, Medic, Iaccarino & Durbin 2005, J. Comput. Phys. 204, 265, who
// tabulate it likewise). Conditions: nu_tilde = 0, omega = 6 / (beta y+^2) (Wilcox 1988) and no flux of k at the wall; above, the
// logarithmic layer: nu_tilde ~ y, k constant, omega ~ 1/y. Called by src/aero/flow (sweep_model_of) once per closure that a wall
// function goes with; tested in tests/kernels/turbulence/wall_law_test.cpp against the solution of Allmaras, Johnson & Spalart
// (2012) for Spalart-Allmaras and the profile of NASA's flat plate for SST. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/turbulence/model.hpp"
#include "kernels/turbulence/wall_law.hpp"

namespace spindrift::turbulence {

/// What the iteration for a law left: the largest relative change of du+/dy+ in the last step, and how many there were.
struct WallLayerHealth {
  double change = 0.0;
  int steps = 0;
};

template <class Model>
struct WallLayer {
  static constexpr int n = Model::equations, points = WallLaw::points;
  static_assert(n == 1 || n == 2);
  using Column = std::array<double, points>;

  Column y, slope;          ///< y+, du+/dy+
  std::array<Column, n> q;  ///< what the closure carries
  WallLayerHealth health;

  WallLayer() {
    const double h = WallLaw::step();
    for (int i = 0; i < points; ++i) {
      const auto at = std::size_t(i);
      y[at] = WallLaw::place(i);
      const double damping = 1.0 - std::exp(-y[at] / 26.0),
                   eddy = 0.41 * y[at] * damping * damping;  // van Driest's, to start from
      slope[at] = 1.0 / (1.0 + eddy);
      if constexpr (n == 1) {
        q[0][at] = 0.41 * y[at];
      } else {
        q[1][at] = std::hypot(omega_at_wall(y[at]), 1.0 / (0.3 * 0.41 * y[at]));
        q[0][at] = std::max(1e-8, q[1][at] * eddy);
      }
    }
    constexpr int most = 2000;
    for (health.steps = 1; health.steps <= most; ++health.steps) {
      iterate(h);
      if (health.change < 1e-11 && health.steps > 5) break;
    }
  }

  WallLaw law() const {
    WallLaw w;
    const double h = WallLaw::step();
    for (std::size_t i = 0; i < points; ++i) {
      w.rise_at[i] = y[i] * slope[i];
      w.velocity_at[i] = i == 0 ? y[0] : w.velocity_at[i - 1] + 0.5 * h * (w.rise_at[i - 1] + w.rise_at[i]);
      if constexpr (n == 2) w.log_k[i] = std::log(q[0][i]), w.log_omega[i] = std::log(q[1][i]);
    }
    return w;
  }

 private:
  static double omega_at_wall(double y) {
    if constexpr (n == 2) return 6.0 / (Model::wall_beta * y * y);
    return 0.0;
  }
  /// Value beyond the last point over that at it: the logarithmic layer.
  static double beyond(int m, double h) { return n == 1 ? std::exp(h) : m == 0 ? 1.0 : std::exp(-h); }

  /// One implicit step, long in pseudo-time, with production as it was; the stress is the wall's after it.
  void iterate(double h) {
    const Model model;
    constexpr double rate_of_time = 0.1;  // in units of the velocity gradient
    std::array<Source<double, n>, points> source;
    std::array<SourceJacobian<double, n>, points> jacobian;
    std::array<std::array<double, n>, points> diffusivity;
    health.change = 0.0;
    const Vector<double> none{0.0, 0.0, 0.0};
    for (std::size_t i = 0; i < points; ++i) {
      Flow<double> flow{1.0, 1.0, y[i], {0.0, slope[i], 0.0}, none, none, none, 1e30, 1e30};  // no grid that could resolve eddies
      Turbulence<double, n> t;
      for (int m = 0; m < n; ++m) {
        const Column& c = q[std::size_t(m)];
        const double up = i + 1 < points ? c[i + 1] : c[i] * beyond(m, h), down = i > 0 ? c[i - 1] : c[i];
        t.q[m] = c[i];
        t.gradient[m] = {0.0, (up - down) / ((i > 0 ? 2.0 : 1.0) * h * y[i]), 0.0};
      }
      const Closure<double, n> closure = model.closure(flow, t);
      const double now = 1.0 / (1.0 + closure.eddy_viscosity);
      health.change = std::max(health.change, std::abs(now / slope[i] - 1.0));
      slope[i] = n == 1 ? std::sqrt(now * slope[i]) : now;  // one equation alone goes to and fro otherwise
      flow.u.y = slope[i];
      source[i] = model.source(flow, t), jacobian[i] = model.source_jacobian(flow, t);
      for (int m = 0; m < n; ++m) diffusivity[i][std::size_t(m)] = closure.diffusivity[m];
    }
    const double half = std::exp(0.5 * h);
    for (int m = 0; m < n; ++m) {
      const auto c = std::size_t(m);
      Column diagonal, above, right;
      double spread_below =
          n == 1 ? diffusivity[0][c] / y[0] : 0.0;  // of the first point: nu_tilde = 0 on the wall, no flux of k
      for (std::size_t i = 0; i < points; ++i) {
        const double width = y[i] * (half - 1.0 / half), J = jacobian[i].m[m][m], time = rate_of_time * slope[i];
        // Above the last point the turbulent part of the diffusivity goes on as y.
        const double next = i + 1 < points ? diffusivity[i + 1][c] : 1.0 + (diffusivity[i][c] - 1.0) * std::exp(h);
        const double spread_above = 0.5 * (diffusivity[i][c] + next) / (h * y[i] * half);
        double d = spread_below + spread_above + width * (time - J);
        above[i] = -spread_above, right[i] = width * (source[i].rate[m] + (time - J) * q[c][i]);
        if (i + 1 == points) d -= spread_above * beyond(m, h), above[i] = 0.0;
        if (i == 0 && m == 1) d = 1.0, above[i] = 0.0, right[i] = omega_at_wall(y[0]);
        if (i > 0) {
          const double g = spread_below / diagonal[i - 1];
          d += g * above[i - 1], right[i] += g * right[i - 1];
        }
        diagonal[i] = d, spread_below = spread_above;
      }
      for (std::size_t i = points; i-- > 0;) q[c][i] = (right[i] - (i + 1 < points ? above[i] * q[c][i + 1] : 0.0)) / diagonal[i];
    }
  }
};

}  // namespace spindrift::turbulence
