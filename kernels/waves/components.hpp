// A sea as a sum of harmonics, and its kinematics at a point: elevation, velocity, acceleration, dynamic pressure.
// Each harmonic, with psi = k (x cos b + y sin b) - omega t + phase and z up from still water, is
//   eta = a cos psi,  horizontal u = U C(z) cos psi,  vertical w = U S(z) sin psi,  p = rho (omega/k) U C(z) cos psi,
//   C = cosh k(z+h) / sinh kh,  S = sinh k(z+h) / sinh kh
// (Airy: U = a omega; docs/theory/waves.md, sections 1 and 2). A second-order Stokes wave is two such harmonics (stokes.hpp), a
// sea state some hundred (spectra.hpp). Sums run over fixed groups of eight lanes, so their order does not depend on the
// processor. Called by src/sea/wave_field; tested in tests/kernels/waves. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>
#include <vector>

#include "kernels/base/lane_math.hpp"

namespace spindrift::waves {

/// One harmonic of the sea.
struct Component {
  double wave_number = 0.0;        ///< k [rad/m]
  double angular_frequency = 0.0;  ///< omega [rad/s]
  double amplitude = 0.0;          ///< a, of the elevation [m]
  double speed_amplitude = 0.0;    ///< U, of the horizontal velocity is U C(z) [m/s]
  double phase = 0.0;              ///< [rad]
  double direction = 0.0;          ///< b, towards which it travels, from the x axis [rad]
};

/// Eight harmonics side by side; unused lanes have amplitude zero.
struct ComponentGroup {
  Lanes kx{}, ky{}, k{}, omega{}, phase{}, amplitude{}, speed{}, cos_b{}, sin_b{};
  Lanes bottom{};       ///< exp(-2 k h), 0 in deep water
  Lanes phase_speed{};  ///< omega / k
};

inline void set_lane(ComponentGroup& g, int lane, const Component& c, double depth) {
  g.k.v[lane] = c.wave_number, g.omega.v[lane] = c.angular_frequency, g.phase.v[lane] = c.phase;
  g.cos_b.v[lane] = std::cos(c.direction), g.sin_b.v[lane] = std::sin(c.direction);
  g.kx.v[lane] = c.wave_number * std::cos(c.direction), g.ky.v[lane] = c.wave_number * std::sin(c.direction);
  g.amplitude.v[lane] = c.amplitude;
  const double bottom = std::exp(-2.0 * c.wave_number * depth);
  g.bottom.v[lane] = bottom;
  g.phase_speed.v[lane] = c.angular_frequency / c.wave_number;
  g.speed.v[lane] = c.speed_amplitude / (1.0 - bottom);  // C = (e^kz + e^-2kh e^-kz) / (1 - e^-2kh): no overflow
}

/// In water of this depth [m].
inline std::vector<ComponentGroup> grouped(std::span<const Component> components, double depth) {
  std::vector<ComponentGroup> groups((components.size() + lanes - 1) / lanes);
  for (std::size_t i = 0; i < components.size(); ++i) set_lane(groups[i / lanes], int(i % lanes), components[i], depth);
  return groups;
}

struct Surface {
  double elevation = 0.0, slope_x = 0.0, slope_y = 0.0;  ///< [m], [-], [-]
};
struct Kinematics {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< [m/s]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< local, d/dt at a fixed point [m/s2]
  double pressure_over_density = 0.0;                      ///< linear dynamic pressure / rho [m2/s2]
};

inline Surface surface(std::span<const ComponentGroup> sea, double t, double x, double y) {
  Lanes eta{}, sx{}, sy{};
  for (const ComponentGroup& g : sea) {
    Lanes sine, cosine;
    lane_sincos(g.kx * x + g.ky * y - g.omega * t + g.phase, sine, cosine);
    eta += g.amplitude * cosine;
    sx -= g.amplitude * g.kx * sine;
    sy -= g.amplitude * g.ky * sine;
  }
  return {sum(eta), sum(sx), sum(sy)};
}

/// The profiles of the horizontal and the vertical velocity over the depth.
struct Profiles {
  Lanes horizontal, vertical;
};
template <class ProfilesOf>
Kinematics kinematics_of(std::span<const ComponentGroup> sea, double t, double x, double y, const ProfilesOf& profiles_of) {
  Lanes vx{}, vy{}, vz{}, ax{}, ay{}, az{}, pressure{};
  for (const ComponentGroup& g : sea) {
    Lanes sine, cosine;
    lane_sincos(g.kx * x + g.ky * y - g.omega * t + g.phase, sine, cosine);
    const Profiles profiles = profiles_of(g);
    const Lanes horizontal = g.speed * profiles.horizontal, vertical = g.speed * profiles.vertical;
    const Lanes u = horizontal * cosine, du = g.omega * horizontal * sine;
    vx += u * g.cos_b, vy += u * g.sin_b, vz += vertical * sine;
    ax += du * g.cos_b, ay += du * g.sin_b, az -= g.omega * vertical * cosine;
    pressure += g.phase_speed * u;
  }
  return {{sum(vx), sum(vy), sum(vz)}, {sum(ax), sum(ay), sum(az)}, sum(pressure)};
}

/// At the height z [m] where the profiles C and S are evaluated: the caller has applied its stretching rule.
inline Kinematics kinematics(std::span<const ComponentGroup> sea, double t, double x, double y, double z) {
  return kinematics_of(sea, t, x, y, [z](const ComponentGroup& g) -> Profiles {
    const Lanes up = exp(Lanes(g.k * z)), down = g.bottom / up;
    return {up + down, up - down};
  });
}

/// Above still water, z > 0, by the straight line that continues the profiles.
inline Kinematics kinematics_above(std::span<const ComponentGroup> sea, double t, double x, double y, double z) {
  return kinematics_of(sea, t, x, y, [z](const ComponentGroup& g) -> Profiles {
    const Lanes even = 1.0 + g.bottom, odd = 1.0 - g.bottom, kz = g.k * z;
    return {even + kz * odd, odd + kz * even};
  });
}

}  // namespace spindrift::waves
