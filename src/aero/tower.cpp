// SPDX-License-Identifier: Apache-2.0
#include "src/aero/tower.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "kernels/rotor/tower_flow.hpp"
#include "src/aero/wind.hpp"
#include "src/scene/section.hpp"

namespace spindrift::aero {

namespace {

Eigen::Matrix3d axes_of(const TowerFrame& f) {
  Eigen::Matrix3d axes;
  axes << f.axis, f.axis.cross(f.up), f.up;
  return axes;
}

}  // namespace

const scene::Section<TowerOptions>& tower_section() {
  static const auto section =
      scene::Section<TowerOptions>("tower", "The tower in the air round it; it moves with what carries the rotor.")
          .vector("foot_m", &TowerOptions::foot_m, "m", "Earth x and y of the tower's axis at the start.")
          .rows("stations", &TowerOptions::stations, "-",
                "Rows upwards of height over still water [m], diameter [m], drag coefficient.")
          .required()
          .flag("changes_wind", &TowerOptions::changes_wind,
                "The blades meet the wind as it goes round the tower (potential flow) and, behind it, its wake; only with model "
                "\"bem\".")
          .flag("has_drag", &TowerOptions::has_drag, "The tower has drag of its own.")
          .check([](const TowerOptions& o, const scene::Report& report) {
            if (o.stations.size() < 2) return report("stations", "needs two rows or more");
            for (std::size_t i = 0; i < o.stations.size(); ++i) {
              const auto& [height, diameter, drag] = o.stations[i];
              if (i > 0 && height <= o.stations[i - 1][0])
                report("stations", fmt::format("row {}: heights must increase", i + 1));
              if (diameter <= 0.0 || drag < 0.0)
                report("stations", fmt::format("row {}: diameter must be positive, drag not negative", i + 1));
            }
          });
  return section;
}

Tower::Tower(const TowerOptions& o, const TowerFrame& start, double density)
    : changes_wind_(o.changes_wind), has_drag_(o.has_drag), density_(density) {
  const Eigen::Matrix3d axes = axes_of(start);
  for (const auto& [height, diameter, drag] : o.stations) {
    const Eigen::Vector3d point(o.foot_m[0], o.foot_m[1], height);
    stations_.push_back({axes.transpose() * (point - start.hub), height, 0.5 * diameter, drag});
  }
}

Eigen::Vector3d Tower::disturbed(const TowerFrame& now, const Eigen::Vector3d& wind, const Eigen::Vector3d& point) const {
  const Eigen::Matrix3d axes = axes_of(now);
  const Eigen::Vector3d local = axes.transpose() * (point - now.hub);
  const Eigen::Vector3d &foot = stations_.front().from_hub, &top = stations_.back().from_hub;
  const double length = (top - foot).norm();
  const Eigen::Vector3d along = (top - foot) / length;
  const double height = (local - foot).dot(along);
  if (height < 0.0) return wind;
  // Between two stations; above the top the tower's effect dies away within some of its radii.
  std::size_t k = 0;
  while (k + 2 < stations_.size() && stations_[k + 1].height - stations_.front().height < height) ++k;
  const double share = std::min(
      (height - (stations_[k].height - stations_.front().height)) / (stations_[k + 1].height - stations_[k].height), 1.0);
  const double radius = (1.0 - share) * stations_[k].radius + share * stations_[k + 1].radius;
  const double above = std::max(height - length, 0.0) / radius, left = std::exp(-above * above);
  if (left < 1e-6) return wind;
  const Eigen::Vector3d tower = axes * along, offset = axes * (local - foot - height * along);
  const Eigen::Vector3d level = wind - wind.dot(tower) * tower;
  const double speed = level.norm();
  if (speed == 0.0) return wind;
  const Eigen::Vector3d x = level / speed, y = tower.cross(x);
  const double downwind = offset.dot(x) / radius, aside = offset.dot(y) / radius;
  const TowerFlow flow = tower_flow(downwind, aside);
  const double wake = tower_wake(downwind, aside, (1.0 - share) * stations_[k].drag + share * stations_[k + 1].drag);
  return wind + left * speed * ((flow.along + wake) * x + flow.across * y);
}

TowerLoad Tower::drag(const TowerFrame& now, const Wind& wind, double t) const {
  TowerLoad load;
  const Eigen::Matrix3d axes = axes_of(now);
  const Eigen::Vector3d tower = axes * (stations_.back().from_hub - stations_.front().from_hub).normalized();
  constexpr double most_pieces = 24.0;  // of the whole tower, some 5 m: the wind at the middle is the mean over a piece
  const double whole = stations_.back().height - stations_.front().height;
  for (std::size_t k = 0; k + 1 < stations_.size(); ++k) {
    const Station &a = stations_[k], &b = stations_[k + 1];
    const double length = b.height - a.height, pieces = std::ceil(most_pieces * length / whole);
    for (double n = 0.5; n < pieces; ++n) {
      const double share = n / pieces;
      const Eigen::Vector3d arm = axes * (a.from_hub + share * (b.from_hub - a.from_hub));
      const Eigen::Vector3d met = wind.at(t, now.hub + arm) - now.hub_velocity - now.omega.cross(arm);
      const Eigen::Vector3d level = met - met.dot(tower) * tower;
      const double area = 2.0 * std::lerp(a.radius, b.radius, share) * length / pieces;
      const Eigen::Vector3d force = 0.5 * density_ * std::lerp(a.drag, b.drag, share) * area * level.norm() * level;
      load.force += force, load.moment += arm.cross(force);
    }
  }
  return load;
}

}  // namespace spindrift::aero
