// Physical constants with their sources; SI units.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace spindrift {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double standard_gravity = 9.80665;  // m/s2, CGPM 1901
inline constexpr double radians_per_degree = pi / 180.0;
inline constexpr double rad_s_per_rpm = pi / 30.0;

}  // namespace spindrift
