// Doubts about mooring lines. Called by src/coupling/doubts.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

#include "src/moorings/options.hpp"
#include "src/scene/document.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::moorings {

/// What lines are held against.
struct LineSurroundings {
  double depth_m = -1.0;  ///< of the water, negative where the scene has no sea
  double weight_N = 0.0;  ///< of all bodies together
  double water_density_kg_m3 = 1025.0, gravity_m_s2 = 9.80665;
  double step_s = 0.0;                                  ///< of the bodies
  std::map<std::string, double> masses_kg{};            ///< of each body
  std::map<std::string, Eigen::AlignedBox3d> shapes{};  ///< round those of each body that has any, where it is described
  std::map<std::string, std::vector<Eigen::AlignedBox3d>> pieces{};  ///< round each of them
  std::map<std::string, Eigen::Vector3d> centres{};                  ///< of mass
  const Bed* bed = nullptr;                                          ///< null: flat, at that depth
};
scene::Doubts line_doubts(const std::vector<scene::Named<LineOptions>>& lines, const LineSurroundings& around);
scene::Doubts junction_doubts(const std::vector<scene::Named<JunctionOptions>>& junctions, const LineSurroundings& around);

}  // namespace spindrift::moorings
