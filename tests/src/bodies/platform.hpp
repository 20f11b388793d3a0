// The floating turbine of Leble & Barakos (2016) with loads written down by hand: spring lines of its Table 3, exact buoyancy of
// its floats, thrust at the hub. Geometry as derived in inputs/leble_barakos/platform.toml; independent of src/sea and
// src/moorings. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "tests/src/bodies/examples.hpp"

namespace spindrift::bodies::examples {

struct Platform {
  double line_stiffness = 4e8 / 116.73;  ///< [N/m]; EA = 4e8 N over the rest length
  double line_damping = 4e4;
  double thrust = 0.0;
  bool moored = true;
  bool gyroscopic = false;
  double rotor_speed = 8.8 * rad_s_per_rpm;

  static constexpr double centre = 16.548, hub = 119.0;
  static Vector3d around(double radius, int k, double z) {
    return {radius * std::cos(k * 2 * pi / 3), radius * std::sin(k * 2 * pi / 3), z};
  }

  /// Cylinder cut by the water plane through its side: volume from the wetted length of the axis, its centre shifted to the low
  /// side.
  static void add_buoyancy(const Motion& m, Wrench& w) {
    constexpr double radius = 5.625, density = 1025.0, g = 9.81;
    const Vector3d axis = m.attitude * Vector3d::UnitZ();
    const double cosine = axis.z();
    const Vector3d down_slope =
        -(Vector3d::UnitZ() - cosine * axis) / cosine;  // in the disc, |.| = tan of the tilt, to the low side
    for (int k = 0; k < 3; ++k) {
      const Vector3d bottom = m.point(around(46.7, k, -14.0 - centre));
      const double wetted = -bottom.z() / cosine, slope2 = down_slope.squaredNorm();
      const Vector3d at = bottom + (0.5 * wetted + 0.125 * radius * radius * slope2 / wetted) * axis +
                          0.25 * radius * radius / wetted * down_slope;
      w.add_force({0, 0, density * g * pi * radius * radius * wetted}, at);
    }
  }

  System system(Integrator integrator = Integrator::rk4) const {
    Body platform = body("platform", 4223938.0, {2.03e10, 2.03e10, 2.81e9}, {0, 0, centre});
    Body rotor = body("rotor", 227962.0, {1.56e8, 7.84e7, 7.84e7}, {0, 0, hub});
    platform.gyroscopic = rotor.gyroscopic = gyroscopic;
    Joint bearing = joint("bearing", JointType::revolute, 0, 1, {0, 0, hub});
    bearing.rotation = PrescribedMotion{.rate = rotor_speed};
    std::vector<LoadSource> loads{gravity_source(std::array{platform, rotor}, 9.81)};
    loads.push_back({"sea", [](double, std::span<const Motion> m, std::span<Wrench> w) { add_buoyancy(m[0], w[0]); }, {}});
    loads.push_back({"thrust", [f = thrust](double, std::span<const Motion>, std::span<Wrench> w) { w[1].force.x() += f; }, {}});
    if (moored)
      loads.push_back({"moorings",
                       [k = line_stiffness, c = line_damping](double, std::span<const Motion> m, std::span<Wrench> w) {
                         for (int line = 0; line < 3; ++line) {
                           const Vector3d body_point = around(46.7, line, -7.0 - centre), fairlead = m[0].point(body_point);
                           const Vector3d span = around(162.63504, line, -20.6) - fairlead;
                           const double length = span.norm(), rate = -m[0].point_velocity(body_point).dot(span) / length;
                           w[0].add_force((k * (length - 116.73) + c * rate) / length * span, fairlead);
                         }
                       },
                       {}});
    return System({platform, rotor}, {bearing}, std::move(loads), integrator);
  }
};

}  // namespace spindrift::bodies::examples
