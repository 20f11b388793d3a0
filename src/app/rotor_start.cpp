// SPDX-License-Identifier: Apache-2.0
#include "src/app/rotor_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/base/interpolation.hpp"
#include "src/aero/operation.hpp"
#include "src/aero/wind.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/rotor_doubts.hpp"

namespace spindrift::app {

namespace {

struct Working {
  double wind;                       ///< undisturbed, at the hub [m/s]
  double speed;                      ///< [rad/s]
  std::optional<double> pitch;       ///< [rad]
  double radius;                     ///< [m]; 0 where the scene does not say
  std::string load_by;               ///< "blade elements"; empty: there is no load
  double thrust = 0.0, power = 0.0;  ///< [N], [W]
  bool has_power = false;            ///< it turns
};

std::string load_model(const coupling::Scenario& s) {
  if (s.resolves_air() || s.aero.model == "bem") return "blade elements";
  return s.aero.model == "thrust_curve" ? "the thrust curve" : "as prescribed";
}

/// "Rotor", or of [rotors.a] "Rotor a".
std::string heading(const coupling::Scenario& s) {
  return s.rotors.empty() ? "Rotor" : "Rotor " + s.rotor_section.substr(s.rotor_section.find('.') + 1);
}

std::string of_table(const aero::Operation& table, const Working& now, bool compares) {
  const aero::OperatingPoint point = table.at(now.wind);
  std::string text = fmt::format("{:.4g} rpm", point.speed / rad_s_per_rpm);
  if (!table.pitch.empty()) text += fmt::format(", blades at {:.4g} degrees", point.pitch / radians_per_degree);
  if (table.power.empty()) return text;
  const double power = interpolate_linear(table.wind, table.power, now.wind), rated = *std::ranges::max_element(table.power);
  const std::size_t first =
      std::size_t(std::ranges::find_if(table.power, [&](double p) { return p > 0.995 * rated; }) - table.power.begin());
  text += fmt::format(", {:.4g} MW", 1e-6 * power);
  if (compares && power > 0.0) text += fmt::format(", of which the start has {:.0f} %", 100.0 * now.power / power);
  return text + fmt::format("; rated {:.4g} MW from {:.4g} m/s on", 1e-6 * rated, table.wind[first]);
}

void print(const coupling::Scenario& s, const Working& now) {
  fmt::print("\n{} at the start\n  {:<22}{:.4g} rpm", heading(s), "speed", now.speed / rad_s_per_rpm);
  if (now.pitch) fmt::print(", blades at {:.4g} degrees", *now.pitch / radians_per_degree);
  const bool blown = s.aero.model != "prescribed" && now.wind > 0.0;
  if (blown) fmt::print(", wind of {:.4g} m/s at the hub", now.wind);
  const bool alike = blown && now.radius > 0.0 && !s.wind.turbulence;  // a gust at the hub is not the wind of the disc
  if (alike) fmt::print(", tip-speed ratio {:.3g}", std::abs(now.speed) * now.radius / now.wind);
  fmt::print("\n");
  if (!now.load_by.empty()) {
    fmt::print("  {:<22}thrust {:.4g} kN", now.load_by, 1e-3 * now.thrust);
    if (now.has_power) fmt::print(", power {:.4g} MW", 1e-6 * now.power);
    if (alike) {
      const double pressure = 0.5 * s.environment.air_density_kg_m3 * now.wind * now.wind * pi * now.radius * now.radius;
      fmt::print("; CT {:.3f}", now.thrust / pressure);
      if (now.has_power) fmt::print(", CP {:.3f}", now.power / (pressure * now.wind));
    }
    fmt::print("\n");
  }
  if (blown && !s.rotor.operation.empty())
    fmt::print("  {:<22}{}\n", "operating table",
               of_table(aero::read_operation(s.rotor.operation), now, now.has_power && !s.wind.turbulence));
}

/// `s`: the scene with this rotor alone.
void print_at_start(const coupling::Scenario& s, const aero::RotorLoads& rotor, const coupling::Start& start) {
  const aero::RotorState state = rotor.state(0.0, start.state.motions);
  const aero::RotorLoad load = rotor.load(0.0, state);
  Working now{.wind = rotor.wind().at(0.0, state.hub).norm(),
              .speed = state.speed,
              .pitch = {},
              .radius = coupling::rotor_radius(s),
              .load_by = load_model(s),
              .thrust = load.thrust,
              .power = load.power,
              .has_power = load.torque != 0.0 && state.speed != 0.0};
  const bool parked = s.is_controlled() && s.control.start == aero::ControlStart::parked;
  if (load_model(s) == "blade elements" && !parked) now.pitch = s.rotor.blade_pitch;
  const aero::PeakShaving* shaving = rotor.shaving();
  if (shaving && now.pitch)
    now.pitch = std::max(
        *now.pitch, shaving->least_pitch(aero::relative_wind(rotor.wind(), 0.0, state.hub, Eigen::Vector3d::Zero(), state.axis)));
  print(s, now);
  if (shaving)
    fmt::print(
        "  {:<22}steady thrust up to {:.4g} kN, {:g} of the {:.4g} kN that it would have at {:.4g} m/s; from {:.3g} to {:.3g} "
        "m/s blades are pitched farther, by up to {:.3g} degrees\n",
        "peak shaving", 1e-3 * shaving->limit, *s.control.peak_shaving, 1e-3 * shaving->largest, shaving->largest_at,
        shaving->from, shaving->to, shaving->farthest / radians_per_degree);
}

}  // namespace

void print_rotors_at_start(coupling::FloatingSystem& floating, const coupling::Start& start) {
  const coupling::FullLoads full(floating);
  const std::vector<coupling::Scenario> each = coupling::by_rotor(floating.scenario());
  for (std::size_t n = 0; n < each.size(); ++n) print_at_start(each[n], floating.rotors()[n].loads, start);
}

void print_rotor_at_start(const coupling::Scenario& s) {
  const aero::RotorOptions rotor = coupling::placed_rotor(s).rotor;
  const aero::Wind wind = aero::wind_of(s.wind, coupling::wind_site(s));
  Working now{.wind = wind.at(0.0, rotor.hub_m).norm(),
              .speed = rotor.speed,
              .pitch = rotor.blade_pitch,
              .radius = coupling::rotor_radius(s),
              .load_by = {},
              .has_power = rotor.speed != 0.0};
  if (const std::optional<aero::RotorLoad> load = coupling::standing_rotor_load(s))
    now.load_by = "blade elements", now.thrust = load->thrust, now.power = load->power;
  print(s, now);
}

}  // namespace spindrift::app
