// SPDX-License-Identifier: Apache-2.0
#include "src/aero/wind_doubts.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "src/aero/wind.hpp"
#include "src/scene/angle_doubts.hpp"
#include "src/scene/columns.hpp"

namespace spindrift::aero {

namespace {

void doubt_wind(scene::Doubts& doubts, const WindOptions& wind) {
  if (wind.speed_m_s > 60.0)
    doubts.push_back({"wind.speed_m_s", fmt::format("{:.4g} m/s", wind.speed_m_s),
                      "up to 60 m/s, the gusts of the strongest class (IEC 61400-1)",
                      "look at its unit: m/s, not km/h or knots"});
  if (wind.law != WindLaw::uniform && *wind.reference_height_m < 5.0)
    doubts.push_back({"wind.reference_height_m", fmt::format("{:.4g} m", *wind.reference_height_m),
                      "5 m or more: 10 m of weather reports, or the hub's height", "look at its unit: m"});
  if (constexpr double most = 300.0; wind.law != WindLaw::uniform && *wind.reference_height_m > most)
    doubts.push_back({"wind.reference_height_m", fmt::format("{:.4g} m", *wind.reference_height_m),
                      fmt::format("up to {:g} m: the laws hold in the lowest few hundred metres", most), "look at its unit: m"});
  if (wind.law == WindLaw::power && (wind.shear_exponent < 0.0 || wind.shear_exponent > 0.6))
    doubts.push_back({"wind.shear_exponent", fmt::format("{:.4g}", wind.shear_exponent),
                      "0 to 0.6: .14 at sea, .2 on land (IEC 61400-3, 61400-1)",
                      "look at its sign and the point; a wind that falls with height is rare"});
  if (!wind.turbulence || wind.turbulence->model != TurbulenceModel::kaimal) return;
  const TurbulenceOptions& t = *wind.turbulence;
  if (t.reference_intensity > 0.3)
    doubts.push_back({"wind.turbulence.reference_intensity", fmt::format("{:.4g}", t.reference_intensity),
                      "up to 0.3: .12 to .16 by class (IEC 61400-1)", "it is a share, not per cent"});
  if (constexpr double least = 0.02; t.sigma_m_s && *t.sigma_m_s < least * wind.speed_m_s)
    doubts.push_back({"wind.turbulence.sigma_m_s",
                      fmt::format("{:.4g} m/s in a wind of {:.4g} m/s", *t.sigma_m_s, wind.speed_m_s),
                      fmt::format("{:g} of the wind or more: 0.04 to 0.2 outdoors", least), "it is in m/s, not a share"});
  if (t.sigma_m_s && wind.speed_m_s > 0.0 && *t.sigma_m_s > 0.5 * wind.speed_m_s)
    doubts.push_back({"wind.turbulence.sigma_m_s",
                      fmt::format("{:.4g} m/s in a wind of {:.4g} m/s", *t.sigma_m_s, wind.speed_m_s), "up to half the wind",
                      "it is in m/s, not a share or per cent"});
}

/// Cyclones of the class T gust to 1.4 * 57 m/s in 50 years (IEC 61400-1 ed. 4). The coherent gust rises by 15 m/s in 10 s,
/// squalls and downbursts by twice that within minutes.
constexpr double most_gust = 80.0, most_rise = 30.0, quick_s = 60.0;

void doubt_step_of_wind(scene::Doubts& doubts, const WindOptions& wind) {
  const WindEventOptions& e = *wind.event;
  const double change = e.speed_change_m_s, then = wind.speed_m_s + change;
  const std::string key = "wind.event.speed_change_m_s",
                    what = fmt::format("{:.4g} m/s on a wind of {:.4g} m/s, {:.4g} m/s then", change, wind.speed_m_s, then);
  if (then > most_gust)
    doubts.push_back({key, what, fmt::format("gusts up to {:g} m/s, of cyclones (IEC 61400-1, class T)", most_gust),
                      "it is added to the wind; look at its unit: m/s"});
  else if (then < 0.0)
    doubts.push_back({key, what, "a wind that does not blow backwards",
                      "it is added to the wind; look at its sign, or take direction_change_deg"});
  else if (std::abs(change) > most_rise && (e.what == WindEvent::step || e.duration_s < quick_s))
    doubts.push_back({key, what + (e.what == WindEvent::step ? ", at once" : fmt::format(", in {:.4g} s", e.duration_s)),
                      fmt::format("up to {:g} m/s within {:g} s: the coherent gust of IEC 61400-1 has 15", most_rise, quick_s),
                      "it is added to the wind and does not take its place; look at its unit: m/s"});
}

/// Events of IEC 61400-1 are made of the class of the turbine: V_ref of 37.5 to 57 m/s, I_ref of .12 to .18.
void doubt_class_of_event(scene::Doubts& doubts, const WindOptions& wind) {
  const WindEventOptions& e = *wind.event;
  if (e.what == WindEvent::eog && (e.reference_wind_m_s < 30.0 || e.reference_wind_m_s > 60.0))
    doubts.push_back({"wind.event.reference_wind_m_s", fmt::format("{:.4g} m/s", e.reference_wind_m_s),
                      "30 to 60 m/s: 50, 42.5 or 37.5 by class, 57 where cyclones pass (IEC 61400-1)",
                      "it is V_ref of the turbine's class, not the wind of the run"});
  if (e.reference_intensity > 0.3)
    doubts.push_back({"wind.event.reference_intensity", fmt::format("{:.4g}", e.reference_intensity),
                      "up to 0.3: .12 to .18 by class (IEC 61400-1)", "it is a share, not per cent"});
}

/// Directions of a table all of which are round numbers of degrees, given in radians.
void doubt_table_of_directions(scene::Doubts& doubts, const WindOptions& wind) {
  const scene::Columns file = scene::read_columns(wind.table);
  if (!file.has("direction_deg")) return;
  double largest = 0.0;
  for (const double angle : file["direction_deg"]) {
    if (angle != 0.0 && !scene::looks_like_radians(angle)) return;
    if (std::abs(angle) > std::abs(largest)) largest = angle;
  }
  if (largest != 0.0) doubts.push_back(scene::doubt_of_angle("wind.table", largest));
}

/// Of a table and of events; that with which they begin is told by doubt_wind.
void doubt_changes(scene::Doubts& doubts, const WindOptions& wind) {
  if (const double most = wind.table.empty() ? 0.0 : greatest_speed(wind); most > most_gust)
    doubts.push_back({"wind.table", fmt::format("a wind of up to {:.4g} m/s", most),
                      fmt::format("gusts up to {:g} m/s, of cyclones (IEC 61400-1, class T)", most_gust),
                      "look at the unit of its speed_m_s: not km/h or knots"});
  if (!wind.table.empty()) doubt_table_of_directions(doubts, wind);
  if (!wind.event) return;
  if (wind.event->what == WindEvent::step || wind.event->what == WindEvent::ramp)
    doubt_step_of_wind(doubts, wind);
  else
    doubt_class_of_event(doubts, wind);
}

/// A box of turbulence whose planes or points are too far apart to change over the rotor.
void doubt_box(scene::Doubts& doubts, const WindOptions& wind, double radius) {
  if (!wind.turbulence || wind.turbulence->model != TurbulenceModel::kaimal || radius <= 0.0) return;
  const TurbulenceOptions& t = *wind.turbulence;
  constexpr double most_step = 1.0, most_gap = 1.2, round = 2.2;  // radii
  if (const double way = t.step_s * wind.speed_m_s; way > most_step * radius)
    doubts.push_back({"wind.turbulence.step_s", fmt::format("{:.4g} s, in which the wind goes {:.4g} m", t.step_s, way),
                      fmt::format("up to {:.4g} m, the blades' length", most_step * radius), "look at its unit: s"});
  for (const auto& [key, points] : {std::pair{"points_across", t.points_across}, std::pair{"points_up", t.points_up}})
    if (const double gap = t.width_m.value_or(round * radius) / (points - 1); gap > most_gap * radius)
      doubts.push_back({std::string("wind.turbulence.") + key, fmt::format("{}, {:.4g} m apart", points, gap),
                        fmt::format("up to {:.4g} m apart, {:g} of the blades' length", most_gap * radius, most_gap),
                        "all of the rotor meets the same wind; take more"});
}

void doubt_roughness(scene::Doubts& doubts, const WindOptions& wind) {
  if (constexpr double most = 0.03; wind.law == WindLaw::logarithmic && wind.roughness_m > most)
    doubts.push_back({"wind.roughness_m", fmt::format("{:.4g} m over water", wind.roughness_m),
                      fmt::format("up to {:g} m: 0.0001 in calm to 0.01 in storm (DNV-RP-C205, table 2-1)", most),
                      "look at its unit: m, not mm"});
}

}  // namespace

scene::Doubts wind_doubts(const WindOptions& wind, double radius, bool over_water) {
  scene::Doubts doubts;
  doubt_wind(doubts, wind);
  doubt_changes(doubts, wind);
  doubt_box(doubts, wind, radius);
  if (over_water) doubt_roughness(doubts, wind);
  return doubts;
}

}  // namespace spindrift::aero
