// SPDX-License-Identifier: Apache-2.0
#include "src/aero/turbine_doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/base/interpolation.hpp"
#include "src/aero/blade_roots.hpp"
#include "src/aero/operation.hpp"
#include "src/aero/turbine.hpp"
#include "src/scene/angle_doubts.hpp"
#include "src/scene/columns.hpp"
#include "src/scene/document.hpp"

namespace spindrift::aero {

namespace {

struct Span {
  double least, greatest;
  explicit Span(const std::vector<double>& values, double scale = 1.0)
      : least(scale * *std::ranges::min_element(values)), greatest(scale * *std::ranges::max_element(values)) {}
  double size() const { return std::max(std::abs(least), std::abs(greatest)); }
};

std::string from_to(const Span& range, const char* unit) {
  return fmt::format("from {:.4g} to {:.4g}{}", range.least, range.greatest, unit);
}

/// Blades of 1 kW to 22 MW have their greatest chord at 5 to 20 % of the radius.
void doubt_chord(scene::Doubts& doubts, const std::string& at, const Planform& p) {
  const Span chord(p.chord);
  const double radius = p.span.back(), share = chord.greatest / radius;
  if (share > 0.4)
    doubts.push_back({at + ".chord_m", fmt::format("{} for a rotor of {:.4g} m radius", from_to(chord, " m"), radius),
                      "a greatest chord of 2 to 40 % of the radius",
                      share > 10.0 ? "in mm? give m" : "look at the unit of the chord and of the span: m"});
  else if (share < 0.02)
    doubts.push_back({at + ".chord_m", fmt::format("{} for a rotor of {:.4g} m radius", from_to(chord, " m"), radius),
                      "a greatest chord of 2 to 40 % of the radius",
                      chord.greatest < 0.4 ? "as a share of the radius? give m" : "look at the unit of the span: m, not mm"});
}

/// Twist falls from the root to the tip by 5 to 25 degrees, for the wind of its own turning grows outward.
void doubt_twist(scene::Doubts& doubts, const std::string& at, const Planform& p) {
  const Span twist(p.twist, 1.0 / radians_per_degree);
  if (const double change = twist.greatest - twist.least; change > 0.0 && twist.size() < 0.55)
    doubts.push_back({at + ".twist_deg", from_to(twist, " degrees"), "a change by 5 to 25 degrees along the blade",
                      "in radians? give degrees"});
  else if (twist.size() > 60.0)
    doubts.push_back({at + ".twist_deg", from_to(twist, " degrees"), "up to 60 degrees", "look at its unit: degrees"});
  else if (const double rise = (p.twist.back() - p.twist.front()) / radians_per_degree; rise > 3.0)
    doubts.push_back({at + ".twist_deg", fmt::format("rises by {:.4g} degrees from the root to the tip", rise),
                      "a twist that falls to the tip: the nose turned into the wind is positive", "turn its sign"});
}

void doubt_thickness(scene::Doubts& doubts, const std::string& at, const Turbine& turbine) {
  const Planform& p = turbine.planform;
  if (p.thickness.empty()) return;
  const Span thickness(p.thickness, 100.0);
  const auto tell = [&](const std::string& rule, const char* advice) {
    doubts.push_back({at + ".thickness_pct", from_to(thickness, " %"), rule, advice});
  };
  if (thickness.greatest <= 1.5) return tell("6 to 100 % of the chord", "as a share? give per cent");
  if (thickness.greatest > 100.5) return tell("6 to 100 % of the chord", "of the chord, in per cent, not in m or mm");
  if (!p.polar.empty()) return;
  constexpr double aside = 0.15;  // of the thickness: the nearest polar is taken
  const double thinnest = 100.0 * turbine.polars.front().place, thickest = 100.0 * turbine.polars.back().place;
  if (thickness.least < (1.0 - aside) * thinnest || thickness.greatest > (1.0 + aside) * thickest)
    tell(fmt::format("within the polars, which go from {:.4g} to {:.4g} %", thinnest, thickest),
         "beyond them the nearest polar holds: give polars there");
}

/// Size and bend of the blade.
void doubt_span(scene::Doubts& doubts, const std::string& at, const Planform& p) {
  const double radius = p.span.back();
  if (radius > 200.0)
    doubts.push_back({at + ".span_m", fmt::format("{:.4g} m at the tip", radius), "up to 200 m", "look at its unit: m"});
  for (const auto& [name, values] : {std::pair{".prebend_m", &p.prebend}, std::pair{".sweep_m", &p.sweep}})
    if (const Span range(*values); range.size() > 0.2 * radius)
      doubts.push_back({at + name, fmt::format("{} on a blade of {:.4g} m", from_to(range, " m"), radius),
                        "up to a fifth of its length", "look at its unit: m"});
  if (constexpr double most = 0.01; p.prebend.back() > most * radius)
    doubts.push_back({at + ".prebend_m", fmt::format("the tip {:.4g} m downwind", p.prebend.back()),
                      fmt::format("up to {:g} of the length: blades are bent upwind, away from the tower", most),
                      "turn its sign"});
}

/// Lift rises with the angle of attack: by 2 pi per radian of a thin section, by less of a thick one, which may even lose lift.
void doubt_polars(scene::Doubts& doubts, const TurbineOptions& options) {
  for (std::size_t n = 0; n < options.polars.size(); ++n) {
    const PolarOptions& polar = options.polars[n];
    const scene::Columns file = scene::read_columns(polar.file);
    const auto alpha = file["alpha_deg"], cl = file["cl"], cd = file["cd"];
    const std::string key = fmt::format("turbine.polars[{}].file", n), name = std::filesystem::path(polar.file).filename();
    const double lift = Span({cl.begin(), cl.end()}).size(), drag = Span({cd.begin(), cd.end()}).size();
    if (lift > 4.0 || drag > 4.0)
      doubts.push_back({key, fmt::format("{} has cl up to {:.4g} and cd up to {:.4g}", name, lift, drag), "up to 2.5",
                        "coefficients have no unit; look at the point"});
    if (!polar.thickness_pct || *polar.thickness_pct > 40.0) continue;
    const auto at = [&](std::span<const double> y, double x) {
      const auto above = std::size_t(std::ranges::upper_bound(alpha, x) - alpha.begin());
      const double share = (x - alpha[above - 1]) / (alpha[above] - alpha[above - 1]);
      return (1.0 - share) * y[above - 1] + share * y[above];
    };
    if (const double slope = (at(cl, 4.0) - at(cl, -4.0)) / (8.0 * radians_per_degree); slope < 1.0 && lift > 0.1)
      doubts.push_back({key,
                        fmt::format("{}: lift {} {:.3g} per radian round no angle of attack", name,
                                    slope < 0.0 ? "falls by" : "rises by only", std::abs(slope)),
                        "about 2 pi per radian", "look at the signs of cl and alpha_deg, and whether cl and cd are exchanged"});
  }
}

}  // namespace

/// Blades weigh about 0.4948 R^2.53 kg (Fingersh, Hand & Laxson 2006, NREL/TP-500-40566): those of the NREL 5 MW and the DTU 10
/// MW within 3 %, old and small ones up to three times that.
scene::Doubts blade_mass_doubts(const std::string& key, const Turbine& turbine, const BladeMasses& masses) {
  constexpr double factor = 0.4948, power = 2.53, least = 0.1, most = 10.0;
  double mass = 0.0;
  for (std::size_t n = 1; n < masses.span.size(); ++n)
    mass += 0.5 * (masses.mass[n - 1] + masses.mass[n]) * (masses.span[n] - masses.span[n - 1]);
  const double radius = turbine.planform.span.back(), usual = factor * std::pow(radius, power);
  if (mass >= least * usual && mass <= most * usual) return {};
  return {{key, fmt::format("blades of {:.4g} kg and {:.4g} m", mass, radius),
           fmt::format("{:.3g} to {:.3g} kg for that length", least * usual, most * usual),
           "look at the unit of mass_kg_m: kg/m"}};
}

/// A rotor that takes the most power has at 0.7 of its radius chords near 16 pi R / (9 B CL lambda^2 0.7), Betz's (Hau 2013,
/// section 5.3), with a lift coefficient CL about 1: the DTU 10 MW .87 of that, the NREL 5 MW 1.03.
scene::Doubts chord_doubts(const std::string& turbine, const std::string& operation) {
  constexpr double place = 0.7, least = 0.6, most = 1.5;
  const Operation table = read_operation(operation);
  const Turbine rotor = read_turbine(turbine);
  const Planform& p = rotor.planform;
  if (table.power.empty() || p.span.size() < 2) return {};
  const double radius = p.span.back();
  std::size_t best = table.wind.size();
  double coefficient = 0.0;
  for (std::size_t n = 0; n < table.wind.size(); ++n)
    if (const double c = table.wind[n] > 0.0 ? table.power[n] / std::pow(table.wind[n], 3) : 0.0; c > coefficient)
      best = n, coefficient = c;
  if (best == table.wind.size() || table.speed[best] <= 0.0) return {};
  const double ratio = table.speed[best] * radius / table.wind[best];
  const double chord = interpolate_linear(p.span, p.chord, place * radius);
  const double betz = 16.0 * pi * radius / (9.0 * rotor.blades * ratio * ratio * place);
  if (chord >= least * betz && chord <= most * betz) return {};
  const std::string planform = scene::load(turbine).read(turbine_section()).planform;
  return {{std::filesystem::path(planform).filename().string() + ".chord_m",
           fmt::format("{:.4g} m at {:g} of the radius, with {} blades at a tip-speed ratio of {:.3g}", chord, place,
                       rotor.blades, ratio),
           fmt::format("{:.3g} to {:.3g} m there, {:g} to {:g} times Betz's chord of a lift coefficient of 1", least * betz,
                       most * betz, least, most),
           "look at the chords, halved or doubled?, at the number of blades and at the operating table"}};
}

scene::Doubts turbine_doubts(const std::string& path) {
  scene::Doubts doubts;
  const Turbine turbine = read_turbine(path);
  scene::Document file = scene::load(path);
  const TurbineOptions options = file.read(turbine_section());
  const std::string at = std::filesystem::path(options.planform).filename();
  doubt_chord(doubts, at, turbine.planform);
  doubt_twist(doubts, at, turbine.planform);
  doubt_thickness(doubts, at, turbine);
  doubt_span(doubts, at, turbine.planform);
  doubt_polars(doubts, options);
  if (constexpr double most = 15.0; std::abs(options.precone) > most * radians_per_degree)
    doubts.push_back({"turbine.precone_deg", fmt::format("{:.4g} degrees", options.precone / radians_per_degree),
                      fmt::format("up to {:g} degrees: turbines have 2 to 5", most), "look at its unit: degrees"});
  if (scene::looks_like_radians(options.precone / radians_per_degree))
    doubts.push_back(scene::doubt_of_angle("turbine.precone_deg", options.precone / radians_per_degree));
  return doubts;
}

}  // namespace spindrift::aero
