// The particles of a body that is a union of cylinders, boxes, spheres and meshes, and how far a point is from its surface. Each
// shape is filled so that its particles displace its volume (shapes.hpp); where shapes overlap, the later one leaves the earlier
// one's room. Called by particle_sea.cpp; tested in tests/src/sea/sph/shapes_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "kernels/rigid/motion.hpp"
#include "kernels/rigid/shapes.hpp"
#include "src/sea/sph/shapes.hpp"

namespace spindrift::sph {

/// In body axes from the centre of mass.
using BodyShape = std::variant<Cylinder, Box, Sphere, Mesh>;

/// A 2-D scene cuts bodies in the plane y = 0 of their centre: a cylinder along y is a disc, one in the plane a rectangle, a mesh
/// is a prism. The half of a body that is symmetrical about that plane is what it has at y > 0.
enum class Cut { space, plane, half };
constexpr Cut cut_of(bool planar, bool symmetric) { return planar ? Cut::plane : symmetric ? Cut::half : Cut::space; }

/// Distance of a point from the surface, negative inside [m]; exact but at the rims of cones.
double signed_distance(const BodyShape& shape, Eigen::Vector3d x, Cut cut);

/// The same from the union: the least of its shapes'.
double signed_distance(std::span<const BodyShape> shapes, const Eigen::Vector3d& x, Cut cut);

/// Volume [m3], or area of the section [m2]; of halves half the shape's, which they are in the sum over a symmetrical body.
double volume_of(const BodyShape& shape, Cut cut);

/// The particles of one shape, body axes.
Points fill_shape(const BodyShape& shape, double spacing, Cut cut);

/// The particles of the union, body axes.
Points fill_body(std::span<const BodyShape> shapes, double spacing, Cut cut);

// The static draft of the discrete body: each particle is a cell of `cell` [m3, m2], a level slab `edge` high round its place.
/// What is under z = 0 of a body in `motion` [m3, m2].
double wetted_volume(const Points& points, const Motion& motion, double cell, double edge);
/// How far up from `motion`, kept in its attitude, it displaces `volume` in still water [m]; none where all of it displaces less.
std::optional<double> rise_to_float(const Points& points, const Motion& motion, double cell, double edge, double volume);

}  // namespace spindrift::sph
