// What instruments in the tank read: height of the surface at a place, pressure and velocity at a point.
// Surface: the share of a neighbourhood that water fills, sum of V W, falls through one half there (of its value below, so that
// walls nearby do not matter). Pressure: weighted mean with the hydrostatic part taken to the probe's height, velocity: weighted
// mean. On several ranks all functions are collective: what lies near an instrument is gathered and summed in one order, so a
// reading has the same bits for any number of ranks. Called by particle_sea.cpp between windows; tested in
// tests/src/sea/sph/gauges_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "kernels/sph/kernel_wendland.hpp"
#include "runtime/mpi/exchange.hpp"
#include "src/sea/sph/parameters.hpp"
#include "src/sea/sph/store.hpp"

namespace spindrift::sph {

/// Water particle near an instrument: where it is from the instrument's place and how much room it takes.
struct NearWater {
  double distance2;  ///< horizontal [m2]
  double z, volume;  ///< [m], [m3] (2-D: [m2])
};

/// Highest z where the filled share falls through half of what it is in the water below; nothing where what is near `top`, the
/// highest particle that counts, is spray: it fills less than `least`.
template <int dim>
std::optional<double> surface_height(std::span<const NearWater> water, double h, double top, double least) {
  const KernelWendland<dim> kernel(h);
  const double step = 0.1 * h;
  const auto filled = [&](double z) {
    double sum = 0.0;
    for (const NearWater& p : water) {
      const double dz = z - p.z;
      if (std::abs(dz) < 2.0 * h) sum += p.volume * kernel.value(p.distance2 + dz * dz);
    }
    return sum;
  };
  // To 4 h below the highest particle: the share has its inner value 2 h below the surface, which must be in the upper part.
  constexpr int depth = 60, upper = depth - 20;
  std::array<double, depth> share;
  for (int n = 0; n < depth; ++n) share[n] = filled(top + 2.0 * h - n * step);
  if (*std::max_element(share.begin(), share.begin() + upper) < least) return std::nullopt;
  const double most = *std::max_element(share.begin(), share.end());
  for (int n = 1; n < upper; ++n)
    if (share[n] >= 0.5 * most) return top + 2.0 * h - step * (n - (share[n] - 0.5 * most) / (share[n] - share[n - 1]));
  return std::nullopt;
}

template <int dim, class Real, class Visit>
void for_water_particles(const Store<dim, Real>& store, std::size_t first, std::size_t last, Visit&& visit) {
  for (std::size_t cluster = first; cluster < last; ++cluster) {
    if (store.owner[cluster] != 0) continue;
    for (std::size_t slot = cluster * cluster_size; slot < (cluster + 1) * cluster_size; ++slot)
      if (store.id[slot] != no_particle) visit(slot);
  }
}
template <int dim, class Real, class Visit>
void for_water_particles(const Store<dim, Real>& store, Visit&& visit) {
  for_water_particles(store, 0, store.clusters(), visit);
}

/// Difference of two places along an axis, the short way round where the axis is periodic.
template <int dim>
double apart(const Domain<dim>& domain, int axis, double difference) {
  if (!domain.periodic[axis]) return difference;
  const double length = domain.high[axis] - domain.low[axis];
  return difference - length * std::round(difference / length);
}

/// Heights of the surface at places (x; in 3-D x, y) [m]; `dry` where there is no water. Each place is summed up by one rank.
/// Where the highest particles are spray the next round looks below them; where all are, once more for water in a corner of two
/// walls, which fills a quarter. Two particles of spray fill less.
template <int dim, class Real>
std::vector<double> surface_heights(const Store<dim, Real>& store, const Parameters& p, const Domain<dim>& domain,
                                    std::span<const std::array<double, dim - 1>> places, double dry,
                                    MPI_Comm comm = MPI_COMM_SELF) {
  constexpr double none = -1e300;
  const auto ranks = std::size_t(runtime::ranks_in(comm)), rank = std::size_t(runtime::rank_in(comm));
  // Places are looked up by cells of at least one reach along x, so that a field of them costs each particle a few comparisons.
  const double reach = p.reach(), mass = p.mass(dim), length = domain.high[0] - domain.low[0];
  const int cells = std::max(1, int(length / reach));
  const auto cell_of = [&](double x) {
    const int cell = int(std::floor((x - domain.low[0]) / length * cells));
    return domain.periodic[0] ? ((cell % cells) + cells) % cells : std::clamp(cell, 0, cells - 1);
  };
  std::vector<std::vector<std::uint32_t>> in_cell(static_cast<std::size_t>(cells));
  std::vector<std::uint8_t> wanted(places.size(), 1);
  const auto for_near = [&](std::size_t slot, auto&& visit) {
    const int home = cell_of(store.x[0][slot]);
    for (int step = -1; step <= 1; ++step) {
      int cell = home + step;
      if (domain.periodic[0]) cell = (cell + cells) % cells;
      if (cell < 0 || cell >= cells) continue;
      for (std::uint32_t n : in_cell[std::size_t(cell)]) {
        double distance2 = 0.0;
        for (int k = 0; k < dim - 1; ++k) {
          const double difference = apart(domain, k, store.x[k][slot] - places[n][k]);
          distance2 += difference * difference;
        }
        if (distance2 < reach * reach) visit(n, distance2);
      }
    }
  };
  struct Found {
    std::uint32_t place;
    NearWater water;
  };
  std::vector<double> heights(places.size(), dry), below(places.size()), top(places.size());
  const auto look = [&](double least) {
    std::ranges::fill(top, none);
    for_water_particles(store, [&](std::size_t slot) {
      const double z = store.x[dim - 1][slot];
      for_near(slot, [&](std::uint32_t n, double) {
        if (z < below[n]) top[n] = std::max(top[n], z);
      });
    });
    if (ranks > 1) {
      runtime::Packer mine;
      mine.put(std::span<const double>(top));
      for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take())) {
        const auto theirs = runtime::Unpacker(bytes).template many<double>();
        for (std::size_t n = 0; n < top.size(); ++n) top[n] = std::max(top[n], theirs[n]);
      }
    }
    std::vector<runtime::Packer> to(ranks);
    std::vector<std::vector<NearWater>> water(places.size());
    for_water_particles(store, [&](std::size_t slot) {
      const double z = store.x[dim - 1][slot];
      for_near(slot, [&](std::uint32_t n, double distance2) {
        if (!(z > top[n] - 8.0 * p.h() && z < top[n] + 4.0 * p.h())) return;
        const NearWater near{distance2, z, mass / (p.eos.rho0 + store.deviation[slot])};
        if (n % ranks == rank)
          water[n].push_back(near);
        else
          to[n % ranks].put_one(Found{n, near});
      });
    });
    if (ranks > 1) {
      std::vector<runtime::Bytes> parcels;
      for (runtime::Packer& packer : to) parcels.push_back(packer.take());
      for (const runtime::Bytes& bytes : runtime::exchange(comm, parcels))
        for (runtime::Unpacker from(bytes); !from.done();) {
          const Found found = from.one<Found>();
          water[found.place].push_back(found.water);
        }
    }
    std::vector<double> read(places.size(), none);  // none: spray, or no water
    for (std::size_t n = rank; n < places.size(); n += ranks) {
      if (water[n].empty()) continue;
      // The order of terms must not depend on where particles lie in memory.
      std::sort(water[n].begin(), water[n].end(),
                [](const NearWater& a, const NearWater& b) { return a.z != b.z ? a.z < b.z : a.distance2 < b.distance2; });
      read[n] = surface_height<dim>(water[n], p.h(), top[n], least).value_or(none);
    }
    if (ranks > 1) {
      runtime::Packer mine;
      mine.put(std::span<const double>(read));
      std::size_t from_rank = 0;
      for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take())) {
        const auto theirs = runtime::Unpacker(bytes).template many<double>();
        for (std::size_t n = from_rank; n < read.size(); n += ranks) read[n] = theirs[n];
        ++from_rank;
      }
    }
    for (auto& cell : in_cell)
      std::erase_if(cell, [&](std::uint32_t n) {
        if (read[n] != none) heights[n] = read[n], wanted[n] = 0;
        below[n] = top[n] - p.h();  // a surface within 2 h of the top would have been found
        return read[n] != none || top[n] == none;
      });
  };
  for (const double least : dim == 3 ? std::vector{0.3, 0.22} : std::vector{0.3}) {
    for (std::uint32_t n = 0; n < places.size(); ++n)
      if (wanted[n]) in_cell[std::size_t(cell_of(places[n][0]))].push_back(n);
    std::ranges::fill(below, 1e300);
    while (std::ranges::any_of(in_cell, [](const auto& cell) { return !cell.empty(); })) look(least);
  }
  return heights;
}

/// Least share of a full neighbourhood that is read as water: at a wall half is filled, in a corner, which water keeps a spacing
/// from, a tenth.
inline constexpr double least_water = 0.02;

/// What a probe reads; velocity is not-a-number where there is no water, pressure zero.
template <int dim>
struct ProbeReading {
  double pressure = 0.0;
  std::array<double, dim> velocity;
};
template <int dim, class Real>
ProbeReading<dim> probe(const Store<dim, Real>& store, const Parameters& p, const Domain<dim>& domain,
                        const std::array<double, dim>& at, MPI_Comm comm = MPI_COMM_SELF) {
  struct Term {
    std::uint32_t id;
    double weight, pressure, over;  ///< of the water above the probe's height [Pa]
    std::array<double, dim> velocity;
  };
  const KernelWendland<dim> kernel(p.h());
  std::vector<Term> terms;
  for_water_particles(store, [&](std::size_t slot) {
    double distance2 = 0.0;
    for (int k = 0; k < dim; ++k) {
      const double difference = apart(domain, k, store.x[k][slot] - at[k]);
      distance2 += difference * difference;
    }
    if (distance2 >= p.reach() * p.reach()) return;
    const double rho = p.eos.rho0 + store.deviation[slot];
    Term term{store.id[slot],
              p.mass(dim) / rho * kernel.value(distance2),
              p.eos.pressure(store.deviation[slot]),
              rho * p.gravity * (store.x[dim - 1][slot] - at[dim - 1]),
              {}};
    for (int k = 0; k < dim; ++k) term.velocity[k] = store.v[k][slot];
    terms.push_back(term);
  });
  if (runtime::ranks_in(comm) > 1) {
    runtime::Packer mine;
    mine.put(std::span<const Term>(terms));
    terms.clear();
    for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take()))
      for (const Term& term : runtime::Unpacker(bytes).template many<Term>()) terms.push_back(term);
  }
  std::sort(terms.begin(), terms.end(), [](const Term& a, const Term& b) { return a.id < b.id; });
  ProbeReading<dim> reading;
  reading.velocity.fill(0.0);
  double weight = 0.0, pressure = 0.0, over = 0.0;
  for (const Term& t : terms) {
    weight += t.weight, pressure += t.weight * t.pressure, over += t.weight * t.over;
    for (int k = 0; k < dim; ++k) reading.velocity[k] += t.weight * t.velocity[k];
  }
  if (weight < least_water) {
    reading.pressure = 0.0;
    reading.velocity.fill(std::numeric_limits<double>::quiet_NaN());
    return reading;
  }
  reading.pressure = std::max(pressure + over, std::min(pressure, 0.0)) / weight;  // as sensors: weight alone makes no tension
  for (double& v : reading.velocity) v /= weight;
  return reading;
}

}  // namespace spindrift::sph
