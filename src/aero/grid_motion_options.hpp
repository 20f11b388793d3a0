// What [aero.flow.motion] says. Declared in grid_motion.cpp; read as part of [aero.flow]. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

namespace spindrift::scene {
template <class Options>
class Section;
}  // namespace spindrift::scene

namespace spindrift::aero {

struct GridMotionOptions {
  std::vector<std::string> patches;  ///< that move
  std::string grid = "elliptic";     ///< or "rigid"
  double stiffness = 1.0;
  std::array<double, 3> centre_m{0.0, 0.0, 0.0}, axis{0.0, 1.0, 0.0};
  double pitch = 0.0, pitch_amplitude = 0.0;     ///< [rad]
  std::array<double, 3> heave_m{0.0, 0.0, 0.0};  ///< amplitude
  double heave_phase = 0.0;                      ///< [rad] of heave before pitch
  double period_s = 1.0;
  bool oscillates() const { return pitch_amplitude != 0.0 || heave_m != std::array<double, 3>{}; }
};
const scene::Section<GridMotionOptions>& grid_motion_section();

}  // namespace spindrift::aero
