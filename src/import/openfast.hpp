// A scene from an OpenFAST deck (versions 3 to 5): turbine, polars, platform, potential flow or strips, lines, waves, wind.
// Called by src/app/import.cpp; tested in tests/src/import.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace spindrift::decks {

struct Imported {
  std::filesystem::path scene;        ///< what was written, with its files beside it
  std::vector<std::string> left_out;  ///< what the deck has and the scene has not, one sentence each
  std::vector<std::string> carried;   ///< what the scene has, one line each
  /// Of a windIO turbine: what its rotor may take from the wind [W], where the file says, and the winds of its operating table
  /// [m/s].
  struct Rating {
    std::optional<double> power_W{};
    double least_wind = 0.0, most_wind = 0.0;
  } rating{};
};

/// A tower that bends in the deck (TwFADOF1 ... TwSSDOF2) is a beam of the scene, or by choice one rigid body with the platform.
enum class ImportedTower { rigid, as_in_deck };
enum class ImportedBlades { rigid, as_in_deck };
/// MoorDyn's lines are dynamic, or by choice catenaries; MAP++ has no others.
enum class ImportedLines { quasi_static, as_in_deck };

/// Reads the deck and writes scene.toml and its files into a folder that is made where it is missing. Throws scene::SceneError
/// naming file and line of what cannot be read.
Imported import_openfast(const std::filesystem::path& main_file, const std::filesystem::path& folder,
                         ImportedTower tower = ImportedTower::as_in_deck, ImportedBlades blades = ImportedBlades::as_in_deck,
                         ImportedLines lines = ImportedLines::as_in_deck);

}  // namespace spindrift::decks
