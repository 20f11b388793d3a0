// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/rotor_source.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernels/base/smooth_step.hpp"
#include "src/aero/turbine.hpp"
#include "src/coupling/flow_scene.hpp"

namespace spindrift::coupling {

namespace {

/// From the bearing, whose second body is the one that turns, or from the rotor's section where it names none.
aero::RotorPlacement place_rotor(const Scenario& s) {
  aero::RotorPlacement placement{.body = bodies::index_of(s.bodies, s.rotor.body),
                                 .support = {},
                                 .hub = s.rotor.hub_m,
                                 .axis = s.rotor.axis,
                                 .sense = s.rotor.sense()};
  for (const auto& [name, joint] : s.joints)
    if (name == s.rotor.joint) {
      const bool second = joint.bodies[1] == s.rotor.body;
      placement.support = bodies::index_of(s.bodies, joint.bodies[second ? 0 : 1]);
      placement.hub = bodies::point_of(joint, s.bodies);
      placement.axis = joint.axis;
    }
  return placement;
}

/// One wind for all rotors, each of which meets it at its own place: gusts and boxes are made for the middle of their hubs.
aero::WindSite site_of(std::span<const Scenario> each) {
  aero::WindSite site{place_rotor(each.front()).hub, aero::rotor_diameter(each.front().rotor)};
  site.t_end = each.front().time.end_s;
  if (each.size() == 1) return site;
  const double direction = each.front().wind.direction;
  Eigen::Matrix3d axes;  // rows: along the wind, across, up
  axes << std::cos(direction), std::sin(direction), 0.0, -std::sin(direction), std::cos(direction), 0.0, 0.0, 0.0, 1.0;
  Eigen::AlignedBox3d hubs;
  for (const Scenario& one : each) {
    hubs.extend(axes * place_rotor(one).hub);
    site.diameter = std::max(site.diameter, aero::rotor_diameter(one.rotor));
  }
  site.hub = axes.transpose() * hubs.center();
  site.upwind = 0.5 * hubs.sizes().x(), site.across = hubs.sizes().y(), site.up = hubs.sizes().z();
  return site;
}

/// [control] with the events that happen to this rotor.
aero::ControlOptions control_of(const Scenario& s, const std::string& rotor) {
  aero::ControlOptions control = s.control;
  std::erase_if(control.events, [&](const aero::EventOptions& event) { return event.rotor && *event.rotor != rotor; });
  return control;
}

/// Resolved air is estimated by blade elements, where the turbine has what they need.
aero::AeroOptions engineering_rung(const Scenario& s) {
  aero::AeroOptions aero = s.aero;
  if (aero.tower && s.rotor.tower_foot_m) aero.tower->foot_m = *s.rotor.tower_foot_m;
  if (s.resolves_air()) aero.model = aero::read_turbine(s.rotor.turbine).polars.empty() ? "none" : "bem";
  return aero;
}

}  // namespace

RotorSource::RotorSource(std::string of, const Scenario& s, const aero::Wind& wind, std::span<const Motion> start, double step_s,
                         const LoadsWanted& wanted)
    : name(std::move(of)),
      radius(rotor_radius(s)),
      loads(engineering_rung(s), s.rotor, wind, s.environment.air_density_kg_m3, place_rotor(s), start, s.control, step_s,
            s.environment.gravity()),
      ramp_s_(s.start.ramp_s),
      bodies_(s.bodies.size()),
      wanted_(wanted) {}

void RotorSource::replace(Loads by, const aero::RotorLoad* written) { replaced_ = std::move(by), written_ = written; }

aero::RotorLoad RotorSource::written(double t, const aero::RotorState& now) const {
  return written_ ? written_->times(ramp_after_air(t)) : loads.load(t, now, ramp(t));
}

double RotorSource::ramp(double t) const {
  if (wanted_.full || t >= ramp_s_) return 1.0;
  return smooth_step(t / ramp_s_);
}

void RotorSource::add_to(LoadSources& sources) {
  bodies::LoadSource source{name,
                            [this](double t, std::span<const Motion> m, std::span<Wrench> w) {
                              if (replaced_)
                                replaced_(t, m, w);
                              else if (wanted_.mean)
                                loads.add_mean_loads(t, m, w);
                              else
                                loads.add_loads(t, m, w, ramp(t));
                              if (wanted_.mean)
                                loads.add_mean_tower_drag(t, m, w);
                              else
                                loads.add_tower_drag(t, m, w, ramp(t));
                            },
                            {}};
  if (loads.flexible())
    source.added_mass = [this](double t, std::span<const Motion> m, std::span<bodies::Matrix6> a) {
      if (!wanted_.mean) loads.add_added_mass(t, m, a);
    };
  if (loads.memory_size() > 0)
    source.memory = {
        loads.memory_size(), [this](double t, std::span<const Motion> m, std::span<double> memory) { loads.begin(t, m, memory); },
        [this](std::span<const double> memory) { loads.recall(memory); },
        [this](double t, double h, std::span<const Motion> m, std::span<double> memory) { loads.remember(t, h, m, memory); }};
  std::vector<int> on{int(loads.bearing().body())};
  if (const std::optional<std::size_t> tower = loads.body_of_tower_drag()) on.push_back(int(*tower));
  sources.add(std::move(source), marked(bodies_, on));
}

std::deque<RotorSource> make_rotors(const Scenario& scenario, std::span<const Motion> start, double step_s,
                                    const LoadsWanted& wanted) {
  std::deque<RotorSource> rotors;
  std::vector<Scenario> each = by_rotor(scenario);
  if (each.empty()) return rotors;
  const aero::Wind wind = aero::wind_of(scenario.wind, site_of(each));
  for (std::size_t n = 0; n < each.size(); ++n) {
    const std::string own = scenario.rotors.empty() ? "" : scenario.rotors[n].name;
    each[n].control = control_of(scenario, own);
    rotors.emplace_back(own.empty() ? "rotor" : "rotor." + own, each[n], wind, start, step_s, wanted);
  }
  return rotors;
}

}  // namespace spindrift::coupling
