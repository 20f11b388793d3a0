// Sections of a scene from the files of an OpenFAST deck, as text; files that they name are written into the scene's folder.
// Called by openfast.cpp in the order in which a reader is told of them; tested in tests/src/import.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "src/import/deck_import.hpp"
#include "src/import/elastodyn.hpp"
#include "src/import/openfast.hpp"

namespace spindrift::decks {

/// What the scene is made of: decided before any section is written.
struct ImportedSystem {
  bool wet = false, floats = false;
  bool tower_bends = false;  ///< in the scene
  bool controlled = false;   ///< [control] turns the rotor
  /// A flexible tower on land is clamped to the earth.
  bool has_platform() const { return wet || !tower_bends; }
};

/// Steps of the bodies [s].
struct TimeSteps {
  double step;
  double longest = window;  ///< that blades which bend can follow
};

/// [environment], and what other sections need of it.
struct ImportedEnvironment {
  std::string text;
  double gravity, depth = 0.0, water_density = 1025.0;
};

/// [sea] and [waves], the platform's cylinders and constant forces, and the ballast within it.
struct ImportedWater {
  std::string text, platform;
  MassSum ballast;
};
ImportedWater import_water(DeckImport& run, double depth, double water_density);

/// WaveMod; 10 where "1P90" stands: a regular wave of given phase.
int wave_model(const Deck& waves);
/// [waves]. `linear`: why the scene's loads take waves of the first order alone; empty where they take those of the second.
std::string import_waves(DeckImport& run, const Deck& waves, const std::string& linear);
/// Keys of [sea]: SeaState's standard current, the sum of a power law of 1/7 over the depth, a part of the uppermost metres, and
/// one that is the same at all depths.
std::string import_current(DeckImport& run, const Deck& waves, double depth);

/// [bodies], the tower among [beams], and the foundation among [joints].
std::string import_bodies(DeckImport& run, const Deck& elastodyn, const RotorFrame& rotor, const ImportedSystem& system,
                          const ImportedWater& water);

/// [wind].
std::string import_wind(DeckImport& run, const Deck& inflow, double hub_height);

/// [wind], [aero] and [rotor]; no text without aerodynamics.
struct ImportedRotor {
  std::string text{};
  double longest_step = window;  ///< that its blades can follow [s]
};
ImportedRotor import_rotor(DeckImport& run, const Deck& elastodyn, const RotorFrame& rotor, const ImportedSystem& system,
                           ImportedBlades blades);

/// [moorings] and [junctions]. `has_waves`: the scene.
std::string import_moorings(DeckImport& run, const ImportedEnvironment& environment, bool moving_water, ImportedLines lines);

/// [control]; no text where the rotor keeps its speed.
struct ImportedControl {
  std::string text{};
  std::optional<double> step{};  ///< of the bodies, where the controller asks for one [s]
  bool shaft_twists = false;
};
ImportedControl import_control(DeckImport& run, const Deck& elastodyn, const RotorFrame& rotor, bool has_rotor, TimeSteps bodies);

}  // namespace spindrift::decks
