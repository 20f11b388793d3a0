// Doubts about the rotor and its wind. Called by src/coupling/doubts.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "src/aero/bem.hpp"
#include "src/aero/options.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::aero {

/// The rotor as the machine has it at the start.
struct RotorAtStart {
  Eigen::Vector3d hub, axis;            ///< earth frame
  double speed = 0.0;                   ///< [rad/s]
  double radius = 0.0;                  ///< [m]; 0 where the scene does not say
  std::optional<double> thrust, power;  ///< at full load [N], [W]
  bool over_water = false;
  std::optional<ReynoldsReach> reynolds{};
};

scene::Doubts rotor_doubts(const AeroOptions& aero, const RotorOptions& rotor, const WindOptions& wind, double air_density,
                           const RotorAtStart& start);

}  // namespace spindrift::aero
