// k-omega: Wilcox (1988), AIAA J. 26, 1299, and Wilcox (2006), Turbulence Modeling for CFD, 3rd ed. (also AIAA J. 46, 2823,
// 2008), with cross diffusion, a stress limiter and the round-jet term; as on NASA's Turbulence Modeling Resource. Transported: k
// [m2/s2], omega [1/s]. Called by src/aero/flow; tested in tests/kernels/turbulence/model_k_omega_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/turbulence/model.hpp"

namespace spindrift::turbulence {

struct KOmegaOptions {
  std::string_view name;
  double gamma, beta, sigma_k, sigma_w;
  double cross = 0.0;       ///< sigma_d, of grad k . grad omega where that is positive
  double stress = 0.0;      ///< C_lim: the eddy viscosity's omega is at least this times sqrt(2 S:S / beta*)
  bool stretching = false;  ///< beta falls where vortices are stretched (f_beta)
};
inline constexpr KOmegaOptions wilcox_1988{
    .name = "k_omega_1988", .gamma = 5.0 / 9.0, .beta = 0.075, .sigma_k = 0.5, .sigma_w = 0.5};
inline constexpr KOmegaOptions wilcox_2006{.name = "k_omega",
                                           .gamma = 13.0 / 25.0,
                                           .beta = 0.0708,
                                           .sigma_k = 0.6,
                                           .sigma_w = 0.5,
                                           .cross = 0.125,
                                           .stress = 0.875,
                                           .stretching = true};

template <const KOmegaOptions& options>
struct WilcoxKOmega {
  static constexpr int equations = 2;
  static constexpr std::string_view name = options.name;
  static constexpr bool sees_grid = false;
  static constexpr std::array<double, 2> lowest{0.0, 0.0};
  static constexpr double beta_star = 0.09, wall_beta = options.beta;

  /// 2/3 rho k is part of the stress. What diffuses k and omega is rho k / omega, not the limited eddy viscosity.
  template <class Real>
  SPINDRIFT_INLINE Closure<Real, 2> closure(const Flow<Real>& f, const Turbulence<Real, 2>& t) const {
    const Real k = max(t.q[0], 0.0), spread = f.rho * k / t.q[1];
    return {f.rho * k / limited(t.q[1], rate_squared(f)),
            (2.0 / 3.0) * f.rho * t.q[0],
            {f.mu + options.sigma_k * spread, f.mu + options.sigma_w * spread}};
  }

  template <class Real>
  SPINDRIFT_INLINE Source<Real, 2> source(const Flow<Real>& f, const Turbulence<Real, 2>& t) const {
    const Real k = t.q[0], omega = t.q[1], rate2 = rate_squared(f), dilatation = (2.0 / 3.0) * (f.u.x + f.v.y + f.w.z);
    // Production over rho k, so that nothing is divided by k.
    const Real production = rate2 / limited(omega, rate2) - dilatation;
    return {{f.rho * k * (production - beta_star * omega),
             f.rho * omega * (options.gamma * production - beta(f, omega) * omega) + max(cross(f, t), 0.0)}};
  }

  /// Destruction only: production and cross diffusion are explicit.
  template <class Real>
  SPINDRIFT_INLINE SourceJacobian<Real, 2> source_jacobian(const Flow<Real>& f, const Turbulence<Real, 2>& t) const {
    const Real zero(0.0), omega = t.q[1];
    return {{{-beta_star * f.rho * omega, zero}, {zero, -2.0 * f.rho * beta(f, omega) * omega - max(cross(f, t), 0.0) / omega}}};
  }

  /// Menter (1994), eq. A12: omega = 10 x 6 nu / (beta d^2) with the distance d of the first centre; k = 0.
  template <class Real>
  SPINDRIFT_INLINE std::array<Real, 2> wall(const Real& distance, const Real& kinematic_viscosity) const {
    return {Real(0.0), 60.0 / options.beta * kinematic_viscosity / (distance * distance)};
  }
  /// As SST's on the TMR: k = 9e-9 c^2, omega = 1e-6 c^2 / nu. Wilcox (1988) is known to depend on them (Menter 1992).
  std::array<double, 2> far_field(double kinematic_viscosity, double /*speed*/, double sound_speed) const {
    return {9e-9 * sound_speed * sound_speed, 1e-6 * sound_speed * sound_speed / kinematic_viscosity};
  }

 private:
  /// 2 S:S of the part of the strain that keeps volumes.
  template <class Real>
  static SPINDRIFT_INLINE Real rate_squared(const Flow<Real>& f) {
    const Real rate = strain(f), div = f.u.x + f.v.y + f.w.z;
    return max(rate * rate - (2.0 / 3.0) * div * div, 0.0);
  }
  template <class Real>
  static SPINDRIFT_INLINE Real limited(const Real& omega, const Real& rate2) {
    if constexpr (options.stress > 0.0) return max(omega, options.stress * sqrt(rate2 * (1.0 / beta_star) + 1e-60));
    return omega;
  }
  template <class Real>
  static SPINDRIFT_INLINE Real cross(const Flow<Real>& f, const Turbulence<Real, 2>& t) {
    if constexpr (options.cross == 0.0) return Real(0.0);
    return options.cross * f.rho * dot(t.gradient[0], t.gradient[1]) / t.q[1];
  }
  /// beta0 f_beta; |Omega_ij Omega_jk S_ki| is a quarter of w . S w, w being the vorticity (dilatation drops out).
  template <class Real>
  static SPINDRIFT_INLINE Real beta(const Flow<Real>& f, const Real& omega) {
    if constexpr (!options.stretching) return Real(options.beta);
    const Real x = f.w.y - f.v.z, y = f.u.z - f.w.x, z = f.v.x - f.u.y;
    const Real stretch = x * (x * f.u.x + y * f.u.y + z * f.u.z) + y * (x * f.v.x + y * f.v.y + z * f.v.z) +
                         z * (x * f.w.x + y * f.w.y + z * f.w.z);
    const Real slow = beta_star * omega, chi = 0.25 * abs(stretch) / (slow * slow * slow);
    return options.beta * (1.0 + 85.0 * chi) / (1.0 + 100.0 * chi);
  }
};
using KOmega1988 = WilcoxKOmega<wilcox_1988>;
using KOmega = WilcoxKOmega<wilcox_2006>;
static_assert(TurbulenceModel<KOmega1988> && TurbulenceModel<KOmega>);

}  // namespace spindrift::turbulence
