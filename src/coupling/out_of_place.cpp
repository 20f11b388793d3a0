// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/out_of_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/bodies/extent.hpp"

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

}  // namespace

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
