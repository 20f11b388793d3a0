// One blade element in balance with the momentum of its annulus: the inflow angle where both say the same.
// Ning (2014), Wind Energy 17, 1327 (one bracketed residual in the inflow angle); Prandtl's tip and hub loss; induction by Madsen
// et al. (2020) or Buhl (2005), NREL/TP-500-36834; across the wind by a skewed cylinder of vortices. Multiplied through so that
// it holds at zero wind and at standstill: theory page, eqs. 5-10. Used by src/aero/bem.cpp; tested in
// tests/kernels/rotor/blade_element_test.cpp. SPDX-License-Identifier: Apache-2.0
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

/// Where the undisturbed wind makes the angle gamma with the axis, the wake is a skewed cylinder of vortices. It takes a V from
/// the wind V along the axis and a V tan(chi/2) in the plane, so that it leans by chi: tan(chi) = (tan(gamma) - a tan(chi/2)) /
/// (1 - a) (Coleman, Feingold & Stempin 1945, NACA ARR L5E10; Burton et al. 2011, section 3.10.6). All air that goes along the
/// wake is slowed, more than what goes straight through the disc.
struct SkewedWake {
  double across, half;                     ///< tan(gamma), tan(gamma/2)
  double growth;                           ///< of the latter to tan(chi/2), for an induction of 1
  explicit SkewedWake(double gamma = 0.0)  ///< [rad]
      : across(std::tan(gamma)), half(std::tan(0.5 * gamma)), growth(0.6 * half * (1.0 - 4.0 / (pi * pi) * gamma * gamma)) {}
  bool level() const { return across == 0.0; }
  /// tan(chi) for 0 <= a < 1: one step from Burton's chi = (1 + 0.6 a) gamma, which is too much where gamma is large.
  double lean(double a) const { return (across - a * std::min(half + growth * a, 1.0)) / (1.0 - a); }
  double tangent_of_half(double a) const {
    const double x = lean(a);
    return x / (1.0 + std::sqrt(1.0 + x * x));
  }
  /// What goes straight through the disc, over the whole: cos(chi).
  double straight_share(double a) const {
    constexpr double most = 1.0 - 1e-12;
    if (level()) return 1.0;
    const double x = lean(std::clamp(a, 0.0, most));
    return 1.0 / std::sqrt(1.0 + x * x);
  }
};

/// How the wake slows the wind: slowdown(k, F, wake) = 1 / (1 - a) for k = sigma c_n / (4 F sin^2 phi), which is
/// C_T / (4 F (1 - a)^2); with k times straight_share where the wind goes across. Momentum theory, a = k / (1 + k), up to a =
/// 0.4; beyond it Buhl (2005), C_T = 8/9 + (4F - 40/9) a + (50/9 - 4F) a^2, solved for a as in Ning (2014), eqs. 18-20.
struct InductionBuhl {
  static constexpr std::string_view name = "buhl";
  double slowdown(double k, double loss, const SkewedWake& wake = SkewedWake()) const {
    if (wake.level() || k <= 0.0) return straight(k, loss);
    const auto over = [&](double s) { return s - straight(k * wake.straight_share(1.0 - 1.0 / s), loss); };
    const double most = straight(k, loss);
    return bracketed_root(over, 1.0, over(1.0), most, over(most), 1e-13 * most).x;
  }

 private:
  static double straight(double k, double loss) {
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
  double slowdown(double k, double /*loss*/, const SkewedWake& wake = SkewedWake()) const {
    if (k <= 0.0) return 1.0 + k;
    const auto induction = [](double c) { return ((0.0883 * c + 0.0586) * c + 0.246) * c; };
    if (!wake.level()) {
      constexpr double standing = 1.7;  // more than that of a = 1
      const auto over = [&](double c) {
        const double a = induction(c), rest = std::max(1.0 - a, 0.0);
        return c / wake.straight_share(a) - 4.0 * k * rest * rest;
      };
      return 1.0 / (1.0 - induction(bracketed_root(over, 0.0, over(0.0), standing, over(standing), 1e-15).x));
    }
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
/// `cross_wind` [m/s]: of the undisturbed wind, in the plane of the rotor.
template <class Induction, class Polar>
ElementState solve_element(const Annulus& s, double normal_wind, double tangential_wind, const Induction& induction,
                           const Polar& polar, double cross_wind = 0.0) {
  const double solidity = s.blades * s.chord / (2.0 * pi * s.radius);
  const double side = normal_wind < 0.0 ? -1.0 : 1.0, vx = side * normal_wind,
               vy = tangential_wind;  // wind from behind: mirrored
  const SkewedWake wake(std::atan2(cross_wind, vx));
  struct Balance {
    double residual, rise, swirl, slowdown;  // rise, swirl: vx and vy over the relative speed
  };
  // Of a rotor that drives the wind the straight part is by what it draws through, about vy tan(phi): in air that stands still
  // nearly all. With little load as of the undisturbed wind.
  const auto driven_share = [&](double k, double phi) {
    if (wake.level()) return 1.0;
    const double through = std::abs(vy * std::sin(phi)), across = std::abs(cross_wind * std::cos(phi));
    const double undisturbed = wake.straight_share(0.0), drawn = through > 0.0 ? through / std::hypot(through, across) : 0.0;
    return undisturbed + (drawn - undisturbed) * std::min(std::abs(k), 1.0);
  };
  const auto balance = [&](double phi) {
    const double sine = std::sin(phi), cosine = std::cos(phi), loss = loss_factor(s, sine);
    const SectionForce f = polar(side * phi - s.setting);
    const double load = solidity / (4.0 * loss * std::abs(sine));  // air is swirled the same way whichever way it passes
    const double k = load / std::abs(sine) * (side * f.lift * cosine + f.drag * sine);
    const bool slowed = phi > 0.0 && k > 0.0;  // else propeller or, below zero, brake and fan
    const double driven = slowed ? 1.0 : driven_share(k, phi);
    const double slowdown = phi < 0.0 ? 1.0 - k * driven : induction.slowdown(k * driven, loss, wake);
    const double share = slowed ? wake.straight_share(1.0 - 1.0 / slowdown) : driven;
    const double rise = sine * slowdown, swirl = cosine - load * share * (side * f.lift * sine - f.drag * cosine);
    return Balance{vy * rise - vx * swirl, rise, swirl, slowdown};
  };
  constexpr double edge = 1e-6, half = 0.5 * pi, inflow_tolerance = 1e-11;
  using Brackets = std::array<std::array<double, 2>, 3>;
  constexpr Brackets forward{{{edge, half}, {half, pi - edge}, {-half, -edge}}};  // windmill, beyond 90 degrees, brake or fan
  constexpr Brackets backward{{{half, pi - edge}, {edge, half}, {-pi + edge, -half}}};
  constexpr double standing = 20.0, farthest = 1e300;  // slowdown of a = 0.95
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
    const double wind = speed * std::sin(root.x), motion = speed * std::cos(root.x);
    // A blade almost at rest has a second balance, with a wake many times the wind: the nearer one is the flow. Air that all but
    // stands is one only where there is no other: a rotor that drives air against a weak wind has both.
    const bool stands = root.x > 0.0 && b.slowdown > standing;
    const double induced = stands ? farthest : std::hypot(wind - vx, motion - vy);
    if (induced < least) {
      least = induced;
      best = element_forces(s, side * wind, motion, polar);
      best.axial_induction = 1.0 - 1.0 / b.slowdown;
      best.tangential_induction = std::cos(root.x) / b.swirl - 1.0;
      best.balanced = true;
    }
    if (!stands && low == edge && high == half && vy >= 0.0) break;  // a windmill's balance is the only one there
  }
  if (best.balanced) return best;
  ElementState undisturbed = element_forces(s, normal_wind, tangential_wind, polar);
  undisturbed.balanced = vx == 0.0 && cross_wind > 0.0;  // nothing goes straight through: this is the balance
  return undisturbed;
}

/// Skewed wake in place: induction grows towards the edge of the disc that lies downwind (Pitt & Peters 1981: 15 pi/64 over the
/// 1/2 of the mean induction, as AeroDyn has it). `across`: r/R times the cosine between the blade and the wind's direction in
/// the disc.
template <class Polar>
ElementState skewed(const Annulus& s, const ElementState& level, double normal_wind, double tangential_wind, double skew,
                    double across, const Polar& polar) {
  const double a = level.axial_induction;
  if (!level.balanced || a <= 0.0 || a >= 1.0) return level;  // the model is for windmills
  const double local = a * (1.0 + 15.0 * pi / 32.0 * SkewedWake(skew).tangent_of_half(a) * across);
  const double tangential =
      level.has_inductions() ? tangential_wind * (1.0 + level.tangential_induction) : level.speed * std::cos(level.inflow);
  ElementState out = element_forces(s, normal_wind * (1.0 - local), tangential, polar);
  out.axial_induction = local, out.tangential_induction = level.tangential_induction, out.balanced = true;
  return out;
}

}  // namespace spindrift
