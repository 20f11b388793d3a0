// What no particle of water may exceed at the end of a window: beyond its own speed of sound, or compressed or torn by half of
// its density, the weakly compressible fluid is no water, and the sums have gone astray. Columns of history.csv follow from these
// states, so none holds a speed above c0, a kinetic energy above m c0^2 / 2 or a pressure above 2.3 rho0 c0^2 (Tait's at 1.5
// rho0). Called by src/sea/particle_sea.cpp; tested in tests/src/sea/sph/bounds_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "runtime/mpi/exchange.hpp"
#include "src/sea/sph/gauges.hpp"
#include "src/sea/sph/parameters.hpp"
#include "src/sea/sph/step_plan.hpp"
#include "src/sea/sph/store.hpp"

namespace spindrift::sph {

inline constexpr double most_mach = 1.0;            // speed over that of sound
inline constexpr double most_density_change = 0.5;  // of rho0, either way

/// The particle that is farthest beyond a bound.
struct Beyond {
  double excess = 0.0;  ///< over the bound; infinite where it is no number
  double value = 0.0, limit = 0.0;
  bool dense = false;  ///< the density, else the speed
  std::int64_t particle = 0;
  std::array<double, 3> at{};

  std::string describe(int dim) const {
    std::string place = in_words(at[0]);
    for (int k = 1; k < dim; ++k) place += ", " + in_words(at[std::size_t(k)]);
    const std::string what = dense ? "the density of particle " : "the speed of particle ", unit = dense ? " kg/m3" : " m/s",
                      why = dense ? " kg/m3 (half of the water's from it)" : " m/s (the water's speed of sound)";
    return "sea: " + what + std::to_string(particle) + " at (" + place + ") m came to " + in_words(value) + unit +
           ", the limit is " + in_words(limit) + why +
           "; try a smaller sea.particles.cfl or a larger sea.particles.sound_speed_factor";
  }
};

/// Of all ranks, the same on each; nothing where all particles are within. Collective.
template <int dim, class Real>
std::optional<Beyond> beyond_bounds(const Store<dim, Real>& store, const Parameters& p, MPI_Comm comm) {
  const double most_speed = most_mach * p.eos.c0, most_change = most_density_change * p.eos.rho0;
  Beyond worst;
  const auto look = [&](std::size_t slot, bool dense, double value, double share) {
    if (share <= 1.0) return;
    const double excess = std::isfinite(share) ? share : std::numeric_limits<double>::infinity();
    if (excess < worst.excess || (excess == worst.excess && store.id[slot] >= worst.particle)) return;
    worst = {.excess = excess, .value = value, .dense = dense, .particle = store.id[slot]};
    worst.limit = !dense ? most_speed : p.eos.rho0 + (value < p.eos.rho0 ? -most_change : most_change);
    for (int k = 0; k < dim; ++k) worst.at[std::size_t(k)] = store.x[k][slot];
  };
  for_water_particles(store, [&](std::size_t slot) {
    double speed2 = 0.0;
    for (int k = 0; k < dim; ++k) speed2 += store.v[k][slot] * store.v[k][slot];
    const double change = std::abs(store.deviation[slot]);
    if (speed2 <= most_speed * most_speed && change <= most_change) return;  // false of what is no number
    look(slot, false, std::sqrt(speed2), std::sqrt(speed2) / most_speed);
    look(slot, true, p.eos.rho0 + store.deviation[slot], change / most_change);
  });
  if (runtime::ranks_in(comm) > 1) {
    runtime::Packer mine;
    mine.put_one(worst);
    for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take())) {
      const Beyond other = runtime::Unpacker(bytes).template one<Beyond>();
      if (other.excess > worst.excess || (other.excess == worst.excess && other.particle < worst.particle)) worst = other;
    }
  }
  return worst.excess > 0.0 ? std::optional(worst) : std::nullopt;
}

}  // namespace spindrift::sph
