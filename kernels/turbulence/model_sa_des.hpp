// Detached eddies after Spalart-Allmaras, by the length of its destruction: DES97 (Spalart, Jou, Strelets & Allmaras 1997,
// Advances in DNS/LES, 137), min(d, C_DES Delta), and DDES (Spalart et al. 2006, Theor. Comput. Fluid Dyn. 20, 181, eqs. 4-7),
// which keeps the distance d inside boundary layers whatever the grid, Delta being the cell's longest side. Called by
// src/aero/flow; tested in tests/kernels/turbulence/model_sa_des_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/turbulence/model_sa.hpp"

namespace spindrift::turbulence {

inline constexpr double c_des = 0.65;

struct Des97Length {
  static constexpr std::string_view name = "des97";
  static constexpr bool sees_grid = true;
  template <class Real, class Number>
  static SPINDRIFT_INLINE Number inverse_square(const Flow<Real>& f, const Number&) {
    const Real length = min(f.distance, c_des * f.longest_side);
    return Number(1.0 / (length * length));
  }
};

struct DdesLength : SaConstants {
  static constexpr std::string_view name = "ddes";
  static constexpr bool sees_grid = true;

  /// r_d (eq. 4): 1 in the logarithmic layer, towards 0 at the edge of a layer. `velocity_gradient` = |grad u|.
  template <class Number>
  static SPINDRIFT_INLINE Number layer(const Number& nu_total, const Number& velocity_gradient, const Number& distance) {
    return nu_total / (max(velocity_gradient, 1e-30) * (kappa * kappa) * distance * distance);
  }
  /// f_d (eq. 5): 0 inside a layer, 1 outside.
  template <class Number>
  static SPINDRIFT_INLINE Number outside(const Number& r) {
    const Number eight = min(8.0 * r, 4.0);  // tanh(64) is 1
    return 1.0 - tanh(eight * eight * eight);
  }
  /// Psi (eq. 7): undoes the damping of small chi, made for walls, where the length is the grid's.
  template <class Number>
  static SPINDRIFT_INLINE Number low_reynolds(const Number& chi) {
    constexpr double fw_star = 0.424;
    const Number damping = fv1(chi), fv2 = 1.0 - chi / (1.0 + chi * damping), ft2 = ct3 * exp(-ct4 * chi * chi);
    const Number up = 1.0 - (cb1 / (cw1 * kappa * kappa * fw_star)) * (ft2 + (1.0 - ft2) * fv2);
    const Number down = damping * max(1.0 - ft2, 1e-10);
    return sqrt(up / max(down, 0.01 * up));  // at most 10
  }
  template <class Real, class Number>
  static SPINDRIFT_INLINE Number length(const Flow<Real>& f, const Number& chi) {
    const auto square = [](const Vector<Real>& a) { return dot(a, a); };
    const Number nu_total = (f.mu / f.rho) * (1.0 + max(chi, 0.0) * fv1(chi));
    const Number f_d = outside(layer(nu_total, Number(sqrt(square(f.u) + square(f.v) + square(f.w))), Number(f.distance)));
    return f.distance - f_d * max(f.distance - (c_des * f.longest_side) * low_reynolds(chi), 0.0);
  }
  template <class Real, class Number>
  static SPINDRIFT_INLINE Number inverse_square(const Flow<Real>& f, const Number& chi) {
    const Number l = length(f, chi);
    return 1.0 / (l * l);
  }
};

using Des97 = SpalartAllmaras<false, Des97Length>;
using Ddes = SpalartAllmaras<false, DdesLength>;
static_assert(TurbulenceModel<Des97> && TurbulenceModel<Ddes>);

}  // namespace spindrift::turbulence
