// SPDX-License-Identifier: Apache-2.0
#include "src/aero/blade_loads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "kernels/base/failure.hpp"

namespace spindrift::aero {

namespace {

UnsteadyFlow::Stall stall_named(std::string_view name) {
  if (name == "oye") return UnsteadyFlow::Stall::oye;
  if (name == "beddoes_leishman") return UnsteadyFlow::Stall::beddoes_leishman;
  if (name == "none") return UnsteadyFlow::Stall::none;
  throw std::invalid_argument("bem: no model of dynamic stall is called " + std::string(name));
}

/// None where the scene names none.
std::optional<FreeVortexWake::Options> wake_of(const AeroOptions& aero, double air_density) {
  if (aero.dynamic_inflow != "free_vortex") return std::nullopt;
  return FreeVortexWake::Options{aero.wake_turns, aero.wake_step, aero.wake_core_chords, aero.kinematic_viscosity(air_density)};
}

}  // namespace

BladeLoads::BladeLoads(const Turbine& turbine, const AeroOptions& aero, const RotorOptions& rotor, double air_density)
    : elements_(turbine, aero.induction, air_density,
                {.inflow = aero.dynamic_inflow == "oye",
                 .inflow_time = aero.inflow_time_s,
                 .stall = stall_named(aero.dynamic_stall),
                 .stall_lag = aero.stall_lag_chords,
                 .speed_of_sound = aero.speed_of_sound_m_s,
                 .wake = wake_of(aero, air_density)},
                aero.kinematic_viscosity(air_density), aero.skew_momentum) {
  if (!rotor.blade_masses.empty()) roots_.emplace(turbine, read_blade_masses(turbine, rotor.blade_masses));
  if (!rotor.blade_structure.empty()) {
    const BladeStructure structure = read_blade_structure(turbine, rotor.blade_structure);
    roots_.emplace(turbine, structure.masses);
    flexible_.emplace(turbine, structure, rotor.blade_damping);
  }
}

std::span<double> BladeLoads::used(OnModes& on_modes) const {
  return std::span(on_modes).first(std::size_t(FlexibleBlades::modes * flexible_->blades()));
}

/// Of blades at rest in the turning rotor, bent by the air and by their own weight and inertia.
FlexibleBlades::Bending BladeLoads::settled(const BladesAt& at, std::span<const double> flow) const {
  FlexibleBlades::Bending bending;
  DiscMotion motion = at.rotor;
  OnModes air{};
  const std::size_t modes = used(air).size();
  constexpr int most = 50;  // the air's force hardly changes with bending: each pass leaves a tenth or less of the error
  constexpr double enough = 1e-12;
  double left = 0.0;
  // Of soft blades a pass may leave most of the error, or more of it. Such a blade goes a share of the way from then on, by
  // Aitken's rule for vectors (Irons & Tuck 1969, Int. J. Numer. Meth. Eng. 1, 275).
  struct Way {
    FlexibleBlades::Modal asked = FlexibleBlades::Modal::Zero();
    double change = std::numeric_limits<double>::infinity(), share = 1.0;
    bool slow = false;
  };
  std::array<Way, most_blades> ways;
  for (int pass = 0; pass < most; ++pass) {
    const FlexibleBlades::Bending before = bending;
    const BentBlades bent = flexible_->bent(before);
    motion.bent = &bent;
    elements_.on_modes(at.wind, motion, at.t, flow, used(air));
    flexible_->settle(motion, at.hub, air, bending);
    double change = 0.0, size = 0.0;
    for (int b = 0; b < flexible_->blades(); ++b) {
      Way& way = ways[std::size_t(b)];
      const FlexibleBlades::Modal asked = bending.amplitude(b) - before.amplitude(b), by = asked - way.asked;
      const double now = asked.cwiseAbs().maxCoeff();
      change = std::max(change, now), size = std::max(size, bending.amplitude(b).cwiseAbs().maxCoeff());
      way.slow = way.slow || now > 0.5 * way.change;
      if (way.slow && by.squaredNorm() > 0.0)
        way.share = std::clamp(-way.share * way.asked.dot(by) / by.squaredNorm(), 0.05, 1.0);
      way.asked = asked, way.change = now;
    }
    if (change <= enough * size) return bending;
    left = change / size;
    for (int b = 0; b < flexible_->blades(); ++b)
      if (const Way& way = ways[std::size_t(b)]; way.slow) bending.amplitude(b) = before.amplitude(b) + way.share * way.asked;
  }
  constexpr double close = 1e-3;
  if (!(left <= close))
    throw NumericalFailure(
        fmt::format("t = {:.4g} s: blades find no rest under the air: after {} passes their bending changes by "
                    "{:.2g} of itself; look at their stiffness, at the wind and at the rotor's speed",
                    at.t, most, left),
        "rotor", 0, at.t, left);
  return bending;
}

void BladeLoads::fill(const BladesAt& at, bool at_rest, Load& load) const {
  const std::span<const double> flow = of_flow(at.memory);
  const int blades = int(roots());
  load.roots.resize(std::size_t(blades));
  for (int b = 0; b < blades; ++b)
    load.roots[std::size_t(b)] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                  roots_->root(at.rotor.axis, blade_direction(at.rotor, b, blades))};
  if (!flexible_) {
    load.disc = elements_(at.wind, at.rotor, at.t, flow, load.roots);
    return;
  }
  load.bending = at.memory.empty() || at_rest ? settled(at, flow) : flexible_->predicted(of_bending(at.memory), at.t);
  const BentBlades bent = flexible_->bent(load.bending);
  DiscMotion motion = at.rotor;
  motion.bent = &bent;
  load.disc = elements_.on_modes(at.wind, motion, at.t, flow, used(load.on_modes), load.roots);
}

Eigen::Matrix<double, 6, 1> BladeLoads::reaction(const BladesAt& at, const Load& load) const {
  if (!flexible_) return Eigen::Matrix<double, 6, 1>::Zero();
  const BentBlades bent = flexible_->bent(load.bending);
  DiscMotion motion = at.rotor;
  motion.bent = &bent;
  return flexible_->reaction(motion, at.hub, load.bending, load.on_modes);
}

std::vector<BladeRootLoad> BladeLoads::root_loads(const BladesAt& at, const Load& load, const HubMotion& hub,
                                                  const Eigen::Vector3d& gravity, double ramp) const {
  DiscMotion rotor = at.rotor;
  BentBlades bent;
  if (flexible_) bent = flexible_->bent(load.bending), rotor.bent = &bent;
  const int blades = int(roots());
  std::vector<BladeRootLoad> loads;
  for (int b = 0; b < blades; ++b) {
    const Eigen::Vector3d out = blade_direction(rotor, b, blades);
    Wrench w = load.roots[std::size_t(b)];
    w.force *= ramp, w.moment *= ramp;
    std::vector<MassMotion> moved;
    if (flexible_) {
      Eigen::Matrix<double, 6, 1> beyond;
      beyond << hub.acceleration, hub.omega_rate - at.hub.omega_rate;
      moved = flexible_->mass_motions(rotor, b, at.hub, beyond, load.bending, load.on_modes);
    }
    roots_->add_mass_loads(hub, rotor.axis, out, gravity, w, moved);
    loads.push_back(BladeRoots::along_blade(w, rotor.axis, out, rotor.sense));
  }
  return loads;
}

std::vector<Eigen::Vector2d> BladeLoads::tips(const BladesAt& at) const {
  const FlexibleBlades::Bending bending = at.memory.empty() ? settled(at, {}) : flexible_->predicted(of_bending(at.memory), at.t);
  std::vector<Eigen::Vector2d> tips;
  for (int b = 0; b < flexible_->blades(); ++b) tips.push_back(flexible_->tip(at.rotor, b, bending));
  return tips;
}

std::size_t BladeLoads::memory_size() const { return elements_.memory_size() + (flexible_ ? flexible_->memory_size() : 0); }

void BladeLoads::begin(const BladesAt& at, double speed, std::span<double> memory) const {
  const std::span<double> flow = of_flow(memory);
  if (!flow.empty()) elements_.begin(at.wind, at.rotor, at.t, flow);
  if (!flexible_) return;
  // At rest in the turning rotor: amplitudes go with the azimuth, and so have rates.
  constexpr double soon = 0.02;  // [s]
  BladesAt later = at;
  later.rotor.azimuth += soon * speed;
  FlexibleBlades::Bending bending = settled(at, flow);
  const FlexibleBlades::Bending next = settled(later, flow);
  for (std::size_t k = 0; k < bending.rates.size(); ++k) bending.rates[k] = (next.amplitudes[k] - bending.amplitudes[k]) / soon;
  const BentBlades bent = flexible_->bent(bending);
  DiscMotion motion = at.rotor;
  motion.bent = &bent;
  OnModes air{};
  elements_.on_modes(at.wind, motion, at.t, flow, used(air));
  flexible_->begin(at.t, motion, at.hub, bending, air, of_bending(memory));
}

void BladeLoads::remember(const BladesAt& at, double h, std::span<double> memory) const {
  const std::span<double> flow = of_flow(memory);
  DiscMotion motion = at.rotor;
  FlexibleBlades::Bending bending;
  BentBlades bent;
  if (flexible_) bending = flexible_->predicted(of_bending(memory), at.t), bent = flexible_->bent(bending), motion.bent = &bent;
  if (!flow.empty()) elements_.remember(at.wind, motion, at.t, h, flow);
  if (!flexible_) return;
  OnModes air{};
  elements_.on_modes(at.wind, motion, at.t, flow, used(air));
  flexible_->advance(at.t, h, motion, at.hub, air, of_bending(memory));
}

}  // namespace spindrift::aero
