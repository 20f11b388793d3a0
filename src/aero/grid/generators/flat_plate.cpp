// The clustering was read off the TMR's 137x97 grid (flatplate_clust2): heights follow a sinh law, spacing ahead of the plate
// too, on the plate a tangent law up to x = 1.012, then uniform. Constants fitted to it; largest differences 5e-11 and 6e-13 m.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "src/aero/grid/generators/box.hpp"
#include "src/aero/grid/generators/plane_cases.hpp"

namespace spindrift::aero {

namespace {

constexpr double inlet = 0.33333;
constexpr int ahead_cells = 6, plate_cells = 28, height_cells = 24;  // of the 35x25 grid
constexpr double ahead_k = 3.0581061597149555, height_k = 11.711924950622882;
constexpr double plate_rate = 0.010366301351225337, plate_phase = 0.360020908508296, plate_scale = 0.3376450765533047;
constexpr int tangent_cells = 89, uniform_cells = 23;  // of the 137x97 grid

/// s: 0 at the inlet, 34 at the outlet, in cells of the 35x25 grid.
double plate_x(double s) {
  if (s <= ahead_cells) return -inlet * std::sinh(ahead_k * (1.0 - s / ahead_cells)) / std::sinh(ahead_k);
  const double fine = 4.0 * (s - ahead_cells);
  const auto tangent = [](double t) { return plate_scale * (std::tan(plate_rate * t + plate_phase) - std::tan(plate_phase)); };
  if (fine <= tangent_cells) return tangent(fine);
  const double start = tangent(tangent_cells);
  return start + (2.0 - start) * (fine - tangent_cells) / uniform_cells;
}

}  // namespace

MultiBlockGrid flat_plate(int n, double width) {
  MultiBlockGrid grid;
  grid.planar = true;
  const int cells = ahead_cells + plate_cells;
  grid.blocks.push_back(mapped_block("plate", cells * n, height_cells * n, 1, [&](double u, double v, double w) {
    return Eigen::Vector3d(plate_x(u * cells), -width * w, std::sinh(height_k * v) / std::sinh(height_k));
  }));
  const int ni = cells * n, nj = height_cells * n, start = ahead_cells * n;
  grid.boundaries = {{{0, Side::i_min, {0, 0}, {nj, 1}}, "inflow"},
                     {{0, Side::i_max, {0, 0}, {nj, 1}}, "outflow"},
                     {{0, Side::j_min, {0, 0}, {start, 1}}, "symmetry"},
                     {{0, Side::j_min, {start, 0}, {ni, 1}}, "wall"},
                     {{0, Side::j_max, {0, 0}, {ni, 1}}, "top"}};
  return grid;
}

}  // namespace spindrift::aero
