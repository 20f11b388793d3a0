// Options of [aero.actuator]: how the forces of blades that the grid does not show are spread in the resolved air.
// Declared in actuator_options.cpp; read as part of [aero]; tested in tests/src/aero/actuator_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace spindrift::scene {
template <class Options>
class Section;
class Document;
}  // namespace spindrift::scene

namespace spindrift::aero {

struct AeroOptions;
struct RotorOptions;
struct MultiBlockGrid;

struct ActuatorOptions {
  double width_cells = 2.0;             ///< of the Gaussian kernel, in cells at the rotor
  double width_chords = 0.25;           ///< or in chords of the section, whichever is more
  std::string correction = "filtered";  ///< filtered, none
};
const scene::Section<ActuatorOptions>& actuator_section();

/// Rules between [rotor], [aero] and the models that act on the air; problems go to the document. `hub_key`: which puts the hub
/// where `rotor` has it.
void check_actuator(scene::Document& document, const AeroOptions& aero, const RotorOptions& rotor, const std::string& hub_key);

/// The rotor has to be inside the grid and the grid to have three dimensions; throws scene::SceneError.
void require_rotor_inside(const MultiBlockGrid& grid, const RotorOptions& rotor, const std::string& hub_key);

}  // namespace spindrift::aero
