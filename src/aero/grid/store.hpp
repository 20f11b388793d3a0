// The geometry of the tiles a rank owns: nodes, face vectors, volumes, centres, wall distances, and at moving grids what faces
// sweep. Bytes per cell (8 x 16 x 64 tile; padding and ghosts counted): nodes 32, faces 80, volume 13, centres 38, wall distance
// 8: 171; moving adds nodes 97, sweeps 80: 348 (docs/theory/grid.md). Called by src/aero/flow; tested in
// tests/src/aero/grid/store_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "kernels/grid/layout.hpp"
#include "kernels/grid/metrics.hpp"
#include "src/aero/grid/aligned.hpp"
#include "src/aero/grid/ghost_links.hpp"
#include "src/aero/grid/multi_block.hpp"
#include "src/aero/grid/tiling.hpp"

namespace spindrift::aero {

/// The rigid part of a motion: velocity at the origin [m/s] and rate of turn [rad/s] now, or what they came to over the last
/// step.
struct RigidRate {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero(), omega = Eigen::Vector3d::Zero();
};

/// Where the nodes of a tile of a moving grid come from, and what its faces swept on the way.
struct MotionHistory {
  AlignedArray<double> reference_nodes;                  ///< as made
  AlignedArray<double> old_nodes, older_nodes;           ///< one and two steps ago
  std::array<AlignedArray<double>, 3> swept, old_swept;  ///< [m3] in this step and in the one before
  RigidRate over_step;
  // Of third order in time (empty otherwise).
  AlignedArray<double> oldest_nodes;                ///< three steps ago
  std::array<AlignedArray<double>, 3> older_swept;  ///< two steps before
  RigidRate over_step_before;

  bool third_order() const { return oldest_nodes.size() > 0; }
};

/// Arrays of one tile. Face n of direction d lies below cell n of that direction; its vector [m2] points towards growing index.
/// In a planar grid the faces across k are left zero: nothing flows through them.
struct TileGeometry {
  BoxLayout node_box;                 ///< ni+1, nj+1, nk+1
  BoxLayout cell_box;                 ///< with cell_ghosts
  std::array<BoxLayout, 3> face_box;  ///< one more in the direction across
  BoxLayout inner_box;                ///< cells without ghosts

  AlignedArray<double> node_data;                 ///< 3 components [m]
  std::array<AlignedArray<double>, 3> face_data;  ///< 3
  AlignedArray<double> volume_data;               ///< 1 [m3]
  AlignedArray<double> centre_data;               ///< 3 [m]
  AlignedArray<double> wall_distance_data;        ///< 1 [m]; infinite where there is no wall

  // Where the grid or its frame moves (empty otherwise).
  std::array<AlignedArray<double>, 3> speed_data;  ///< [m3/s] volume per time swept, see swept_rate
  RigidRate rate;
  std::optional<MotionHistory> history;  ///< of a grid built as moving

  BoxView<double> nodes() { return {node_data.data(), node_box}; }
  BoxView<double> volume() { return {volume_data.data(), cell_box}; }
  BoxView<double> centre() { return {centre_data.data(), cell_box}; }
  BoxView<double> wall_distance() { return {wall_distance_data.data(), inner_box}; }
  BoxView<double> face(int direction) { return {face_data[direction].data(), face_box[direction]}; }
  BoxView<double> speed(int direction) { return {speed_data[direction].data(), face_box[direction]}; }
  BoxView<const double> nodes() const { return {node_data.data(), node_box}; }
  BoxView<const double> volume() const { return {volume_data.data(), cell_box}; }
  BoxView<const double> centre() const { return {centre_data.data(), cell_box}; }
  BoxView<const double> wall_distance() const { return {wall_distance_data.data(), inner_box}; }
  BoxView<const double> face(int direction) const { return {face_data[direction].data(), face_box[direction]}; }
  BoxView<const double> speed(int direction) const { return {speed_data[direction].data(), face_box[direction]}; }
  bool moving() const { return speed_data[0].size() > 0; }
  std::size_t bytes() const;
};

/// The arrays of a tile; nodes and what follows from them are still to come.
std::unique_ptr<TileGeometry> empty_geometry(const Tile& tile, bool planar);
/// Copies those of a tile's nodes that a piece of its block has; `first`: the block's layer that the piece begins with.
void copy_nodes(TileGeometry& geometry, const Tile& tile, const Block& piece, int first = 0);
/// Copies a tile's nodes out of its block and builds faces, volumes, centres. Ghosts of volume and centre are filled by
/// fill_boundary_geometry and by the links (geometry_quantities).
std::unique_ptr<TileGeometry> make_geometry(const MultiBlockGrid& grid, const Tile& tile, bool planar);

/// Lets a tile's nodes move from where they are: gives it room for what they were and what its faces sweep, all at rest.
void make_movable(TileGeometry& geometry);
/// Room for one step more, of third order in time. @pre the tile is movable and at rest
void keep_third_step(TileGeometry& geometry);

/// Of a cell, along a unit vector: its volume over the area that it shows there [m].
double extent_along(const TileGeometry& geometry, const Eigen::Vector3d& normal, int k, int j, int i);

/// Faces, volumes and centres from the nodes as they are.
void update_metrics(TileGeometry& geometry, bool planar);

/// Ghost volumes and centres beyond boundary windows: the volume of the cell inside, its centre mirrored in the face.
void fill_boundary_geometry(TileGeometry& geometry, std::span<const TileBoundary> boundaries);

/// Exchanged after each update_metrics: one layer of centre and of volume.
inline constexpr Quantity centre_quantities[] = {Quantity::point};
inline constexpr Quantity volume_quantities[] = {Quantity::scalar};

/// A moving grid's step, each a task per tile: present becomes past; nodes move; metrics and sweeps follow; speeds for the
/// weights.
void begin_step(TileGeometry& geometry);
void move_rigidly(TileGeometry& geometry, const RigidMap& from_reference);
/// Any motion: where a node of the reference position is now.
void move_nodes(TileGeometry& geometry, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& position);
void update_sweeps(TileGeometry& geometry, bool planar);
void update_speeds(TileGeometry& geometry, TimeWeights weights, double dt, bool planar);
/// Velocity of a node under the same weights [m/s].
Eigen::Vector3d node_velocity(const TileGeometry& geometry, TimeWeights weights, double dt, int k, int j, int i);

/// A frame that turns steadily about `centre` with the nodes at rest in it: speeds of the faces, exact integrals of (omega x r) .
/// n, so that they sum to zero over a cell. Makes room for them where the grid does not move otherwise.
void turn_frame(TileGeometry& geometry, const Eigen::Vector3d& omega, const Eigen::Vector3d& centre, bool planar);

/// The tiles of one rank; a tile that lives elsewhere has no geometry.
class GridStore {
 public:
  GridStore(Tiling tiling, std::vector<int> rank_of_tile, int rank);
  const Tiling& tiling() const { return tiling_; }
  std::span<const int> rank_of_tile() const { return rank_of_tile_; }
  int rank() const { return rank_; }
  const LinkPlan& plan() const { return plan_; }
  std::span<const int> owned() const { return owned_; }  ///< ascending
  bool owns(int tile) const { return rank_of_tile_[tile] == rank_; }
  TileGeometry& operator[](int tile) { return *geometry_[tile]; }
  const TileGeometry& operator[](int tile) const { return *geometry_[tile]; }
  /// Builds one owned tile (a task: memory is touched by the thread that calls).
  void build(int tile, const MultiBlockGrid& grid, bool moving);
  /// Builds all owned tiles one after the other and fills what ghosts can be filled without messages.
  void build_all(const MultiBlockGrid& grid, bool moving = false);
  /// The same of a grid that comes in parts: first the arrays, then the nodes of all layers that hold owned tiles, in any order,
  /// then what follows from them.
  void begin_parts();
  void take(const GridLayers& part);
  void end_parts(bool moving);
  /// Nodes of owned tiles, at rest, to where the map takes them, and what follows from them. Wall distances stay.
  void carry(const RigidMap& map);
  /// Ghost centres and volumes beyond boundaries and from tiles of this rank; those of other ranks come by pack and unpack.
  void fill_local_geometry() { fill_local_geometry(tiling_.periodic); }
  /// With the periodic maps of a grid that has moved (moved_maps).
  void fill_local_geometry(std::span<const RigidMap> periodic);
  std::size_t bytes() const;

 private:
  Tiling tiling_;
  std::vector<int> rank_of_tile_;
  int rank_;
  LinkPlan plan_;
  std::vector<int> owned_;
  std::vector<std::unique_ptr<TileGeometry>> geometry_;
};

/// Copies a tile's interior values into the arrays of its block (i fastest, one array per component, block index order), for
/// output: each block's array has ni*nj*nk numbers.
void gather_cells(const Tiling& tiling, int tile, BoxView<const double> values, int component, std::span<double> block_values);
/// The other way, for restarts.
void scatter_cells(const Tiling& tiling, int tile, std::span<const double> block_values, int component, BoxView<double> values);

/// A tile as a block of its own, for output without passing anything between ranks: numbers of one place lie together, i fastest.
/// Node coordinates, 3 (ni+1)(nj+1)(nk+1); components [first, first + count) of cells, count ni nj nk.
void copy_points(const TileGeometry& geometry, std::span<double> points);
void copy_cells(BoxView<const double> values, int first, int count, std::span<double> cells);

/// Window of a block that a tile covers, for parallel output: cells [low, high) of the block.
Box block_box(const Tiling& tiling, int tile);

}  // namespace spindrift::aero
