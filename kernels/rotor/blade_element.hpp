// One blade element in balance with the momentum of its annulus: the inflow angle where both say the same.
// Ning (2014), Wind Energy 17, 1327 (one bracketed residual in the inflow angle); Prandtl's tip and hub loss; induction by Madsen
// et al. (2020) or Buhl (2005), NREL/TP-500-36834. Multiplied through so that it holds at zero wind and at standstill: theory
// page, eqs. 5-9. Used by src/aero/bem.cpp; tested in tests/kernels/rotor/blade_element_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "kernels/base/constants.hpp"
#include "kernels/base/root.hpp"

namespace spindrift {

/// Lift and drag coefficient [-].
struct SectionForce {
  double lift = 0.0, drag = 0.0;
};

/// What the momentum balance needs of an element besides its polar.
struct Annulus {
  double radius = 1.0;      ///< distance of the element from the rotor axis [m]
  double hub_radius = 0.0;  ///< of the blade root [m]
  double tip_radius = 2.0;  ///< [m]
  int blades = 3;
  double chord = 0.1;    ///< [m]
  double setting = 0.0;  ///< twist and blade pitch, nose into the wind positive [rad]
};

struct ElementState {
  double inflow = 0.0;                                       ///< phi, between the relative wind and the direction of motion [rad]
  double attack = 0.0;                                       ///< [rad]
  double speed = 0.0;                                        ///< relative to the section, induction included [m/s]
  double normal = 0.0;                                       ///< coefficient of force along the normal wind
  double tangential = 0.0;                                   ///< coefficient of force along the motion
  double axial_induction = 0.0, tangential_induction = 0.0;  ///< a, a'
  bool balanced = false;  ///< false: no inflow angle satisfies the momentum balance and there is no induction

  /// Of a blade that hardly moves, or in air that hardly does, the inductions over that motion are huge or no number: speed and
  /// inflow tell what it meets.
  bool has_inductions() const {
    constexpr double many = 1e6;
    return std::abs(axial_induction) < many && std::abs(tangential_induction) < many;
  }
};

/// Prandtl's factor for tip and hub together, at least 1e-6.
inline double loss_factor(const Annulus& s, double sin_inflow) {
  const double sine = std::max(std::abs(sin_inflow), 1e-9), half = 0.5 * s.blades / (s.radius * sine);
  const auto prandtl = [](double f) { return 2.0 / pi * std::acos(std::exp(-std::max(f, 0.0))); };
  const double hub = s.hub_radius > 0.0 ? prandtl(0.5 * s.blades * (s.radius - s.hub_radius) / (s.hub_radius * sine)) : 1.0;
  return std::max(prandtl(half * (s.tip_radius - s.radius)) * hub, 1e-6);
}

/// How the wake slows the wind: slowdown(k, F) = 1 / (1 - a) for k = sigma c_n / (4 F sin^2 phi), which is C_T / (4 F (1 - a)^2).
/// Momentum theory, a = k / (1 + k), up to a = 0.4; beyond it Buhl (2005), C_T = 8/9 + (4F - 40/9) a + (50/9 - 4F) a^2, solved
/// for a as in Ning (2014), eqs. 18-20.
struct InductionBuhl {
  static constexpr std::string_view name = "buhl";
  double slowdown(double k, double loss) const {
    if (k <= 2.0 / 3.0) return 1.0 + k;
    const double g1 = 2.0 * loss * k - (10.0 / 9.0 - loss), g2 = 2.0 * loss * k - loss * (4.0 / 3.0 - loss);
    const double g3 = 2.0 * loss * k - (25.0 / 9.0 - 2.0 * loss), root = std::sqrt(g2);
    return 1.0 / (1.0 - (std::abs(g3) < 1e-6 ? 1.0 - 0.5 / root : (g1 - root) / g3));
  }
};

/// One polynomial for every loading, fitted to momentum theory and to actuator-disc computations: a = 0.0883 c^3 + 0.0586 c^2 +
/// 0.246 c, c = C_T / F. Madsen et al. (2020), Wind Energ. Sci. 5, 1, the relation of HAWC2. Momentum theory where the rotor
/// drives the wind.
struct InductionMadsen {
  static constexpr std::string_view name = "madsen";
  double slowdown(double k, double /*loss*/) const {
    if (k <= 0.0) return 1.0 + k;
    const auto induction = [](double c) { return ((0.0883 * c + 0.0586) * c + 0.246) * c; };
    const Root loading = increasing_root(
        [&](double c) {
          const double rest = std::max(1.0 - induction(c), 0.0), slope = (3.0 * 0.0883 * c + 2.0 * 0.0586) * c + 0.246;
          return ValueAndSlope{c - 4.0 * k * rest * rest, 1.0 + 8.0 * k * rest * slope};
        },
        k < 1.0 ? 4.0 * k / ((1.0 + k) * (1.0 + k)) : 1.0);
    return 1.0 / (1.0 - induction(loading.x));
  }
};

/// Forces of an element in the wind that it meets, induction included [m/s].
template <class Polar>
ElementState element_forces(const Annulus& s, double normal_wind, double tangential_wind, const Polar& polar) {
  ElementState out;
  out.inflow = std::atan2(normal_wind, tangential_wind);
  out.attack = out.inflow - s.setting;
  out.speed = std::hypot(normal_wind, tangential_wind);
  const SectionForce f = polar(out.attack);
  const double sine = std::sin(out.inflow), cosine = std::cos(out.inflow);
  out.normal = f.lift * cosine + f.drag * sine;
  out.tangential = f.lift * sine - f.drag * cosine;
  return out;
}

/// Solves one element. `normal_wind`, `tangential_wind` [m/s]: the undisturbed wind seen from the moving element, along the
/// section's normal (downwind) and against its motion. `polar(attack)` returns a SectionForce for any angle in (-2 pi, 2 pi).
template <class Induction, class Polar>
ElementState solve_element(const Annulus& s, double normal_wind, double tangential_wind, const Induction& induction,
                           const Polar& polar) {
  const double solidity = s.blades * s.chord / (2.0 * pi * s.radius);
  const double side = normal_wind < 0.0 ? -1.0 : 1.0, vx = side * normal_wind,
               vy = tangential_wind;  // wind from behind: mirrored
  struct Balance {
    double residual, rise, swirl, slowdown;  // rise, swirl: vx and vy over the relative speed
  };
  const auto balance = [&](double phi) {
    const double sine = std::sin(phi), cosine = std::cos(phi), loss = loss_factor(s, sine);
    const SectionForce f = polar(side * phi - s.setting);
    const double load = solidity / (4.0 * loss * std::abs(sine));  // air is swirled the same way whichever way it passes
    const double k = load / std::abs(sine) * (side * f.lift * cosine + f.drag * sine);
    const double slowdown = phi < 0.0 ? 1.0 - k : induction.slowdown(k, loss);  // below zero: propeller brake
    const double rise = sine * slowdown, swirl = cosine - load * (side * f.lift * sine - f.drag * cosine);
    return Balance{vy * rise - vx * swirl, rise, swirl, slowdown};
  };
  constexpr double edge = 1e-6, half = 0.5 * pi, inflow_tolerance = 1e-11;
  using Brackets = std::array<std::array<double, 2>, 3>;
  constexpr Brackets forward{{{edge, half}, {half, pi - edge}, {-half, -edge}}};  // windmill, beyond 90 degrees, brake or fan
  constexpr Brackets backward{{{half, pi - edge}, {edge, half}, {-pi + edge, -half}}};
  ElementState best;
  double least = std::numeric_limits<double>::infinity();  // induced velocity
  for (const auto& [low, high] : vy < 0.0 ? backward : forward) {
    const double at_low = balance(low).residual, at_high = balance(high).residual;
    if ((at_low > 0.0) == (at_high > 0.0)) continue;
    const Root root =
        bracketed_root([&](double phi) { return balance(phi).residual; }, low, at_low, high, at_high, inflow_tolerance);
    const Balance b = balance(root.x);
    const double speed =
        (vx * b.rise + vy * b.swirl) / (b.rise * b.rise + b.swirl * b.swirl);  // two equations for one: least squares
    if (!(speed > 0.0)) continue;                                              // a sign change without a flow
    const double wind = speed * std::sin(root.x), motion = speed * std::cos(root.x), induced = std::hypot(wind - vx, motion - vy);
    // A blade almost at rest has a second balance, with a wake many times the wind: the nearer one is the flow.
    if (induced < least) {
      least = induced;
      best = element_forces(s, side * wind, motion, polar);
      best.axial_induction = 1.0 - 1.0 / b.slowdown;
      best.tangential_induction = std::cos(root.x) / b.swirl - 1.0;
      best.balanced = true;
    }
    if (low == edge && high == half && vy >= 0.0) break;  // a windmill's balance is the only one there
  }
  return best.balanced ? best : element_forces(s, normal_wind, tangential_wind, polar);
}

/// Skewed wake in place: induction grows towards the edge of the disc that lies downwind (Pitt & Peters 1981: 15 pi/64 over the
/// 1/2 of the mean induction, as AeroDyn has it). `across`: r/R times the cosine between the blade and the wind's direction in
/// the disc.
template <class Polar>
ElementState skewed(const Annulus& s, const ElementState& level, double normal_wind, double tangential_wind, double skew,
                    double across, const Polar& polar) {
  const double a = level.axial_induction;
  if (!level.balanced || a <= 0.0 || a >= 1.0) return level;  // the model is for windmills
  const double wake = std::min((0.6 * a + 1.0) * skew, 0.45 * pi);
  const double local = a * (1.0 + 15.0 * pi / 32.0 * std::tan(0.5 * wake) * across);
  const double tangential =
      level.has_inductions() ? tangential_wind * (1.0 + level.tangential_induction) : level.speed * std::cos(level.inflow);
  ElementState out = element_forces(s, normal_wind * (1.0 - local), tangential, polar);
  out.axial_induction = local, out.tangential_induction = level.tangential_induction, out.balanced = true;
  return out;
}

}  // namespace spindrift
