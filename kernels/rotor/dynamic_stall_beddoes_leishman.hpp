// Dynamic stall after Beddoes & Leishman: the shed wake delays the angle of attack, the boundary layer delays separation, and a
// vortex from the leading edge carries normal force along the chord before it leaves. Leishman & Beddoes (1989), J. Am.
// Helicopter Soc. 34(3), 3, with the constants and the normal force between attached and separated flow of AeroDyn (Damiani &
// Hayman 2019, NREL/TP-5000-66347); equations: docs/theory/rotor_engineering.md. Without that code's changes of the time
// constants within a stall. Used by src/aero/bem.cpp; tested in tests/kernels/rotor/dynamic_stall_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "kernels/base/constants.hpp"
#include "kernels/base/half_turn.hpp"
#include "kernels/rotor/blade_element.hpp"
#include "kernels/rotor/dynamic_inflow_oye.hpp"
#include "kernels/rotor/dynamic_stall_oye.hpp"

namespace spindrift {

struct DynamicStallBeddoesLeishman {
  // In half chords that pass: lags of pressure, of separation and of the vortex's force, and its way along the chord; of the
  // wake.
  static constexpr double pressure_lag = 1.7, separation_lag = 3.0, vortex_lag = 6.0, vortex_way = 11.0;
  static constexpr double turned_round = 20.0 * radians_per_degree;  // in a step
  static constexpr double A1 = 0.3, A2 = 0.7, b1 = 0.14, b2 = 0.53;

  double zero_lift = 0.0;  ///< angle [rad]
  double slope = 0.0;      ///< of the normal force in attached flow [1/rad]; 0: a section without lift, which has no stall
  double drag_0 = 0.0;     ///< at zero lift
  double most = 0.0, least = 0.0;  ///< normal force at which the leading edge separates, both ways
  bool limits =
      false;  ///< what the polar has beyond the straight line and full suction is lost, as AeroDyn has it with given slopes

  /// What a section carries from step to step.
  struct State {
    double attack = 0.0, wake_1 = 0.0, wake_2 = 0.0;  ///< [rad]
    double potential = 0.0, pressure = 0.0;           ///< normal force of attached flow, and lagged
    double still_separation = 1.0, separation = 1.0;  ///< f of the lagged angle, and lagged
    double still_loss = 0.0, loss = 0.0;              ///< of chordwise force, likewise
    double impulse = 0.0;                             ///< normal force of the air that is accelerated
    double source = 0.0, vortex = 0.0;                ///< normal force that feeds the vortex, and of it
    double age = -1.0;                                ///< of the vortex, in half chords; below zero: there is none
  };
  static constexpr std::size_t state_size = sizeof(State) / sizeof(double);

  /// From a polar: the steepest straight line from zero lift that touches its normal force, and its first largest ones.
  static DynamicStallBeddoesLeishman of(std::span<const double> attack, std::span<const double> lift,
                                        std::span<const double> drag) {
    DynamicStallBeddoesLeishman found;
    const DynamicStallOye by_lift = DynamicStallOye::of(attack, lift);
    if (by_lift.slope <= 0.0) return found;
    found.zero_lift = by_lift.zero_lift;
    constexpr double near = 2.0 * radians_per_degree, far = 20.0 * radians_per_degree, farthest = 25.0 * radians_per_degree;
    for (std::size_t i = 0; i + 1 < attack.size(); ++i)
      if (attack[i] <= found.zero_lift && found.zero_lift < attack[i + 1])
        found.drag_0 = drag[i] + (found.zero_lift - attack[i]) / (attack[i + 1] - attack[i]) * (drag[i + 1] - drag[i]);
    for (std::size_t i = 0; i < attack.size(); ++i) {
      const double angle = attack[i] - found.zero_lift;
      const double normal = lift[i] * std::cos(attack[i]) + (drag[i] - found.drag_0) * std::sin(attack[i]);
      if (std::abs(angle) > near && std::abs(angle) < far) found.slope = std::max(found.slope, normal / angle);
      if (std::abs(attack[i]) < farthest) found.most = std::max(found.most, normal), found.least = std::min(found.least, normal);
    }
    return found;
  }

  /// Held still at this angle, where the relative speed has Prandtl and Glauert's factor `beta`.
  template <class Polar>
  SectionForce still(double attack, double beta, const Polar& polar) const {
    if (slope <= 0.0 || !limits) return polar(attack);
    return force(settled(attack, beta, polar), attack, beta, polar);
  }

  template <class Polar>
  State settled(double attack, double beta, const Polar& polar) const {
    State s;
    s.attack = attack;
    s.potential = s.pressure = slope / beta * (attack - zero_lift);
    s.still_separation = s.separation = separation(attack, beta, polar).f;
    s.still_loss = s.loss = loss(attack, beta, polar);
    return s;
  }

  /// After h in the relative speed [m/s], at whose end the angle of attack is this. Wind that turns round a section at rest,
  /// whose speed goes through zero, is no motion of the section in a stream: the state begins anew from the polar.
  template <class Polar>
  State advance(State s, double attack, double beta, double h, double chord, double speed, const Polar& polar) const {
    if (slope <= 0.0) return s;
    const double way = 2.0 * std::max(speed, 1e-3) * h / chord, turned = within_half_turn(attack - s.attack);
    if (std::abs(turned) > turned_round || away(attack) >= 1.0) return settled(attack, beta, polar);
    const double rate = turned / h, steep = slope / beta;
    s.wake_1 = s.wake_1 * std::exp(-b1 * beta * beta * way) + A1 * turned * std::exp(-0.5 * b1 * beta * beta * way);
    s.wake_2 = s.wake_2 * std::exp(-b2 * beta * beta * way) + A2 * turned * std::exp(-0.5 * b2 * beta * beta * way);
    s.attack = attack;
    const double circulatory = steep * (attack - zero_lift - s.wake_1 - s.wake_2);
    s.impulse = 0.5 * pi * chord * rate / std::max(speed, 1e-3);
    s.pressure = lagged(s.pressure, s.potential, circulatory + s.impulse, way, pressure_lag),
    s.potential = circulatory + s.impulse;
    // Separation follows the pressure, as the angle at which attached flow would have it.
    const double angle = s.pressure / steep + zero_lift, f = separation(angle, beta, polar).f, lost = loss(angle, beta, polar);
    s.separation = lagged(s.separation, s.still_separation, f, way, separation_lag), s.still_separation = f;
    s.loss = lagged(s.loss, s.still_loss, lost, way, separation_lag), s.still_loss = lost;
    // The vortex is fed by what separation takes from the normal force while it travels and the angle grows.
    const double kirchhoff = 0.5 + 0.5 * std::sqrt(std::max(s.separation, 0.0)),
                 source = circulatory * (1.0 - kirchhoff * kirchhoff);
    const bool grows = rate * (attack - zero_lift) > 0.0, beyond = s.pressure > most || s.pressure < least;
    if (s.age >= 0.0)
      s.age = (s.age + way > vortex_way && !beyond) ? -1.0 : s.age + way;
    else if (beyond && grows)
      s.age = 0.0;
    s.vortex *= std::exp(-way / vortex_lag);
    if (s.age >= 0.0 && s.age <= vortex_way && grows) s.vortex += (source - s.source) * std::exp(-0.5 * way / vortex_lag);
    if (s.vortex * circulatory < 0.0) s.vortex = 0.0;
    s.source = source;
    return s;
  }

  /// At an angle within the step that follows.
  template <class Polar>
  SectionForce force(const State& s, double attack, double beta, const Polar& polar) const {
    const SectionForce steady = polar(attack);
    const double out = away(attack);
    if (slope <= 0.0 || out >= 1.0) return steady;
    const double effective = attack - s.wake_1 - s.wake_2, circulatory = slope / beta * (effective - zero_lift);
    const Separation now = separation(effective, beta, polar);
    const double normal = now.attached * s.separation + now.separated * (1.0 - s.separation) + s.impulse + s.vortex;
    const double suction = circulatory * std::tan(near_zero_lift(effective));
    // What was lost at a larger angle than now is at most all the suction that there is.
    const double lost = s.loss > suction ? std::min(s.loss, std::max(suction, loss(effective, beta, polar))) : s.loss;
    const double chordwise = suction - lost, sine = std::sin(attack), cosine = std::cos(attack);
    const SectionForce moving{normal * cosine + chordwise * sine, drag_0 + normal * sine - chordwise * cosine};
    return {steady.lift + (1.0 - out) * (moving.lift - steady.lift), steady.drag + (1.0 - out) * (moving.drag - steady.drag)};
  }

 private:
  double away(double attack) const { return DynamicStallOye::away(std::abs(within_half_turn(attack - zero_lift))); }
  /// Full suction is that of small angles: its tangent ends at one radian from zero lift.
  double near_zero_lift(double attack) const { return std::clamp(attack, zero_lift - 1.0, zero_lift + 1.0); }
  static double lagged(double value, double from, double to, double way, double lag) {
    return spindrift::lagged(value, from, to, way, lag);
  }
  struct Separation {
    double f;                    ///< 1 attached
    double attached, separated;  ///< normal force where all is attached and where all is separated
  };
  /// Of the polar: Kirchhoff's flow past a flat plate, cn = slope (alpha - alpha_0) ((1 + sqrt f)/2)^2. Where the polar has more
  /// than the straight line, as thick sections by their drag at large angles, attached flow has it too, unless it `limits`.
  template <class Polar>
  Separation separation(double attack, double beta, const Polar& polar) const {
    const SectionForce steady = polar(attack);
    const double straight = slope / beta * (attack - zero_lift),
                 normal = steady.lift * std::cos(attack) + (steady.drag - drag_0) * std::sin(attack);
    if (std::abs(straight) < 1e-9) return {1.0, straight, 0.0};
    const double root = 2.0 * std::sqrt(std::max(normal / straight, 0.0)) - 1.0,
                 f = root > 0.0 ? std::min(root * root, 1.0) : 0.0;
    if (f > 0.9999) return limits ? Separation{1.0, straight, 0.0} : Separation{1.0, normal, 0.25 * straight};
    return {f, straight, (normal - straight * f) / (1.0 - f)};
  }
  /// What the polar's chordwise force lacks of full suction.
  template <class Polar>
  double loss(double attack, double beta, const Polar& polar) const {
    const double bounded = near_zero_lift(attack);
    const SectionForce steady = polar(bounded);
    const double chordwise = steady.lift * std::sin(bounded) - (steady.drag - drag_0) * std::cos(bounded);
    const double lost = slope / beta * (bounded - zero_lift) * std::tan(bounded) - chordwise;
    return limits ? std::max(lost, 0.0) : lost;
  }
};

}  // namespace spindrift
