// What a scene with a resolved rotor says, whether it can be made, how large it would be: without the solver's own headers.
// Read by src/coupling/scenario.cpp and `spindrift check`; tested in tests/src/aero/resolved_rotor_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

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
};

/// Rules between [rotor], [aero.grid], [aero.flow] and the wind; problems go to the document.
void check_resolved_rotor(scene::Document& document, const AeroOptions& aero, const RotorOptions& rotor,
                          const Eigen::Vector3d& wind, const WindProfile& profile = {});

/// Size and cost of a scene's rotor before anything is made.
struct ResolvedRotorSize {
  long cells = 0;
  int sectors = 1, stations = 0;
  double megabytes = 0.0;                     ///< of the solver and its grid
  double core_seconds_per_pseudo_step = 0.0;  ///< by the figure of docs/developer/rotor_resolved.md
};
ResolvedRotorSize resolved_rotor_size(const ResolvedRotorSetup& setup);

}  // namespace spindrift::aero
