// Where waves die away: the velocity of the water decays at a rate that grows quadratically over a zone, exactly over each step
// (v exp(-rate s^2 dt)), so that no rate is too large. Called by particle_sea.cpp for each group after a step; tested in
// tests/src/sea/sph/wave_tank_parts_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <span>

#include "src/sea/sph/store.hpp"

namespace spindrift::sph {

/// No damping at `from`, the full rate at `to` and beyond; to < from for a zone at the lower end [m], [1/s]. Axis: 0 x, 1 y.
struct DampingZone {
  double from, to, rate;
  int axis = 0;
  double rate_at(double x) const {
    const double s = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return rate * s * s;
  }
};

/// Damps the water in some clusters; `everywhere` [1/s] comes on top of the zones.
template <int dim, class Real>
void damp(Store<dim, Real>& store, std::span<const DampingZone> zones, double everywhere, double dt, std::size_t first,
          std::size_t last) {
  if (zones.empty() && everywhere == 0.0) return;
  for (std::size_t cluster = first; cluster < last; ++cluster) {
    if (store.owner[cluster] != 0) continue;
    for (std::size_t slot = cluster * cluster_size; slot < (cluster + 1) * cluster_size; ++slot) {
      double rate = everywhere;
      for (const DampingZone& zone : zones) rate += zone.rate_at(store.x[zone.axis][slot]);
      if (rate == 0.0) continue;
      const double factor = std::exp(-rate * dt);
      for (int k = 0; k < dim; ++k) {
        store.v[k][slot] *= factor;
        if (!store.v_before[k].empty()) store.v_before[k][slot] *= factor;
      }
    }
  }
}

/// All of it.
template <int dim, class Real>
void damp(Store<dim, Real>& store, std::span<const DampingZone> zones, double everywhere, double dt) {
  damp(store, zones, everywhere, dt, 0, store.clusters());
}

}  // namespace spindrift::sph
