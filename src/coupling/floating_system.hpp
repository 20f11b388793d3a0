// The floating system that a scene describes: bodies with every source of load that the scene names, and nothing else.
// Built by src/app from a Scenario; advanced by src/run; tested in tests/src/coupling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/aero/rotor_loads.hpp"
#include "src/bodies/system.hpp"
#include "src/coupling/scenario.hpp"
#include "src/coupling/timeline.hpp"
#include "src/coupling/yaw_drive.hpp"
#include "src/moorings/moorings.hpp"
#include "src/sea/engineering_sea.hpp"
#include "src/sea/particle_sea.hpp"

namespace spindrift::coupling {

/// Time spent in one source of load, counted inside the right-hand side of the bodies.
struct SourceClock {
  std::int64_t ns = 0, calls = 0;
};

class FloatingSystem {
 public:
  explicit FloatingSystem(Scenario scenario);
  FloatingSystem(const FloatingSystem&) = delete;
  FloatingSystem& operator=(const FloatingSystem&) = delete;

  const Scenario& scenario() const { return scenario_; }
  const Timeline& timeline() const { return timeline_; }
  bodies::System& multibody() { return *multibody_; }

  std::span<const bodies::Beam> beams() const { return beams_; }
  Eigen::Vector3d gravity_m_s2() const { return {0.0, 0.0, -scenario_.environment.gravity_m_s2}; }
  const std::optional<moorings::Moorings>& moorings() const { return moorings_; }
  /// Of a scene with particles: its hydrostatics, which statics and linearisation use, where its shapes are cylinders.
  const std::optional<sea::EngineeringSea>& sea() const { return sea_; }
  /// Where the rotor is, and its loads by the engineering model; of a resolved rotor by blade element momentum on the same
  /// blades, for estimates (static equilibrium, linearisation, `check`).
  const std::optional<aero::RotorLoads>& rotor() const { return rotor_; }

  /// Empty where nothing turns the nacelle.
  const std::optional<YawDrive>& yaw() const { return yaw_; }

  /// Whether rotor and bodies are parts of a window that exchange data by a scheme; else the rotor, if there is one, loads the
  /// bodies as they go.
  bool has_interface() const { return rotor_.has_value() && scenario_.coupling.scheme != SchemeKind::monolithic; }

  /// Bodies take the rotor's load from `loads` instead of asking the rotor as they go; an empty one undoes it. For coupling
  /// windows.
  using RotorLoadFunction = std::function<void(double, std::span<const Motion>, std::span<Wrench>)>;
  void replace_rotor_loads(RotorLoadFunction loads);
  /// The rotor's load as history has it: what a coupling window wrote here, else that of its state.
  aero::RotorLoad written_rotor_load(double t, const aero::RotorState& now) const {
    return rotor_written_ ? *rotor_written_ : rotor_->load(t, now, ramp(t));
  }
  void write_rotor_load(const aero::RotorLoad* load) { rotor_written_ = load; }

  bool has_waves() const { return scenario_.has_waves() && !scenario_.has_particles(); }

  /// Windows before t = 0 in which the bodies are held, and the tick (not above zero) with which the run begins.
  std::int64_t held_windows() const { return std::llround(scenario_.sea.settle_s() / timeline_.window_s()); }
  std::int64_t first_tick() const { return -timeline_.tick_of_window(held_windows()); }

  /// Of a scene with particles, before any is made.
  const std::optional<sea::ParticlePlan>& particle_plan() const { return particle_plan_; }
  /// Makes the particles, round the bodies where they start; from then on their loads are the sea's.
  void fill_sea(std::span<const Motion> start, const runtime::World& world);
  /// Null where the scene has none or fill_sea was not called.
  sea::ParticleSea* particles() const { return particles_.get(); }
  /// Largest step of the bodies' integrator beside particles that choose their own [s].
  double body_step_limit() const { return body_step_limit_; }
  void limit_body_step(double limit_s) { body_step_limit_ = limit_s; }

  /// Whether the source can load the body at all (what cannot is not written).
  bool loads_body(std::size_t source, std::size_t body) const { return loaded_[source][body]; }
  /// Of a body, in its axes from the centre of mass.
  const Eigen::Vector3d& reference_point(std::size_t body) const { return reference_points_[body]; }

  /// By source, in the order of multibody().loads().
  std::span<const SourceClock> clocks() const { return clocks_; }
  void reset_clocks() { clocks_.assign(clocks_.size(), {}); }
  void set_clocks(std::span<const SourceClock> clocks) { clocks_.assign(clocks.begin(), clocks.end()); }

  /// Factor on the rotor's loads at time t [s] (start.ramp_s): 0 at the start, 1 after the ramp, with a continuous rate.
  double ramp(double t) const;
  /// Until told otherwise loads are ramped; the statics and stability ask for their full value (FullLoads below).
  void use_full_loads(bool full) { full_loads_ = full, loads_changed(); }
  /// For the statics: loads at their full mean value. The water is still but for its current, the wind is without gusts and
  /// turbulence, the rotor's load is its mean over a turn (MeanLoads below).
  void use_mean_loads(bool mean) { mean_loads_ = mean, loads_changed(); }

 private:
  const sea::EngineeringSea& sea_now() const { return mean_loads_ && still_sea_ ? *still_sea_ : *sea_; }
  /// To be called when anything that loads depend on, besides time and motions, has changed.
  void loads_changed();
  void add_source(std::vector<bodies::LoadSource>& sources, bodies::LoadSource source, std::vector<bool> on);

  Scenario scenario_;
  Timeline timeline_;
  std::vector<bodies::Beam> beams_;
  std::optional<moorings::Moorings> moorings_;
  std::optional<sea::EngineeringSea> sea_;
  std::optional<aero::RotorLoads> rotor_;
  std::optional<YawDrive> yaw_;
  RotorLoadFunction rotor_elsewhere_;
  const aero::RotorLoad* rotor_written_ = nullptr;
  std::vector<Eigen::Vector3d> reference_points_;
  std::vector<std::vector<bool>> loaded_;  ///< [source][body]
  std::vector<SourceClock> clocks_;
  bool full_loads_ = false, mean_loads_ = false;
  std::optional<sea::EngineeringSea> still_sea_;  ///< of a sea with waves: the same without them
  std::optional<sea::ParticlePlan> particle_plan_;
  std::unique_ptr<sea::ParticleSea> particles_;
  double body_step_limit_ = std::numeric_limits<double>::infinity();
  std::unique_ptr<bodies::System> multibody_;
};

/// Changes how the floating system's loads are evaluated while this lives.
template <void (FloatingSystem::*use)(bool)>
class LoadsAsked {
 public:
  explicit LoadsAsked(FloatingSystem& floating) : floating_(floating) { (floating_.*use)(true); }
  ~LoadsAsked() { (floating_.*use)(false); }
  LoadsAsked(const LoadsAsked&) = delete;
  LoadsAsked& operator=(const LoadsAsked&) = delete;

 private:
  FloatingSystem& floating_;
};
using FullLoads = LoadsAsked<&FloatingSystem::use_full_loads>;
using MeanLoads = LoadsAsked<&FloatingSystem::use_mean_loads>;

}  // namespace spindrift::coupling
