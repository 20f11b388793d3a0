// SPDX-License-Identifier: Apache-2.0
#include "src/moorings/doubts.hpp"

#include <fmt/format.h>

#include <cmath>

namespace spindrift::moorings {

namespace {

void doubt_length(scene::Doubts& doubts, const std::string& at, const LineOptions& line, double weight_N) {
  if (line.model == "table") return;
  const Eigen::Vector3d along = line.fairlead_m - line.anchor_m;
  const double apart = along.norm(), length = line.rest_length_m, round = std::hypot(along.x(), along.y()) + std::abs(along.z());
  const std::string what = fmt::format("{:.4g} m for ends {:.4g} m apart", length, apart);
  const double stiffness = line.stiffness_N_m ? *line.stiffness_N_m : line.axial_stiffness_N.value_or(0.0) / length;
  if (apart > length) {
    const double tension = stiffness * (apart - length);
    if (tension > weight_N && weight_N > 0.0)
      doubts.push_back({at + ".rest_length_m", fmt::format("{}, a tension of {:.3g} N at the start", what, tension),
                        fmt::format("a tension below the weight of all bodies, {:.3g} N", weight_N),
                        "look at the length, the stiffness and the place of the ends"});
  } else if (line.model == "catenary" && length > round && line.anchor_body == "earth") {
    doubts.push_back({at + ".rest_length_m", what, fmt::format("less than straight down and along the bed, {:.4g} m", round),
                      "the line hangs down and does nothing; look at the length and at the anchor"});
  } else if (line.model != "catenary" && length > 1.5 * apart) {
    doubts.push_back(
        {at + ".rest_length_m", what, "up to 1.5 times the distance", "the line is slack until the body has drifted far"});
  }
}

/// Chain, wire and fibre rope alike have an axial stiffness of some 10^6 m times their weight in water: studless chain 8.5e10 d^2
/// N over 1.7e5 d^2 N/m, wire rope 4e10 over 3e4 (diameters d in m; Orcina's fits to manufacturers' tables). Buoyant ropes may
/// weigh less.
void doubt_material(scene::Doubts& doubts, const std::string& at, const LineOptions& line) {
  if (line.model != "catenary" || !line.axial_stiffness_N) return;
  const double ratio = *line.axial_stiffness_N / line.weight_N_m;
  if (ratio < 3e4 || ratio > 5e7)
    doubts.push_back({at + ".weight_N_m",
                      fmt::format("{:.4g} N/m with an axial stiffness of {:.4g} N", line.weight_N_m, *line.axial_stiffness_N),
                      "a stiffness of 3e4 to 5e7 m times the weight in water",
                      "look at the units: N/m in water, not kg/m or kN/m; N, not kN"});
}

}  // namespace

scene::Doubts line_doubts(const std::vector<scene::Named<LineOptions>>& lines, double depth_m, double weight_N) {
  scene::Doubts doubts;
  for (const auto& [name, line] : lines) {
    const std::string at = "moorings." + name;
    doubt_length(doubts, at, line, weight_N);
    doubt_material(doubts, at, line);
    if (depth_m < 0.0 || line.anchor_body != "earth") continue;
    const double above = line.anchor_m.z() + depth_m;
    if (above < -0.01 * depth_m - 0.5)
      doubts.push_back({at + ".anchor_m", fmt::format("z = {:.4g} m is {:.4g} m under the bed", line.anchor_m.z(), -above),
                        fmt::format("an anchor on the bed at {:.4g} m", -depth_m),
                        "look at anchor_m and environment.water_depth_m"});
    else if (line.model == "catenary" && line.bed_contact && above > 0.05 * depth_m)
      doubts.push_back({at + ".anchor_m", fmt::format("z = {:.4g} m is {:.4g} m above the bed", line.anchor_m.z(), above),
                        fmt::format("an anchor on the bed at {:.4g} m, where the line lies", -depth_m),
                        "look at anchor_m and environment.water_depth_m, or say bed_contact = false"});
    if (line.fairlead_m.z() < -depth_m)
      doubts.push_back({at + ".fairlead_m", fmt::format("z = {:.4g} m is under the bed", line.fairlead_m.z()),
                        fmt::format("a fairlead above {:.4g} m", -depth_m), "look at its sign and at environment.water_depth_m"});
  }
  return doubts;
}

}  // namespace spindrift::moorings
