// Spalart-Allmaras one-equation model: Spalart & Allmaras (1994), La Recherche Aerospatiale 1, 5; limited vorticity and the
// negative variant of Allmaras, Johnson & Spalart (2012), ICCFD7-1902, eqs. 11-12 and 20-24; as on NASA's Turbulence Modeling
// Resource. Transported: nu_tilde [m2/s], conserved as rho nu_tilde (their section 4: the extra term with the density's gradient
// is kept). Called by src/aero/flow; tested in tests/kernels/turbulence/model_sa_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

#include "kernels/turbulence/model.hpp"

namespace spindrift::turbulence {

/// Constants that the length of a detached-eddy variant shares with the model.
struct SaConstants {
  static constexpr double cb1 = 0.1355, cb2 = 0.622, sigma = 2.0 / 3.0, kappa = 0.41, cw2 = 0.3, cw3 = 2.0, cv1 = 7.1, ct3 = 1.2,
                          ct4 = 0.5, c2 = 0.7, c3 = 0.9, cn1 = 16.0;
  static constexpr double cw1 = cb1 / (kappa * kappa) + (1.0 + cb2) / sigma;

  template <class Real>
  static SPINDRIFT_INLINE Real fv1(const Real& chi) {
    const Real cube = chi * chi * chi;
    return cube / (cube + cv1 * cv1 * cv1);
  }
  /// nu_tilde over nu where nu_t / nu = chi fv1(chi) is given: Newton from above, where that is convex.
  static double chi_of(double eddy_viscosity) {
    constexpr double cube = cv1 * cv1 * cv1;
    double chi = eddy_viscosity + std::pow(eddy_viscosity * cube, 0.25);
    for (int n = 0; n < 50; ++n) {
      const double c3 = chi * chi * chi, value = c3 * (chi - eddy_viscosity) - eddy_viscosity * cube;
      chi -= value / (c3 + 3.0 * chi * chi * (chi - eddy_viscosity));
    }
    return chi;
  }
};

/// The length whose square destroys nu_tilde: the distance to the wall. Others (model_sa_des.hpp) see the grid too. `chi` may be
/// a dual number while the flow is held.
struct WallLength {
  static constexpr std::string_view name = "sa";
  static constexpr bool sees_grid = false;
  template <class Real, class Number>
  static SPINDRIFT_INLINE Number inverse_square(const Flow<Real>& f, const Number&) {
    return Number(1.0 / (f.distance * f.distance));
  }
};

/// negative: nu_tilde may pass below zero at the edge of layers that the grid does not resolve; the source brings it back.
template <bool negative, class Length = WallLength>
struct SpalartAllmaras : SaConstants {
  static constexpr int equations = 1;
  static constexpr std::string_view name = negative ? "sa_neg" : Length::name;
  static constexpr bool sees_grid = Length::sees_grid;
  static constexpr std::array<double, 1> lowest{negative ? -std::numeric_limits<double>::max() : 0.0};

  template <class Real>
  SPINDRIFT_INLINE Closure<Real, 1> closure(const Flow<Real>& f, const Turbulence<Real, 1>& t) const {
    const Real chi = f.rho * t.q[0] / f.mu, cube = chi * chi * chi, positive_cube = max(cube, 0.0);
    const Real eddy = f.mu * max(chi, 0.0) * positive_cube / (positive_cube + cv1 * cv1 * cv1);
    return {eddy, Real(0.0), {(1.0 / sigma) * f.mu * (1.0 + chi * negative_factor(chi))}};
  }

  /// Production less destruction, and the part of the diffusion that is no divergence: cb2 and the density's gradient.
  template <class Real>
  SPINDRIFT_INLINE Source<Real, 1> source(const Flow<Real>& f, const Turbulence<Real, 1>& t) const {
    const Real nu = t.q[0], laminar = f.mu / f.rho, chi = nu / laminar;
    const Vector<Real>& g = t.gradient[0];
    const Real spread = (cb2 / sigma) * f.rho * dot(g, g) -
                        (1.0 / sigma) * laminar * (1.0 + chi * negative_factor(chi)) * dot(g, f.density_gradient);
    return {{f.rho * balance(nu, chi, vorticity(f), Length::inverse_square(f, chi)) + spread}};
  }

  /// The exact slope where it is not positive.
  template <class Real>
  SPINDRIFT_INLINE SourceJacobian<Real, 1> source_jacobian(const Flow<Real>& f, const Turbulence<Real, 1>& t) const {
    using D = Dual<Real, 1>;
    const D nu = D::variable(t.q[0], 0), chi = (f.rho / f.mu) * nu;
    const D rate = balance(nu, chi, D(vorticity(f)), Length::inverse_square(f, chi));
    return {{{min(f.rho * rate.d[0], 0.0)}}};
  }

  /// On a wall, of the distance of the cell's centre and the laminar kinematic viscosity there.
  template <class Real>
  SPINDRIFT_INLINE std::array<Real, 1> wall(const Real&, const Real&) const {
    return {Real(0.0)};
  }
  /// Fully turbulent stream: nu_tilde = `ratio` nu (3 to 5 by Spalart & Rumsey 2007; 3 on the TMR).
  std::array<double, 1> far_field(double kinematic_viscosity, double /*speed*/, double /*sound_speed*/) const {
    return {ratio * kinematic_viscosity};
  }
  double ratio = 3.0;

 private:
  /// fn of the diffusion: 1 for positive chi; keeps mu + rho nu_tilde fn positive for negative ones.
  template <class Real>
  static SPINDRIFT_INLINE Real negative_factor(const Real& chi) {
    if constexpr (negative) {
      const Real low = min(chi, 0.0), cube = low * low * low;
      return (cn1 + cube) / (cn1 - cube);
    } else {
      return Real(1.0);
    }
  }

  /// Production less destruction per density [m2/s2]; `inverse_d2` = 1/d^2, d being the model's length.
  template <class Real>
  static SPINDRIFT_INLINE Real balance(const Real& nu, const Real& chi, const Real& omega, const Real& inverse_d2) {
    const Real fv2 = 1.0 - chi / (1.0 + chi * fv1(chi));
    const Real by_wall = inverse_d2 * (1.0 / (kappa * kappa)), extra = nu * fv2 * by_wall;
    // Eqs. 11-12: stays positive where fv2 is negative.
    const Real modified = select(
        extra < -c2 * omega, omega + omega * (c2 * c2 * omega + c3 * extra) / ((c3 - 2.0 * c2) * omega - extra), omega + extra);
    const Real u = nu * by_wall;
    const Real r = u / max(modified, 0.1 * max(u, 1e-300));  // at most 10
    const Real r2 = r * r, g = r + cw2 * (r2 * r2 * r2 - r), g2 = g * g, g6 = g2 * g2 * g2;
    constexpr double cw3_6 = cw3 * cw3 * cw3 * cw3 * cw3 * cw3;
    const Real fw = g * power(Real((1.0 + cw3_6) / (g6 + cw3_6)), 1.0 / 6.0);
    const Real ft2 = ct3 * exp(-ct4 * chi * chi);
    const Real squared = nu * nu * inverse_d2;
    const Real positive = cb1 * (1.0 - ft2) * modified * nu - (cw1 * fw - (cb1 / (kappa * kappa)) * ft2) * squared;
    if constexpr (!negative) return positive;
    return select(nu < Real(0.0), cb1 * (1.0 - ct3) * omega * nu + cw1 * squared, positive);
  }
};
using Sa = SpalartAllmaras<false>;
using SaNeg = SpalartAllmaras<true>;
static_assert(TurbulenceModel<Sa> && TurbulenceModel<SaNeg>);

}  // namespace spindrift::turbulence
