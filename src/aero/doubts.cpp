// SPDX-License-Identifier: Apache-2.0
#include "src/aero/doubts.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kernels/base/constants.hpp"
#include "src/aero/control_options.hpp"

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
  if (!blown || start.radius <= 0.0 || wind.speed_m_s < 3.0 || tip > 130.0 || start.speed < 0.0 || start.parked) return;
  const double ratio = tip / wind.speed_m_s;
  if (ratio < 2.0 || ratio > 16.0)
    doubts.push_back(
        {at,
         fmt::format("{:.4g} rpm in {:.4g} m/s, a tip-speed ratio of {:.3g}", start.speed / rad_s_per_rpm, wind.speed_m_s, ratio),
         "2 to 16", ratio < 2.0 ? "in rad/s or Hz? give rpm; or the wind is not in m/s" : "look at the units: rpm, m/s"});
}

void doubt_wind(scene::Doubts& doubts, const WindOptions& wind) {
  if (wind.speed_m_s > 60.0)
    doubts.push_back({"wind.speed_m_s", fmt::format("{:.4g} m/s", wind.speed_m_s),
                      "up to 60 m/s, the gusts of the strongest class (IEC 61400-1)",
                      "look at its unit: m/s, not km/h or knots"});
  if (wind.law != WindLaw::uniform && *wind.reference_height_m < 5.0)
    doubts.push_back({"wind.reference_height_m", fmt::format("{:.4g} m", *wind.reference_height_m),
                      "5 m or more: 10 m of weather reports, or the hub's height", "look at its unit: m"});
  if (wind.law == WindLaw::power && (wind.shear_exponent < 0.0 || wind.shear_exponent > 0.6))
    doubts.push_back({"wind.shear_exponent", fmt::format("{:.4g}", wind.shear_exponent),
                      "0 to 0.6: .14 at sea, .2 on land (IEC 61400-3, 61400-1)",
                      "look at its sign and the point; a wind that falls with height is rare"});
  if (!wind.turbulence || wind.turbulence->model != TurbulenceModel::kaimal) return;
  const TurbulenceOptions& t = *wind.turbulence;
  if (t.reference_intensity > 0.3)
    doubts.push_back({"wind.turbulence.reference_intensity", fmt::format("{:.4g}", t.reference_intensity),
                      "up to 0.3: .12 to .16 by class (IEC 61400-1)", "it is a share, not per cent"});
  if (t.sigma_m_s && wind.speed_m_s > 0.0 && *t.sigma_m_s > 0.5 * wind.speed_m_s)
    doubts.push_back({"wind.turbulence.sigma_m_s",
                      fmt::format("{:.4g} m/s in a wind of {:.4g} m/s", *t.sigma_m_s, wind.speed_m_s), "up to half the wind",
                      "it is in m/s, not a share or per cent"});
}

void doubt_roughness(scene::Doubts& doubts, const WindOptions& wind) {
  if (constexpr double most = 0.03; wind.law == WindLaw::logarithmic && wind.roughness_m > most)
    doubts.push_back({"wind.roughness_m", fmt::format("{:.4g} m over water", wind.roughness_m),
                      fmt::format("up to {:g} m: 0.0001 in calm to 0.01 in storm (DNV-RP-C205, table 2-1)", most),
                      "look at its unit: m, not mm"});
}

bool is_wing(const GenerateOptions& grid) { return grid.kind == "naca0012" || grid.kind == "aerofoil"; }

/// Length that the flow's Reynolds number goes with, where the program makes the grid and knows it; else 0.
double length_of(const FlowOptions& flow) {
  if (!flow.generate) return 0.0;
  if (is_wing(*flow.generate) || flow.generate->kind == "wing") return 1.0;  // the chord
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

/// Towers are about a tenth as thick as the blades are long, thinner under small rotors.
void doubt_tower(scene::Doubts& doubts, const AeroOptions& aero, double radius) {
  if (!aero.tower || radius <= 0.0) return;
  constexpr double most = 0.3;
  double thickest = 0.0;
  for (const auto& [height, diameter, drag] : aero.tower->stations) thickest = std::max(thickest, diameter);
  if (thickest > most * radius)
    doubts.push_back({"aero.tower.stations", fmt::format("a diameter of {:.4g} m behind blades of {:.4g} m", thickest, radius),
                      fmt::format("up to {:g} of their length", most), "look at its unit: m, not mm"});
}

/// Of resolved air: by the radius and the faster of tips and wind. Rotors of 0.5 to 150 m have 1e6 to 1e9.
void doubt_viscosity(scene::Doubts& doubts, const AeroOptions& aero, const WindOptions& wind, double air_density,
                     const RotorAtStart& start) {
  if (!aero.flow || aero.flow->viscous == "none" || start.radius <= 0.0) return;
  constexpr double least = 1e5, most = 5e9;
  const double speed = std::max(std::abs(start.speed) * start.radius, wind.speed_m_s);
  const double reynolds = air_density * speed * start.radius / aero.flow->viscosity_Pa_s;
  if (speed > 0.0 && (reynolds < least || reynolds > most))
    doubts.push_back(
        {"aero.flow.viscosity_Pa_s",
         fmt::format("{:.4g} Pa s, a Reynolds number of {:.3g} by the rotor's radius", aero.flow->viscosity_Pa_s, reynolds),
         fmt::format("{:g} to {:g}", least, most), "look at its unit: air has 1.8e-5 Pa s"});
}

}  // namespace

scene::Doubts rotor_doubts(const AeroOptions& aero, const RotorOptions& rotor, const WindOptions& wind, double air_density,
                           const RotorAtStart& start) {
  scene::Doubts doubts;
  const bool blown = aero.model != "prescribed" && wind.speed_m_s > 0.0;
  const std::string axis_key = rotor.joint.empty() ? "rotor.axis" : "joints." + rotor.joint + ".axis";
  doubt_axis(doubts, axis_key, wind, start.axis, blown);
  doubt_speed(doubts, start.speed_key, wind, start, blown);
  if (aero.model != "prescribed") doubt_wind(doubts, wind);
  doubt_load(doubts, wind, air_density, start, blown);
  doubt_viscosity(doubts, aero, wind, air_density, start);
  doubt_tower(doubts, aero, start.radius);
  if (start.reynolds) doubt_reynolds(doubts, *start.reynolds);
  const std::string hub_key = rotor.joint.empty() ? "rotor.hub_m" : "joints." + rotor.joint + ".point_m";
  if (start.over_water && start.hub.z() < start.radius)
    doubts.push_back({hub_key,
                      start.hub.z() < 0.0
                          ? fmt::format("the hub is {:.4g} m under water", -start.hub.z())
                          : fmt::format("the hub is {:.4g} m above water with blades of {:.4g} m", start.hub.z(), start.radius),
                      "a hub higher than its blades are long", "look at z: up is positive"});
  if (constexpr double least = 60.0, blades = 4.0; start.radius > 0.0 && start.hub.z() > std::max(least, blades * start.radius))
    doubts.push_back({hub_key, fmt::format("the hub is {:.4g} m up with blades of {:.4g} m", start.hub.z(), start.radius),
                      fmt::format("up to {:g} times their length", blades), "look at its unit: m"});
  if (start.over_water) doubt_roughness(doubts, wind);
  if (const double pitch = rotor.blade_pitch / radians_per_degree; pitch < -15.0 || pitch > 95.0)
    doubts.push_back({"rotor.blade_pitch_deg", fmt::format("{:.4g} degrees", pitch), "-10 to 90 degrees",
                      "look at its unit and sign: positive turns the nose into the wind"});
  if (air_density < 0.9 || air_density > 1.5)
    doubts.push_back(
        {"environment.air_density_kg_m3", fmt::format("{:.4g} kg/m3", air_density), "0.9 to 1.5 kg/m3", "look at its unit"});
  return doubts;
}

scene::Doubts control_doubts(const ControlOptions& control) {
  scene::Doubts doubts;
  const bool library = control.model == ControlModel::library;
  for (std::size_t i = 0; i < control.events.size(); ++i)
    if (control.events[i].what == ControlEvent::emergency_stop &&
        !((library ? control.drive_train->brake_torque_N_m : read_controller(control.file).brake_torque_N_m) > 0.0))
      doubts.push_back({fmt::format("control.events[{}]", i), "emergency_stop with a brake of 0 N m",
                        fmt::format("brake_torque_N_m above 0 in {}", library ? "control.drive_train" : control.file),
                        "without a brake it is a grid_loss: the blades alone slow the rotor down"});
  return doubts;
}

scene::Doubts rotor_body_doubts(const RotorBody& body, const RotorAtStart& start) {
  scene::Doubts doubts;
  if (start.radius <= 0.0) return doubts;
  const Eigen::Vector3d off = body.centre - start.hub, axis = start.axis.normalized();
  const double along = std::abs(off.dot(axis)), across = (off - off.dot(axis) * axis).norm();
  if (across > 0.05 * start.radius || along > 0.5 * start.radius)
    doubts.push_back(
        {body.key + ".centre_m", fmt::format("{:.4g} m off the rotor's axis, {:.4g} m along it from the hub", across, along),
         fmt::format("up to {:.3g} and {:.3g} m: a rotor is balanced about its shaft", 0.05 * start.radius, 0.5 * start.radius),
         "look at the place of the centre of mass and of the bearing"});
  // Blades with a hub: .29 of the radius for turbines of 5 to 15 MW; a disc has .71, a ring 1.
  if (const double share = body.radius_of_gyration / start.radius; share < 0.05 || share > 0.8)
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
  const double length = length_of(flow);
  if (length == 0.0) return doubts;
  doubt_closure(doubts, flow, air_density * speed * length / flow.viscosity_Pa_s);
  doubt_window(doubts, flow, speed * window / length, window);
  doubt_far_side(doubts, *flow.generate, length);
  if (!is_wing(*flow.generate)) return doubts;
  if (const double incidence = flow.incidence / radians_per_degree; std::abs(incidence) > 45.0)
    doubts.push_back({"aero.flow.incidence_deg", fmt::format("{:.4g} degrees", incidence), "up to 45 degrees of a section",
                      "look at its unit: degrees"});
  else
    doubt_stall(doubts, flow);
  if (const double share = flow.reference_area_m2 / (length * flow.width_m); share < 0.05 || share > 20.0)
    doubts.push_back({"aero.flow.reference_area_m2", fmt::format("{:.4g} m2", flow.reference_area_m2),
                      fmt::format("about chord times width, {:.3g} m2", length * flow.width_m), "look at its unit: m2"});
  if (flow.motion && flow.motion->oscillates() && std::abs(flow.motion->pitch_amplitude) > 45.0 * radians_per_degree)
    doubts.push_back({"aero.flow.motion.pitch_amplitude_deg",
                      fmt::format("{:.4g} degrees", flow.motion->pitch_amplitude / radians_per_degree), "up to 45 degrees",
                      "look at its unit: degrees"});
  return doubts;
}

}  // namespace spindrift::aero
