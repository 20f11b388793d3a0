// SPDX-License-Identifier: Apache-2.0
#include "src/aero/wind_options.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kernels/base/constants.hpp"
#include "src/scene/section.hpp"

namespace spindrift::aero {

namespace {

void check_wind(const WindOptions& o, const scene::Report& report) {
  if (o.turbulence && o.turbulence->model == TurbulenceModel::bts) {
    if (o.law != WindLaw::uniform) report("profile", "has no effect: the shear of a .bts file is in the file");
    if (o.event || !o.table.empty()) report(o.event ? "event" : "table", "has no effect: a .bts file has the whole wind in it");
  }
  if (o.law == WindLaw::uniform) return;
  if (!o.reference_height_m)
    return report("reference_height_m", "must be given: a profile has speed_m_s at one height, the hub's say");
  if (o.least_height_m > *o.reference_height_m)
    report("least_height_m",
           fmt::format("= {} must not be above reference_height_m = {}", o.least_height_m, *o.reference_height_m));
  if (o.law == WindLaw::logarithmic && !(o.roughness_m < o.least_height_m))
    report("roughness_m", fmt::format("= {} must be below least_height_m = {}: the logarithmic law is zero at the roughness",
                                      o.roughness_m, o.least_height_m));
}

const scene::Section<WindEventOptions>& wind_event_section() {
  const std::vector<std::string> plain{"step", "ramp"}, by_class{"eog", "edc", "ews_vertical", "ews_horizontal"};
  static const auto section =
      scene::Section<WindEventOptions>("event", "A change of the wind, the same for the whole rotor but for the shears.")
          .choice("what", &WindEventOptions::what,
                  {{"step", WindEvent::step, "speed and direction change at once"},
                   {"ramp", WindEvent::ramp, "they change in a straight line over duration_s"},
                   {"eog", WindEvent::eog, "extreme operating gust of IEC 61400-1"},
                   {"ecd", WindEvent::ecd, "extreme coherent gust with change of direction"},
                   {"edc", WindEvent::edc, "extreme change of direction"},
                   {"ews_vertical", WindEvent::ews_vertical, "extreme shear over height"},
                   {"ews_horizontal", WindEvent::ews_horizontal, "extreme shear sideways"}},
                  "Which.")
          .required()
          .number("start_s", &WindEventOptions::start_s, "s", "When it begins.", scene::not_negative())
          .number("speed_change_m_s", &WindEventOptions::speed_change_m_s, "m/s", "Change of the speed.",
                  scene::between(-200.0, 200.0))
          .only_if("what", plain)
          .degrees("direction_change_deg", &WindEventOptions::direction_change, "Change of the direction.",
                   scene::between(-180.0, 180.0))
          .only_if("what", plain)
          .number("duration_s", &WindEventOptions::duration_s, "s", "Length of the ramp.", scene::positive())
          .only_if("what", {"ramp"})
          .number("reference_wind_m_s", &WindEventOptions::reference_wind_m_s, "m/s",
                  "V_ref of the wind turbine class: 50, 42.5 or 37.5.", scene::between(10.0, 100.0))
          .only_if("what", {"eog"})
          .number("reference_intensity", &WindEventOptions::reference_intensity, "-",
                  "I_ref of the turbulence category: .16 (A), .14 (B), .12 (C).", scene::between(0.01, 1.0))
          .only_if("what", by_class)
          .flag("reversed", &WindEventOptions::reversed, "Direction or shear the other way.")
          .only_if("what", {"ecd", "edc", "ews_vertical", "ews_horizontal"});
  return section;
}

void check_turbulence(const TurbulenceOptions& o, const scene::Report& report) {
  if (o.model == TurbulenceModel::mann)
    for (double n : o.points)
      if (n != std::floor(n) || n < 2.0) return report("points", fmt::format("{} is not a number of points", n));
  if (o.model != TurbulenceModel::kaimal) return;
  if (!(o.duration_s >= 10.0 * o.step_s)) return report("duration_s", "must be many steps");
  // Each frequency has a matrix over all points to factor; each point and plane has some 40 bytes.
  constexpr double most_work = 1e13, most_values = 1e8;
  const double points = double(o.points_across) * double(o.points_up), planes = o.duration_s / o.step_s;
  if (points * planes > most_values || planes * std::pow(points, 3) / 6.0 > most_work)
    report("duration_s", fmt::format("a box of {} x {} points and {:.3g} planes (duration_s / step_s) is more than can be made: "
                                     "take fewer points_across and points_up, a longer step_s, or a box from a file",
                                     o.points_across, o.points_up, planes));
}

const scene::Section<TurbulenceOptions>& turbulence_section() {
  const std::vector<std::string> kaimal{"kaimal"}, mann{"mann"};
  static const auto section =
      scene::Section<TurbulenceOptions>("turbulence", "A box of turbulent wind that blows past the rotor.")
          .choice("model", &TurbulenceOptions::model,
                  {{"kaimal", TurbulenceModel::kaimal, "made here, with Kaimal's spectra and IEC's coherence (Veers)"},
                   {"bts", TurbulenceModel::bts, "TurbSim's full-field file, mean wind and shear included"},
                   {"mann", TurbulenceModel::mann,
                    "three binaries of a Mann box as OpenFAST reads them, the first plane first and each from left to right, "
                    "added to the wind"}},
                  "Where it comes from.")
          .path("file", &TurbulenceOptions::file, "The .bts file.")
          .only_if("model", {"bts"})
          .required()
          .path("files", &TurbulenceOptions::files, "Files of u, v, w.")
          .only_if("model", mann)
          .required()
          .size(3, 3)
          .vector("points", &TurbulenceOptions::points, "-", "Points of the Mann box along, across, up.",
                  scene::between(0.0, 1e6))
          .only_if("model", mann)
          .required()
          .vector("spacing_m", &TurbulenceOptions::spacing_m, "m", "Distance between them.", scene::positive())
          .only_if("model", mann)
          .required()
          .number("start_s", &TurbulenceOptions::start_s, "s", "Time in the box at t = 0.", scene::not_negative())
          .integer("seed", &TurbulenceOptions::seed, "-", "The same seed gives the same wind on every computer.",
                   scene::not_negative())
          .only_if("model", kaimal)
          .number("reference_intensity", &TurbulenceOptions::reference_intensity, "-",
                  "I_ref of IEC 61400-1: .16 (A), .14 (B), .12 (C).", scene::between(0.001, 1.0))
          .only_if("model", kaimal)
          .flag("extreme", &TurbulenceOptions::extreme, "Extreme instead of normal turbulence model (ETM, NTM).")
          .only_if("model", kaimal)
          .number("reference_wind_m_s", &TurbulenceOptions::reference_wind_m_s, "m/s", "V_ref, for the extreme model.",
                  scene::between(10.0, 100.0))
          .only_if("model", kaimal)
          .only_if("extreme", {"true"})
          .number("sigma_m_s", &TurbulenceOptions::sigma_m_s, "m/s",
                  "Standard deviation along the wind, instead of that of the intensity.", scene::above(0.0).up_to(100.0))
          .only_if("model", kaimal)
          .integer("points_across", &TurbulenceOptions::points_across, "-", "Points of the box across the wind.",
                   scene::between(2, 100))
          .only_if("model", kaimal)
          .integer("points_up", &TurbulenceOptions::points_up, "-", "Points upwards.", scene::between(2, 100))
          .only_if("model", kaimal)
          .number("width_m", &TurbulenceOptions::width_m, "m", "Width and height of the box; 1.1 diameters where absent.",
                  scene::positive())
          .only_if("model", kaimal)
          .number("duration_s", &TurbulenceOptions::duration_s, "s", "Length of the box; then it repeats.", scene::positive())
          .only_if("model", kaimal)
          .number("step_s", &TurbulenceOptions::step_s, "s", "Time between its planes.", scene::positive())
          .only_if("model", kaimal)
          .number(
              "inflow_plane_m", &TurbulenceOptions::inflow_plane_m, "m",
              "Resolved air: how far upwind of the hub forces on a plane bring the turbulence in; without it a rotor's diameter.",
              scene::above(0.0).up_to(1e5))
          .check(check_turbulence);
  return section;
}

}  // namespace

const scene::Section<WindOptions>& wind_section() {
  const std::vector<std::string> sheared{"power_law", "logarithmic"};
  static const auto section =
      scene::Section<WindOptions>("wind", "The undisturbed wind, over height and time.")
          .number("speed_m_s", &WindOptions::speed_m_s, "m/s", "Wind speed; with a profile, at reference_height_m.",
                  scene::between(0.0, 300.0))
          .degrees("direction_deg", &WindOptions::direction, "Where it blows to: 0 along +x, positive towards +y.",
                   scene::between(-360.0, 360.0))
          .choice("profile", &WindOptions::law,
                  {{"uniform", WindLaw::uniform, "the same at every height"},
                   {"power_law", WindLaw::power, "speed_m_s times (z / reference_height_m)^shear_exponent"},
                   {"logarithmic", WindLaw::logarithmic,
                    "speed_m_s times ln(z / roughness_m) / ln(reference_height_m / roughness_m)"}},
                  "Speed over the height z above still water.")
          .number("reference_height_m", &WindOptions::reference_height_m, "m",
                  "Height above still water at which the wind has speed_m_s.", scene::above(0.0).up_to(1e4))
          .only_if("profile", sheared)
          .number("shear_exponent", &WindOptions::shear_exponent, "-",
                  "Of the power law: .14 at sea, .2 on land (IEC 61400-3, 61400-1).", scene::between(-1.0, 1.0))
          .only_if("profile", {"power_law"})
          .number("roughness_m", &WindOptions::roughness_m, "m", "Of the surface, for the logarithmic law; 0.0002 for open sea.",
                  scene::between(1e-6, 10.0))
          .only_if("profile", {"logarithmic"})
          .number(
              "least_height_m", &WindOptions::least_height_m, "m",
              "Below this height, and below the water, which the grid of the air does not know, the wind is as at this height.",
              scene::above(0.0).up_to(1e4))
          .only_if("profile", sheared)
          .path("table", &WindOptions::table,
                "CSV file with time_s, speed_m_s and, if any, direction_deg, vertical_m_s, joined by straight lines: takes the "
                "place of speed_m_s and, where it has directions, direction_deg, which are its first row.")
          .table("event", &WindOptions::event, wind_event_section(), "A gust or another change.")
          .table("turbulence", &WindOptions::turbulence, turbulence_section(), "Turbulence.")
          .at_most_one_of({"table", "event"})
          .check(check_wind);
  return section;
}

}  // namespace spindrift::aero
