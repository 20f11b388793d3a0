// SPDX-License-Identifier: Apache-2.0
#include "src/aero/doubts.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kernels/base/constants.hpp"

namespace spindrift::aero {

namespace {

void doubt_axis(scene::Doubts& doubts, const std::string& at, const WindOptions& wind, const Eigen::Vector3d& axis, bool blown) {
  const double up = std::abs(std::asin(std::clamp(axis.normalized().z(), -1.0, 1.0))) / radians_per_degree;
  if (up > 30.0) {
    doubts.push_back({at, fmt::format("{:.3g} degrees from level", up), "up to 30 degrees of tilt",
                      "the axis lies along the wind, [1, 0, 0] for wind along x"});
    return;
  }
  if (!blown) return;
  const Eigen::Vector3d to(std::cos(wind.direction), std::sin(wind.direction), 0.0);
  const double off = std::acos(std::clamp(axis.normalized().dot(to), -1.0, 1.0)) / radians_per_degree;
  if (off > 60.0)
    doubts.push_back(
        {at, fmt::format("{:.3g} degrees from where the wind blows to", off), "up to 60 degrees: the axis points downwind",
         off > 120.0 ? "turn its sign, or wind.direction_deg" : "look at it and at wind.direction_deg (to, not from)"});
}

void doubt_speed(scene::Doubts& doubts, const std::string& at, const WindOptions& wind, const RotorAtStart& start, bool blown) {
  if (start.speed < 0.0)
    doubts.push_back({at, fmt::format("{:.4g} rpm", start.speed / rad_s_per_rpm),
                      "above zero: clockwise seen from upwind, as the blades are made", "turn its sign, or the axis"});
  const double tip = std::abs(start.speed) * start.radius;
  if (tip > 130.0)
    doubts.push_back({at, fmt::format("{:.4g} rpm, tips at {:.4g} m/s", start.speed / rad_s_per_rpm, tip), "tips up to 130 m/s",
                      "look at its unit: rpm, not rad/s or deg/s"});
  if (!blown || start.radius <= 0.0 || wind.speed_m_s < 3.0 || tip > 130.0 || start.speed < 0.0) return;
  const double ratio = tip / wind.speed_m_s;
  if (ratio < 2.0 || ratio > 16.0)
    doubts.push_back(
        {at,
         fmt::format("{:.4g} rpm in {:.4g} m/s, a tip-speed ratio of {:.3g}", start.speed / rad_s_per_rpm, wind.speed_m_s, ratio),
         "2 to 16", "look at the units (rpm, m/s), or give rotor.operation"});
}

void doubt_wind(scene::Doubts& doubts, const WindOptions& wind) {
  if (wind.speed_m_s > 60.0)
    doubts.push_back({"wind.speed_m_s", fmt::format("{:.4g} m/s", wind.speed_m_s),
                      "up to 60 m/s, the gusts of the strongest class (IEC 61400-1)",
                      "look at its unit: m/s, not km/h or knots"});
}

void doubt_load(scene::Doubts& doubts, const WindOptions& wind, double air_density, const RotorAtStart& start, bool blown) {
  if (start.radius <= 0.0) return;
  const double area = pi * start.radius * start.radius;
  // Turbines of 5 to 15 MW are rated at 320 to 410 W per square metre swept.
  constexpr double most = 600.0;
  if (start.power && *start.power > most * area)
    doubts.push_back(
        {"rotor",
         fmt::format("a power of {:.3g} MW at the start, {:.3g} W per square metre swept", 1e-6 * *start.power,
                     *start.power / area),
         fmt::format("up to {:.0f} W/m2: above rated wind blades are pitched", most),
         "look at wind.speed_m_s; rotor.operating_point = \"table\" takes speed and pitch from the turbine's table, or give "
         "rotor.blade_pitch_deg"});
  if (blown && start.power && *start.power < 0.0)
    doubts.push_back({"rotor", fmt::format("a power of {:.3g} MW at the start: the rotor drives the air", 1e-6 * *start.power),
                      "above zero in wind", "look at the rotor's speed and rotor.blade_pitch_deg"});
  if (start.thrust && blown && wind.speed_m_s >= 3.0) {
    const double coefficient = *start.thrust / (0.5 * air_density * area * wind.speed_m_s * wind.speed_m_s);
    if (std::abs(coefficient) > 1.5)
      doubts.push_back(
          {"aero", fmt::format("a thrust of {:.3g} kN at the start, a coefficient of {:.3g}", 1e-3 * *start.thrust, coefficient),
           "up to 1.5", "look at the thrust's unit, the wind and the rotor's speed"});
  }
}

void doubt_reynolds(scene::Doubts& doubts, const ReynoldsReach& reach) {
  if (reach.outside == 0) return;
  doubts.push_back(
      {"rotor.turbine",
       fmt::format("Reynolds numbers from {:.3g} to {:.3g} along the blades at the start, at {} of {} elements outside "
                   "of their polars' tables, which go from {:.3g} to {:.3g}",
                   reach.least, reach.greatest, reach.outside, reach.elements, reach.table_least, reach.table_greatest),
       "within the tables, beyond which the first or the last one holds",
       "give polars there, or look at their reynolds and at the viscosity"});
}

}  // namespace

scene::Doubts rotor_doubts(const AeroOptions& aero, const RotorOptions& rotor, const WindOptions& wind, double air_density,
                           const RotorAtStart& start) {
  scene::Doubts doubts;
  const bool blown = aero.model != "prescribed" && wind.speed_m_s > 0.0;
  const std::string axis_key = rotor.joint.empty() ? "rotor.axis" : "joints." + rotor.joint + ".axis";
  const std::string speed_key =
      !rotor.operation.empty() || rotor.joint.empty() ? "rotor.speed_rpm" : "joints." + rotor.joint + ".rotation.speed_rpm";
  doubt_axis(doubts, axis_key, wind, start.axis, blown);
  doubt_speed(doubts, speed_key, wind, start, blown);
  if (aero.model != "prescribed") doubt_wind(doubts, wind);
  doubt_load(doubts, wind, air_density, start, blown);
  if (start.reynolds) doubt_reynolds(doubts, *start.reynolds);
  if (start.over_water && start.hub.z() < start.radius)
    doubts.push_back({rotor.joint.empty() ? "rotor.hub_m" : "joints." + rotor.joint + ".point_m",
                      start.hub.z() < 0.0
                          ? fmt::format("the hub is {:.4g} m under water", -start.hub.z())
                          : fmt::format("the hub is {:.4g} m above water with blades of {:.4g} m", start.hub.z(), start.radius),
                      "a hub higher than its blades are long", "look at z: up is positive"});
  if (const double pitch = rotor.blade_pitch / radians_per_degree; std::abs(pitch) > 95.0)
    doubts.push_back({"rotor.blade_pitch_deg", fmt::format("{:.4g} degrees", pitch), "-10 to 90 degrees", "look at its unit"});
  if (air_density < 0.9 || air_density > 1.5)
    doubts.push_back(
        {"environment.air_density_kg_m3", fmt::format("{:.4g} kg/m3", air_density), "0.9 to 1.5 kg/m3", "look at its unit"});
  return doubts;
}

}  // namespace spindrift::aero
