// Particles of a body whose surface is made of triangles: as many as stand for its volume, evenly in it up to half a spacing from
// the surface. They begin on a lattice and are pushed apart as by packing.hpp, and inwards by what would stand outside: the
// gradient of a smoothed outside is an integral over the surface. Called by body_shapes.cpp; tested in
// tests/src/sea/sph/mesh_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "kernels/rigid/shapes.hpp"
#include "src/sea/sph/shapes.hpp"

namespace spindrift::sph {

/// Body axes. In 2-D the mesh is a prism (closed_surface.hpp), of which the plane y = 0 is filled.
template <int dim>
Points fill_mesh(const Mesh& mesh, double spacing);

/// Calls visit(index, distance) for the points origin + index x edges of a lattice, index in [0, count): the signed distance from
/// the surface, exact from `low` to `high` and elsewhere a value on the same side of that range. The last axis is fastest.
void for_distances(const ClosedSurface& surface, const Eigen::Vector3d& origin, const Eigen::Vector3d& edges,
                   const std::array<int, 3>& count, double low, double high,
                   const std::function<void(const std::array<int, 3>&, double)>& visit);

}  // namespace spindrift::sph
