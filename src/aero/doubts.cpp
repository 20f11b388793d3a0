// SPDX-License-Identifier: Apache-2.0
#include "src/aero/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "src/aero/turbine.hpp"
#include "src/aero/wind_doubts.hpp"
#include "src/scene/columns.hpp"

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

/// Blades that are pitched out of the wind on a rotor that hardly turns: parked or idling, as in load cases of storms.
bool is_feathered(const RotorOptions& rotor, double tip_speed, double wind) {
  constexpr double out_of_the_wind = 45.0;
  return rotor.blade_pitch > out_of_the_wind * radians_per_degree && tip_speed < wind;
}

void doubt_speed(scene::Doubts& doubts, const std::string& at, const RotorOptions& rotor, const WindOptions& wind,
                 const RotorAtStart& start, bool blown) {
  if (start.speed < 0.0)
    doubts.push_back({at, fmt::format("{:.4g} rpm", start.speed / rad_s_per_rpm),
                      "above zero: clockwise seen from upwind, as the blades are made", "turn its sign, or the axis"});
  const double tip = std::abs(start.speed) * std::max(start.radius, start.least_radius);
  if (tip > 130.0)
    doubts.push_back({at, fmt::format("{:.4g} rpm, tips at {:.4g} m/s", start.speed / rad_s_per_rpm, tip), "tips up to 130 m/s",
                      "look at its unit: rpm, not rad/s or deg/s"});
  if (!blown || start.radius <= 0.0 || wind.speed_m_s < 3.0 || tip > 130.0 || start.speed < 0.0 || start.parked) return;
  if (is_feathered(rotor, tip, wind.speed_m_s)) return;
  const double ratio = tip / wind.speed_m_s;
  if (ratio < 2.0 || ratio > 16.0)
    doubts.push_back(
        {at,
         fmt::format("{:.4g} rpm in {:.4g} m/s, a tip-speed ratio of {:.3g}", start.speed / rad_s_per_rpm, wind.speed_m_s, ratio),
         "2 to 16", ratio < 2.0 ? "in rad/s or Hz? give rpm; or the wind is not in m/s" : "look at the units: rpm, m/s"});
}

/// Blades that are pitched far beyond the wind that meets them, where no model tells their power. `angle`: of the wind to the
/// rotor's plane at 0.7 of the radius, without induction.
void doubt_braking(scene::Doubts& doubts, const RotorOptions& rotor, const WindOptions& wind, const RotorAtStart& start) {
  if (start.power || start.parked || start.radius <= 0.0 || start.speed <= 0.0 || wind.speed_m_s <= 0.0) return;
  constexpr double most_beyond = 15.0, outer = 0.7;
  const double angle = std::atan(wind.speed_m_s / (outer * start.speed * start.radius)) / radians_per_degree,
               pitch = rotor.blade_pitch / radians_per_degree;
  if (pitch > angle + most_beyond)
    doubts.push_back({"rotor.blade_pitch_deg",
                      fmt::format("{:.4g} degrees where the wind meets the blades at {:.3g} degrees", pitch, angle),
                      fmt::format("up to {:g} degrees more than that", most_beyond),
                      "the rotor drives the air; look at its unit, and at the rotor's speed and the wind"});
}

/// A section, or one drawn out along the span.
bool is_wing(const GenerateOptions& grid) { return grid.kind == "naca0012" || grid.kind == "aerofoil" || grid.kind == "wing"; }

/// Length that the flow's Reynolds number goes with, where the program makes the grid and knows it; else 0.
double length_of(const FlowOptions& flow) {
  if (!flow.generate) return 0.0;
  if (is_wing(*flow.generate)) return 1.0;  // the chord
  return flow.generate->kind == "cylinder" ? 2.0 * flow.generate->radius_m : 0.0;
}

/// Where closures were made for, and where laminar flow ends: the boundary layer of a plate turns turbulent by itself from 5e5 on
/// (White 2011, sec. 7.1), behind the suction peak of a section or on a cylinder earlier; below 1e4 nothing does. The closures
/// have no model of that change (Spalart & Allmaras 1994; Menter 1994).
void doubt_closure(scene::Doubts& doubts, const FlowOptions& flow, double reynolds) {
  if (flow.viscous == "none" || reynolds <= 0.0) return;
  constexpr double least = 2e4, most = 5e5;
  const std::string look =
      "look at aero.flow.viscosity_Pa_s (air: 1.8e-5), the wind and the size, or take aero.flow.turbulence = ";
  if (flow.turbulence != "none" && reynolds < least)
    doubts.push_back({"aero.flow.turbulence", fmt::format("{} at a Reynolds number of {:.3g}", flow.turbulence, reynolds),
                      fmt::format("turbulence above {:.0e}", least), look + "\"none\""});
  if (flow.turbulence == "none" && reynolds > most)
    doubts.push_back(
        {"aero.flow.turbulence", fmt::format("laminar flow at a Reynolds number of {:.3g}", reynolds),
         fmt::format("laminar up to {:.0e}, beyond which boundary layers turn turbulent and drag, stall and what is shed are "
                     "others",
                     most),
         look + "\"sst\" or \"sa\""});
}

/// Of a section: beyond stall it sheds vortices; a steady march that ends there has found one state among them.
void doubt_stall(scene::Doubts& doubts, const FlowOptions& flow) {
  constexpr double most = 20.0;
  if (flow.viscous == "none" || flow.time != "steady") return;
  if (const double degrees = std::abs(flow.incidence) / radians_per_degree; degrees > most)
    doubts.push_back(
        {"aero.flow.incidence_deg", fmt::format("{:.3g} degrees in steady flow", degrees),
         fmt::format("up to {:g}: beyond stall the flow is not steady, and a closure's lift and drag are guesses", most),
         "take aero.flow.time = \"bdf2\" and means over time, or look at its unit"});
}

/// The wake of a cylinder is steady up to Reynolds numbers of 47 (Williamson 1996, Annu. Rev. Fluid Mech. 28, 477).
void doubt_shedding(scene::Doubts& doubts, const FlowOptions& flow, double reynolds) {
  constexpr double most = 47.0;
  if (flow.generate->kind != "cylinder" || flow.viscous == "none" || flow.time != "steady" || reynolds <= most) return;
  doubts.push_back({"aero.flow.time", fmt::format("\"steady\" round a cylinder at a Reynolds number of {:.3g}", reynolds),
                    fmt::format("up to {:g}: beyond, vortices are shed", most),
                    "take aero.flow.time = \"bdf2\" and means over time: a steady march has a third less drag"});
}

/// A window in which the air passes the body twice resolves no vortex shedding.
void doubt_window(scene::Doubts& doubts, const FlowOptions& flow, double passes, double window) {
  if (flow.time == "steady") return;
  if (passes > 2.0)
    doubts.push_back({"time.window_s", fmt::format("{:.4g} s, in which the air passes the body {:.3g} times", window, passes),
                      "up to twice; a tenth of a time to see what is shed", "shorten it: a window is a step of the flow"});
  if (flow.motion && flow.motion->oscillates() && window > flow.motion->period_s / 10.0)
    doubts.push_back({"aero.flow.motion.period_s",
                      fmt::format("{:.4g} s with windows of {:.4g} s", flow.motion->period_s, window),
                      "ten windows to a period at least", "look at its unit, or shorten the window"});
}

void doubt_far_side(scene::Doubts& doubts, const GenerateOptions& grid, double length) {
  if (length > 0.0 && grid.far_m < 8.0 * length)
    doubts.push_back({"aero.flow.generate.far_m", fmt::format("{:.4g} m from a body of {:.4g} m", grid.far_m, length),
                      "8 lengths or more", "a near far side holds the flow as a tunnel's walls would"});
  if (constexpr double most = 1000.0; length > 0.0 && grid.far_m > most * length)
    doubts.push_back({"aero.flow.generate.far_m", fmt::format("{:.4g} m from a body of {:.4g} m", grid.far_m, length),
                      fmt::format("up to {:g} lengths; 20 to 500 are usual", most), "look at its unit: m, not mm"});
}

void doubt_load(scene::Doubts& doubts, const WindOptions& wind, double air_density, const RotorAtStart& start, bool blown) {
  if (start.radius <= 0.0) return;
  const double area = pi * start.radius * start.radius;
  // Turbines of 5 to 15 MW are rated at 320 to 410 W per square metre swept. A gust at the start finds blades pitched for the
  // mean.
  const double most = wind.turbulence ? 1200.0 : 600.0, least = wind.turbulence ? -most : 0.0;
  if (start.power && *start.power > most * area)
    doubts.push_back(
        {"rotor",
         fmt::format("a power of {:.3g} MW at the start, {:.3g} W per square metre swept", 1e-6 * *start.power,
                     *start.power / area),
         fmt::format("up to {:.0f} W/m2: above rated wind blades are pitched", most),
         "look at wind.speed_m_s; rotor.operating_point = \"table\" takes speed and pitch from the turbine's table, or give "
         "rotor.blade_pitch_deg"});
  if (blown && start.power && *start.power < least * area)
    doubts.push_back({"rotor", fmt::format("a power of {:.3g} MW at the start: the rotor drives the air", 1e-6 * *start.power),
                      "above zero in wind", "look at the rotor's speed and rotor.blade_pitch_deg"});
  if (start.thrust && blown && wind.speed_m_s >= 3.0) {
    const double coefficient = *start.thrust / (0.5 * air_density * area * wind.speed_m_s * wind.speed_m_s);
    if (coefficient < -0.3)
      doubts.push_back({"aero", fmt::format("a thrust of {:.3g} kN at the start, against the axis", 1e-3 * *start.thrust),
                        "above zero: the air pushes the rotor downwind",
                        "look at the signs of the thrust and of the axis, and at the blades' pitch"});
    else if (std::abs(coefficient) > 1.5)
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

/// Towers are about a tenth as thick as the blades are long, thinner under small rotors; they end below the hub or behind it. Its
/// foot is by the hub as the scene describes it, not where an equilibrium has taken it.
void doubt_tower(scene::Doubts& doubts, const AeroOptions& aero, const RotorOptions& rotor, const RotorAtStart& start) {
  const double radius = start.radius, hub_height = rotor.hub_m.z();
  if (!aero.tower || radius <= 0.0) return;
  constexpr double most_aside = 0.5;
  const std::array<double, 2>& foot = rotor.tower_foot_m ? *rotor.tower_foot_m : aero.tower->foot_m;
  const Eigen::Vector2d behind(foot[0] - rotor.hub_m.x(), foot[1] - rotor.hub_m.y());
  const Eigen::Vector2d behind_start(foot[0] - start.hub.x(), foot[1] - start.hub.y());
  if (const double aside = std::min(behind.norm(), behind_start.norm()); aside > most_aside * radius)
    doubts.push_back({rotor.tower_foot_m ? "rotor.tower_foot_m" : "aero.tower.foot_m",
                      fmt::format("{:.4g} m aside of the hub", aside),
                      fmt::format("up to {:.4g} m, {:g} of the blades' length", most_aside * radius, most_aside),
                      "look at its signs and unit, m, and at those of the hub"});
  const double along = behind.dot(rotor.axis.head<2>()), along_start = behind_start.dot(rotor.axis.head<2>());
  const bool is_upwind = std::min(along, along_start) > 0.0, is_downwind = std::max(along, along_start) < 0.0;
  if (constexpr double level = 0.02; is_upwind && rotor.axis.normalized().z() > level)
    doubts.push_back(
        {rotor.joint.empty() ? "rotor.axis" : "joints." + rotor.joint + ".axis",
         fmt::format("the axis rises downwind, by {:.3g} degrees", std::asin(rotor.axis.normalized().z()) / radians_per_degree),
         "one that falls: a rotor upwind of its tower is tilted to keep its blades away from it", "turn the sign of z"});
  if (constexpr double bent = -0.01; is_downwind && !rotor.turbine.empty())
    if (const double tip = read_turbine(rotor.turbine).planform.prebend.back(); tip < bent * radius)
      doubts.push_back({rotor.joint.empty() ? "rotor.hub_m" : "joints." + rotor.joint + ".point_m",
                        fmt::format("a rotor downwind of its tower with tips bent upwind by {:.3g} m", -tip),
                        "blades that are bent away from the tower", "look at the sign of its x, or at the tower's foot"});
  constexpr double most_above = 0.2, most_drag = 3.0;  // DNV-RP-C205, table E-1: sections of any shape have up to 2.3
  const double top = aero.tower->stations.back()[0];
  if (constexpr double least_top = 0.6; top > hub_height + most_above * radius || top < least_top * hub_height)
    doubts.push_back({"aero.tower.stations", fmt::format("a top at {:.4g} m where the hub is at {:.4g} m", top, hub_height),
                      "a top at the hub's height", "look at its unit: m above still water, and whether a station is missing"});
  for (const auto& [height, diameter, drag] : aero.tower->stations)
    if (drag > most_drag) {
      doubts.push_back({"aero.tower.stations", fmt::format("a drag coefficient of {:.4g}", drag),
                        fmt::format("up to {:g}: cylinders have 0.3 to 1.2", most_drag), "it has no unit; look at the point"});
      break;
    }
  constexpr double most = 0.3;
  double thickest = 0.0;
  for (const auto& [height, diameter, drag] : aero.tower->stations) thickest = std::max(thickest, diameter);
  if (thickest > most * radius)
    doubts.push_back({"aero.tower.stations", fmt::format("a diameter of {:.4g} m behind blades of {:.4g} m", thickest, radius),
                      fmt::format("up to {:g} of their length", most), "look at its unit: m, not mm"});
  // At the foot, of steel: 0.07 (IEA 22 MW) to 0.1 of it. Thrust times height bends it, and diameters cubed bear that.
  constexpr double least = 0.05, large = 30.0, foot_share = 0.4;
  if (thickest < least * radius && radius > large && aero.tower->stations.front()[0] < foot_share * hub_height)
    doubts.push_back({"aero.tower.stations", fmt::format("a diameter of {:.4g} m behind blades of {:.4g} m", thickest, radius),
                      fmt::format("{:g} of their length or more at its foot", least), "they are diameters, not radii; in m"});
}

/// Turbines cut out at 20 to 25 m/s, some at 34.
void doubt_cut_out(scene::Doubts& doubts, const WindOptions& wind, const RotorAtStart& start) {
  constexpr double most = 35.0, idle = 25.0, told = 60.0;
  const double tip = std::abs(start.speed) * std::max(start.radius, start.least_radius);
  if (start.parked || tip < idle || wind.speed_m_s <= most || wind.speed_m_s > told) return;
  doubts.push_back({"wind.speed_m_s", fmt::format("{:.4g} m/s on a rotor whose tips turn at {:.3g} m/s", wind.speed_m_s, tip),
                    fmt::format("up to {:g} m/s: turbines cut out at 20 to 34", most),
                    fmt::format("in km/h or knots? give m/s ({:.3g} or {:.3g})", wind.speed_m_s / 3.6, 0.5144 * wind.speed_m_s)});
}

/// Open sides of a box: at 2.5 radii from the hub the rotor covers an eighth of a square section.
void doubt_sides(scene::Doubts& doubts, const AeroOptions& aero, const RotorAtStart& start) {
  if (!aero.acts() || !aero.flow || !aero.flow->generate || start.radius <= 0.0) return;
  constexpr double least = 2.5;
  const GenerateOptions& grid = *aero.flow->generate;
  for (const PatchOptions& side : aero.flow->boundaries) {
    const auto axis = side.patch.empty() ? std::string::npos : std::string("xyz").find(side.patch[0]);
    const bool low = side.patch.ends_with("_min");
    if (side.condition != Condition::far_field || axis == std::string::npos || !(low || side.patch.ends_with("_max"))) continue;
    const double hub = start.hub[Eigen::Index(axis)], off = low ? hub - grid.low_m[axis] : grid.high_m[axis] - hub;
    if (off < least * start.radius)
      doubts.push_back({low ? "aero.flow.generate.low_m" : "aero.flow.generate.high_m",
                        fmt::format("{} is {:.4g} m from the hub of blades of {:.4g} m", side.patch, off, start.radius),
                        fmt::format("{:g} times their length or more; ten are usual", least),
                        "a near far side holds the flow as a tunnel's walls would; look at its unit: m"});
  }
}

/// Of resolved air: by the radius and the faster of tips and wind. Rotors of 0.5 to 150 m have 1e6 to 1e9.
void doubt_viscosity(scene::Doubts& doubts, const AeroOptions& aero, const WindOptions& wind, double air_density,
                     const RotorAtStart& start) {
  if (!aero.flow || aero.flow->viscous == "none" || start.radius <= 0.0) return;
  constexpr double large = 5.0, most = 5e9;
  const double least = start.radius > large ? 1e6 : 1e5;
  const double speed = std::max(std::abs(start.speed) * start.radius, wind.speed_m_s);
  const double reynolds = air_density * speed * start.radius / aero.flow->viscosity_Pa_s;
  if (speed > 0.0 && (reynolds < least || reynolds > most))
    doubts.push_back(
        {"aero.flow.viscosity_Pa_s",
         fmt::format("{:.4g} Pa s, a Reynolds number of {:.3g} by the rotor's radius", aero.flow->viscosity_Pa_s, reynolds),
         fmt::format("{:g} to {:g}", least, most), "look at its unit: air has 1.8e-5 Pa s"});
}

/// Tables of thrust and power against wind: their units, and a wind that they do not reach. Sound ones have a thrust coefficient
/// above .02 and above 5 m/s a power coefficient above .01, up to storms.
void doubt_curve(scene::Doubts& doubts, const AeroOptions& aero, const WindOptions& wind, double air_density,
                 const RotorAtStart& start) {
  if (aero.model != "thrust_curve" || aero.curve.empty() || start.radius <= 0.0) return;
  constexpr double least_thrust = 0.005, least_power = 0.003, beyond = 1.05;
  const double speed = wind.speed_m_s, pressure = 0.5 * air_density * pi * start.radius * start.radius * speed * speed;
  const double thrust = start.thrust.value_or(0.0), power = start.power.value_or(0.0);
  if (speed >= 3.0 && thrust > 0.0 && thrust < least_thrust * pressure)
    doubts.push_back({"aero.curve",
                      fmt::format("a thrust of {:.3g} N at the start, a coefficient of {:.2g}", thrust, thrust / pressure),
                      fmt::format("{:g} or more", least_thrust), "look at the unit of its thrust_N: N, not kN"});
  if (speed >= 5.0 && power > 0.0 && power < least_power * pressure * speed)
    doubts.push_back({"aero.curve",
                      fmt::format("a power of {:.3g} W at the start, a coefficient of {:.2g}", power, power / (pressure * speed)),
                      fmt::format("{:g} or more", least_power), "look at the units of its power_W or torque_N_m: W, not kW"});
  const scene::Columns file = scene::read_columns(aero.curve);
  if (file.has("wind_m_s") && speed > beyond * file["wind_m_s"].back())
    doubts.push_back({"aero.curve", fmt::format("rows up to {:.4g} m/s in a wind of {:.4g} m/s", file["wind_m_s"].back(), speed),
                      "rows for the winds of the run", "beyond them the coefficients of the last row hold: loads go on as U^2"});
}

/// The wake of a rotor answers within some radii of the wind's way (Oye 1990; Madsen et al. 2020). Sound travels through air at
/// 295 to 355 m/s from -55 to 40 C; pressurised tunnels have a hundredth of air's viscosity.
void doubt_air(scene::Doubts& doubts, const AeroOptions& aero, const WindOptions& wind, double radius) {
  constexpr double least = 0.02, most = 50.0;
  if (const double way = aero.inflow_time_s.value_or(0.0) * wind.speed_m_s;
      way > 0.0 && radius > 0.0 && (way < least * radius || way > most * radius))
    doubts.push_back({"aero.inflow_time_s", fmt::format("{:.4g} s, in which the wind goes {:.4g} m", *aero.inflow_time_s, way),
                      fmt::format("{:g} to {:g} times the blades' length", least, most), "look at its unit: s"});
  if (const double sound = aero.speed_of_sound_m_s; aero.dynamic_stall == "beddoes_leishman" && (sound < 250.0 || sound > 400.0))
    doubts.push_back({"aero.speed_of_sound_m_s", fmt::format("{:.4g} m/s", sound), "250 to 400 m/s: 340 in air at 15 C",
                      "look at its unit: m/s, not km/h"});
  if (const auto& viscosity = aero.kinematic_viscosity_m2_s; viscosity && (*viscosity < 5e-8 || *viscosity > 2e-4))
    doubts.push_back({"aero.kinematic_viscosity_m2_s", fmt::format("{:.4g} m2/s", *viscosity),
                      "5e-8 to 2e-4 m2/s: air at 15 C has 1.46e-5", "look at its unit and the power of ten"});
}

/// Blades clear the water or the ground at z = 0 by 0.2 of their length (IEA 22 MW) to half of it. A rotor in free air, without
/// either, has its hub at the origin. Where nothing says how long blades are, they are longer than least_radius.
void doubt_height(scene::Doubts& doubts, const std::string& key, const RotorAtStart& start) {
  constexpr double clear = 1.05;
  const double z = start.hub.z(), radius = start.radius > 0.0 ? start.radius : start.least_radius;
  const char *ground = start.over_water ? "water" : "the ground", *least = start.radius > 0.0 ? "" : "at least ";
  if (z < clear * radius && (start.over_water || z != 0.0)) {
    if (z < 0.0)
      doubts.push_back({key, fmt::format("the hub is {:.4g} m under {}", -z, ground), "a hub higher than its blades are long",
                        "look at z: up is positive"});
    else
      doubts.push_back(
          {key,
           fmt::format(
               "the hub is {:.4g} m above {} with blades of {}{:.4g} m: their tips come {}", z, ground, least, radius,
               z < radius ? fmt::format("{:.3g} m under it", radius - z) : fmt::format("as near as {:.3g} m", z - radius)),
           fmt::format("a hub higher than {:g} of their length", clear), "look at z and its unit: m"});
  }
  if (constexpr double low = 60.0, blades = 4.0; start.radius > 0.0 && z > std::max(low, blades * start.radius))
    doubts.push_back({key, fmt::format("the hub is {:.4g} m up with blades of {:.4g} m", z, start.radius),
                      fmt::format("up to {:g} times their length", blades), "look at its unit: m"});
}

}  // namespace

scene::Doubts rotor_doubts(const AeroOptions& aero, const RotorOptions& rotor, const WindOptions& wind, double air_density,
                           const RotorAtStart& start) {
  scene::Doubts doubts;
  const bool blown = aero.model != "prescribed" && wind.speed_m_s > 0.0;
  const std::string axis_key = rotor.joint.empty() ? "rotor.axis" : "joints." + rotor.joint + ".axis";
  doubt_axis(doubts, axis_key, wind, start.axis, blown);
  doubt_speed(doubts, start.speed_key, rotor, wind, start, blown);
  if (aero.model != "prescribed") append(doubts, wind_doubts(wind, start.radius, start.over_water));
  doubt_load(doubts, wind, air_density, start, blown);
  doubt_curve(doubts, aero, wind, air_density, start);
  doubt_viscosity(doubts, aero, wind, air_density, start);
  doubt_sides(doubts, aero, start);
  doubt_tower(doubts, aero, rotor, start);
  doubt_air(doubts, aero, wind, start.radius);
  if (blown) doubt_cut_out(doubts, wind, start), doubt_braking(doubts, rotor, wind, start);
  if (constexpr double most = 0.1; std::ranges::any_of(rotor.blade_damping, [](double d) { return d > most; }))
    doubts.push_back({"rotor.blade_damping", fmt::format("{:.4g} of critical", std::ranges::max(rotor.blade_damping)),
                      fmt::format("up to {:g}: blades have 0.002 to 0.03", most), "it is a share, not per cent"});
  if (start.reynolds) doubt_reynolds(doubts, *start.reynolds);
  doubt_height(doubts, rotor.joint.empty() ? "rotor.hub_m" : "joints." + rotor.joint + ".point_m", start);
  if (const double pitch = rotor.blade_pitch / radians_per_degree; pitch < -15.0 || pitch > 95.0)
    doubts.push_back({"rotor.blade_pitch_deg", fmt::format("{:.4g} degrees", pitch), "-10 to 90 degrees",
                      "look at its unit and sign: positive turns the nose into the wind"});
  if (air_density < 0.9 || air_density > 1.5)
    doubts.push_back(
        {"environment.air_density_kg_m3", fmt::format("{:.4g} kg/m3", air_density), "0.9 to 1.5 kg/m3", "look at its unit"});
  return doubts;
}

scene::Doubts rotor_body_doubts(const RotorBody& body, const RotorAtStart& start) {
  scene::Doubts doubts;
  constexpr double usual_share = 0.29;  // radius of gyration of blades with a hub, of turbines of 5 to 15 MW; a disc has .71
  const double radius = start.radius > 0.0 ? start.radius : body.radius_of_gyration / usual_share;
  const Eigen::Vector3d off = body.centre - start.hub, axis = start.axis.normalized();
  const double along = std::abs(off.dot(axis)), across = (off - off.dot(axis) * axis).norm();
  if (across > 0.05 * radius || along > 0.5 * radius)
    doubts.push_back({body.key + ".centre_m",
                      fmt::format("{:.4g} m off the rotor's axis, {:.4g} m along it from the hub", across, along),
                      fmt::format("up to {:.3g} and {:.3g} m: a rotor is balanced about its shaft", 0.05 * radius, 0.5 * radius),
                      "look at the place of the centre of mass and of the bearing"});
  // Masses in a plane have as much about its normal as about two axes in it together.
  if (constexpr double least = 0.9; body.radius_of_gyration < least * body.across)
    doubts.push_back({body.key + ".inertia_kg_m2",
                      fmt::format("a radius of gyration of {:.3g} m about the shaft, of {:.3g} m across it",
                                  body.radius_of_gyration, body.across),
                      "the largest about the shaft", "look at the order of the axes: x, y, z, of the earth"});
  const double longest = std::max(start.radius, start.least_radius);
  if (longest <= 0.0) return doubts;
  if (const double share = body.radius_of_gyration / longest; share < 0.05 || (share > 0.8 && start.radius > 0.0))
    doubts.push_back({body.key + ".inertia_kg_m2",
                      fmt::format("a radius of gyration of {:.3g} m about the shaft, {:.2g} of the rotor's radius",
                                  body.radius_of_gyration, share),
                      "0.05 to 0.8 of it", "look at the units of mass and inertia: kg and kg m2, not t; x first"});
  return doubts;
}

scene::Doubts flow_doubts(const FlowOptions& flow, double speed, double window, double air_density) {
  scene::Doubts doubts;
  if (air_density < 0.3 || air_density > 1.5)
    doubts.push_back({"environment.air_density_kg_m3", fmt::format("{:.4g} kg/m3", air_density),
                      "0.3 to 1.5 kg/m3: the air from sea level to 12 km", "look at its unit"});
  if (flow.temperature_K < 200.0 || flow.temperature_K > 400.0)
    doubts.push_back({"aero.flow.temperature_K", fmt::format("{:.4g} K", flow.temperature_K), "200 to 400 K",
                      "look at its unit: K, not degrees Celsius"});
  if (const double mach = speed / std::sqrt(1.4 * 287.05 * flow.temperature_K); mach > 1.0)
    doubts.push_back({"wind.speed_m_s", fmt::format("{:.4g} m/s, a Mach number of {:.3g}", speed, mach),
                      "below that of sound, which blades do not reach", "look at its unit: m/s, not km/h"});
  const double length = length_of(flow);
  if (length == 0.0) return doubts;
  const double reynolds = air_density * speed * length / flow.viscosity_Pa_s;
  doubt_closure(doubts, flow, reynolds);
  doubt_shedding(doubts, flow, reynolds);
  doubt_window(doubts, flow, speed * window / length, window);
  doubt_far_side(doubts, *flow.generate, length);
  if (!is_wing(*flow.generate)) return doubts;
  if (const double incidence = flow.incidence / radians_per_degree; std::abs(incidence) > 45.0)
    doubts.push_back({"aero.flow.incidence_deg", fmt::format("{:.4g} degrees", incidence), "up to 45 degrees of a section",
                      "look at its unit: degrees"});
  else
    doubt_stall(doubts, flow);
  if (const double area = reference_area(flow), share = area / own_area(flow); share < 0.05 || share > 20.0)
    doubts.push_back({"aero.flow.reference_area_m2", fmt::format("{:.4g} m2", area),
                      fmt::format("about chord times width, {:.3g} m2", own_area(flow)), "look at its unit: m2"});
  if (flow.motion && flow.motion->oscillates() && std::abs(flow.motion->pitch_amplitude) > 45.0 * radians_per_degree)
    doubts.push_back({"aero.flow.motion.pitch_amplitude_deg",
                      fmt::format("{:.4g} degrees", flow.motion->pitch_amplitude / radians_per_degree), "up to 45 degrees",
                      "look at its unit: degrees"});
  return doubts;
}

}  // namespace spindrift::aero
