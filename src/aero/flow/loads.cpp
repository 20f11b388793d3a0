// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/loads.hpp"

#include <algorithm>

#include "src/aero/flow/sweep.hpp"
#include "src/aero/flow/sweep_gradients.hpp"
#include "src/aero/grid/line_growth.hpp"

namespace spindrift::aero {

namespace {

/// Calls body(boundary, k, j, i, outward face, pressure, friction force) for the wall faces of a tile. On a slip wall, and where
/// two equations meet a wall function, pressure includes the push of the stress, 2/3 rho k for the most part, and friction is
/// along the wall; a slip wall has none.
template <class Body>
void for_walls(const FlowTile& tile, const double* state, const ViscousSetting& viscous, Body&& body) {
  for (const FlowBoundary& boundary : tile.boundaries) {
    if (!is_closed(*boundary.condition)) continue;
    const Side side = boundary.where.side;
    for_window(tile, side, boundary.where.low, boundary.where.high, [&](int k, int j, int i) {
      const gas::Face<double> f = outward_face(*tile.geometry, side, k, j, i);
      Eigen::Vector3d friction = Eigen::Vector3d::Zero();
      double p = wall_pressure(tile, state, side, k, j, i);
      if (viscous.active) {
        const gas::Conserved<double> flux = wall_friction(tile, state, viscous, side, k, j, i);
        friction = {flux.mx, flux.my, flux.mz};
        const bool slips = !sticks(*boundary.condition);
        if (slips || (boundary.condition->wall_law && tile.turbulence == 2)) {
          const Eigen::Vector3d n(f.nx, f.ny, f.nz);
          const double push = friction.dot(n);
          friction -= push * n, p += push / f.area;
        }
        if (slips) friction.setZero();  // but for round-off it is
      }
      body(boundary, k, j, i, f, p, friction);
    });
  }
}

/// FirstCell::growth of the line of cells that leaves a wall, within the tile; of the first one, its y+ and its centre's
/// distance.
double growth_of_line(const FlowTile& tile, Side side, Index at, double y_plus, double distance) {
  const int d = direction_of(side), cells = d == 0 ? tile.box.ni : d == 1 ? tile.box.nj : tile.box.nk;
  const TileGeometry& g = *tile.geometry;
  LineGrowth growth(distance > 0.0 ? reach_of_growth(y_plus, distance) : 0.0);
  for (int n = 0; n < cells && !growth.done(); ++n, at[std::size_t(d)] += at_end(side) ? -1 : 1) {
    const auto [i, j, k] = at;
    const double areas = face_at(g, d, k, j, i).area + face_at(g, d, k + (d == 2), j + (d == 1), i + (d == 0)).area;
    growth.add(2.0 * g.volume_data.data()[g.cell_box.at(k, j, i)] / areas);
  }
  return growth.largest();
}

}  // namespace

PatchLoads patch_loads(std::span<const double> sums, int patch) {
  PatchLoads loads;
  const double* at = sums.data() + std::size_t(patch) * load_components;
  for (std::size_t c = 0; c < 3; ++c)
    loads.pressure_force[c] = at[c], loads.viscous_force[c] = at[3 + c], loads.moment[c] = at[6 + c];
  return loads;
}

BandLoads band_loads(std::span<const double> sums, int bands, int band) {
  BandLoads loads;
  const double* at = sums.data() + sums.size() - std::size_t(bands - band) * band_components;
  for (std::size_t c = 0; c < 3; ++c) loads.pressure_force[c] = at[c], loads.viscous_force[c] = at[3 + c];
  return loads;
}

bool has_loads(const FlowTile& tile) {
  return std::ranges::any_of(tile.boundaries, [](const FlowBoundary& b) { return b.loads && is_closed(*b.condition); });
}

void add_loads(const FlowTile& tile, const double* state, const ViscousSetting& viscous, const LoadBands& bands,
               std::span<double> of_patches, std::span<double> of_bands) {
  for_walls(tile, state, viscous,
            [&](const FlowBoundary& boundary, int k, int j, int i, const gas::Face<double>& f, double p,
                const Eigen::Vector3d& friction) {
              if (!boundary.loads) return;
              // What flows out of the gas through the wall is what the wall receives.
              const Eigen::Vector3d push = p * f.area * Eigen::Vector3d(f.nx, f.ny, f.nz);
              const Eigen::Vector3d moment = face_centre(*tile.geometry, boundary.where.side, k, j, i).cross(push + friction);
              double* at = of_patches.data() + std::size_t(boundary.where.patch) * load_components;
              for (int c = 0; c < 3; ++c) at[c] += push[c], at[3 + c] += friction[c], at[6 + c] += moment[c];
              const int band = bands.count > 0 ? bands.of(tile, k, j, i) : -1;
              if (band < 0) return;
              at = of_bands.data() + band * band_components;
              for (int c = 0; c < 3; ++c) at[c] += push[c], at[3 + c] += friction[c];
            });
}

void gather_wall(const FlowTile& tile, const double* state, const ViscousSetting& viscous, const BoundarySetting& setting,
                 std::vector<WallPoint>& points) {
  for_walls(tile, state, viscous,
            [&](const FlowBoundary& boundary, int k, int j, int i, const gas::Face<double>& f, double p,
                const Eigen::Vector3d& friction) {
              const Eigen::Vector3d x = face_centre(*tile.geometry, boundary.where.side, k, j, i);
              WallPoint point{.patch = boundary.where.patch, .place = {x[0], x[1], x[2]}, .pressure = p, .area = f.area};
              for (int c = 0; c < 3; ++c) point.traction[std::size_t(c)] = friction[c] / f.area;
              const auto q = gas::load_primitive<double>(state + tile.cells.at(k, j, i), std::size_t(tile.cells.component));
              const double rho = gas::density(setting.gas, q),
                           mu = gas::viscosity(setting.gas, gas::absolute_temperature(setting.gas, q));
              const double distance = distance_to_wall(tile, boundary.where.side, k, j, i);
              const Eigen::Vector3d n(f.nx, f.ny, f.nz), shear = friction - friction.dot(n) * n;
              if (viscous.active && sticks(*boundary.condition)) {
                point.y_plus = std::sqrt(rho * shear.norm() / f.area) * distance / mu;
                point.growth = growth_of_line(tile, boundary.where.side, {i, j, k}, point.y_plus, distance);
              }
              points.push_back(point);
            });
}

}  // namespace spindrift::aero
