// Generated states, faces and gases for the laws of kernels/gas: random but the same on every machine.
// Used by tests/kernels/gas and tests/kernels/turbulence.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include <cmath>
#include <vector>

#include "kernels/base/random.hpp"
#include "kernels/gas/state.hpp"

namespace spindrift::gas::testing {

struct Generator {
  Random random{20260101};
  double between(double low, double high) { return low + (high - low) * random.uniform(); }
  Eigen::Vector3d direction() {
    Eigen::Vector3d v;
    do v = Eigen::Vector3d(between(-1, 1), between(-1, 1), between(-1, 1));
    while (v.norm() > 1.0 || v.norm() < 0.1);
    return v.normalized();
  }
  /// Absolute pressure 1e3 ... 1e6 Pa, temperature 150 ... 600 K, speed up to `mach`.
  Primitive<double> state(const IdealGas& gas, double mach = 2.5) {
    const double p = std::pow(10.0, between(3.0, 6.0)), T = between(150.0, 600.0);
    const Eigen::Vector3d v = between(0.0, mach) * std::sqrt(gas.gamma * gas.gas_constant * T) * direction();
    return {p - gas.pressure_reference, v.x(), v.y(), v.z(), T - gas.temperature_reference};
  }
  /// Within a fraction of another state (of its sound speed for the velocity).
  Primitive<double> near(const IdealGas& gas, const Primitive<double>& q, double fraction) {
    const Eigen::Vector3d v = fraction * sound_speed(gas, q) * direction();
    return {q.p + fraction * between(-1, 1) * absolute_pressure(gas, q), q.u + v.x(), q.v + v.y(), q.w + v.z(),
            q.T + fraction * between(-1, 1) * absolute_temperature(gas, q)};
  }
  Face<double> face() {
    const Eigen::Vector3d n = direction();
    return {n.x(), n.y(), n.z(), between(0.1, 3.0), between(-200.0, 200.0)};
  }
};

/// Air measured from absolute zero, and from a reference state.
inline IdealGas absolute_air() { return {}; }
inline IdealGas gauge_air() {
  IdealGas gas;
  gas.pressure_reference = 101325.0;
  gas.temperature_reference = 288.15;
  return gas;
}

inline Face<double> reversed(const Face<double>& f) { return {-f.nx, -f.ny, -f.nz, f.area, -f.speed}; }

/// Sizes that the components of a flux may be compared with: those of waves at the face.
inline Conserved<double> flux_scale(const IdealGas& gas, const Primitive<double>& l, const Primitive<double>& r,
                                    const Face<double>& f) {
  double mass = 0, momentum = 0, energy = 0;
  for (const auto& q : {l, r}) {
    const double c = sound_speed(gas, q), v = c + std::sqrt(2 * kinetic(q)) + std::abs(f.speed), rho = density(gas, q);
    mass = std::max(mass, f.area * rho * v);
    momentum = std::max(momentum, f.area * rho * v * v);
    energy = std::max(energy, f.area * rho * v * (v * v + gas.enthalpy_reference() + std::abs(q.T) * gas.cp()));
  }
  return {mass, momentum, momentum, momentum, energy};
}

/// Largest difference of two fluxes relative to `scale`.
inline double difference(const Conserved<double>& a, const Conserved<double>& b, const Conserved<double>& scale) {
  return std::max({std::abs(a.rho - b.rho) / scale.rho, std::abs(a.mx - b.mx) / scale.mx, std::abs(a.my - b.my) / scale.my,
                   std::abs(a.mz - b.mz) / scale.mz, std::abs(a.E - b.E) / scale.E});
}

inline Primitive<double> rotated(const Primitive<double>& q, const Eigen::Matrix3d& R) {
  const Eigen::Vector3d v = R * Eigen::Vector3d(q.u, q.v, q.w);
  return {q.p, v.x(), v.y(), v.z(), q.T};
}
inline Conserved<double> rotated(const Conserved<double>& c, const Eigen::Matrix3d& R) {
  const Eigen::Vector3d m = R * Eigen::Vector3d(c.mx, c.my, c.mz);
  return {c.rho, m.x(), m.y(), m.z(), c.E};
}
inline Face<double> rotated(const Face<double>& f, const Eigen::Matrix3d& R) {
  const Eigen::Vector3d n = R * Eigen::Vector3d(f.nx, f.ny, f.nz);
  return {n.x(), n.y(), n.z(), f.area, f.speed};
}
inline Eigen::Matrix3d random_rotation(Generator& g) {
  return Eigen::AngleAxisd(g.between(0, 6.28), g.direction()).toRotationMatrix();
}

}  // namespace spindrift::gas::testing
