// Osher's flux on a moving face: the integral of |A| along waves. Osher & Chakravarthy (1983), J. Comput. Phys. 50, 447, sections
// 3-4: intermediate states and sonic points in closed form, for both orders of the waves between the states. F = sum of physical
// fluxes at l, a, b, r and the sonic points s1, s3, each with a weight -1, 0 or 1 that follows from the signs of the speeds
// (docs/theory/gas.md). Called by src/aero/flow; tested in tests/kernels/gas/flux_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/gas/flux.hpp"

namespace spindrift::gas {

/// physical: waves from left to right are u - c, u, u + c (P variant); inverse: u + c, u, u - c, Osher's own (O variant).
enum class OsherOrder { physical, inverse };

template <OsherOrder order>
struct Osher {
  static constexpr std::string_view name = order == OsherOrder::physical ? "osher_p" : "osher_o";

  template <class Real>
  SPINDRIFT_INLINE Conserved<Real> operator()(const IdealGas& gas, const Primitive<Real>& l, const Primitive<Real>& r,
                                              const Face<Real>& f) const {
    constexpr double sign = order == OsherOrder::physical ? 1.0 : -1.0;
    const double g = 0.5 * (gas.gamma - 1.0), z = (gas.gamma - 1.0) / (2.0 * gas.gamma);
    const Real ul = normal_velocity(l, f) - f.speed, ur = normal_velocity(r, f) - f.speed;
    const Real cl = sound_speed(gas, l), cr = sound_speed(gas, r);

    // Along the first wave u + sign c/g and the entropy hold, along the third u - sign c/g. Written for ca/cl - 1, which is as
    // small as the jump, so that the pressure between two almost equal ones keeps its digits.
    const Real ratio = power_minus_one((l.p - r.p) / absolute_pressure(gas, r), z);  // (pl/pr)^z - 1
    const Real kappa = cr / cl * (1.0 + ratio);
    const Real jump = max((sign * g * (ul - ur) - cr * ratio) / (cl * (1.0 + kappa)), -0.99);  // -1 is vacuum between the waves
    const Real u = ul - (sign / g) * (cl * jump);
    const Real ca = cl * (1.0 + jump), cb = max(cr + sign * g * (u - ur), 0.01 * cr);
    const Real p = l.p + absolute_pressure(gas, l) * power_minus_one(jump, 1.0 / z);

    const Real zero(0.0), one(1.0);
    const auto negative = [&](const Real& speed) { return select(speed < zero, one, zero); };
    const Real first_l = negative(ul - sign * cl), first_a = negative(u - sign * ca), contact = negative(u),
               third_b = negative(u + sign * cb), third_r = negative(ur + sign * cr);

    // Of a and b one has a weight, that on the contact's upwind side (O variant: the other one). Its velocity differs from l's or
    // r's along the normal only; the entropy is the same: temperature goes with c^2.
    const Real at_a = first_a - contact, at_b = contact - third_b;
    const auto left = abs(at_a) > zero;
    const Primitive<Real> side = select_state(left, l, r);
    const Real from = select(left, cl, cr), c = select(left, ca, cb), shift = u - select(left, ul, ur);
    const Primitive<Real> between{p, side.u + shift * f.nx, side.v + shift * f.ny, side.w + shift * f.nz,
                                  side.T + (c - from) * (c + from) * (1.0 / (gas.gamma * gas.gas_constant))};
    Conserved<Real> flux = (at_a + at_b) * physical_flux(gas, between, f);
    const Real at_l = one - first_l, at_r = third_r;
    if (any(value_of(at_l) + value_of(at_r) > value_of(zero)))
      flux = flux + at_l * physical_flux(gas, l, f) + at_r * physical_flux(gas, r, f);
    const Real at_first = first_l - first_a, at_third = third_b - third_r;
    if (any(abs(value_of(at_first)) + abs(value_of(at_third)) > value_of(zero)))
      flux = flux + at_first * physical_flux(gas, sonic(gas, l, ul, cl, sign, f), f) +
             at_third * physical_flux(gas, sonic(gas, r, ur, cr, -sign, f), f);
    return flux;
  }

 private:
  /// The state of q's wave where u = side c.
  template <class Real>
  static SPINDRIFT_INLINE Primitive<Real> sonic(const IdealGas& gas, const Primitive<Real>& q, const Real& un, const Real& c,
                                                double side, const Face<Real>& f) {
    const double g = 0.5 * (gas.gamma - 1.0);
    // Floor: where the weight is zero the formula may leave physical states, and zero times anything finite is zero.
    const Real cs = max((side * g * un + c) * (1.0 / (1.0 + g)), 0.01 * c), jump = cs / c - 1.0, shift = side * cs - un;
    return {q.p + absolute_pressure(gas, q) * power_minus_one(jump, gas.gamma / g), q.u + shift * f.nx, q.v + shift * f.ny,
            q.w + shift * f.nz, q.T + absolute_temperature(gas, q) * (jump * (2.0 + jump))};
  }
};
using OsherP = Osher<OsherOrder::physical>;
using OsherO = Osher<OsherOrder::inverse>;
static_assert(FluxScheme<OsherP> && FluxScheme<OsherO>);

}  // namespace spindrift::gas
