// The undisturbed wind: steady, of one direction, its speed by a law of the height above still water. A turbulent box would take
// its place behind the same function. Used by rotor_loads.cpp, bem.cpp and the scenes of the resolved air; tested in
// tests/src/aero/rotor_loads_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "kernels/rotor/wind_profile.hpp"
#include "src/aero/options.hpp"

namespace spindrift::aero {

struct Wind {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< at the profile's reference height [m/s], earth frame
  WindProfile profile = {};
  Eigen::Vector3d at(const Eigen::Vector3d& point) const {
    return profile.uniform() ? velocity : Eigen::Vector3d(profile.share(point.z()) * velocity);
  }
};

inline WindProfile wind_profile(const WindOptions& wind) {
  return {wind.law, wind.reference_height_m.value_or(1.0), wind.least_height_m, wind.shear_exponent, wind.roughness_m};
}

inline Wind wind_of(const WindOptions& wind) {
  return {wind.speed_m_s * Eigen::Vector3d(std::cos(wind.direction), std::sin(wind.direction), 0.0), wind_profile(wind)};
}

}  // namespace spindrift::aero
