// SPDX-License-Identifier: Apache-2.0
#include "src/aero/blade_roots.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kernels/base/interpolation.hpp"
#include "src/scene/columns.hpp"

namespace spindrift::aero {

BladeRoots::BladeRoots(const Turbine& turbine, const std::string& path) : blades_(turbine.blades) {
  const scene::Columns file = scene::read_columns(path);
  file.allow_only({"span_m", "mass_kg_m"});
  file.require_rows(2);
  file.require_increasing("span_m", "distance from the rotor axis along the blade");
  const Planform& p = turbine.planform;
  const auto span = file["span_m"], mass = file["mass_kg_m"];
  constexpr double tolerance = 1e-3;  // of the span
  const double length = p.span.back();
  if (std::abs(span.front() - turbine.hub_radius) > tolerance * length)
    file.fail(0, fmt::format("span_m = {} must be the turbine's hub_radius_m = {}", span.front(), turbine.hub_radius));
  if (std::abs(span.back() - length) > tolerance * length)
    file.fail(int(span.size()) - 1, fmt::format("span_m = {} must be the tip of the planform, {}", span.back(), length));
  for (std::size_t n = 0; n < mass.size(); ++n)
    if (mass[n] < 0.0) file.fail(int(n), fmt::format("mass_kg_m = {} must not be negative", mass[n]));
  const double sine = std::sin(turbine.precone), cosine = std::cos(turbine.precone);
  root_radius_ = turbine.hub_radius * cosine, root_axial_ = -turbine.hub_radius * sine;
  // Two points by Gauss in each piece: mass and both moments of a linear distribution.
  for (std::size_t n = 1; n < span.size(); ++n)
    for (const double at : {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)}) {
      const double s = (1.0 - at) * span[n - 1] + at * span[n], bend = interpolate_linear(p.span, p.prebend, s);
      points_.push_back({0.5 * (span[n] - span[n - 1]) * ((1.0 - at) * mass[n - 1] + at * mass[n]), s * cosine + bend * sine,
                         bend * cosine - s * sine});
    }
}

void BladeRoots::add_mass_loads(const HubMotion& hub, const Eigen::Vector3d& axis, const Eigen::Vector3d& out,
                                const Eigen::Vector3d& gravity, Wrench& wrench) const {
  for (const Point& p : points_) {
    const Eigen::Vector3d arm = p.radius * out + p.axial * axis;
    const Eigen::Vector3d acceleration = hub.acceleration + hub.omega_rate.cross(arm) + hub.omega.cross(hub.omega.cross(arm));
    wrench.add_force(p.mass * (gravity - acceleration), arm);
  }
}

BladeRootLoad BladeRoots::seen(const Wrench& w, const Eigen::Vector3d& axis, const Eigen::Vector3d& out) {
  const Eigen::Vector3d ahead = axis.cross(out);
  return {w.force.dot(axis), w.force.dot(ahead), w.force.dot(out), -w.moment.dot(ahead), w.moment.dot(axis)};
}

}  // namespace spindrift::aero
