// Second- and third-order states on both sides of a face from four cells in a row: MUSCL with kappa = 1/3.
// van Leer (1979), J. Comput. Phys. 32, 101; the limited form of Anderson, Thomas & van Leer (1986), AIAA J. 24, 1453, eq. 17;
// van Albada, van Leer & Roberts (1982), Astron. Astrophys. 108, 76; van Leer (1974), J. Comput. Phys. 14, 361; Roe (1986),
// minmod. Called by src/aero/flow; tested in tests/kernels/gas/muscl_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <string_view>

#include "kernels/gas/state.hpp"

namespace spindrift::gas {

/// What to add to a cell's value on its face ahead, of the differences behind and ahead of the cell.
template <class L>
concept Limiter = requires(const L limiter, double difference) {
  { limiter(difference, difference) } -> std::same_as<double>;
  { L::name } -> std::convertible_to<std::string_view>;
};

/// Weights of the differences behind and ahead of a cell in its value on the face ahead.
template <class Real>
struct Weights {
  Real behind, ahead;
};
/// kappa = 1/3 with differences over distances, for cells of these sizes along the row: a straight line is met exactly however
/// sizes change, and equal ones give Unlimited. (The parabola through the three cells' means would be of third order, but where
/// cells shrink by more than 1.7 a cell's own value then drives its rate up, and marches fail.)
template <class Real>
SPINDRIFT_INLINE Weights<Real> weights_by_size(const Real& behind, const Real& cell, const Real& ahead) {
  return {(1.0 / 3.0) * cell / (behind + cell), (2.0 / 3.0) * cell / (cell + ahead)};
}

/// No limiter: kappa = 1/3, third order on a uniform row.
struct Unlimited {
  static constexpr std::string_view name = "none";
  template <class Real>
  SPINDRIFT_INLINE Real operator()(const Real& behind, const Real& ahead) const {
    return (1.0 / 6.0) * behind + (1.0 / 3.0) * ahead;
  }
};
static_assert(Limiter<Unlimited>);

inline constexpr double squared_difference_floor = 1e-300;  ///< any: a limiter's quotient of equal cells is then no 0/0

/// kappa = 1/3 blended to the cell's value by van Albada's ratio, which is 1 + O(h^2) where the solution is smooth and has no
/// extremum.
struct VanAlbada {
  static constexpr std::string_view name = "van_albada";
  template <class Real>
  SPINDRIFT_INLINE Real operator()(const Real& behind, const Real& ahead) const {
    constexpr double floor = squared_difference_floor;
    const Real s = max((2.0 * behind * ahead + floor) / (behind * behind + ahead * ahead + floor), 0.0);
    return 0.25 * s * ((behind + ahead) + (1.0 / 3.0) * s * (ahead - behind));
  }
};
static_assert(Limiter<VanAlbada>);

/// Harmonic mean of the two differences (van Leer 1974).
struct VanLeer {
  static constexpr std::string_view name = "van_leer";
  template <class Real>
  SPINDRIFT_INLINE Real operator()(const Real& behind, const Real& ahead) const {
    // As a weight on the mean of the differences.
    const Real product = max(behind * ahead, 0.0), mean = 0.5 * (behind + ahead);
    constexpr double floor = squared_difference_floor;
    return 0.5 * mean * ((product + floor) / (mean * mean + floor));
  }
};
static_assert(Limiter<VanLeer>);

/// The smaller of the two differences, zero where their signs differ.
struct Minmod {
  static constexpr std::string_view name = "minmod";
  template <class Real>
  SPINDRIFT_INLINE Real operator()(const Real& behind, const Real& ahead) const {
    return 0.5 * (max(min(behind, ahead), 0.0) + min(max(behind, ahead), 0.0));
  }
};
static_assert(Limiter<Minmod>);

/// States on both sides of a face.
template <class Real>
struct FaceStates {
  Primitive<Real> l, r;
};

/// One number, of the cell and its differences behind and ahead.
template <class Limiter, class Real>
SPINDRIFT_INLINE Real reconstruct(const Limiter& limiter, const Real& behind, const Real& cell, const Real& ahead) {
  return cell + limiter(cell - behind, ahead - cell);
}

template <class Limiter, class Real>
SPINDRIFT_INLINE Primitive<Real> reconstruct(const Limiter& limiter, const Primitive<Real>& behind, const Primitive<Real>& cell,
                                             const Primitive<Real>& ahead) {
  return {reconstruct(limiter, behind.p, cell.p, ahead.p), reconstruct(limiter, behind.u, cell.u, ahead.u),
          reconstruct(limiter, behind.v, cell.v, ahead.v), reconstruct(limiter, behind.w, cell.w, ahead.w),
          reconstruct(limiter, behind.T, cell.T, ahead.T)};
}

/// The two reconstructed states, each as a whole its cell's where its absolute pressure or temperature would be less than `least`
/// of the cell's: positive states stay positive.
template <class Real>
SPINDRIFT_INLINE FaceStates<Real> kept_positive(const IdealGas& gas, const Primitive<Real>& left, const Primitive<Real>& l,
                                                const Primitive<Real>& right, const Primitive<Real>& r, double least) {
  const auto bad = [&](const Primitive<Real>& q, const Primitive<Real>& cell) {
    return (absolute_pressure(gas, q) < least * absolute_pressure(gas, cell)) |
           (absolute_temperature(gas, q) < least * absolute_temperature(gas, cell));
  };
  return {select_state(bad(l, left), left, l), select_state(bad(r, right), right, r)};
}

/// Face between `left` and `right`, kept positive.
template <class Limiter, class Real>
SPINDRIFT_INLINE FaceStates<Real> muscl(const IdealGas& gas, const Limiter& limiter, const Primitive<Real>& before_left,
                                        const Primitive<Real>& left, const Primitive<Real>& right,
                                        const Primitive<Real>& after_right, double least = 0.3) {
  const Primitive<Real> l = reconstruct(limiter, before_left, left, right);
  const Primitive<Real> r = reconstruct(limiter, after_right, right, left);
  return kept_positive(gas, left, l, right, r, least);
}

/// The same without limiter, by the sizes of the four cells; the velocity as if they were even where `even_velocity`.
template <bool even_velocity, class Real>
SPINDRIFT_INLINE FaceStates<Real> muscl_by_size(const IdealGas& gas, const std::array<Real, 4>& size,
                                                const Primitive<Real>& before_left, const Primitive<Real>& left,
                                                const Primitive<Real>& right, const Primitive<Real>& after_right,
                                                double least = 0.3) {
  const auto face = [](const Weights<Real>& by_size, const Primitive<Real>& behind, const Primitive<Real>& cell,
                       const Primitive<Real>& ahead) {
    Primitive<Real> state = cell + (by_size.behind * (cell - behind) + by_size.ahead * (ahead - cell));
    if constexpr (even_velocity) {
      state.u = reconstruct(Unlimited{}, behind.u, cell.u, ahead.u);
      state.v = reconstruct(Unlimited{}, behind.v, cell.v, ahead.v);
      state.w = reconstruct(Unlimited{}, behind.w, cell.w, ahead.w);
    }
    return state;
  };
  const Primitive<Real> l = face(weights_by_size(size[0], size[1], size[2]), before_left, left, right);
  const Primitive<Real> r = face(weights_by_size(size[3], size[2], size[1]), after_right, right, left);
  return kept_positive(gas, left, l, right, r, least);
}

}  // namespace spindrift::gas
