// SPDX-License-Identifier: Apache-2.0
#include "src/aero/turbine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <utility>

#include "kernels/base/constants.hpp"
#include "kernels/grid/aerofoil.hpp"
#include "src/scene/columns.hpp"
#include "src/scene/document.hpp"

namespace spindrift::aero {

namespace {

const scene::Section<StallOptions>& stall_section() {
  static const auto section =
      scene::Section<StallOptions>("stall", "Attached flow about a section, and how it ends.")
          .number("normal_slope", &StallOptions::normal_slope, "1/rad",
                  "Of the normal force in attached flow; 0: no dynamic stall.", scene::between(0.0, 20.0))
          .required()
          .degrees("zero_lift_deg", &StallOptions::zero_lift, "Angle of attack without lift.", scene::between(-30.0, 30.0))
          .number("drag_0", &StallOptions::drag_0, "-", "Drag coefficient there.", scene::not_negative())
          .number("critical_normal", &StallOptions::critical_normal, "-",
                  "Coefficient of normal force at which the leading edge separates.", scene::positive())
          .number("critical_normal_low", &StallOptions::critical_normal_low, "-", "The same at negative angles.",
                  scene::between(-10.0, 0.0));
  return section;
}

const scene::Section<PolarOptions>& polar_section() {
  static const auto section =
      scene::Section<PolarOptions>("polars", "Lift and drag of one section of the blade.")
          .number("thickness_pct", &PolarOptions::thickness_pct, "%", "Relative thickness of the section.",
                  scene::between(0.1, 100.0))
          .integer("number", &PolarOptions::number, "-",
                   "Of the section, in place of its thickness: the planform's column polar names it.", scene::between(1, 10000))
          .number("reynolds", &PolarOptions::reynolds, "-",
                  "Reynolds number of the chord that the file holds for, where a section has files for several, in increasing "
                  "order; without it the file holds for any.",
                  scene::positive())
          .path("file", &PolarOptions::file,
                "CSV file with columns alpha_deg from -180 to 180, cl, cd; cm may be there and is not used.")
          .required()
          .table("stall", &PolarOptions::stall, stall_section(),
                 "For aero.dynamic_stall = \"beddoes_leishman\", in place of what the polar says: normal force above the "
                 "straight line "
                 "is lost, as in AeroDyn.")
          .one_of({"thickness_pct", "number"});
  return section;
}

const scene::Section<OutlineOptions>& aerofoil_section() {
  static const auto section = scene::Section<OutlineOptions>("aerofoils", "The outline of one relative thickness.")
                                  .number("thickness_pct", &OutlineOptions::thickness_pct, "%",
                                          "Relative thickness of the section.", scene::between(0.1, 100.0))
                                  .required()
                                  .path("file", &OutlineOptions::file,
                                        "CSV file with columns x_c, y_c over the chord: from the trailing edge along the suction "
                                        "side (y_c > 0) to the leading "
                                        "edge and back along the pressure side.")
                                  .required();
  return section;
}

std::vector<double> column(const scene::Columns& file, const char* name, double scale = 1.0) {
  std::vector<double> values(file[name].begin(), file[name].end());
  for (double& v : values) v *= scale;
  return values;
}

Polar read_polar(const PolarOptions& options) {
  const scene::Columns file = scene::read_columns(options.file);
  file.allow_only({"alpha_deg", "cl", "cd", "cm"});
  file.require_rows(2);
  file.require_increasing("alpha_deg", "angle of attack");
  const auto alpha = file["alpha_deg"];
  if (alpha.front() != -180.0 || alpha.back() != 180.0)
    file.fail(-1, "alpha_deg must go from -180 to 180: a blade may meet any wind");
  for (std::size_t i = 0; i < file.rows(); ++i)
    if (file["cd"][i] < 0.0) file.fail(int(i), "cd must not be negative");
  return {options.number ? double(*options.number) : 0.01 * *options.thickness_pct,
          options.reynolds,
          column(file, "alpha_deg", radians_per_degree),
          column(file, "cl"),
          column(file, "cd"),
          options.stall};
}

Aerofoil read_aerofoil(const OutlineOptions& options) {
  Aerofoil aerofoil{0.01 * options.thickness_pct, read_outline(options.file)};
  std::vector<Eigen::Vector2d> loop = aerofoil.outline;
  if ((loop.front() - loop.back()).norm() < 1e-9) loop.pop_back();
  const double thickness = outline_thickness(loop);
  if (std::abs(thickness - aerofoil.thickness) > 0.02)
    throw scene::SceneError(
        {{options.file, 0, "", "",
          fmt::format("the outline is {:.1f} % thick, thickness_pct says {}", 100.0 * thickness, options.thickness_pct)}});
  return aerofoil;
}

/// x_c and y_c of a Selig or Lednicer file as those of a CSV one: a title, then two numbers a line.
scene::Columns read_points(const std::string& path) {
  if (std::filesystem::path(path).extension() != ".dat") {
    const scene::Columns file = scene::read_columns(path);
    file.allow_only({"x_c", "y_c"});
    return file;
  }
  return scene::read_blank_columns(path, {"x_c", "y_c"});
}

Planform read_planform(const std::string& path, double hub_radius, bool by_number) {
  const scene::Columns file = scene::read_columns(path);
  file.allow_only({"span_m", "chord_m", "twist_deg", "thickness_pct", "polar", "prebend_m", "sweep_m"});
  file.require_rows(2);
  file.require_increasing("span_m", "distance from the rotor axis along the blade");
  if (std::abs(file["span_m"][0] - hub_radius) > 1e-6 * hub_radius)
    file.fail(0, fmt::format("span_m = {} must be turbine.hub_radius_m = {}: the first section is the root", file["span_m"][0],
                             hub_radius));
  for (std::size_t i = 0; i < file.rows(); ++i)
    if (file["chord_m"][i] <= 0.0) file.fail(int(i), "chord_m must be positive");
  if (file.has("polar") && !by_number)
    file.fail(-1,
              "has a column polar, but the polars of the turbine file have no number: give them one, or leave the column out");
  const auto or_zero = [&](const char* name) {
    return file.has(name) ? column(file, name) : std::vector<double>(file.rows(), 0.0);
  };
  return {column(file, "span_m"),
          column(file, "chord_m"),
          column(file, "twist_deg", radians_per_degree),
          by_number && !file.has("thickness_pct") ? std::vector<double>() : column(file, "thickness_pct", 0.01),
          or_zero("prebend_m"),
          or_zero("sweep_m"),
          by_number ? column(file, "polar") : std::vector<double>()};
}

/// "24.1 % thick", "of number 3".
std::string section_of(const PolarOptions& polar) {
  return polar.number ? fmt::format("of number {}", *polar.number) : fmt::format("{} % thick", *polar.thickness_pct);
}

/// All of thickness or all of number; several of one section by increasing Reynolds number, with or without `stall`.
void check_polars(scene::Document& doc, const std::vector<PolarOptions>& polars) {
  const auto key = [](std::size_t n, const char* name) { return fmt::format("turbine.polars[{}].{}", n, name); };
  for (std::size_t n = 0; n < polars.size(); ++n) {
    const PolarOptions& polar = polars[n];
    if (!polar.number && !polar.thickness_pct) continue;  // told already
    if (polar.number.has_value() != polars[0].number.has_value()) {
      doc.problem(key(n, polar.number ? "number" : "thickness_pct"),
                  "names a section otherwise than turbine.polars[0] does: all by number or all by thickness_pct");
      continue;
    }
    const auto same = [&](const PolarOptions& p) { return p.number == polar.number && p.thickness_pct == polar.thickness_pct; };
    const auto before = std::find_if(std::make_reverse_iterator(polars.begin() + std::ptrdiff_t(n)), polars.rend(), same);
    if (before == polars.rend()) continue;
    const std::string other = fmt::format("turbine.polars[{}]", polars.rend() - before - 1);
    if (!polar.reynolds || !before->reynolds)
      doc.problem(polar.reynolds ? other + ".reynolds" : key(n, "reynolds"),
                  fmt::format("must be given: two polars are {}, {} and turbine.polars[{}]", section_of(polar), other, n));
    else if (*polar.reynolds <= *before->reynolds)
      doc.problem(key(n, "reynolds"), fmt::format("must be more than {:g}, that of {}, which is {} too", *before->reynolds, other,
                                                  section_of(polar)));
    else if (polar.stall.has_value() != before->stall.has_value())
      doc.problem(polar.stall ? other + ".stall" : key(n, "stall"),
                  fmt::format("must be given: of the polars {} all say something of stall or none does", section_of(polar)));
  }
}

/// Between the least and the greatest number of the polars. Throws scene::SceneError by file and line.
void check_numbers(const std::string& path, const std::vector<PolarOptions>& polars) {
  const scene::Columns file = scene::read_columns(path);
  const auto [least, greatest] = std::minmax_element(
      polars.begin(), polars.end(), [](const PolarOptions& a, const PolarOptions& b) { return *a.number < *b.number; });
  for (std::size_t i = 0; i < file.rows(); ++i)
    if (const double n = file["polar"][i]; n < *least->number || n > *greatest->number)
      file.fail(int(i), fmt::format("polar = {}: the polars of the turbine have numbers from {} to {}", n, *least->number,
                                    *greatest->number));
}

}  // namespace

const scene::Section<TurbineOptions>& turbine_section() {
  static const auto section =
      scene::Section<TurbineOptions>("turbine", "A rotor as data: blades from tables of sections.")
          .integer("blades", &TurbineOptions::blades, "-", "Number of equal blades.", scene::between(1, most_blades))
          .number("hub_radius_m", &TurbineOptions::hub_radius_m, "m", "Radius at which the blades begin.", scene::positive())
          .required()
          .degrees("precone_deg", &TurbineOptions::precone,
                   "Angle by which the blades lean out of the plane of the rotor: positive upwind, away from the tower.",
                   scene::between(-45.0, 45.0))
          .path(
              "planform", &TurbineOptions::planform,
              "CSV file from root to tip: span_m (from the rotor axis along the blade), chord_m, twist_deg (nose into the wind), "
              "thickness_pct; by choice prebend_m (downwind) and sweep_m, which blade element momentum does not use. Where "
              "polars "
              "have numbers a column polar says which, 2.5 being half of polar 2 and half of 3; thickness_pct may then be left "
              "out.")
          .required()
          .choice(
              "elements", &TurbineOptions::elements,
              {{"between_stations", "from each row of the planform to the next, with the mean of both"},
               {"at_stations",
                "round each row, from half-way to half-way, with its own section: AeroDyn's sum over nodes. The first and the "
                "last row carry no load"}},
              "What blade elements are; an actuator disc or line has them between stations, as fine as its cells, in any case.")
          .tables("polars", &TurbineOptions::polars, polar_section(), "Lift and drag for the sections along the blade.")
          .tables("aerofoils", &TurbineOptions::aerofoils, aerofoil_section(),
                  "Outlines for the thicknesses along the blade: what a resolved blade's surface is made from.")
          .path("operation", &TurbineOptions::operation, "Operating table, for scenes that give no rotor.operation.")
          .path("controller", &TurbineOptions::controller, "Controller file, for scenes that give no control.file.");
  return section;
}

std::vector<BladePiece> blade_pieces(const Turbine& turbine) {
  const Planform& p = turbine.planform;
  const double sine = std::sin(turbine.precone), cosine = std::cos(turbine.precone);
  const auto radius = [&](std::size_t i) { return p.span[i] * cosine + p.prebend[i] * sine; };
  const auto axial = [&](std::size_t i) { return p.prebend[i] * cosine - p.span[i] * sine; };
  std::vector<BladePiece> pieces;
  if (turbine.elements_at_stations) {
    for (std::size_t i = 1; i + 1 < p.span.size(); ++i) {
      const double outward = 0.5 * (radius(i + 1) - radius(i - 1)), downwind = 0.5 * (axial(i + 1) - axial(i - 1));
      const double length = 0.5 * (std::hypot(radius(i + 1) - radius(i), axial(i + 1) - axial(i)) +
                                   std::hypot(radius(i) - radius(i - 1), axial(i) - axial(i - 1)));
      pieces.push_back({p.span[i], radius(i), axial(i), outward, downwind, length, p.chord[i], p.twist[i], p.place()[i]});
    }
    return pieces;
  }
  for (std::size_t i = 0; i + 1 < p.span.size(); ++i) {
    const auto middle = [&](const std::vector<double>& values) { return 0.5 * (values[i] + values[i + 1]); };
    const double outward = radius(i + 1) - radius(i), downwind = axial(i + 1) - axial(i);
    pieces.push_back({middle(p.span), 0.5 * (radius(i) + radius(i + 1)), 0.5 * (axial(i) + axial(i + 1)), outward, downwind,
                      std::hypot(outward, downwind), middle(p.chord), middle(p.twist), middle(p.place())});
  }
  return pieces;
}

TurbineFiles turbine_files(const std::string& path) {
  scene::Document doc = scene::load(path);
  const TurbineOptions options = doc.read(turbine_section());
  doc.finish();
  return {options.operation, options.controller};
}

namespace {

/// Rows of an outline in the order in which they stand in an outline, from the trailing edge over the suction side to the nose
/// and back. A file in Lednicer's order begins with the numbers of points of both sides, which go from the nose.
std::vector<std::size_t> rows_in_order(std::span<const double> x, std::span<const double> y) {
  const std::size_t n = x.size();
  std::vector<std::size_t> rows(n);
  std::iota(rows.begin(), rows.end(), std::size_t(0));
  if (!(x[0] > 2.0 && y[0] > 2.0 && x[0] + y[0] + 1.0 == double(n))) return rows;
  const auto upper = std::size_t(x[0]);
  rows.erase(rows.begin());
  std::reverse(rows.begin(), rows.begin() + std::ptrdiff_t(upper));
  if (x[1] == x[upper + 1] && y[1] == y[upper + 1]) rows.erase(rows.begin() + std::ptrdiff_t(upper));  // the nose, twice
  return rows;
}

}  // namespace

std::vector<Eigen::Vector2d> read_outline(const std::string& path) {
  const scene::Columns file = read_points(path);
  file.require_rows(9);
  const std::vector<std::size_t> rows = rows_in_order(file["x_c"], file["y_c"]);
  std::vector<double> x, y;
  for (const std::size_t row : rows) x.push_back(file["x_c"][row]), y.push_back(file["y_c"][row]);
  const auto fail = [&](std::size_t i, const std::string& what) { file.fail(int(rows[i]), what); };
  const std::size_t n = rows.size();
  std::vector<Eigen::Vector2d> outline;
  for (std::size_t i = 0; i < n; ++i) {
    if (x[i] < -0.05 || x[i] > 1.05) fail(i, fmt::format("x_c = {} is off the chord, which goes from 0 to 1", x[i]));
    if (i > 0 && x[i] == x[i - 1] && y[i] == y[i - 1]) fail(i, "the same point as the one before");
    outline.emplace_back(x[i], y[i]);
  }
  for (const std::size_t i : {std::size_t(0), n - 1})
    if (std::abs(x[i] - 1.0) > 0.02)
      fail(i, fmt::format("x_c = {}: an outline begins and ends at the trailing edge, x_c = 1", x[i]));
  std::vector<Eigen::Vector2d> loop = outline;
  if ((loop.front() - loop.back()).norm() < 1e-9) loop.pop_back();
  const SegmentPair crossing = first_crossing(loop);
  if (crossing.first >= 0)
    fail(std::size_t(crossing.second),
         fmt::format("the outline crosses itself: the piece from ({}, {}) meets the one from ({}, {})",
                     x[std::size_t(crossing.second)], y[std::size_t(crossing.second)], x[std::size_t(crossing.first)],
                     y[std::size_t(crossing.first)]));
  if (signed_area(loop) < 0.0)
    fail(0, "the outline runs along the pressure side first: it must begin with the suction side, y_c > 0");
  return outline;
}

bool depends_on_reynolds(const Turbine& turbine) {
  return std::adjacent_find(turbine.polars.begin(), turbine.polars.end(),
                            [](const Polar& a, const Polar& b) { return a.place == b.place; }) != turbine.polars.end();
}

Turbine read_turbine(const std::string& path) {
  scene::Document doc = scene::load(path);
  const TurbineOptions options = doc.read(turbine_section());
  if (options.polars.empty()) doc.problem("turbine.polars", "must have at least one entry");
  check_polars(doc, options.polars);
  doc.finish();
  const bool by_number = options.polars[0].number.has_value();
  Turbine turbine{options.blades,
                  options.hub_radius_m,
                  options.precone,
                  read_planform(options.planform, options.hub_radius_m, by_number),
                  {},
                  {}};
  if (by_number) check_numbers(options.planform, options.polars);
  turbine.elements_at_stations = options.elements == "at_stations";
  if (turbine.elements_at_stations && turbine.planform.span.size() < 3)
    doc.problem("turbine.elements", "= \"at_stations\" needs a planform of three rows or more"), doc.finish();
  for (const PolarOptions& polar : options.polars) turbine.polars.push_back(read_polar(polar));
  for (const OutlineOptions& aerofoil : options.aerofoils) turbine.aerofoils.push_back(read_aerofoil(aerofoil));
  const auto thinner = [](const auto& a, const auto& b) { return a.thickness < b.thickness; };
  std::sort(turbine.aerofoils.begin(), turbine.aerofoils.end(), thinner);
  if (!turbine.aerofoils.empty()) {
    if (turbine.planform.thickness.empty())
      scene::read_columns(options.planform).fail(-1, "has no column thickness_pct, by which turbine.aerofoils have their places");
    const double thin = turbine.aerofoils.front().thickness, thick = turbine.aerofoils.back().thickness;
    for (std::size_t m = 0; m < turbine.planform.span.size(); ++m) {
      const double t = turbine.planform.thickness[m];
      if (t < thin - 1e-9 || t > thick + 1e-9) {
        doc.problem(
            "turbine.aerofoils",
            fmt::format(
                "no outline for the section {:.1f} % thick at span {} m of the planform: outlines go from {:.1f} to {:.1f} %",
                100.0 * t, turbine.planform.span[m], 100.0 * thin, 100.0 * thick));
        break;
      }
    }
    for (std::size_t a = 1; a < turbine.aerofoils.size(); ++a)
      if (turbine.aerofoils[a].thickness == turbine.aerofoils[a - 1].thickness)
        doc.problem("turbine.aerofoils", fmt::format("two outlines are {} % thick", 100.0 * turbine.aerofoils[a].thickness));
    doc.finish();
  }
  std::sort(turbine.polars.begin(), turbine.polars.end(), [](const Polar& a, const Polar& b) {
    return std::pair(a.place, a.reynolds.value_or(0.0)) < std::pair(b.place, b.reynolds.value_or(0.0));
  });
  return turbine;
}

}  // namespace spindrift::aero
