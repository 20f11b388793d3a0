// The symplectic (position Verlet) step of SPH, second order, two evaluations of the rates:
//   half state   x* = x + dt/2 v,  v* = v + dt/2 a(n),  rho* = rho + dt/2 R(n)
//   full state   v' = v + dt a*,   x' = x + dt/2 (v + v'),  rho' = rho (2 - e)/(2 + e),  e = -dt R* / rho*
// Leimkuhler, Reich & Skeel (1996), IMA Vol. Math. Appl. 82; with the density as in Parshikov et al. (2000), Int. J. Impact Eng.
// 24 and DualSPHysics (Dominguez et al. 2022, Comput. Part. Mech. 9, section 2.4). The scheme of Leble & Barakos (2016), section
// 3.
//
// But v* is taken later than the middle by (c0 dt / h)^2 of the step. For velocity and density the scheme is the explicit
// midpoint rule, which lifts the energy of an oscillation by (omega dt)^4 / 4 a step. In water viscosity and diffusion take that
// away. A particle alone on a wall has neither: it bounces ever higher. The delay s takes s (omega dt)^2: more, for omega dt up
// to 1.7 c0 dt / h. Of waves of the sea, whose omega dt is a thousandth, it takes next to nothing. The order stays two.
//
// Called by src/sea/sph/step.hpp; tested in tests/kernels/sph/step_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace spindrift::sph {

struct StepSymplectic {
  /// Value at n + 1/2 of a quantity with the rate at n: position with velocity, velocity with acceleration, density with its
  /// rate.
  template <class Real>
  static Real half(Real value, Real rate, Real dt) {
    return value + Real(0.5) * dt * rate;
  }
  /// The velocity that rates at n + 1/2 are made with; courant: c0 dt / h.
  template <class Real>
  static Real velocity_half(Real v, Real acceleration, Real dt, Real courant) {
    return v + (Real(0.5) + courant * courant) * dt * acceleration;
  }
  template <class Real>
  static Real velocity(Real v, Real acceleration_half, Real dt) {
    return v + dt * acceleration_half;
  }
  template <class Real>
  static Real position(Real x, Real v, Real v_new, Real dt) {
    return x + Real(0.5) * dt * (v + v_new);
  }
  /// Deviation rho' - rho0 from the deviations at n and n + 1/2: the ratio (2 - e)/(2 + e) written as an increment, which keeps
  /// small digits.
  template <class Real>
  static Real deviation(Real d, Real d_half, Real rate_half, Real dt, Real rho0) {
    const Real e = -dt * rate_half / (rho0 + d_half);
    return d - (rho0 + d) * (Real(2) * e / (Real(2) + e));
  }
};

}  // namespace spindrift::sph
