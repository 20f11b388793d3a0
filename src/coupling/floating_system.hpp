// The floating system that a scene describes: bodies with every source of load that the scene names, and nothing else.
// Built by src/app from a Scenario; advanced by src/run; tested in tests/src/coupling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/bodies/system.hpp"
#include "src/coupling/load_sources.hpp"
#include "src/coupling/rotor_source.hpp"
#include "src/coupling/scenario.hpp"
#include "src/coupling/sea_source.hpp"
#include "src/coupling/timeline.hpp"
#include "src/coupling/yaw_drive.hpp"
#include "src/moorings/moorings.hpp"

namespace spindrift::coupling {

class FloatingSystem {
 public:
  explicit FloatingSystem(Scenario scenario);
  FloatingSystem(FloatingSystem&&) = delete;

  const Scenario& scenario() const { return scenario_; }
  const Timeline& timeline() const { return timeline_; }
  bodies::System& multibody() { return *multibody_; }
  const bodies::System& multibody() const { return *multibody_; }

  std::span<const bodies::Beam> beams() const { return beams_; }
  const std::optional<moorings::Moorings>& moorings() const { return moorings_; }
  /// As SeaSource::engineering() and so on.
  const sea::EngineeringSea* sea() const { return sea_.engineering(); }
  const sea::ParticlePlan* particle_plan() const { return sea_.plan(); }
  sea::ParticleSea* particles() const { return sea_.particles(); }
  void fill_sea(std::span<const Motion> start, const runtime::World& world) { sea_.fill(start, world); }

  /// In the order of by_rotor(scenario()).
  const std::deque<RotorSource>& rotors() const { return rotors_; }
  /// The first of them, which is the only one where a coupling window or resolved air asks; null where there is none.
  const aero::RotorLoads* rotor() const { return rotors_.empty() ? nullptr : &rotors_.front().loads; }
  /// @pre rotor()
  RotorSource& rotor_source() { return rotors_.front(); }
  const RotorSource& rotor_source() const { return rotors_.front(); }
  /// As RotorSource::replace(). @pre rotor()
  void replace_rotor_loads(RotorSource::Loads loads, const aero::RotorLoad* written = nullptr);
  /// Whether rotor and bodies are parts of a window that exchange data by a scheme; else the rotor, if there is one, loads the
  /// bodies as they go.
  bool has_interface() const { return !rotors_.empty() && scenario_.coupling.scheme != SchemeKind::monolithic; }

  /// Empty where nothing turns the nacelle.
  const std::optional<YawDrive>& yaw() const { return yaw_; }

  /// Of a body, in its axes from the centre of mass.
  const Eigen::Vector3d& reference_point(std::size_t body) const { return reference_points_[body]; }

  /// For FullLoads and MeanLoads below.
  void use_full_loads(bool full) { loads_.full = full, loads_changed(); }
  void use_mean_loads(bool mean) { loads_.mean = mean, loads_changed(); }

  LoadSources sources;
  /// Largest step of the bodies' integrator beside particles that choose their own [s].
  double body_step_limit_s = std::numeric_limits<double>::infinity();

 private:
  /// To be called when anything that loads depend on, besides time and motions, has changed.
  void loads_changed();

  Scenario scenario_;
  Timeline timeline_;
  LoadsWanted loads_;
  SeaSource sea_;
  std::vector<bodies::Beam> beams_;
  std::optional<moorings::Moorings> moorings_;
  std::deque<RotorSource> rotors_;
  std::optional<YawDrive> yaw_;
  std::vector<Eigen::Vector3d> reference_points_;
  std::unique_ptr<bodies::System> multibody_;
};

/// Throws scene::SceneError that names the system's scene, a key of it, its value and what is wrong with that.
[[noreturn]] void refuse(const FloatingSystem& floating, std::string key, std::string value, std::string message);

/// Loads are evaluated as LoadsWanted has it while this lives.
template <void (FloatingSystem::*use)(bool)>
class UseLoads {
 public:
  explicit UseLoads(FloatingSystem& floating) : floating_(floating) { (floating_.*use)(true); }
  ~UseLoads() { (floating_.*use)(false); }
  UseLoads(const UseLoads&) = delete;
  UseLoads& operator=(const UseLoads&) = delete;

 private:
  FloatingSystem& floating_;
};
using FullLoads = UseLoads<&FloatingSystem::use_full_loads>;
using MeanLoads = UseLoads<&FloatingSystem::use_mean_loads>;

}  // namespace spindrift::coupling
