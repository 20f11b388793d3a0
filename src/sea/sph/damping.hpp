// Where waves die away, or are led back to what they are to be (relaxation zones: Jacobsen, Fuhrman & Fredsoe 2012; with
// particles Altomare et al. 2018): the velocity of the water goes to rest, or to that of given waves, at a rate that grows
// quadratically over a zone, exactly over each step (exp(-rate s^2 dt)), so that no rate is too large. Called by tasks.cpp for
// each group after a step; tested in tests/src/sea/sph/wave_tank_parts_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "kernels/waves/components.hpp"
#include "src/sea/sph/store.hpp"

namespace spindrift::sph {

/// No damping at `from`, the full rate at `to` and beyond; to < from for a zone at the lower end [m], [1/s]. Axis: 0 x, 1 y. A
/// zone that leads to waves does so at its full rate in the middle and no more at `to`: there, at a wall or where sides that
/// repeat meet, the waves need not fit, and water that has to follow them on both sides has nowhere to go. From the middle on it
/// is brought to rest, at a fifth of the rate at `to`, lest it sways to and fro between two such zones.
struct DampingZone {
  double from, to, rate;
  int axis = 0;
  bool to_waves = false;  ///< to the motion of Damping::waves, not to rest
  struct Rates {
    double to_rest = 0.0, to_waves = 0.0;
  };
  Rates rates_at(double x) const {
    const double s = std::clamp((x - from) / (to - from), 0.0, 1.0);
    if (!to_waves) return {.to_rest = rate * s * s};
    const double rest = std::sqrt(0.2) * std::max(0.0, 2.0 * s - 1.0), lead = 1.0 - std::abs(2.0 * s - 1.0);
    return {rate * rest * rest, rate * lead * lead};
  }
};

/// What damps the water after each step; nothing by default.
struct Damping {
  std::vector<DampingZone> zones;
  double everywhere = 0.0;                   ///< on top of the zones [1/s]: of water that settles
  std::vector<waves::ComponentGroup> waves;  ///< whose motion some zones lead to
  double ahead = 0.0;                        ///< time of the waves over the sea's own [s]
  bool acts() const { return !zones.empty() || everywhere != 0.0; }
};

/// Of the waves at a place of the tank; above still water by the straight line that continues their profiles.
template <int dim>
std::array<double, dim> wave_velocity(const Damping& damping, const std::array<double, dim>& x, double t) {
  const double y = dim == 3 ? x[1] : 0.0, z = x[dim - 1];
  const waves::Kinematics motion = z > 0.0 ? waves::kinematics_above(damping.waves, t + damping.ahead, x[0], y, z)
                                           : waves::kinematics(damping.waves, t + damping.ahead, x[0], y, z);
  if constexpr (dim == 3)
    return {motion.velocity.x(), motion.velocity.y(), motion.velocity.z()};
  else
    return {motion.velocity.x(), motion.velocity.z()};
}

/// Damps the water in some clusters over a step of dt that ends at t [s], by the clock of the sea. took(s): what that takes of
/// the square of a particle's speed [m2/s2].
template <int dim, class Real, class Took>
void damp(Store<dim, Real>& store, const Damping& damping, double t, double dt, std::size_t first, std::size_t last,
          Took&& took) {
  for (std::size_t cluster = first; cluster < last; ++cluster) {
    if (store.owner[cluster] != 0) continue;
    for (std::size_t slot = cluster * cluster_size; slot < (cluster + 1) * cluster_size; ++slot) {
      if (store.id[slot] == no_particle) continue;
      double rate = damping.everywhere, to_waves = 0.0;
      for (const DampingZone& zone : damping.zones) {
        const DampingZone::Rates of_zone = zone.rates_at(store.x[zone.axis][slot]);
        rate += of_zone.to_rest + of_zone.to_waves;
        to_waves += of_zone.to_waves;
      }
      if (rate == 0.0) continue;
      const double factor = std::exp(-rate * dt);
      std::array<double, dim> led{};  // what the waves give
      if (to_waves > 0.0) {
        std::array<double, dim> x;
        for (int k = 0; k < dim; ++k) x[k] = store.x[k][slot];
        led = wave_velocity<dim>(damping, x, t);
        for (double& v : led) v *= (1.0 - factor) * to_waves / rate;
      }
      double taken = 0.0;
      for (int k = 0; k < dim; ++k) {
        const double before = store.v[k][slot], after = before * factor + led[k];
        taken += before * before - after * after;
        store.v[k][slot] = after;
        if (!store.v_before[k].empty()) store.v_before[k][slot] = store.v_before[k][slot] * factor + led[k];
      }
      took(taken);
    }
  }
}

}  // namespace spindrift::sph
