// Where waves die away: the velocity of the water decays at a rate that grows quadratically over a zone, exactly over each step
// (v exp(-rate s^2 dt)), so that no rate is too large. Called by tasks.cpp for each group after a step; tested in
// tests/src/sea/sph/wave_tank_parts_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <span>
#include <vector>

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

/// What damps the water after each step; nothing by default.
struct Damping {
  std::vector<DampingZone> zones;
  double everywhere = 0.0;  ///< on top of the zones [1/s]: of water that settles
  bool acts() const { return !zones.empty() || everywhere != 0.0; }
};

/// Damps the water in some clusters over a step of dt [s].
template <int dim, class Real>
void damp(Store<dim, Real>& store, const Damping& damping, double dt, std::size_t first, std::size_t last) {
  const auto& [zones, everywhere] = damping;
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
void damp(Store<dim, Real>& store, const Damping& damping, double dt) {
  if (damping.acts()) damp(store, damping, dt, 0, store.clusters());
}

}  // namespace spindrift::sph
