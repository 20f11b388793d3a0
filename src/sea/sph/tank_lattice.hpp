// The lattice that a tank is filled on. Used by tank.cpp and tank_count.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "src/sea/sph/parameters.hpp"
#include "src/sea/sph/tank.hpp"

namespace spindrift::sph {

/// The lattice of a tank: cells counted from the lower corner of the water at the level bed.
template <int dim>
struct TankLattice {
  std::array<double, dim> corner, edge;
  std::array<int, dim> count;  ///< inside the walls; along z up to their top

  TankLattice(const TankPlan& plan, double spacing) {
    const auto cells = [&](int axis, double low, double high, double whole) {
      corner[axis] = low, edge[axis] = whole / std::max(1.0, std::round(whole / spacing));
      count[axis] = int(std::ceil((high - low) / edge[axis] * (1.0 - 1e-12)));
    };
    cells(0, plan.x[0], plan.x[1], plan.x[1] - plan.x[0]);
    if constexpr (dim == 3) cells(1, plan.y[0], plan.y[1], plan.y[1] - plan.y[0]);
    cells(dim - 1, -plan.depth, plan.top, plan.depth);
  }
  double at(int axis, int index) const { return corner[axis] + (index + 0.5) * edge[axis]; }
  std::array<double, dim> at(const std::array<int, dim>& index) const {
    std::array<double, dim> x;
    for (int k = 0; k < dim; ++k) x[k] = at(k, index[k]);
    return x;
  }
  double cell() const {
    double volume = 1.0;
    for (double e : edge) volume *= e;
    return volume;
  }
};

/// Whether a place [m] is in a block of water or of an obstacle; of the plane whatever its y.
template <int dim>
bool inside(const TankPlan::Block& block, const Eigen::Vector3d& x) {
  for (int k = 0; k < 3; ++k)
    if (!(dim == 2 && k == 1) && !(x[k] > block.low[k] && x[k] < block.high[k])) return false;
  return true;
}

/// Mean density of the water of the depth at rest over that under no pressure: a column of whole cells fills it.
inline double mean_density_ratio(const TankPlan& plan, const Parameters& p) {
  return p.gravity > 0.0 ? p.eos.mean_density_ratio(plan.depth, p.gravity) : 1.0;
}

/// Layers of wall particles: as many as act on water.
inline int wall_layers(const Parameters& p) { return int(std::ceil(p.reach() / p.spacing - 1e-9)) - 1; }

}  // namespace spindrift::sph
