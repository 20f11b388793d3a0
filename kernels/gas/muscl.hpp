// Second- and third-order states on both sides of a face from four cells in a row: MUSCL with kappa = 1/3.
// van Leer (1979), J. Comput. Phys. 32, 101; the limited form of Anderson, Thomas & van Leer (1986), AIAA J. 24, 1453, eq. 17;
// van Albada, van Leer & Roberts (1982), Astron. Astrophys. 108, 76; van Leer (1974), J. Comput. Phys. 14, 361; Roe (1986),
// minmod. Called by src/aero/flow; tested in tests/kernels/gas/muscl_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <string_view>

#include "kernels/gas/state.hpp"

namespace spindrift::gas {

/// What to add to a cell's value on its face ahead, of the differences behind and ahead of the cell. Differences whose squares
/// are below `smooth` (the unit of the variable squared) count as smooth and are not limited, so that round-off and gentle
/// extrema do not lose the order.
template <class L>
concept Limiter = requires(const L limiter, double difference, double smooth) {
  { limiter(difference, difference, smooth) } -> std::same_as<double>;
  { L::name } -> std::convertible_to<std::string_view>;
};

/// No limiter: kappa = 1/3, third order on a uniform row.
struct Unlimited {
  static constexpr std::string_view name = "none";
  template <class Real>
  SPINDRIFT_INLINE Real operator()(const Real& behind, const Real& ahead, double) const {
    return (1.0 / 6.0) * behind + (1.0 / 3.0) * ahead;
  }
};
static_assert(Limiter<Unlimited>);

/// kappa = 1/3 blended to the cell's value by van Albada's ratio, which is 1 + O(h^2) where the solution is smooth.
struct VanAlbada {
  static constexpr std::string_view name = "van_albada";
  template <class Real>
  SPINDRIFT_INLINE Real operator()(const Real& behind, const Real& ahead, double smooth) const {
    const Real s = max((2.0 * behind * ahead + floor_of(smooth)) / (behind * behind + ahead * ahead + floor_of(smooth)), 0.0);
    return 0.25 * s * ((behind + ahead) + (1.0 / 3.0) * s * (ahead - behind));
  }
  static double floor_of(double smooth) { return smooth > 1e-300 ? smooth : 1e-300; }  // 0/0 of equal cells
};
static_assert(Limiter<VanAlbada>);

/// Harmonic mean of the two differences (van Leer 1974).
struct VanLeer {
  static constexpr std::string_view name = "van_leer";
  template <class Real>
  SPINDRIFT_INLINE Real operator()(const Real& behind, const Real& ahead, double smooth) const {
    // As a weight on the mean of the differences, 1 where both are small.
    const Real product = max(behind * ahead, 0.0), mean = 0.5 * (behind + ahead);
    const double floor = VanAlbada::floor_of(smooth);
    return 0.5 * mean * ((product + floor) / (mean * mean + floor));
  }
};
static_assert(Limiter<VanLeer>);

/// The smaller of the two differences, zero where their signs differ; ignores `smooth`.
struct Minmod {
  static constexpr std::string_view name = "minmod";
  template <class Real>
  SPINDRIFT_INLINE Real operator()(const Real& behind, const Real& ahead, double) const {
    return 0.5 * (max(min(behind, ahead), 0.0) + min(max(behind, ahead), 0.0));
  }
};
static_assert(Limiter<Minmod>);

/// `smooth` of each variable for cells of relative size h (a cell over the length on which the flow varies): (K h)^3 times the
/// square of the variable's scale, after Venkatakrishnan (1995), J. Comput. Phys. 118, 120. Scales: rho U^2, U, U^2/cp + what the
/// temperature itself varies by.
inline Primitive<double> smoothness(const IdealGas& gas, double rho, double speed, double temperature_scale, double h,
                                    double K = 1.0) {
  const double fraction = (K * h) * (K * h) * (K * h), p = rho * speed * speed, T = speed * speed / gas.cp() + temperature_scale;
  const double u2 = fraction * speed * speed;
  return {fraction * p * p, u2, u2, u2, fraction * T * T};
}

/// States on both sides of a face, and how many of them (0, 1, 2) fell back to their cell's value to stay positive.
template <class Real>
struct FaceStates {
  Primitive<Real> l, r;
  Real fallbacks;
};

/// One number, of the cell and its differences behind and ahead.
template <class Limiter, class Real>
SPINDRIFT_INLINE Real reconstruct(const Limiter& limiter, const Real& behind, const Real& cell, const Real& ahead,
                                  double smooth) {
  return cell + limiter(cell - behind, ahead - cell, smooth);
}

template <class Limiter, class Real>
SPINDRIFT_INLINE Primitive<Real> reconstruct(const Limiter& limiter, const Primitive<Real>& behind, const Primitive<Real>& cell,
                                             const Primitive<Real>& ahead, const Primitive<double>& smooth) {
  return {reconstruct(limiter, behind.p, cell.p, ahead.p, smooth.p), reconstruct(limiter, behind.u, cell.u, ahead.u, smooth.u),
          reconstruct(limiter, behind.v, cell.v, ahead.v, smooth.v), reconstruct(limiter, behind.w, cell.w, ahead.w, smooth.w),
          reconstruct(limiter, behind.T, cell.T, ahead.T, smooth.T)};
}

/// Face between `left` and `right`. A state whose absolute pressure or temperature would lose more than `least` of its cell's
/// falls back to the cell's state as a whole: positive states stay positive.
template <class Limiter, class Real>
SPINDRIFT_INLINE FaceStates<Real> muscl(const IdealGas& gas, const Limiter& limiter, const Primitive<Real>& before_left,
                                        const Primitive<Real>& left, const Primitive<Real>& right,
                                        const Primitive<Real>& after_right, const Primitive<double>& smooth, double least = 0.3) {
  const Primitive<Real> l = reconstruct(limiter, before_left, left, right, smooth);
  const Primitive<Real> r = reconstruct(limiter, after_right, right, left, smooth);
  const auto bad = [&](const Primitive<Real>& q, const Primitive<Real>& cell) {
    return (absolute_pressure(gas, q) < least * absolute_pressure(gas, cell)) |
           (absolute_temperature(gas, q) < least * absolute_temperature(gas, cell));
  };
  const auto bad_l = bad(l, left);
  const auto bad_r = bad(r, right);
  const Real one(1.0), zero(0.0);
  return {select_state(bad_l, left, l), select_state(bad_r, right, r), select(bad_l, one, zero) + select(bad_r, one, zero)};
}

}  // namespace spindrift::gas
