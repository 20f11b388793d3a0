// The floating system that a scene describes: bodies with every source of load that the scene names, and nothing else.
// Built by src/app from a Scenario; advanced by src/run; tested in tests/src/coupling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/aero/rotor_loads.hpp"
#include "src/bodies/system.hpp"
#include "src/coupling/load_sources.hpp"
#include "src/coupling/scenario.hpp"
#include "src/coupling/timeline.hpp"
#include "src/coupling/yaw_drive.hpp"
#include "src/moorings/moorings.hpp"
#include "src/sea/engineering_sea.hpp"
#include "src/sea/particle_sea.hpp"

namespace spindrift::coupling {

class FloatingSystem {
 public:
  explicit FloatingSystem(Scenario scenario);
  FloatingSystem(FloatingSystem&&) = delete;

  const Scenario& scenario() const { return scenario_; }
  const Timeline& timeline() const { return timeline_; }
  bodies::System& multibody() { return *multibody_; }

  std::span<const bodies::Beam> beams() const { return beams_; }
  const std::optional<moorings::Moorings>& moorings() const { return moorings_; }
  /// Of a scene with particles: its hydrostatics, which statics and linearisation use, where its shapes are cylinders.
  const std::optional<sea::EngineeringSea>& sea() const { return sea_; }
  /// Where a rotor is, and its loads by the engineering model; of a resolved rotor by blade element momentum on the same blades,
  /// for estimates (static equilibrium, linearisation, `check`).
  struct Rotor {
    std::string name;  ///< of its source of load and its columns: "rotor", or "rotor.NAME" of [rotors.NAME]
    double radius;     ///< as rotor_radius has it [m]
    aero::RotorLoads loads;
  };
  /// In the order of by_rotor(scenario()).
  const std::deque<Rotor>& rotors() const { return rotors_; }
  /// The first of them, which is the only one where a coupling window or resolved air asks; null where there is none.
  const aero::RotorLoads* rotor() const { return rotors_.empty() ? nullptr : &rotors_.front().loads; }

  /// Empty where nothing turns the nacelle.
  const std::optional<YawDrive>& yaw() const { return yaw_; }

  /// Whether rotor and bodies are parts of a window that exchange data by a scheme; else the rotor, if there is one, loads the
  /// bodies as they go.
  bool has_interface() const { return !rotors_.empty() && scenario_.coupling.scheme != SchemeKind::monolithic; }

  /// Bodies take the rotor's load from `loads` instead of asking the rotor as they go, and history has it from `written`, where
  /// they are given. For coupling windows.
  using RotorLoadFunction = std::function<void(double, std::span<const Motion>, std::span<Wrench>)>;
  void replace_rotor_loads(RotorLoadFunction loads, const aero::RotorLoad* written = nullptr);
  /// The air's moment that turns the rotor where the scene has control, as aero::RotorLoads::turn_by has it.
  void turn_rotor_by(aero::RotorLoads::AirMoment moment) {
    if (!rotors_.empty()) rotors_.front().loads.turn_by(std::move(moment));
  }
  /// The rotor's load as history has it: what a coupling window wrote here, else that of its state.
  aero::RotorLoad written_rotor_load(const aero::RotorLoads& rotor, double t, const aero::RotorState& now) const {
    return rotor_written_ ? rotor_written_->times(ramp_after_air(t)) : rotor.load(t, now, ramp(t));
  }

  /// Of a scene with particles, before any is made.
  const std::optional<sea::ParticlePlan>& particle_plan() const { return particle_plan_; }
  /// Makes the particles, round the bodies where they start; from then on their loads are the sea's.
  void fill_sea(std::span<const Motion> start, const runtime::World& world);
  /// Null where the scene has none or fill_sea was not called.
  sea::ParticleSea* particles() const { return particles_.get(); }

  /// Of a body, in its axes from the centre of mass.
  const Eigen::Vector3d& reference_point(std::size_t body) const { return reference_points_[body]; }

  /// Factor on the rotor's loads at time t [s] (start.ramp_s): 0 at the start, 1 after the ramp, with a continuous rate.
  double ramp(double t) const;
  /// Its parts in a coupling window: what the air's side answers has the first. A drive train is turned by the whole of it, and
  /// the second goes on what the bodies feel.
  double ramp_of_air(double t) const { return rotor()->control() ? 1.0 : ramp(t); }
  double ramp_after_air(double t) const { return rotor()->control() ? ramp(t) : 1.0; }
  /// Until told otherwise loads are ramped; the statics and stability ask for their full value (FullLoads below).
  void use_full_loads(bool full) { full_loads_ = full, loads_changed(); }
  /// For the statics: loads at their full mean value. The water is still but for its current, the wind is without gusts and
  /// turbulence, the rotor's load is its mean over a turn (MeanLoads below).
  void use_mean_loads(bool mean) { mean_loads_ = mean, loads_changed(); }

  LoadSources sources;
  /// Largest step of the bodies' integrator beside particles that choose their own [s].
  double body_step_limit_s = std::numeric_limits<double>::infinity();

 private:
  const sea::EngineeringSea& sea_now() const { return mean_loads_ && still_sea_ ? *still_sea_ : *sea_; }
  void add_rotors(const std::vector<std::string>& bodies, std::span<const Motion> start);
  /// To be called when anything that loads depend on, besides time and motions, has changed.
  void loads_changed();

  Scenario scenario_;
  Timeline timeline_;
  std::vector<bodies::Beam> beams_;
  std::optional<moorings::Moorings> moorings_;
  std::optional<sea::EngineeringSea> sea_;
  std::deque<Rotor> rotors_;
  std::optional<YawDrive> yaw_;
  RotorLoadFunction rotor_elsewhere_;
  const aero::RotorLoad* rotor_written_ = nullptr;
  std::vector<Eigen::Vector3d> reference_points_;
  bool full_loads_ = false, mean_loads_ = false;
  std::optional<sea::EngineeringSea> still_sea_;  ///< of a sea with waves: the same without them
  std::optional<sea::ParticlePlan> particle_plan_;
  std::unique_ptr<sea::ParticleSea> particles_;
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
