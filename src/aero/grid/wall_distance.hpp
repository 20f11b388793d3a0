// Exact distance to the nearest wall: the nearest point on all wall faces, each four triangles round its middle (the same
// whichever way a block is turned), found through a tree of bounding boxes. Called where a solver is set up, by each rank with
// the whole wall surface; tested in tests/src/aero/grid/wall_distance_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <array>
#include <span>
#include <string>
#include <vector>

#include "src/aero/grid/multi_block.hpp"
#include "src/aero/grid/store.hpp"

namespace spindrift::aero {

class WallSurface {
 public:
  using Face = std::array<Eigen::Vector3d, 4>;  ///< corners in order round it
  explicit WallSurface(std::vector<Face> faces);

  bool empty() const { return faces_.empty(); }
  std::span<const Face> faces() const { return faces_; }  ///< to hand on to ranks that have no grid
  /// Nearest point on the wall; the surface must not be empty.
  Eigen::Vector3d nearest(const Eigen::Vector3d& point) const;
  double distance(const Eigen::Vector3d& point) const { return (nearest(point) - point).norm(); }

 private:
  /// Faces [first, last); children stand at `left` and `left + 1`, leaves have left = 0.
  struct Node {
    Eigen::Vector3d low, high;
    int first, last, left;
  };
  void divide(int node);
  std::vector<Face> faces_;
  std::vector<Node> nodes_;
};

/// All faces of the named patches, and their images through periodic connections (one step each way).
WallSurface wall_surface(const MultiBlockGrid& grid, std::span<const std::string> patches);

/// Distance of every cell centre of a tile; infinite where the surface is empty.
void fill_wall_distance(TileGeometry& geometry, const WallSurface& wall);

}  // namespace spindrift::aero
