// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/out_of_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernels/rigid/closed_surface.hpp"
#include "src/bodies/extent.hpp"
#include "src/sea/particle_sea.hpp"

namespace spindrift::coupling {

namespace {

/// "rotor", or "rotor a".
std::string spoken(const RotorSource& rotor) {
  std::string name = rotor.name;
  std::ranges::replace(name, '.', ' ');
  return name;
}

/// Modes of a straight beam hold for bending that is small beside its length.
std::optional<NumericalFailure> bent_too_far(const RotorSource& rotor, const bodies::BodiesState& state, double t) {
  if (!rotor.loads.flexible()) return {};
  const double most = rotor.radius / 3.0;
  const std::vector<Eigen::Vector2d> tips = rotor.loads.tips(t, state.motions);
  for (std::size_t blade = 0; blade < tips.size(); ++blade)
    if (!(tips[blade].norm() <= most))
      return NumericalFailure(
          fmt::format("t = {:.4g} s: blade {} of the {} bends by {:.4g} m at its tip, the limit is {:.4g} m, a third of its "
                      "length: small bending is all that its modes know; look at its stiffness, at the wind and at the "
                      "rotor's speed",
                      t, blade + 1, spoken(rotor), tips[blade].norm(), most),
          rotor.name, long(state.tick), t, most);
  return {};
}

bool tied(const Scenario& s, const std::string& one, const std::string& other) {
  const auto holds = [&](const std::vector<std::string>& both) {
    return std::ranges::find(both, one) != both.end() && std::ranges::find(both, other) != both.end();
  };
  return std::ranges::any_of(s.joints, [&](const auto& joint) { return holds(joint.options.bodies); }) ||
         std::ranges::any_of(s.beams, [&](const auto& beam) { return holds(beam.options.bodies); });
}

/// How deep a point is in bed, walls and obstacles of the tank, and in which of them [m].
std::pair<double, std::string> depth_in_tank(const sph::TankPlan& tank, bool planar, const Eigen::Vector3d& at) {
  std::pair<double, std::string> most{0.0, ""};
  const auto in = [&](double depth, const std::string& what) {
    if (depth > most.first) most = {depth, what};
  };
  in(tank.bed_at(at.x()) - at.z(), "the bed");
  if (at.z() < tank.top)
    for (int axis = 0; axis < (planar ? 1 : 2); ++axis) {
      const std::array<double, 2>& sides = axis == 0 ? tank.x : tank.y;
      if (!tank.periodic[std::size_t(axis)] && !tank.open[std::size_t(axis)])
        in(std::max(tank.mirrored && axis == 1 ? 0.0 : sides[0] - at[axis], at[axis] - sides[1]), "a wall of the tank");
    }
  for (std::size_t n = 0; n < tank.obstacles.size(); ++n) {
    const sph::TankPlan::Block& block = tank.obstacles[n];
    double depth = std::min(at.x() - block.low.x(), block.high.x() - at.x());
    depth = std::min({depth, at.z() - block.low.z(), block.high.z() - at.z()});
    if (!planar) depth = std::min({depth, at.y() - block.low.y(), block.high.y() - at.y()});
    in(depth, fmt::format("sea.obstacles[{}]", n));
  }
  for (std::size_t n = 0; n < tank.walls.size(); ++n) {
    const double distance = tank.walls[n].surface->signed_distance(at);
    in(tank.walls[n].water_inside ? distance : -distance, fmt::format("sea.tank.meshes[{}]", n));
  }
  return most;
}

}  // namespace

bool has_level_water(const Scenario& scenario) {
  const sea::SeaOptions& sea = scenario.sea;
  if (!sea.has_particles() || sea.water.empty()) return true;
  return sea.water.size() == 1 && sea::stands_level(sea, scenario.environment.water_depth_m, sea.tank->x_m, sea.tank->y_m);
}

void require_room(const FloatingSystem& floating, const bodies::BodiesState& start) {
  const sea::ParticlePlan* plan = floating.particle_plan();
  if (!plan) return;
  const Scenario& s = floating.scenario();
  const bool planar = plan->options.planar();
  const sph::Cut cut = planar ? sph::Cut::plane : sph::Cut::space;
  constexpr double points_of_size = 24.0;  // are enough to see how deep
  for (std::size_t b = 0; b < plan->bodies.size(); ++b) {
    const sea::ParticleBody& body = plan->bodies[b];
    if (body.shapes.empty()) continue;
    const double spacing = plan->options.spacing_m;
    const double step = std::max(spacing, 2.0 * bodies::extent(s.bodies[b].options) / points_of_size);
    const Motion& at = start.motions[b];
    std::pair<double, std::string> deepest{spacing, ""};
    for (const auto& point : sph::fill_body(body.shapes, step, cut)) {
      const Eigen::Vector3d x = at.position + at.attitude * point;
      if (!tied(s, body.name, "earth"))
        if (const auto found = depth_in_tank(plan->tank, planar, x); found.first > deepest.first) deepest = found;
      for (std::size_t c = 0; c < plan->bodies.size(); ++c) {
        const sea::ParticleBody& other = plan->bodies[c];
        if (c == b || other.shapes.empty() || tied(s, body.name, other.name)) continue;
        const Motion& there = start.motions[c];
        const double depth = -sph::signed_distance(other.shapes, there.attitude.conjugate() * (x - there.position), cut);
        if (depth > deepest.first) deepest = {depth, "body " + other.name};
      }
    }
    if (!deepest.second.empty())
      refuse(floating, "bodies." + body.name, "",
             fmt::format(
                 "starts {:.3g} m deep in {}: contact would throw it off; look at its shapes, their place and displacement_m",
                 deepest.first, deepest.second));
  }
}

std::optional<NumericalFailure> out_of_place(const FloatingSystem& floating, const bodies::BodiesState& state) {
  const Scenario& s = floating.scenario();
  const double t = double(state.tick) * floating.timeline().tick_s(), bed = -s.environment.water_depth_m;
  for (const RotorSource& rotor : floating.rotors())
    if (std::optional<NumericalFailure> bent = bent_too_far(rotor, state, t)) return bent;
  if (!s.has_sea() || s.has_particles()) return {};
  for (std::size_t b = 0; b < s.bodies.size(); ++b) {
    const auto& [name, body] = s.bodies[b];
    const bodies::Reach r = bodies::reach(body, state.motions[b]);
    const double most = 0.1 * bodies::extent(body);
    if (r.any && bed - r.low > most)
      return NumericalFailure(
          fmt::format("t = {:.4g} s: body {} is {:.4g} m deep in the bed at z = {:.4g} m, the limit is {:.3g} m, a "
                      "tenth of its size: the bed carries no bodies; look at its weight, its shapes, its "
                      "lines and environment.water_depth_m",
                      t, name, bed - r.low, bed, most),
          "bodies." + name, long(state.tick), t, most);
  }
  for (const RotorSource& rotor : floating.rotors()) {
    const aero::RotorState now = rotor.loads.state(t, state.motions);
    const double low = now.hub.z() - rotor.radius * std::sqrt(std::max(0.0, 1.0 - now.axis.z() * now.axis.z()));
    const double surface = floating.sea() ? floating.sea()->elevation(now.hub.x(), now.hub.y(), t) : 0.0;
    if (low < surface)
      return NumericalFailure(
          fmt::format("t = {:.4g} s: the {} reaches {:.4g} m into the water: its hub is at z = {:.4g} m, the "
                      "surface there at {:.4g} m; look at the hub's height and at what holds the floating system up",
                      t, spoken(rotor), surface - low, now.hub.z(), surface),
          rotor.name, long(state.tick), t, 0.0);
  }
  return {};
}

}  // namespace spindrift::coupling
