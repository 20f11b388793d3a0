// SPDX-License-Identifier: Apache-2.0
#include "src/aero/turbine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "src/scene/columns.hpp"
#include "src/scene/document.hpp"

namespace spindrift::aero {

namespace {

const scene::Section<PolarOptions>& polar_section() {
  static const auto section =
      scene::Section<PolarOptions>("polars", "Lift and drag of one relative thickness.")
          .number("thickness_pct", &PolarOptions::thickness_pct, "%", "Relative thickness of the section.",
                  scene::between(0.1, 100.0))
          .required()
          .path("file", &PolarOptions::file,
                "CSV file with columns alpha_deg from -180 to 180, cl, cd; cm may be there and is not used.")
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
  return {0.01 * options.thickness_pct, column(file, "alpha_deg", radians_per_degree), column(file, "cl"), column(file, "cd")};
}

Planform read_planform(const std::string& path, double hub_radius) {
  const scene::Columns file = scene::read_columns(path);
  file.allow_only({"span_m", "chord_m", "twist_deg", "thickness_pct", "prebend_m", "sweep_m"});
  file.require_rows(2);
  file.require_increasing("span_m", "distance from the rotor axis along the blade");
  if (std::abs(file["span_m"][0] - hub_radius) > 1e-6 * hub_radius)
    file.fail(0, fmt::format("span_m = {} must be turbine.hub_radius_m = {}: the first section is the root", file["span_m"][0],
                             hub_radius));
  for (std::size_t i = 0; i < file.rows(); ++i)
    if (file["chord_m"][i] <= 0.0) file.fail(int(i), "chord_m must be positive");
  return {column(file, "span_m"), column(file, "chord_m"), column(file, "twist_deg", radians_per_degree),
          column(file, "thickness_pct", 0.01), column(file, "prebend_m")};
}

}  // namespace

const scene::Section<TurbineOptions>& turbine_section() {
  static const auto section =
      scene::Section<TurbineOptions>("turbine", "A rotor as data.")
          .integer("blades", &TurbineOptions::blades, "-", "Number of equal blades.", scene::between(1, 12))
          .number("hub_radius_m", &TurbineOptions::hub_radius_m, "m", "Radius at which the blades begin.", scene::positive())
          .required()
          .degrees("precone_deg", &TurbineOptions::precone, "Angle by which the blades lean upwind.", scene::between(-45.0, 45.0))
          .path(
              "planform", &TurbineOptions::planform,
              "CSV file from root to tip: span_m (from the rotor axis along the blade), chord_m, twist_deg (nose into the wind), "
              "thickness_pct, prebend_m (downwind); sweep_m may be there and is not used by blade element momentum.")
          .required()
          .tables("polars", &TurbineOptions::polars, polar_section(), "Lift and drag for the thicknesses along the blade.");
  return section;
}

Turbine read_turbine(const std::string& path) {
  scene::Document doc = scene::load(path);
  const TurbineOptions options = doc.read(turbine_section());
  if (options.polars.empty()) doc.problem("turbine.polars", "must have at least one entry");
  doc.finish();
  Turbine turbine{
      options.blades, options.hub_radius_m, options.precone, read_planform(options.planform, options.hub_radius_m), {}};
  for (const PolarOptions& polar : options.polars) turbine.polars.push_back(read_polar(polar));
  std::sort(turbine.polars.begin(), turbine.polars.end(),
            [](const Polar& a, const Polar& b) { return a.thickness < b.thickness; });
  return turbine;
}

}  // namespace spindrift::aero
