// The undisturbed wind: its speed by a law of the height above still water, its changes in time, its turbulence.
// Made from [wind]; used by rotor_loads.cpp, bem.cpp and, for resolved air, changing_wind.cpp; tested in
// tests/src/aero/wind_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <string>

#include "kernels/rotor/wind_profile.hpp"
#include "src/aero/wind_options.hpp"

namespace spindrift::aero {

/// What makes the wind change: a table, an event, a box of turbulence.
class WindInTime;

struct Wind {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< at the profile's reference height, at the start [m/s], earth frame
  WindProfile profile = {};
  std::shared_ptr<const WindInTime> in_time = {};  ///< null: steady

  bool steady() const { return !in_time; }
  Eigen::Vector3d at(double t, const Eigen::Vector3d& point) const {
    if (in_time) return changing(t, point);
    return profile.uniform() ? velocity : Eigen::Vector3d(profile.share(point.z()) * velocity);
  }

  /// at() in two parts, of a wind that changes in time: what is the same along the wind, of turbulence the mean of each plane of
  /// the box, and the rest, none where !turbulent(). The rest fades out beside the box, extreme shear beside the rotor.
  Eigen::Vector3d common(double t, const Eigen::Vector3d& point) const;
  Eigen::Vector3d fluctuation(double t, const Eigen::Vector3d& point) const;
  bool turbulent() const;
  /// Speed by which turbulence is carried [m/s], the way that the wind blows at the start.
  double carrier() const;
  /// In words, where the standard deviation that a box made here has along the wind is 2 % off what was asked for; else empty.
  std::string spread() const;

 private:
  Eigen::Vector3d changing(double t, const Eigen::Vector3d& point) const;
};

/// Unit vector; angles as of WindOptions.
inline Eigen::Vector3d blowing(double direction, double incidence) {
  return {std::cos(incidence) * std::cos(direction), std::cos(incidence) * std::sin(direction), std::sin(incidence)};
}

inline WindProfile wind_profile(const WindOptions& wind) {
  return {wind.law, wind.reference_height_m.value_or(1.0), wind.least_height_m, wind.shear_exponent, wind.roughness_m};
}

/// Where the rotor is and how large: what gusts and boxes are made for.
struct WindSite {
  Eigen::Vector3d hub = Eigen::Vector3d::Zero();  ///< at the start; of several the middle [m]
  double diameter = 0.0;                          ///< of several the largest [m]
  double across = 0.0, up = 0.0;                  ///< of several, from hub to hub at most, across the wind and upwards [m]
  double upwind = 0.0;                            ///< from there, the farthest hub or plane that wind is asked for at [m]
  double t_end = 0.0;                             ///< of the run [s]
};

/// Throws scene::SceneError where a file cannot be read, or a box does not cover the rotor or the run.
Wind wind_of(const WindOptions& wind, const WindSite& site);

/// The speed that the scene's wind begins with, from its files where those say so [m/s].
double starting_speed(const WindOptions& wind);
/// Likewise where it blows to [rad].
double starting_direction(const WindOptions& wind);
/// Of its table, or that which it begins with: before events and turbulence [m/s].
double greatest_speed(const WindOptions& wind);

/// Whether a table says where it blows to, in place of wind.direction_deg; throws as below.
bool has_directions(const WindOptions& wind);
/// Whether its direction changes in time; throws scene::SceneError where its table cannot be read.
bool turns(const WindOptions& wind);
/// Whether a table has it rise or sink; throws likewise.
bool rises(const WindOptions& wind);

/// In words: "8 m/s, eog at 60 s".
std::string describe_wind(const WindOptions& wind);

}  // namespace spindrift::aero
