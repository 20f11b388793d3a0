// A scene, read and checked: the options of every module, side by side, and the rules between them.
// Nothing after it uses the parser. Built by read_scenario; used by FloatingSystem; tested in
// tests/src/coupling/scenario_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/aero/control_options.hpp"
#include "src/aero/options.hpp"
#include "src/bodies/beam_options.hpp"
#include "src/bodies/options.hpp"
#include "src/coupling/coupling_options.hpp"
#include "src/coupling/options.hpp"
#include "src/moorings/options.hpp"
#include "src/scene/document.hpp"
#include "src/sea/engineering_sea.hpp"
#include "src/sea/options.hpp"
#include "src/sea/particle_sea.hpp"

namespace spindrift::coupling {

struct Scenario {
  std::string source;  ///< the scene file as the user named it
  TimeOptions time;
  EnvironmentOptions environment;
  StartOptions start;
  RuntimeOptions runtime;
  OutputOptions output;
  CheckpointOptions checkpoint;
  CouplingOptions coupling;
  bodies::NamedBodies bodies;
  bodies::NamedJoints joints;
  bodies::NamedBeams beams;
  std::vector<scene::Named<moorings::LineOptions>> moorings;
  std::vector<scene::Named<moorings::JunctionOptions>> junctions;
  aero::AeroOptions aero;
  /// [rotor], or the first of [rotors.NAME]: that of resolved air, and of a scene that by_rotor gives.
  aero::RotorOptions rotor;
  std::string rotor_section = "rotor";  ///< where it stands: "rotor", "rotors.NAME"
  std::vector<scene::Named<aero::RotorOptions>> rotors;
  aero::WindOptions wind;
  aero::ControlOptions control;
  sea::SeaOptions sea;
  sea::WavesOptions waves;

  bool resolves_air() const { return aero.resolves_air(); }
  bool has_actuator() const { return aero.acts(); }
  bool has_flow() const { return resolves_air() && bodies.empty(); }  ///< the air by itself: src/run/flow_simulation.hpp
  bool has_rotor() const { return aero.model != "none" && !has_flow(); }
  /// Simulated time between fields of resolved air round a rotor on bodies; 0: at the end alone.
  double air_interval_s() const { return output.air_interval_s.value_or(sea.fields ? sea.fields->interval_s : 0.0); }
  bool is_controlled() const { return control.model != aero::ControlModel::none; }
  bool has_sea() const { return sea.model != "none"; }
  bool has_waves() const { return has_sea() && waves.model != "none"; }
  /// Given by theory; particles make their own.
  bool has_given_waves() const { return has_waves() && !has_particles(); }
  bool has_particles() const { return sea.has_particles(); }

  /// The unit of time that steps are counted in. Substeps of a sea of particles are even numbers of ticks (bodies are evaluated
  /// at their middle); where its step is not given, a window has enough ticks that rounding a step to them does not show.
  double tick_s() const {
    if (!has_particles()) return time.step();
    return time.step_s ? 0.5 * *time.step_s : time.window_s / ticks_per_free_window;
  }
  static constexpr double ticks_per_free_window = 16777216.0;
};

/// Every section of the program, for the reader, `spindrift reference` and inputs/REFERENCE.md.
std::span<const scene::SectionBase* const> all_sections();

/// Reads and checks the whole document; throws scene::SceneError with every problem.
Scenario read_scenario(scene::Document& document);

/// The scene with each of its rotors alone; with [rotor] as it is, without a rotor none.
std::vector<Scenario> by_rotor(const Scenario& scenario);

/// The bodies for the engineering sea, in the order of the scene.
std::vector<sea::SeaBody> sea_bodies(const bodies::NamedBodies& bodies);

/// The same for a sea of particles.
std::vector<sea::ParticleBody> particle_bodies(const bodies::NamedBodies& bodies);

sea::SeaEnvironment sea_environment(const EnvironmentOptions& environment);

/// What is modelled, in words: "3 lines (spring_damper)".
std::string describe_bodies(const Scenario& scenario);
std::string describe_rotor(const Scenario& scenario);  ///< of one of by_rotor
std::string describe_sea(const Scenario& scenario);
std::string describe_moorings(const Scenario& scenario);

}  // namespace spindrift::coupling
