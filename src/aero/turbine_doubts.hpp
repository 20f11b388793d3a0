// Doubts about the blades of a turbine file: units and signs of its planform, its polars and its cone, and masses along them.
// Called by src/coupling/rotor_doubts.cpp; tested by the blunders of tests/extremes/blunders.toml. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <string>

#include "src/scene/doubt.hpp"

namespace spindrift::aero {

struct BladeMasses;
struct Turbine;

/// Of a turbine file that can be read.
scene::Doubts turbine_doubts(const std::string& path);
/// Of its chords, against the tip-speed ratio at which its operating table has the largest power coefficient. Both can be read.
scene::Doubts chord_doubts(const std::string& turbine, const std::string& operation);
/// Of masses along the blades of a turbine; `key`: of the scene, that names their file.
scene::Doubts blade_mass_doubts(const std::string& key, const Turbine& turbine, const BladeMasses& masses);

}  // namespace spindrift::aero
