// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/tile_motion.hpp"

#include <Eigen/Geometry>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

namespace spindrift::aero {

const BlockPose& TileMotion::pose(const std::vector<BlockPose>& poses, const FlowTile& tile) const {
  return poses.size() == 1 ? poses[0] : poses[std::size_t(arrays_.of(tile).block)];
}

void TileMotion::check(const std::vector<BlockPose>& poses) const {
  const Tiling& tiling = arrays_.grid.tiling();
  if (!time_.unsteady() || (!arrays_.tiles.empty() && !arrays_.tiles[0].geometry->moving()))
    throw std::invalid_argument("flow: only grids built as moving, in unsteady flow, move");
  if (poses.size() != 1 && poses.size() != tiling.block_cells.size())
    throw std::invalid_argument("flow: " + std::to_string(poses.size()) + " poses for " +
                                std::to_string(tiling.block_cells.size()) + " blocks");
  if (tiling.periodic.empty()) return;
  // Across a periodic link both sides must have the same motion: only along the period, or about and along its axis.
  for (const BlockPose& p : poses) {
    const std::vector<RigidMap> maps = moved_maps(tiling.periodic, p.map);
    for (std::size_t n = 0; n < maps.size(); ++n) {
      const double size = 1.0 + p.map.translation.norm() + periodic_[n].translation.norm();
      if ((maps[n].rotation - periodic_[n].rotation).norm() > 1e-9 ||
          (maps[n].translation - periodic_[n].translation).norm() > 1e-9 * size)
        throw std::invalid_argument("flow: this motion does not keep the periodicity of the grid; a turn must be about its axis");
    }
  }
}

void TileMotion::move_to(std::vector<BlockPose> poses) {
  check(poses);
  next_ = std::move(poses);
}

namespace {
/// Of a node of a tile in its block: cell t lies between nodes t and t + 1 in both, also where the two count against each other.
Index node_of_block(const IndexMap& to_block, const Index& node) {
  Index at = to_block(node);
  for (int d = 0; d < 3; ++d)
    if (to_block.sign(d) < 0) ++at[std::size_t(to_block.target(d))];
  return at;
}
void set_nodes(TileGeometry& g, const Tile& tile, const BlockPose& pose) {
  if (pose.shape_at) {
    for (int k = 0; k <= tile.nk; ++k)
      for (int j = 0; j <= tile.nj; ++j)
        for (int i = 0; i <= tile.ni; ++i) {
          const std::ptrdiff_t at = g.node_box.at(k, j, i), c = g.node_box.component;
          const double* x = g.history->reference_nodes.data() + at;
          const Eigen::Vector3d shaped = pose.shape_at(node_of_block(tile.to_block, {i, j, k}), {x[0], x[c], x[2 * c]});
          const Eigen::Vector3d placed = pose.map.rotation * shaped + pose.map.translation;
          for (int d = 0; d < 3; ++d) g.node_data.data()[at + d * c] = placed[d];
        }
    return;
  }
  if (!pose.shape) return move_rigidly(g, pose.map);
  move_nodes(
      g, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return pose.map.rotation * pose.shape(x) + pose.map.translation; });
}
/// From one pose to another: displacement at the origin and turn, those of the middle of the step to second order.
RigidRate change(const RigidMap& from, const RigidMap& to) {
  const Eigen::AngleAxisd axis(to.rotation * from.rotation.transpose());
  const Eigen::Vector3d turn = axis.axis() * axis.angle();
  return {to.translation - from.translation - turn.cross(0.5 * (to.translation + from.translation)), turn};
}
}  // namespace

namespace {
/// Up to round-off.
bool alike(const std::vector<RigidMap>& a, const std::vector<RigidMap>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t n = 0; n < a.size(); ++n)
    if ((a[n].rotation - b[n].rotation).norm() > 1e-9 ||
        (a[n].translation - b[n].translation).norm() > 1e-9 * (1.0 + a[n].translation.norm()))
      return false;
  return true;
}
}  // namespace

void TileMotion::place(std::vector<BlockPose> before, std::vector<BlockPose> now, std::vector<BlockPose> long_before) {
  const bool third = time_.order > 2;
  if (long_before.empty()) long_before = before;
  // A motion about the axis of the period leaves the maps as they are but for round-off: those of the first place stay, so that
  // a restart, which places the grid somewhere else, has their bits.
  if (std::vector<RigidMap> maps = moved_maps(arrays_.grid.tiling().periodic, now[0].map); !alike(maps, periodic_))
    periodic_ = std::move(maps);
  check(before), check(now), check(long_before);
  const bool planar = arrays_.planar();
  for (FlowTile& tile : arrays_.tiles) {
    TileGeometry& g = *tile.geometry;
    set_nodes(g, arrays_.of(tile), pose(third ? long_before : before, tile));
    aero::begin_step(g);  // nothing was swept up to here
    if (third) set_nodes(g, arrays_.of(tile), pose(before, tile));
    update_metrics(g, planar);
    update_sweeps(g, planar);
    aero::begin_step(g);
    set_nodes(g, arrays_.of(tile), pose(now, tile));
    update_metrics(g, planar);
    update_sweeps(g, planar);
    g.history->over_step = change(pose(before, tile).map, pose(now, tile).map);
    if (third) g.history->over_step_before = change(pose(long_before, tile).map, pose(before, tile).map);
  }
  if (third) long_before_ = std::move(long_before);
  before_ = std::move(before);
  now_ = next_ = std::move(now);
  arrays_.grid.fill_local_geometry(periodic_);
}

void TileMotion::move(FlowTile& tile) const {
  TileGeometry& g = *tile.geometry;
  const bool planar = arrays_.planar();
  aero::begin_step(g);
  set_nodes(g, arrays_.of(tile), pose(now_, tile));
  update_metrics(g, planar);
  update_sweeps(g, planar);
  update_speeds(g, time_.weights, time_.dt, planar);
  // As face speeds: of this step and the one before it, second order at the new time level.
  const TimeWeights& w = time_.weights;
  const RigidRate now = change(pose(before_, tile).map, pose(now_, tile).map), old = std::exchange(g.history->over_step, now);
  if (time_.order > 2) {
    const RigidRate older = std::exchange(g.history->over_step_before, old);
    g.rate.velocity = swept_rate(w, now.velocity, old.velocity, older.velocity, time_.dt);
    g.rate.omega = swept_rate(w, now.omega, old.omega, older.omega, time_.dt);
  } else {
    g.rate.velocity = swept_rate(w, now.velocity, old.velocity, time_.dt);
    g.rate.omega = swept_rate(w, now.omega, old.omega, time_.dt);
  }
  fill_boundary_geometry(g, arrays_.grid.tiling().boundary(tile.index));
}

void TileMotion::begin_step() {
  std::vector<BlockPose> before = std::exchange(before_, std::exchange(now_, next_));
  if (time_.order > 2) long_before_ = std::move(before);
}

void TileMotion::save(std::vector<double>& to) const {
  to.push_back(double(before_.size()));
  if (time_.order > 2) to.push_back(double(now_.size()));
  const auto add = [&](const RigidMap& map) {
    to.insert(to.end(), map.rotation.data(), map.rotation.data() + 9);
    to.insert(to.end(), map.translation.data(), map.translation.data() + 3);
  };
  for (const RigidMap& map : periodic_) add(map);
  for (const auto* poses : {&before_, &now_})
    for (const BlockPose& p : *poses) add(p.map);
  if (time_.order > 2)
    for (const BlockPose& p : long_before_) add(p.map);
}

void TileMotion::load(std::span<const double> from) {
  constexpr std::size_t numbers = 12;
  const bool third = time_.order > 2;
  const auto first = std::ptrdiff_t(from[0]), last = third ? std::ptrdiff_t(from[1]) : 0;
  from = from.subspan(third ? 2 : 1);
  const auto next = [&from] {
    RigidMap map;
    map.rotation = Eigen::Map<const Eigen::Matrix3d>(from.data());
    map.translation = Eigen::Map<const Eigen::Vector3d>(from.data() + 9);
    from = from.subspan(numbers);
    return map;
  };
  periodic_.resize(arrays_.grid.tiling().periodic.size());
  for (RigidMap& map : periodic_) map = next();
  std::vector<BlockPose> all;
  while (!from.empty()) all.push_back({.map = next(), .shape = {}});
  const auto now = all.begin() + first, end = third ? now + last : all.end();
  place({all.begin(), now}, {now, end}, {end, all.end()});
}

}  // namespace spindrift::aero
