// AeroDyn's blade and aerofoil files as a turbine file. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/import/elastodyn.hpp"

namespace spindrift::decks {

struct WrittenTurbine {
  std::vector<std::string> left_out;
  bool by_reynolds = false;     ///< some polar depends on the Reynolds number
  double separation_lag = 3.0;  ///< in half chords, of the outermost aerofoil file with stall (T_f0)
  bool lags_differ = false;     ///< between files
};
/// Writes planform, polars and turbine.toml.
WrittenTurbine write_turbine(const Deck& aerodyn, const RotorFrame& rotor, const std::filesystem::path& folder);

}  // namespace spindrift::decks
