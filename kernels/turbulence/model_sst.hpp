// k-omega SST: Menter (1994), AIAA J. 32, 1598 (SST), Menter, Kuntz & Langtry (2003), Turbulence, Heat and Mass Transfer 4, 625
// (SST-2003), and their variants on NASA's Turbulence Modeling Resource (TMR): production by vorticity (-V; Menter 1992, NASA TM
// 103975), without 2/3 rho k in the momentum (-m). The TMR's flat-plate figures belong to SST-Vm. Transported: k [m2/s2], omega
// [1/s]. Called by src/aero/flow; tested in tests/kernels/turbulence/model_sst_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/turbulence/model.hpp"

namespace spindrift::turbulence {

struct SstOptions {
  std::string_view name;
  bool made_by_vorticity = false;    ///< production mu_t Omega^2; else by strain
  bool limited_by_vorticity = true;  ///< rate in the limiter of the shear stress; else the strain
  bool carries_pressure = true;      ///< 2/3 rho k in momentum and in production where the flow is compressed
  double limiter = 20.0;             ///< production of k at most this times its destruction
  bool limits_omega = false;         ///< so is the production of k in omega's equation
  double gamma1 = 0.0, gamma2 = 0.0;
  double least_cross = 1e-20;  ///< floor of the cross diffusion in F1 [kg/(m3 s2)]
};
inline constexpr double sst_beta_star = 0.09, sst_kappa = 0.41;
/// gamma_i = beta_i / beta* - sigma_i kappa^2 / sqrt(beta*): the log layer is an exact solution.
inline constexpr double sst_gamma1 = 0.075 / sst_beta_star - 0.5 * sst_kappa * sst_kappa / 0.3,
                        sst_gamma2 = 0.0828 / sst_beta_star - 0.856 * sst_kappa * sst_kappa / 0.3;
inline constexpr SstOptions sst_1994{.name = "sst_1994", .gamma1 = sst_gamma1, .gamma2 = sst_gamma2};
inline constexpr SstOptions sst_v{.name = "sst_v", .made_by_vorticity = true, .gamma1 = sst_gamma1, .gamma2 = sst_gamma2};
inline constexpr SstOptions sst_vm{
    .name = "sst_vm", .made_by_vorticity = true, .carries_pressure = false, .gamma1 = sst_gamma1, .gamma2 = sst_gamma2};
inline constexpr SstOptions sst_2003{.name = "sst",
                                     .limited_by_vorticity = false,
                                     .limiter = 10.0,
                                     .limits_omega = true,
                                     .gamma1 = 5.0 / 9.0,
                                     .gamma2 = 0.44,
                                     .least_cross = 1e-10};
inline constexpr SstOptions sst_2003_vm = [] {
  SstOptions o = sst_2003;
  o.name = "sst_2003_vm", o.made_by_vorticity = true, o.carries_pressure = false;
  return o;
}();

template <const SstOptions& options>
struct MenterSst {
  static constexpr int equations = 2;
  static constexpr std::string_view name = options.name;
  static constexpr bool sees_grid = false;
  static constexpr std::array<double, 2> lowest{0.0, 0.0};
  static constexpr double beta_star = sst_beta_star, wall_beta = 0.075, a1 = 0.31, sigma_k1 = 0.85, sigma_k2 = 1.0,
                          sigma_w1 = 0.5, sigma_w2 = 0.856, beta1 = 0.075, beta2 = 0.0828;

  template <class Real>
  SPINDRIFT_INLINE Closure<Real, 2> closure(const Flow<Real>& f, const Turbulence<Real, 2>& t) const {
    const Blend<Real> b = blend(f, t);
    const Real eddy = f.rho * b.nu_t;
    return {eddy,
            options.carries_pressure ? (2.0 / 3.0) * f.rho * t.q[0] : Real(0.0),
            {f.mu + mix(b.f1, sigma_k1, sigma_k2) * eddy, f.mu + mix(b.f1, sigma_w1, sigma_w2) * eddy}};
  }

  template <class Real>
  SPINDRIFT_INLINE Source<Real, 2> source(const Flow<Real>& f, const Turbulence<Real, 2>& t) const {
    const Blend<Real> b = blend(f, t);
    const Real k = t.q[0], omega = t.q[1], destruction = beta_star * f.rho * k * omega;
    // Production of k over nu_t, of which omega's is gamma times: nothing is divided by k.
    const Real rate = options.made_by_vorticity ? vorticity(f) : strain(f), div = f.u.x + f.v.y + f.w.z;
    Real rate2 = rate * rate, dilatation(0.0);
    if constexpr (!options.made_by_vorticity) rate2 -= (2.0 / 3.0) * div * div;
    if constexpr (options.carries_pressure) dilatation = (2.0 / 3.0) * f.rho * div;
    const Real production = min(f.rho * b.nu_t * rate2 - dilatation * k, options.limiter * destruction);
    Real over_nu_t = f.rho * rate2 - dilatation * b.k_over_nu_t;
    if constexpr (options.limits_omega) over_nu_t = min(over_nu_t, options.limiter * beta_star * f.rho * omega * b.k_over_nu_t);
    return {{production - destruction, mix(b.f1, options.gamma1, options.gamma2) * over_nu_t -
                                           mix(b.f1, beta1, beta2) * f.rho * omega * omega + (1.0 - b.f1) * b.cross}};
  }

  /// Destruction only: production and cross diffusion are explicit.
  template <class Real>
  SPINDRIFT_INLINE SourceJacobian<Real, 2> source_jacobian(const Flow<Real>& f, const Turbulence<Real, 2>& t) const {
    const Blend<Real> b = blend(f, t);
    const Real zero(0.0), by_cross = (1.0 - b.f1) * max(b.cross, 0.0) / t.q[1];
    return {{{-beta_star * f.rho * t.q[1], zero}, {zero, -2.0 * mix(b.f1, beta1, beta2) * f.rho * t.q[1] - by_cross}}};
  }

  /// Menter (1994), eq. A12: omega = 10 x 6 nu / (beta1 d^2) with the distance d of the first centre; k = 0.
  template <class Real>
  SPINDRIFT_INLINE std::array<Real, 2> wall(const Real& distance, const Real& kinematic_viscosity) const {
    return {Real(0.0), 60.0 / beta1 * kinematic_viscosity / (distance * distance)};
  }
  /// As CFL3D's on the TMR: k = 9e-9 c^2, omega = 1e-6 c^2 / nu, so nu_t = 0.009 nu.
  std::array<double, 2> far_field(double kinematic_viscosity, double /*speed*/, double sound_speed) const {
    return {9e-9 * sound_speed * sound_speed, 1e-6 * sound_speed * sound_speed / kinematic_viscosity};
  }

 private:
  template <class Real>
  struct Blend {
    Real f1, nu_t, k_over_nu_t, cross;
  };
  template <class Real>
  static SPINDRIFT_INLINE Real mix(const Real& f1, double inner, double outer) {
    return outer + f1 * (inner - outer);
  }
  /// The blending function F1, eddy viscosity (limited by F2), cross diffusion.
  template <class Real>
  static SPINDRIFT_INLINE Blend<Real> blend(const Flow<Real>& f, const Turbulence<Real, 2>& t) {
    const Real k = max(t.q[0], 0.0), omega = t.q[1], inverse = 1.0 / (omega * f.distance), inverse_d = 1.0 / f.distance;
    const Real large = sqrt(k + 1e-60) * inverse * (1.0 / beta_star), viscous = 500.0 * (f.mu / f.rho) * inverse * inverse_d;
    const Real cross = 2.0 * sigma_w2 * f.rho * dot(t.gradient[0], t.gradient[1]) / omega;
    const Real argument =
        min(max(large, viscous), 4.0 * sigma_w2 * f.rho * k * inverse_d * inverse_d / max(cross, options.least_cross));
    const Real a = argument * argument, argument2 = max(2.0 * large, viscous);
    // tanh is 1 to round-off from 20 on, and the fourth power of what stands above would overflow.
    const Real f1 = tanh(min(a, 100.0) * min(a, 100.0)), f2 = tanh(min(argument2, 10.0) * min(argument2, 10.0));
    const Real rate = options.limited_by_vorticity ? vorticity(f) : strain(f);
    const Real limited = max(a1 * omega, rate * f2);
    return {f1, a1 * k / limited, limited * (1.0 / a1), cross};
  }
};
using Sst = MenterSst<sst_2003>;
using Sst2003Vm = MenterSst<sst_2003_vm>;
using Sst1994 = MenterSst<sst_1994>;
using SstV = MenterSst<sst_v>;
using SstVm = MenterSst<sst_vm>;
static_assert(TurbulenceModel<Sst> && TurbulenceModel<Sst2003Vm> && TurbulenceModel<Sst1994> && TurbulenceModel<SstV> &&
              TurbulenceModel<SstVm>);

}  // namespace spindrift::turbulence
