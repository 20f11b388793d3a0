// SPDX-License-Identifier: Apache-2.0
#include "src/aero/actuator_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/aero/grid/multi_block.hpp"
#include "src/aero/options.hpp"
#include "src/aero/turbine.hpp"
#include "src/scene/document.hpp"
#include "src/scene/error.hpp"
#include "src/scene/section.hpp"

namespace spindrift::aero {

const scene::Section<ActuatorOptions>& actuator_section() {
  static const auto section =
      scene::Section<ActuatorOptions>("actuator", "How blades act on a resolved air whose grid does not show them.")
          .number("width_cells", &ActuatorOptions::width_cells, "-",
                  "Width (epsilon) of the Gaussian that spreads the forces and samples the velocities, in cells at the rotor.",
                  scene::between(1.0, 20.0))
          .number("width_chords", &ActuatorOptions::width_chords, "-",
                  "Its least width in chords of the section; a quarter is that of a lifting surface.", scene::between(0.0, 10.0))
          .choice(
              "correction", &ActuatorOptions::correction,
              {{"filtered", "blades meet the velocity without the smoothing of the width: filtered lifting line, or its disc"},
               {"none", "the velocity as sampled"}},
              "What is done about the width.");
  return section;
}

namespace {

/// Empty where the blades are between the corners of a grid at any azimuth. The turbine file is sound.
std::string why_outside(const RotorOptions& rotor, const Corners& grid) {
  const double radius = read_turbine(rotor.turbine).planform.span.back();
  const Eigen::Vector3d axis = rotor.axis.normalized();
  for (int d = 0; d < 3; ++d) {
    const double reach = radius * std::sqrt(std::max(0.0, 1.0 - axis[d] * axis[d]));
    if (rotor.hub_m[d] - reach < grid.low[d] || rotor.hub_m[d] + reach > grid.high[d])
      return fmt::format(
          "puts the rotor out of the grid, which goes from {:g} to {:g} m along {}: the blades reach {:g} m from the "
          "hub there",
          grid.low[d], grid.high[d], "xyz"[d], reach);
  }
  return {};
}

}  // namespace

void check_actuator(scene::Document& document, const AeroOptions& aero, const RotorOptions& rotor, const std::string& hub_key) {
  if (rotor.turbine.empty())
    document.problem("rotor.turbine", fmt::format("must name a turbine file: aero.model \"{}\" needs the blades", aero.model));
  else
    try {
      if (read_turbine(rotor.turbine).polars.empty())
        document.problem("rotor.turbine",
                         fmt::format("names a turbine without polars, which aero.model \"{}\" needs", aero.model));
      const std::optional<Corners> box = aero.flow ? box_corners(*aero.flow) : std::nullopt;
      if (box && rotor.axis.norm() > 0.0)
        if (const std::string why = why_outside(rotor, *box); !why.empty()) document.problem(hub_key, why);
    } catch (const scene::SceneError& e) { document.problem("rotor.turbine", e.what()); }
  if (aero.model == "actuator_line" && aero.flow && aero.flow->time == "steady")
    document.problem(
        "aero.flow.time",
        "must be \"bdf1\", \"bdf2\" or \"bdf3\": lines turn; aero.model \"actuator_disc\" has the steady flow of their mean");
  if (aero.flow && aero.flow->motion)
    document.problem("aero.flow.motion", "has no effect: the grid stands, the rotor goes through it");
}

void require_rotor_inside(const MultiBlockGrid& grid, const RotorOptions& rotor, const std::string& hub_key) {
  if (grid.planar)
    throw scene::SceneError(
        {scene::Problem{.key = "aero.model", .message = "acts on a grid of three dimensions; that of aero.flow is planar"}});
  if (const std::string why = why_outside(rotor, corners(grid)); !why.empty())
    throw scene::SceneError({scene::Problem{.key = hub_key, .message = why}});
}

}  // namespace spindrift::aero
