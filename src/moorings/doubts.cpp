// SPDX-License-Identifier: Apache-2.0
#include "src/moorings/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernels/base/constants.hpp"
#include "kernels/base/interpolation.hpp"
#include "kernels/mooring/bed.hpp"
#include "kernels/mooring/line_catenary.hpp"
#include "kernels/mooring/line_spring_damper.hpp"
#include "src/moorings/composite.hpp"
#include "src/moorings/model.hpp"
#include "src/moorings/table_file.hpp"

namespace spindrift::moorings {

namespace {

bool hangs(const LineOptions& line) { return line_models().named(line.model).hangs; }

/// To an anchor under water, more steeply than the level lines by which models are held from the walls of a tank.
bool goes_down(const LineOptions& line) {
  constexpr double least = 0.05;  // of the distance of the ends
  return line.anchor_m->z() < 0.0 && line.span().z() > least * line.span().norm();
}

/// From a fairlead under water, less steeply than what lowers a load.
bool comes_up(const LineOptions& line) {
  const Eigen::Vector3d along = -line.span();
  return line.fairlead_m->z() < 0.0 && along.z() > 0.0 && along.z() < along.head<2>().norm();
}

void doubt_length(scene::Doubts& doubts, const std::string& at, const LineOptions& line, double weight_N) {
  if (line.length_m() == 0.0) return;  // a table has none
  const std::string key = at + (line.sections.empty() ? ".rest_length_m" : ".sections");
  const Eigen::Vector3d along = line.span();
  const double apart = along.norm(), length = line.length_m(), round = std::hypot(along.x(), along.y()) + std::abs(along.z());
  const std::string what = fmt::format("{:.4g} m for ends {:.4g} m apart", length, apart);
  if (apart > length) {
    const double tension = line.series_stiffness_N_m() * (apart - length);
    if (tension > weight_N && weight_N > 0.0)
      doubts.push_back({key, fmt::format("{}, a tension of {:.3g} N at the start", what, tension),
                        fmt::format("a tension below the weight of all bodies, {:.3g} N", weight_N),
                        "look at the length, the stiffness and the place of the ends"});
    else if (constexpr double most = 0.03; hangs(line) && apart > (1.0 + most) * length)
      doubts.push_back({key, fmt::format("{}, stretched by {:.3g} %", what, 100.0 * (apart / length - 1.0)),
                        fmt::format("up to {:.2g} %: chain and wire break there", 100.0 * most),
                        "look at the length and the place of the ends, and at their units: m"});
  } else if (hangs(line) && length > round && line.anchor_body == "earth") {
    doubts.push_back({key, what, fmt::format("less than straight down and along the bed, {:.4g} m", round),
                      "the line hangs down and does nothing; look at the length and at the anchor"});
  } else if (!hangs(line) && length > 1.5 * apart) {
    doubts.push_back({key, what, "up to 1.5 times the distance", "the line is slack until the body has drifted far"});
  }
}

/// Chain, wire and fibre rope alike have an axial stiffness of some 10^6 m times their weight in water: studless chain 8.5e10 d^2
/// N over 1.7e5 d^2 N/m, wire rope 4e10 over 3.4e4, spiral strand 9e10 over 4.2e4, polyester 1.1e9 over 2e3, nylon 1.2e8 over 650
/// (diameters d in m; Orcina's fits to manufacturers' tables). A weight in kg/m is a tenth of that in N/m. Lines of a model basin
/// have springs in them: by Froude's law the ratio goes with the length.
void doubt_material(scene::Doubts& doubts, const std::string& at, const LineOptions& line, double weight_N_m) {
  constexpr double at_sea_m = 200.0;
  const double least = 6e4 * std::min(1.0, line.length_m() / at_sea_m), most = 3e6;
  const auto doubt = [&](const std::string& key, double weight, double stiffness) {
    if (const double ratio = stiffness / weight; ratio < least || ratio > most)
      doubts.push_back({at + key, fmt::format("{:.4g} N/m in water with an axial stiffness of {:.4g} N", weight, stiffness),
                        fmt::format("a stiffness of {:.3g} to {:g} m times the weight in water", least, most),
                        "look at the units: N/m in water, not kg/m or kN/m; N, not kN"});
  };
  if (hangs(line) && line.axial_stiffness_N)
    doubt(line.mass_kg_m == 0.0 ? ".weight_N_m" : ".mass_kg_m", weight_N_m, *line.axial_stiffness_N);
  for (std::size_t n = 0; n < line.sections.size(); ++n)
    doubt(fmt::format(".sections[{}].weight_N_m", n), line.sections[n].weight_N_m, line.sections[n].axial_stiffness_N);
}

bool is_spring(const LineOptions& line) { return line.model == LineSpringDamper::name; }

std::string stiffness_key(const LineOptions& line) { return line.stiffness_N_m ? ".stiffness_N_m" : ".axial_stiffness_N"; }

/// A spring between floating bodies and the earth, by all bodies' mass on it. Floats of any size swing in times of sqrt(size / g)
/// (Froude). Tendons, the stiffest of moorings, hold one in 1 to 2 of these, soft lines of a model test in 50. A line whose
/// length a hundredth of the weight would double holds nothing: vessels' lines have from 0.03 of their weight on.
void doubt_spring(scene::Doubts& doubts, const std::string& at, const LineOptions& line, const LineSurroundings& around) {
  if (!is_spring(line) || around.weight_N <= 0.0 || around.gravity_m_s2 <= 0.0) return;
  const double stiffness = line.series_stiffness_N_m(), mass = around.weight_N / around.gravity_m_s2;
  constexpr double most_damping = 2.0, least_damping = 2e-5, least_period = 0.3, least_share = 0.01;
  if (const double ratio = line.damping_N_s_m / (2.0 * std::sqrt(stiffness * mass)); ratio > most_damping)
    doubts.push_back({at + ".damping_N_s_m",
                      fmt::format("{:.4g} N s/m, {:.3g} of critical for all bodies on this line", line.damping_N_s_m, ratio),
                      fmt::format("up to {:g} of it", most_damping), "look at its unit: N s/m, not kN s/m or per cent"});
  else if (ratio > 0.0 && ratio < least_damping)
    doubts.push_back({at + ".damping_N_s_m",
                      fmt::format("{:.4g} N s/m, {:.2g} of critical for all bodies on this line", line.damping_N_s_m, ratio),
                      fmt::format("{:g} of it or more, or 0", least_damping), "look at its unit: N s/m, not kN s/m"});
  const auto shape = around.shapes.find(line.body);
  if (around.depth_m < 0.0 || line.anchor_body != "earth" || shape == around.shapes.end()) return;
  const double swing = std::sqrt(0.5 * shape->second.diagonal().norm() / around.gravity_m_s2);
  const std::string key = at + stiffness_key(line), what = fmt::format("a spring of {:.4g} N/m", stiffness),
                    advice = line.stiffness_N_m ? "look at its unit: N/m of the whole line, neither EA nor kN/m"
                                                : "look at its unit: N, not kN or MN, and EA of the line, not N/m";
  if (const double period = 2.0 * pi * std::sqrt(mass / stiffness); period < least_period * swing)
    doubts.push_back(
        {key, fmt::format("{}, on which all bodies swing in {:.3g} s", what, period),
         fmt::format("{:.3g} s or more, {:g} of sqrt(size / g): a tendon has more", least_period * swing, least_period), advice});
  else if (const double load = stiffness * line.length_m(); load < least_share * around.weight_N)
    doubts.push_back({key, fmt::format("{}: {:.3g} N double its length", what, load),
                      fmt::format("{:g} of the weight of all bodies, {:.3g} N, at least", least_share, around.weight_N), advice});
}

/// Lines of one mooring are alike: their axial stiffnesses, which do not go with the length, are of one order.
void doubt_unlike(scene::Doubts& doubts, const std::vector<scene::Named<LineOptions>>& lines) {
  constexpr double most = 100.0;
  for (const auto& [name, line] : lines) {
    if (!is_spring(line)) continue;
    std::vector<double> alike;
    for (const auto& [other_name, other] : lines)
      if (is_spring(other) && other.body == line.body && other.anchor_body == line.anchor_body)
        alike.push_back(other.series_stiffness_N_m() * other.length_m());
    if (alike.size() < 3) continue;
    std::ranges::sort(alike);
    const double median = alike[alike.size() / 2], own = line.series_stiffness_N_m() * line.length_m();
    if (own > most * median || own < median / most)
      doubts.push_back({"moorings." + name + stiffness_key(line),
                        fmt::format("an axial stiffness of {:.3g} N beside lines of {:.3g} N", own, median),
                        fmt::format("within {:g} times that of the body's other lines", most),
                        "look at its unit, and whether it is EA or the stiffness of the whole line"});
  }
}

/// What hangs on lines or where they meet weighs less than what the lines hold; whether this does.
bool doubt_hung(scene::Doubts& doubts, const std::string& key, double mass_kg, double volume_m3, const std::string& where,
                const LineSurroundings& around) {
  constexpr double most = 0.5;  // of the weight of all bodies
  const double hung = around.gravity_m_s2 * (mass_kg - around.water_density_kg_m3 * volume_m3);
  if (around.depth_m < 0.0 || around.weight_N <= 0.0 || std::abs(hung) <= most * around.weight_N) return true;
  doubts.push_back({key, fmt::format("{} of {:.3g} N in water{}", hung < 0.0 ? "a lift" : "a weight", std::abs(hung), where),
                    fmt::format("up to half the weight of all bodies, {:.3g} N", around.weight_N),
                    "look at volume_m3 and mass_kg, and at their units"});
  return false;
}

/// Coefficients of the water on a dynamic line: chain has 2.4 on the bar's diameter, 1.33 on that of its volume (DNV-OS-E301).
void doubt_coefficients(scene::Doubts& doubts, const std::string& at, const LineOptions& line) {
  constexpr double most = 5.0;
  for (const auto& [key, value] :
       {std::pair{".drag_coefficient", line.drag_coefficient}, std::pair{".axial_drag_coefficient", line.axial_drag_coefficient},
        std::pair{".added_mass_coefficient", line.added_mass_coefficient}})
    if (value > most)
      doubts.push_back({at + key, fmt::format("{:.4g}", value),
                        fmt::format("up to {:g} (DNV-OS-E301: chain has 1.3 to 3.2)", most),
                        "coefficients have no unit; look at the point"});
}

/// The tension of a tabulated line at the start is less than all that floats.
void doubt_table(scene::Doubts& doubts, const std::string& at, const LineOptions& line, const LineSurroundings& around) {
  if (line.table.empty() || around.weight_N <= 0.0) return;
  const TableFile table = read_line_table(line.table);
  const double apart = line.span().norm();
  if (const double tension = interpolate_linear(table.distance, table.tension, apart); tension > around.weight_N)
    doubts.push_back({at + ".table", fmt::format("a tension of {:.3g} N at the start, at {:.4g} m", tension, apart),
                      fmt::format("a tension below the weight of all bodies, {:.3g} N", around.weight_N),
                      "look at the units of the table, m and N, and at the place of the ends"});
}

/// A line at rest is lifted by all of a float, also where it would lie at the surface.
void doubt_floats(scene::Doubts& doubts, const std::string& at, const LineOptions& line, const LineSurroundings& around) {
  bool light = true;
  for (const ClumpOptions& clump : line.clumps)
    light &=
        doubt_hung(doubts, at + ".clumps", clump.mass_kg, clump.volume_m3, fmt::format(" at {:.4g} m", clump.distance_m), around);
  if (!light || line.sections.empty() || around.depth_m < 0.0) return;
  const CompositeParts parts = composite_parts(line, around.water_density_kg_m3, around.gravity_m_s2);
  const std::vector<double> heights = composite_line(parts, line).joint_heights(line.span());
  for (std::size_t joint = 0; joint < heights.size(); ++joint)
    if (const double z = line.anchor_m->z() + heights[joint]; parts.hung[joint] < 0.0 && z > 0.0)
      doubts.push_back({at + ".clumps",
                        fmt::format("the float at {:.4g} m is {:.4g} m above the surface at the start", parts.joints[joint], z),
                        "floats under water: this model has all of their lift at any height",
                        "look at volume_m3 and mass_kg, or take lumped_mass and a junction, which floats"});
}

/// Where a straight line, seen from above, is within the least convex outline round these boxes: distances from `from` along the
/// unit vector `along`; empty (the first larger) where it passes beside. Such an outline meets the line where chords between
/// corners on its two sides do.
std::pair<double, double> crossing(const std::vector<Eigen::AlignedBox3d>& boxes, const Eigen::Vector2d& from,
                                   const Eigen::Vector2d& along) {
  std::vector<Eigen::Vector2d> left, right;  // (distance along the line, distance aside of it)
  for (const Eigen::AlignedBox3d& box : boxes)
    for (const double x : {box.min().x(), box.max().x()})
      for (const double y : {box.min().y(), box.max().y()}) {
        const Eigen::Vector2d off = Eigen::Vector2d(x, y) - from;
        const double aside = along.x() * off.y() - along.y() * off.x();
        (aside > 0.0 ? left : right).emplace_back(off.dot(along), std::abs(aside));
      }
  std::pair<double, double> within{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Eigen::Vector2d& a : left)
    for (const Eigen::Vector2d& b : right) {
      const double share = a.y() / (a.y() + b.y()), place = a.x() + share * (b.x() - a.x());
      within.first = std::min(within.first, place), within.second = std::max(within.second, place);
    }
  return within;
}

/// In plan, of all fairleads of the body.
Eigen::Vector3d mean_fairlead(const std::vector<scene::Named<LineOptions>>& lines, const std::string& body) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const auto& [name, line] : lines)
    if (line.body == body) sum += *line.fairlead_m, ++count;
  return sum / count;
}

/// A straight line from its fairlead to its anchor that goes inwards by the body's centre of mass, and either by the middles of
/// its shapes and of its fairleads too, or through the body. Lines of a turret at an outrigger go every way, crossed ones under
/// the hull.
void doubt_far_side(scene::Doubts& doubts, const std::string& at, const LineOptions& line, const LineSurroundings& around,
                    const Eigen::Vector3d& fairleads) {
  const auto pieces = around.pieces.find(line.body);
  const auto centre = around.centres.find(line.body);
  const Eigen::Vector2d from = line.fairlead_m->head<2>(), to = (-line.span()).head<2>();
  if (line.anchor_body != "earth" || pieces == around.pieces.end() || centre == around.centres.end()) return;
  if (to.norm() < 0.1 * line.length_m()) return;
  Eigen::AlignedBox3d box;
  for (const Eigen::AlignedBox3d& piece : pieces->second) box.extend(piece);
  const double half = 0.5 * box.diagonal().norm(), half_plan = 0.5 * box.sizes().head<2>().norm();
  constexpr double least = -0.3, least_share = 0.2;  // of the cosine, 107 degrees; of half the shapes' diagonal in plan
  const auto outwards = [&](const Eigen::Vector3d& middle) {
    const Eigen::Vector2d out = from - middle.head<2>();
    return out.norm() < 0.02 * half ? 1.0 : out.dot(to) / (out.norm() * to.norm());
  };
  if (outwards(centre->second) >= least) return;
  const auto [enters, leaves] = crossing(pieces->second, from, to.normalized());
  const double first = std::max(0.0, enters), last = std::min(leaves, to.norm());
  const bool crosses = last - first > least_share * half_plan;
  const double height = line.fairlead_m->z() - line.span().z() * 0.5 * (first + last) / to.norm();
  if (crosses && height <= box.min().z()) return;
  if (!crosses && (outwards(box.center()) >= least || outwards(fairleads) >= least)) return;
  doubts.push_back({at + ".anchor_m",
                    fmt::format("on the far side of body {}: the line leaves its fairlead at {:.3g} degrees from outwards{}",
                                line.body, std::acos(outwards(centre->second)) / radians_per_degree,
                                crosses ? fmt::format(" and goes {:.3g} m through it", last - first) : ""),
                    "up to 107 degrees: lines do not cross the body", "look at the signs of anchor_m, or whose anchor it is"});
}

/// Where the line leaves its body: on the body, and on the side of its anchor.
void doubt_fairlead(scene::Doubts& doubts, const std::string& at, const LineOptions& line, const LineSurroundings& around,
                    const std::vector<scene::Named<LineOptions>>& lines) {
  const auto found = around.shapes.find(line.body);
  if (found == around.shapes.end()) return;
  const Eigen::AlignedBox3d& box = found->second;
  const double half = 0.5 * box.diagonal().norm();
  if (const double off = std::sqrt(box.squaredExteriorDistance(*line.fairlead_m)); off > 0.5 * half)
    doubts.push_back({at + ".fairlead_m", fmt::format("{:.4g} m away from the shapes of body {}", off, line.body),
                      fmt::format("within {:.3g} m of them", 0.5 * half),
                      "look at its unit and sign, and whether it stands in place of the anchor"});
  else
    doubt_far_side(doubts, at, line, around, mean_fairlead(lines, line.body));
}

/// Steel fills 7850 kg/m3, with wires and sheaths to 12000. With the bar's diameter, of which studless chain displaces 1.8 times,
/// a chain has 25000, as some published models have it. Lines alike are told of once.
void doubt_diameters(scene::Doubts& doubts, const std::vector<scene::Named<LineOptions>>& lines) {
  constexpr double most = 20e3;
  std::vector<std::pair<std::string, std::vector<std::string>>> found;  // what is wrong, and of which lines
  for (const auto& [name, line] : lines) {
    if (line.mass_kg_m <= 0.0 || line.diameter_m <= 0.0) continue;
    const double density = line.mass_kg_m / (0.25 * pi * line.diameter_m * line.diameter_m);
    if (density <= most) continue;
    const std::string what = fmt::format("{:.4g} m at {:.4g} kg/m, {:.3g} kg/m3", line.diameter_m, line.mass_kg_m, density);
    const auto alike = std::ranges::find_if(found, [&](const auto& one) { return one.first == what; });
    if (alike == found.end())
      found.push_back({what, {name}});
    else
      alike->second.push_back(name);
  }
  for (const auto& [what, names] : found)
    doubts.push_back({"moorings." + names[0] + ".diameter_m",
                      names.size() > 1 ? fmt::format("{} (and {} more lines)", what, names.size() - 1) : what,
                      fmt::format("up to {:g} kg/m3", most),
                      "it is that of the displaced volume, for studless chain 1.8 times the bar's; look at its unit: m"});
}

void doubt_friction(scene::Doubts& doubts, const std::string& at, const LineOptions& line) {
  if (constexpr double most = 2.0; hangs(line) && line.bed_friction > most)
    doubts.push_back({at + ".bed_friction", fmt::format("{:.4g}", line.bed_friction),
                      fmt::format("up to {:g}: chain on sand has 0.7 to 1 (DNV-OS-E301)", most),
                      "it has no unit, and is not in per cent"});
}

/// Chords instead of arcs: the tension is off by some (segment / radius of curvature)^2 / 24, 1 per cent at half the radius.
void doubt_segments(scene::Doubts& doubts, const std::string& at, const LineOptions& line, double weight_N_m) {
  const Eigen::Vector3d along = line.span();
  const LineCatenary rest{line.rest_length_m, weight_N_m, *line.axial_stiffness_N, 0.0, line.bed_contact};
  const CatenaryState s = rest.solve(std::hypot(along.x(), along.y()), std::abs(along.z()));
  const double radius = s.horizontal / weight_N_m, segment = line.rest_length_m / line.segments;
  if (s.regime != CatenaryRegime::slack && s.horizontal > 0.0 && segment > 0.5 * radius)
    doubts.push_back({at + ".segments",
                      fmt::format("{}, of {:.4g} m each, where the line at rest is bent to a radius of {:.4g} m", line.segments,
                                  segment, radius),
                      "segments up to half the radius",
                      fmt::format("take {:.0f} or more", std::ceil(2.0 * line.rest_length_m / radius))});
}

/// The line loads its bodies as it did in the step before: stable while the step is below M / sqrt(EA m'), in which a body of
/// mass M loses its speed to the axial waves of the line (second-order Adams-Bashforth on that decay).
void doubt_step(scene::Doubts& doubts, const std::string& at, const LineOptions& line, const LineSurroundings& around) {
  for (const std::string& body : {line.body, line.anchor_body}) {
    const auto mass = around.masses_kg.find(body);
    if (mass == around.masses_kg.end()) continue;
    const double limit = mass->second / std::sqrt(*line.axial_stiffness_N * line.mass_kg_m);
    if (around.step_s > 0.5 * limit)
      doubts.push_back({"time.step_s",
                        fmt::format("{:.4g} s with {} pulling on body {} of {:.4g} kg", around.step_s, at, body, mass->second),
                        fmt::format("up to {:.3g} s, half the time in which the line's axial waves stop the body", 0.5 * limit),
                        "take a smaller step, or look at the body's mass and the line's axial_stiffness_N"});
  }
}

}  // namespace

scene::Doubts line_doubts(const std::vector<scene::Named<LineOptions>>& lines, const LineSurroundings& around) {
  scene::Doubts doubts;
  doubt_diameters(doubts, lines);
  for (const auto& [name, line] : lines) {
    const std::string at = "moorings." + name;
    const double weight_N_m = weight_in_water(line, around.water_density_kg_m3, around.gravity_m_s2);
    doubt_length(doubts, at, line, around.weight_N);
    doubt_material(doubts, at, line, weight_N_m);
    doubt_spring(doubts, at, line, around);
    doubt_floats(doubts, at, line, around);
    doubt_fairlead(doubts, at, line, around, lines);
    doubt_friction(doubts, at, line);
    doubt_coefficients(doubts, at, line);
    doubt_table(doubts, at, line, around);
    if (line_models().named(line.model).make_dynamic)
      doubt_segments(doubts, at, line, weight_N_m), doubt_step(doubts, at, line, around);
    if (around.depth_m < 0.0 || line.anchor_body != "earth") continue;
    const bool on_table = around.bed && lies_on_bed(line);
    const double depth_m = on_table ? -around.bed->level(line.anchor_m->x(), line.anchor_m->y()) : around.depth_m;
    const std::string bed_key = on_table ? "environment.bathymetry" : "environment.water_depth_m";
    if (on_table && !around.bed->covers(line.anchor_m->x(), line.anchor_m->y()))
      doubts.push_back({at + ".anchor_m", "outside the places of environment.bathymetry", "an anchor among them",
                        "the depth at their edge holds there; look at x and y of anchor_m, and at the table"});
    const double above = line.anchor_m->z() + depth_m;
    if (above < -0.01 * depth_m - 0.5)
      doubts.push_back({at + ".anchor_m", fmt::format("z = {:.4g} m is {:.4g} m under the bed", line.anchor_m->z(), -above),
                        fmt::format("an anchor on the bed at {:.4g} m", -depth_m), "look at anchor_m and " + bed_key});
    else if (hangs(line) && line.bed_contact && above > 0.05 * depth_m)
      doubts.push_back({at + ".anchor_m", fmt::format("z = {:.4g} m is {:.4g} m above the bed", line.anchor_m->z(), above),
                        fmt::format("an anchor on the bed at {:.4g} m, where the line lies", -depth_m),
                        "look at anchor_m and " + bed_key + ", or say bed_contact = false"});
    else if (above > 0.5 * depth_m && goes_down(line) && (on_table || !around.bed))
      doubts.push_back({at + ".anchor_m", fmt::format("z = {:.4g} m is {:.4g} m above the bed", line.anchor_m->z(), above),
                        fmt::format("an anchor near the bed at {:.4g} m", -depth_m),
                        "look at anchor_m and environment.water_depth_m"});
    else if (!hangs(line) && comes_up(line) && line.anchor_m->z() > 0.25 * depth_m)
      doubts.push_back({at + ".anchor_m", fmt::format("z = {:.4g} m is above water", line.anchor_m->z()),
                        fmt::format("an anchor on the bed at {:.4g} m, or by the water's surface", -depth_m),
                        "look at the sign of z: up is positive"});
    if (line.fairlead_m->z() < -depth_m && around.masses_kg.contains(line.body))
      doubts.push_back({at + ".fairlead_m", fmt::format("z = {:.4g} m is under the bed", line.fairlead_m->z()),
                        fmt::format("a fairlead above {:.4g} m", -depth_m), "look at its sign and at environment.water_depth_m"});
  }
  doubt_unlike(doubts, lines);
  return doubts;
}

scene::Doubts junction_doubts(const std::vector<scene::Named<JunctionOptions>>& junctions, const LineSurroundings& around) {
  scene::Doubts doubts;
  for (const auto& [name, junction] : junctions) {
    const std::string at = "junctions." + name;
    if (around.depth_m >= 0.0 && junction.position_m.z() < -around.depth_m)
      doubts.push_back({at + ".position_m", fmt::format("z = {:.4g} m is under the bed", junction.position_m.z()),
                        fmt::format("a place above {:.4g} m", -around.depth_m),
                        "look at its sign and at environment.water_depth_m"});
    doubt_hung(doubts, at, junction.mass_kg, junction.volume_m3, "", around);
  }
  return doubts;
}

}  // namespace spindrift::moorings
