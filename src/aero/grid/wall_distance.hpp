// Exact distance to the nearest wall: the nearest point on all wall faces, each four triangles round its middle (the same
// whichever way a block is turned), found through a tree of bounding boxes. The search begins at the face that was nearest to the
// cell before, which lies next to it: most of the tree is then cut off at once. Called where a solver is set up, by each rank
// with the whole wall surface, on all its threads; tested in tests/src/aero/grid/wall_distance_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <array>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "kernels/grid/box_tree.hpp"
#include "src/aero/grid/multi_block.hpp"
#include "src/aero/grid/store.hpp"

namespace spindrift::aero {

class WallSurface {
 public:
  using Face = std::array<Eigen::Vector3d, 4>;  ///< corners in order round it
  explicit WallSurface(std::vector<Face> faces);

  bool empty() const { return faces_.empty(); }
  std::span<const Face> faces() const { return faces_; }  ///< to hand on to ranks that have no grid
  /// To the nearest point on the wall; the surface must not be empty. `face` is where the search begins and, afterwards, a face
  /// that is nearest: the distance does not depend on it, the time does.
  double distance(const Eigen::Vector3d& point, int& face) const;
  double distance(const Eigen::Vector3d& point) const {
    int face = 0;
    return distance(point, face);
  }

 private:
  /// Squared distance to a face where that is less than `least`; else a number that is not less.
  double closer(const Eigen::Vector3d& point, int face, double least) const;
  std::vector<Face> faces_;
  struct Ball {
    Eigen::Vector3d middle;
    double radius;
  };
  std::vector<Ball> balls_;  ///< round each face
  BoxTree tree_;             ///< whose order the faces have
};

/// Faces of the named patches.
std::vector<WallSurface::Face> wall_faces(const MultiBlockGrid& grid, std::span<const std::string> patches);
/// The same of the layers that a part counts.
std::vector<WallSurface::Face> wall_faces(const GridLayers& part, std::span<const std::string> patches);
/// These faces, and their images through periodic connections: one step each way, and across corners where
/// periods meet.
WallSurface wall_surface(std::vector<WallSurface::Face> faces, std::span<const Connection> connections);
WallSurface wall_surface(const MultiBlockGrid& grid, std::span<const std::string> patches);

/// Distance of every cell centre of a tile; infinite where the surface is empty.
void fill_wall_distance(TileGeometry& geometry, const WallSurface& wall);

/// The same of all tiles that the store owns, on the threads of the rank; `told` hears the share that is done. Throws
/// runtime::StopAsked, on this rank alone, where it is asked to stop meanwhile.
void fill_wall_distance(GridStore& store, const WallSurface& wall, const std::function<void(double)>& told = {});

/// By tile, for another store of the same grid; rigid motion leaves them as they are.
using WallDistances = std::map<int, std::vector<double>>;
/// Of all tiles that the store owns.
void keep_wall_distance(const GridStore& store, WallDistances& kept);
/// Fills the store with them; false, and nothing done, where a tile that it owns is missing.
bool take_wall_distance(GridStore& store, const WallDistances& kept);

}  // namespace spindrift::aero
