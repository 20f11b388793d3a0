// The undisturbed wind. Uniform and steady so far: a profile or a turbulent box takes its place behind the same function.
// Used by rotor_loads.cpp; tested in tests/src/aero/rotor_loads_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "src/aero/options.hpp"

namespace spindrift::aero {

/// Wind velocity [m/s], earth frame.
inline Eigen::Vector3d wind_velocity(const WindOptions& wind) {
  return wind.speed_m_s * Eigen::Vector3d(std::cos(wind.direction), std::sin(wind.direction), 0.0);
}

}  // namespace spindrift::aero
