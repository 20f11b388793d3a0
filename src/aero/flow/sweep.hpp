// What sweeps over a tile share: eight cells of a row at once, faces of a row, and the parameters of a solver that do not change.
// Called by sweep_*.cpp; tested in tests/src/aero/flow/solver_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/gas/muscl.hpp"
#include "kernels/gas/viscous.hpp"
#include "src/aero/flow/flow_tile.hpp"

namespace spindrift::aero {

using Row = Wide<double, 8>;  ///< eight cells along i: the whole row of lanes is the same arithmetic at any width of registers

inline constexpr int longest_row = 512;  ///< cells in i that the buffers of a sweep hold

/// Area vector and, on moving grids, speed of eight faces from (k, j, i) on. Lanes beyond the row have no area and harmless
/// numbers.
SPINDRIFT_INLINE gas::Face<Row> load_face(const TileGeometry& g, int direction, int k, int j, int i) {
  const BoxLayout& box = g.face_box[direction];
  const double* at = g.face_data[direction].data() + box.at(k, j, i);
  const Row x = Row::load(at), y = Row::load(at + box.component), z = Row::load(at + 2 * box.component);
  const Row area = sqrt(max(x * x + y * y + z * z, Row(1e-280))), inverse = 1.0 / area;
  gas::Face<Row> f{x * inverse, y * inverse, z * inverse, area, Row(0.0)};
  if (g.moving()) f.speed = Row::load(g.speed_data[direction].data() + box.at(k, j, i)) * inverse;
  return f;
}
/// Adds the velocity of the grid at eight faces, by its rigid motion at the middle of the cells on both sides.
SPINDRIFT_INLINE void add_grid_velocity(const TileGeometry& g, int direction, int k, int j, int i, gas::Face<Row>& f) {
  const double* at = g.centre_data.data() + g.cell_box.at(k, j, i);
  const std::ptrdiff_t c = g.cell_box.component, back = g.cell_box.stride(direction);
  const auto middle = [&](int n) { return 0.5 * (Row::load(at + n * c) + Row::load(at + n * c - back)); };
  const Row x = middle(0), y = middle(1), z = middle(2);
  const Eigen::Vector3d &v = g.rate.velocity, &turn = g.rate.omega;
  f.vx = v[0] + (turn[1] * z - turn[2] * y);
  f.vy = v[1] + (turn[2] * x - turn[0] * z);
  f.vz = v[2] + (turn[0] * y - turn[1] * x);
}
/// One face, for boundaries.
inline gas::Face<double> face_at(const TileGeometry& g, int direction, int k, int j, int i) {
  const BoxLayout& box = g.face_box[direction];
  const double* at = g.face_data[direction].data() + box.at(k, j, i);
  const double x = at[0], y = at[box.component], z = at[2 * box.component];
  const double area = std::sqrt(std::max(x * x + y * y + z * z, 1e-280)), inverse = 1.0 / area;
  const double speed = g.moving() ? g.speed_data[direction].data()[box.at(k, j, i)] * inverse : 0.0;
  return {x * inverse, y * inverse, z * inverse, area, speed};
}
/// The face of a boundary window at the cell (k, j, i), pointing out of the tile.
inline gas::Face<double> outward_face(const TileGeometry& g, Side side, int k, int j, int i) {
  const int d = direction_of(side);
  if (!at_end(side)) {
    gas::Face<double> f = face_at(g, d, k, j, i);
    return {-f.nx, -f.ny, -f.nz, f.area, -f.speed};
  }
  return face_at(g, d, k + (d == 2), j + (d == 1), i + (d == 0));
}
SPINDRIFT_INLINE gas::Vector<Row> load_vector(const double* at, std::ptrdiff_t component) {
  return {Row::load(at), Row::load(at + component), Row::load(at + 2 * component)};
}

/// Calls body(k, j) for the rows of cells of a tile.
template <class Body>
SPINDRIFT_INLINE void for_rows(const linear::CellBox& box, Body&& body) {
  for (int k = 0; k < box.nk; ++k)
    for (int j = 0; j < box.nj; ++j) body(k, j);
}

/// Flags of one side's faces at (a, b), lower direction a fastest: where they are in FlowTile::open.
inline std::ptrdiff_t open_row(const linear::CellBox& box, int direction) {
  return round_up(direction == 0 ? box.nj : box.ni, row_lanes);
}

}  // namespace spindrift::aero
