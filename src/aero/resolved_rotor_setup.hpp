// What a scene with a resolved rotor says, whether it can be made, how large it would be: without the solver's own headers.
// Read by src/coupling/scenario.cpp and `spindrift check`; tested in tests/src/aero/resolved_rotor_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>

#include "src/aero/flow_size.hpp"
#include "src/aero/options.hpp"

namespace spindrift::aero {

/// What a scene says of a resolved rotor.
struct ResolvedRotorSetup {
  FlowOptions flow;
  RotorGridOptions grid;
  RotorOptions rotor;
  Eigen::Vector3d wind = Eigen::Vector3d::Zero();  ///< [m/s], earth frame
  double air_density = 1.225;                      ///< [kg/m3]
  double dt = 0.0;                                 ///< physical step [s]; steady scenes have none
  WindProfile profile = {};                        ///< of the wind over height
  bool ranks_may_idle = false;                     ///< more ranks than tiles are not refused: of a coarser grid to begin with
};

/// Whether the wind, where there is any, blows along the rotor's axis: then all blades meet it alike.
bool blows_along_axis(const RotorOptions& rotor, const Eigen::Vector3d& wind);

/// Rules between [rotor], [aero.grid], [aero.flow] and the wind; problems go to the document.
void check_resolved_rotor(scene::Document& document, const AeroOptions& aero, const RotorOptions& rotor,
                          const Eigen::Vector3d& wind, const WindProfile& profile = {});

/// Share by which the outer radius of the grid raises the wind through the rotor, as the walls of a wind tunnel would (Glauert
/// 1935; docs/theory/rotor_resolved.md), at a thrust coefficient of .8.
double far_side_excess(const RotorGridOptions& grid);
/// A sentence about it where it is above one per cent; else empty.
std::string far_side_note(const RotorGridOptions& grid);

/// Size and cost of a scene's rotor before anything is made (resolved_rotor_size.cpp).
/// Of bytes also those of a window's start, which is noted; of one note more per iterated window.
struct ResolvedRotorSize : FlowSize {
  int sectors = 1, stations = 0;
};
ResolvedRotorSize resolved_rotor_size(const ResolvedRotorSetup& setup);

/// Physical steps in which the rotor turns by more than 4 degrees: where little is left of the step before, their pseudo-steps
/// cost as those of a steady march.
bool turns_far(const ResolvedRotorSetup& setup);

/// Processor seconds per cell and pseudo-step of this scene's schemes on this computer: a short march on some thousand cells,
/// one thread.
struct AirRate {
  double core_seconds = 0.0;
  long cells = 0;
  int pseudo_steps = 0;
};
AirRate measured_air_rate(const ResolvedRotorSetup& setup);

}  // namespace spindrift::aero
