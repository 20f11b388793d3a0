// Tait equation of state with gamma 7: p = B [(rho/rho0)^7 - 1], B = rho0 c0^2 / 7. Monaghan (1994), J. Comput. Phys. 110, eq. 3.
// Written in the deviation d = rho - rho0, because floats then keep seven digits of the pressure and not of the density.
// Called by src/sea/sph (pack, initial state); tested in tests/kernels/sph/eos_tait_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <concepts>

#include "kernels/base/wide.hpp"

namespace spindrift::sph {

struct EosTait {
  double rho0 = 1000.0;  ///< density at zero pressure [kg/m3]
  double c0 = 20.0;      ///< speed of sound at rho0 [m/s]
  static constexpr double gamma = 7.0;

  double stiffness() const { return rho0 * c0 * c0 / gamma; }

  /// Pressure [Pa] of a density deviation [kg/m3]: (1 + e)^7 - 1 expanded, so that no digit cancels for small e.
  template <class Real>
  Real pressure(Real deviation) const {
    const Real e = deviation * Real(1.0 / rho0);
    const Real series = Real(7) + e * (Real(21) + e * (Real(35) + e * (Real(35) + e * (Real(21) + e * (Real(7) + e)))));
    return Real(stiffness()) * (e * series);
  }
  /// Inverse for pressures in [-0.9 B, 10 B] by Newton's method, to round-off for those under B: for lanes.
  template <class Real>
  Real deviation_by_newton(Real pressure) const {
    const Real y = pressure * Real(1.0 / stiffness());
    Real e = y * reciprocal(Real(7) + Real(3) * y);  // of second order; above the root
    for (int turn = 0; turn < 4; ++turn) {
      const Real s = Real(1) + e, s2 = s * s;
      const Real series = Real(7) + e * (Real(21) + e * (Real(35) + e * (Real(35) + e * (Real(21) + e * (Real(7) + e)))));
      e = e - (e * series - y) * reciprocal(Real(7) * (s2 * s2) * s2);
    }
    return Real(rho0) * e;
  }
  /// Inverse: deviation [kg/m3] that gives the pressure [Pa]; below -B there is none.
  double deviation(double pressure) const { return rho0 * std::expm1(std::log1p(pressure / stiffness()) / gamma); }
  /// Deviation at a depth [m] under the surface of water at rest, dp/dz = -rho g of the compressible fluid itself.
  double hydrostatic_deviation(double depth, double gravity) const {
    // With s = rho/rho0 the balance reads c0^2 s^5 ds = g dz: s^6 = 1 + 6 g depth / c0^2.
    return rho0 * std::expm1(std::log1p((gamma - 1.0) * gravity * depth / (c0 * c0)) / (gamma - 1.0));
  }
  /// Mass of a column of water at rest over that of rho0 filling it: the mean of s over the depth.
  double mean_density_ratio(double depth, double gravity) const { return column_mass(depth, gravity) / (rho0 * depth); }
  /// Mass per area [kg/m2] above a depth [m] of water at rest: p/g.
  double column_mass(double depth, double gravity) const { return pressure(hydrostatic_deviation(depth, gravity)) / gravity; }
  /// Depth [m] under which water at rest has that mass per area [kg/m2] above it.
  double depth_of_mass(double mass, double gravity) const {
    const double s = std::log1p(mass * gravity / stiffness()) / gamma;
    return c0 * c0 / ((gamma - 1.0) * gravity) * std::expm1((gamma - 1.0) * s);
  }
  /// Work of compression per mass [J/kg] from rho0 to rho0 + deviation, the integral of p/rho^2 d rho. With s = 1 + e it is
  /// B/rho0 [(s^6 - 1)/6 - e/s], here without the digits that cancel.
  double compression_energy(double deviation) const {
    const double e = deviation / rho0;
    const double series = 3.5 + e * (35.0 / 6.0 + e * (35.0 / 6.0 + e * (3.5 + e * (7.0 / 6.0 + e * (1.0 / 6.0)))));
    return stiffness() / rho0 * (e * e * series) / (1.0 + e);
  }
  double sound_speed(double deviation) const {
    const double s = 1.0 + deviation / rho0;
    return c0 * s * s * s;
  }
};

/// An equation of state p(d) of the density deviation d with its inverse.
template <class E>
concept EquationOfState = requires(const E eos, double d) {
  { eos.pressure(d) } -> std::same_as<double>;
  { eos.deviation(d) } -> std::same_as<double>;
  { eos.sound_speed(d) } -> std::same_as<double>;
};
static_assert(EquationOfState<EosTait>);

}  // namespace spindrift::sph
