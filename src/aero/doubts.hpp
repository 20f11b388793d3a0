// Doubts about the rotor and its wind. Called by src/coupling/doubts.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "src/aero/bem.hpp"
#include "src/aero/options.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::aero {

/// The rotor at the start, as the floating system has it.
struct RotorAtStart {
  Eigen::Vector3d hub, axis;            ///< earth frame
  double speed = 0.0;                   ///< [rad/s]
  std::string speed_key;                ///< of the scene, that gives it
  double radius = 0.0;                  ///< [m]; 0 where the scene does not say
  double least_radius = 0.0;            ///< where it does not: by what the rotor weighs and gives [m]
  std::optional<double> thrust, power;  ///< at full load [N], [W]
  bool over_water = false;
  bool parked = false;  ///< by its controller
  std::optional<ReynoldsReach> reynolds{};
};

/// A body that turns with the rotor, against the bearing and the blades that it carries.
struct RotorBody {
  std::string key;                ///< "bodies.rotor"
  Eigen::Vector3d centre;         ///< of mass, earth frame, as the hub and the axis
  double radius_of_gyration = 0;  ///< about the axis [m]
  double across = 0;              ///< the largest square to it [m]
};
scene::Doubts rotor_body_doubts(const RotorBody& body, const RotorAtStart& start);

/// Air that is resolved, by itself or round a rotor. `speed`: of the wind [m/s]; `window`: of time [s].
scene::Doubts flow_doubts(const FlowOptions& flow, double speed, double window, double air_density);

scene::Doubts rotor_doubts(const AeroOptions& aero, const RotorOptions& rotor, const WindOptions& wind, double air_density,
                           const RotorAtStart& start);

}  // namespace spindrift::aero
