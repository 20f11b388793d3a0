// A closed surface of triangles: whether it is closed, what it encloses, what of it is under water, and how far a point is from
// it. The sign of the distance is that of the angle-weighted normal of the nearest face, edge or corner (Baerentzen & Aanaes
// 2005, IEEE Trans. Vis. Comput. Graph. 11, 243), exact for any closed surface; volumes and moments are sums over tetrahedra.
// Filled by src/scene/surface_file.cpp from STL; read by src/sea. Tested in tests/kernels/rigid/closed_surface_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/grid/box_tree.hpp"

namespace spindrift {

/// Three corners as a file has them, counter-clockwise seen from outside.
using Facet = std::array<Eigen::Vector3d, 3>;

/// Facets that share their corners.
struct Triangulation {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::size_t> facets;  ///< number of each triangle's facet in the file, from 1
};
/// Corners nearer to each other than a millionth of the size are one; facets with no three corners left are dropped.
Triangulation weld(std::span<const Facet> facets);
/// A sentence with a place: open edges, facets that are there twice or inside out beside others; none where the surface is
/// closed.
std::optional<std::string> why_not_closed(const Triangulation& surface);

class ClosedSurface {
 public:
  /// @pre why_not_closed() has nothing to say. Where all of it is inside out it is turned.
  explicit ClosedSurface(Triangulation surface);

  std::span<const Eigen::Vector3d> points() const { return points_; }
  std::span<const std::array<int, 3>> triangles() const { return triangles_; }
  const Eigen::AlignedBox3d& box() const { return box_; }
  bool was_inside_out() const { return was_inside_out_; }
  double volume() const { return volume_; }
  const Eigen::Vector3d& centre() const { return centre_; }  ///< of the volume
  /// Of what it encloses at a density of 1, about its centre [m5].
  const Eigen::Matrix3d& inertia() const { return inertia_; }

  struct Nearest {
    Eigen::Vector3d point;
    double distance;  ///< signed, negative inside
  };
  Nearest nearest(const Eigen::Vector3d& x) const;
  double signed_distance(const Eigen::Vector3d& x) const { return nearest(x).distance; }
  std::size_t facet(int triangle) const { return facets_[std::size_t(triangle)]; }  ///< its number in the file; of no prism

  struct Crossing {
    int first, second;  ///< triangles
    Eigen::Vector3d place;
  };
  /// Two triangles that cut through each other, deeper than corners are welded: parts that overlap. None where they only touch.
  std::optional<Crossing> crossing() const;
  struct Misplaced {
    int triangle;  ///< of the part
    bool inside;   ///< a solid part in a solid part; else a part by itself that is inside out
  };
  /// Of a surface of several parts, one that encloses what another encloses already, or less than nothing. Parts that
  /// reach out of another's box are beside it.
  std::optional<Misplaced> misplaced_part() const;

 private:
  void integrate();
  void make_normals();
  std::optional<Eigen::Vector3d> place_of_crossing(int first, int second) const;

  std::vector<Eigen::Vector3d> points_, normals_, corner_normals_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<std::size_t> facets_;
  std::vector<std::array<Eigen::Vector3d, 3>> side_normals_;  ///< of the side from each corner to the next
  BoxTree tree_;                                              ///< of the triangles with an area
  Eigen::AlignedBox3d box_;
  bool was_inside_out_ = false;
  double volume_ = 0.0;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia_ = Eigen::Matrix3d::Zero();
};

/// What is under z = 0 of a surface whose points x stand at attitude x + shift, and the plane in which it meets the water.
struct Submerged {
  double volume = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of buoyancy
  double area = 0.0;                                 ///< of the waterplane
  Eigen::Vector2d area_centre = Eigen::Vector2d::Zero();
  Eigen::Matrix2d area_moment = Eigen::Matrix2d::Zero();  ///< second moments of x and y about its centre [m4]

  /// Height of the metacentre over the centre of buoyancy for a turn about x (roll) or y (pitch).
  double metacentric_radius_roll() const { return area_moment(1, 1) / volume; }
  double metacentric_radius_pitch() const { return area_moment(0, 0) / volume; }
};
Submerged submerged(const ClosedSurface& surface, const Eigen::Matrix3d& attitude, const Eigen::Vector3d& shift);

/// Where the plane of a height y cuts a surface: segments from point to point, the solid on their left seen along y.
struct Outline {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 2>> segments;
};
/// Empty where the surface does not reach the plane.
Outline outline_of(const ClosedSurface& surface, double y);
/// The outline drawn out along y, far beyond any distance that matters in its plane: what a 2-D scene has of a surface. Its
/// volume over its length is the area inside the outline. @pre The outline has segments.
ClosedSurface prism_of(const Outline& outline);

/// In pieces shorter than `size` along every side: their centres, and areas as vectors outwards.
struct SurfacePiece {
  Eigen::Vector3d place, area;
};
std::vector<SurfacePiece> pieces_of(const ClosedSurface& surface, double size);

}  // namespace spindrift
