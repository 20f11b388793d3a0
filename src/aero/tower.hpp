// The tower's effect on the rotor's wind, and its own drag. It stands on what carries the rotor and moves with it.
// Made from [aero.tower]; used by rotor_loads.cpp and bem.cpp; tested in tests/src/aero/tower_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace spindrift::scene {
template <class Options>
class Section;
}

namespace spindrift::aero {

struct Wind;

/// [aero.tower]
struct TowerOptions {
  std::array<double, 2> foot_m{0.0, 0.0};       ///< earth x and y of the tower's axis at the start
  std::vector<std::array<double, 3>> stations;  ///< height over still water [m], diameter [m], drag coefficient, upwards
  bool changes_wind = true, has_drag = true;
};

const scene::Section<TowerOptions>& tower_section();

/// Where the tower is: hub and directions of what carries the rotor.
struct TowerFrame {
  Eigen::Vector3d hub, axis, up;        ///< [m]; rotor axis and upright of the carrier, unit
  Eigen::Vector3d hub_velocity, omega;  ///< [m/s], of the carrier [rad/s]
};

struct TowerLoad {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();  ///< about the hub [N], [N m]
};

class Tower {
 public:
  /// `start`: how the rotor stands in the scene.
  Tower(const TowerOptions& options, const TowerFrame& start, double air_density_kg_m3);

  /// The wind at a point near the tower, from that which would be there without it.
  Eigen::Vector3d disturbed(const TowerFrame& now, const Eigen::Vector3d& wind, const Eigen::Vector3d& point) const;
  /// Where has_drag().
  TowerLoad drag(const TowerFrame& now, const Wind& wind, double t) const;
  bool changes_wind() const { return changes_wind_; }
  bool has_drag() const { return has_drag_; }

 private:
  struct Station {
    Eigen::Vector3d from_hub;  ///< along axis, side and up of the frame [m]
    double height, radius, drag;
  };
  std::vector<Station> stations_;
  bool changes_wind_, has_drag_;
  double density_;
};

}  // namespace spindrift::aero
