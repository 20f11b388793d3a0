// SPDX-License-Identifier: Apache-2.0
#include "src/aero/blade_roots.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kernels/base/interpolation.hpp"
#include "src/scene/columns.hpp"

namespace spindrift::aero {

namespace {

/// Two points by Gauss in each piece: mass and both moments of a linear distribution. visit(piece, share of the way in it).
template <class Visit>
void for_each_mass(const BladeMasses& m, const Visit& visit) {
  for (std::size_t n = 1; n < m.span.size(); ++n)
    for (const double at : {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)}) visit(n, at);
}

}  // namespace

BladeMasses read_blade_masses(const Turbine& turbine, const std::string& path) {
  const scene::Columns file = scene::read_columns(path);
  file.allow_only({"span_m", "mass_kg_m"});
  return blade_masses_of(turbine, file);
}

BladeMasses blade_masses_of(const Turbine& turbine, const scene::Columns& file) {
  file.require_rows(2);
  file.require_increasing("span_m", "distance from the rotor axis along the blade");
  const auto span = file["span_m"], mass = file["mass_kg_m"];
  constexpr double tolerance = 1e-3;  // of the span
  const double length = turbine.planform.span.back();
  if (std::abs(span.front() - turbine.hub_radius) > tolerance * length)
    file.fail(0, fmt::format("span_m = {} must be the turbine's hub_radius_m = {}", span.front(), turbine.hub_radius));
  if (std::abs(span.back() - length) > tolerance * length)
    file.fail(int(span.size()) - 1, fmt::format("span_m = {} must be the tip of the planform, {}", span.back(), length));
  for (std::size_t n = 0; n < mass.size(); ++n)
    if (mass[n] < 0.0) file.fail(int(n), fmt::format("mass_kg_m = {} must not be negative", mass[n]));
  return {{span.begin(), span.end()}, {mass.begin(), mass.end()}};
}

std::vector<double> BladeRoots::stations(const BladeMasses& m) {
  std::vector<double> at;
  for_each_mass(m, [&](std::size_t n, double share) { at.push_back((1.0 - share) * m.span[n - 1] + share * m.span[n]); });
  return at;
}

BladeRoots::BladeRoots(const Turbine& turbine, const BladeMasses& m) : blades_(turbine.blades) {
  const Planform& p = turbine.planform;
  const double sine = std::sin(turbine.precone), cosine = std::cos(turbine.precone);
  root_radius_ = turbine.hub_radius * cosine, root_axial_ = -turbine.hub_radius * sine;
  for_each_mass(m, [&](std::size_t n, double at) {
    const double s = (1.0 - at) * m.span[n - 1] + at * m.span[n], bend = interpolate_linear(p.span, p.prebend, s);
    points_.push_back({0.5 * (m.span[n] - m.span[n - 1]) * ((1.0 - at) * m.mass[n - 1] + at * m.mass[n]),
                       s * cosine + bend * sine, bend * cosine - s * sine});
  });
}

void BladeRoots::add_mass_loads(const HubMotion& hub, const Eigen::Vector3d& axis, const Eigen::Vector3d& out,
                                const Eigen::Vector3d& gravity, Wrench& wrench, std::span<const MassMotion> bent) const {
  for (std::size_t n = 0; n < points_.size(); ++n) {
    const Point& p = points_[n];
    Eigen::Vector3d arm = p.radius * out + p.axial * axis;
    if (!bent.empty()) arm += bent[n].displacement;
    Eigen::Vector3d acceleration = hub.acceleration + hub.omega_rate.cross(arm) + hub.omega.cross(hub.omega.cross(arm));
    if (!bent.empty()) acceleration += bent[n].acceleration;
    wrench.add_force(p.mass * (gravity - acceleration), arm);
  }
}

BladeRootLoad BladeRoots::along_blade(const Wrench& w, const Eigen::Vector3d& axis, const Eigen::Vector3d& out, double sense) {
  const Eigen::Vector3d side = axis.cross(out);
  return {w.force.dot(axis), sense * w.force.dot(side), w.force.dot(out), -w.moment.dot(side), sense * w.moment.dot(axis)};
}

}  // namespace spindrift::aero
