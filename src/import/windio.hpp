// A turbine from a file of the IEA ontology (windIO 1.x, as WISDEM reads it): blades, polars, hub, axis, tower, operating table.
// Called by src/app/import.cpp; tested in tests/src/import/windio_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "src/import/openfast.hpp"

namespace spindrift::decks {

/// Reads the YAML file and writes turbine.toml, its tables and a scene of the standing rotor at its rated wind into a folder that
/// is made where it is missing; of a tower with layers the table of a beam, tower.csv, besides, unless it is to be rigid. The
/// operating table ends where the greatest speed is reached, or at `rated_wind` [m/s]. Throws scene::SceneError naming file, line
/// and key of what cannot be read.
Imported import_windio(const std::filesystem::path& file, const std::filesystem::path& folder,
                       ImportedTower tower = ImportedTower::as_in_deck, std::optional<double> rated_wind = std::nullopt);

}  // namespace spindrift::decks
