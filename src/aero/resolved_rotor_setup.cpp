// SPDX-License-Identifier: Apache-2.0
#include "src/aero/resolved_rotor_setup.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "src/aero/turbine.hpp"
#include "src/scene/document.hpp"
#include "src/scene/error.hpp"

namespace spindrift::aero {

namespace {

double off_axis_degrees(const RotorOptions& rotor, const Eigen::Vector3d& wind) {
  if (wind.norm() == 0.0) return 0.0;
  return std::atan2(rotor.axis.cross(wind).norm(), std::abs(rotor.axis.dot(wind))) / radians_per_degree;
}

}  // namespace

bool blows_along_axis(const RotorOptions& rotor, const Eigen::Vector3d& wind) { return off_axis_degrees(rotor, wind) <= 1e-6; }

void check_resolved_rotor(scene::Document& document, const AeroOptions& aero, const RotorOptions& rotor,
                          const Eigen::Vector3d& wind, const WindProfile& profile) {
  if (rotor.turbine.empty()) {
    document.problem("rotor.turbine", "must name a turbine file: the grid of [aero.grid] is made round its blades");
    return;
  }
  try {
    if (read_turbine(rotor.turbine).aerofoils.empty())
      document.problem("rotor.turbine",
                       "names a turbine without outlines of its aerofoils ([[turbine.aerofoils]]): no surface can be made");
  } catch (const scene::SceneError& e) { document.problem("rotor.turbine", e.what()); }
  const bool steady = aero.flow->time == "steady", one = aero.grid->sectors == "one";
  const double off = off_axis_degrees(rotor, wind);
  if (!blows_along_axis(rotor, wind) && (steady || one))
    document.problem(
        steady ? "aero.flow.time" : "aero.grid.sectors",
        fmt::format(
            "{} needs the wind along the rotor axis; it is {:.3g} degrees off (wind.direction_deg, aero.flow.incidence_deg, "
            "rotor.axis): {}",
            steady ? "\"steady\", a flow seen from the turning rotor," : "\"one\"", off,
            steady ? "take \"bdf2\"" : "take \"all\""));
  if (!profile.uniform() && steady)
    document.problem("aero.flow.time",
                     "\"steady\", a flow seen from the turning rotor, needs a wind of one speed; wind.profile gives it one over "
                     "height, which a "
                     "turning blade meets as a wind that changes: take \"bdf2\"");
  if (!profile.uniform() && one)
    document.problem("aero.grid.sectors",
                     "\"one\" stands for all sectors where all see the same; wind.profile gives each its own wind: take \"all\"");
  if (wind.norm() == 0.0 && rotor.speed == 0.0)
    document.problem("wind.speed_m_s", "must be > 0 where rotor.speed_rpm is 0: nothing would move");
  if (!steady && aero.flow->start != "wind" && aero.flow->start != "rest")
    document.problem("aero.flow.start", "must be \"wind\" or \"rest\" with a rotor");
}

double far_side_excess(const RotorGridOptions& grid) {
  constexpr double thrust_coefficient = 0.8;
  const double blocked = 1.0 / (grid.radial_extent * grid.radial_extent);
  return blocked * thrust_coefficient / (4.0 * std::sqrt(1.0 - thrust_coefficient));
}

std::string far_side_note(const RotorGridOptions& grid) {
  const double excess = far_side_excess(grid);
  if (excess < 0.01) return {};
  // Powers of the wind at fixed speed of rotation by blade elements (docs/theory/rotor_resolved.md).
  return fmt::format(
      "far sides at {:g} tip radii (aero.grid.radial_extent) raise the wind through the rotor by some {:.1f} % (Glauert, thrust "
      "coefficient .8): "
      "about {:.0f} % of thrust and {:.0f} % of power; at 12 radii {:.1f} %",
      grid.radial_extent, 100.0 * excess, 100.0 * (std::pow(1.0 + excess, 1.2) - 1.0),
      100.0 * (std::pow(1.0 + excess, 2.9) - 1.0), 100.0 * far_side_excess({.radial_extent = 12.0}));
}

}  // namespace spindrift::aero
