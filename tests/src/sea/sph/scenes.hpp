// Small seas that several tests use.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <vector>

#include "src/sea/sph/parameters.hpp"
#include "src/sea/sph/store.hpp"

namespace spindrift::sph {

/// A block of water with disorder, random velocities and densities, over a sheet of wall particles; low corner at `corner`.
template <int dim>
std::vector<Seed<dim>> disordered_block(double d, std::array<int, dim> cells, std::array<double, dim> corner, bool wall,
                                        unsigned seed = 7) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Seed<dim>> seeds;
  std::array<int, dim> at{};
  for (bool more = true; more;) {
    Seed<dim> seed;
    for (int k = 0; k < dim; ++k) {
      seed.position[k] = corner[k] + d * (at[k] + 0.5 + 0.25 * unit(random));
      seed.velocity[k] = unit(random);
    }
    seed.deviation = 5.0 * unit(random);
    if (wall && at[dim - 1] == 0) seed.owner = 1, seed.velocity = {};
    seeds.push_back(seed);
    more = false;
    for (int k = 0; k < dim && !more; ++k) {
      if (++at[k] < cells[k])
        more = true;
      else
        at[k] = 0;
    }
  }
  return seeds;
}

template <int dim>
Domain<dim> domain_around(std::array<double, dim> corner, double size) {
  Domain<dim> domain;
  for (int k = 0; k < dim; ++k) domain.low[k] = corner[k] - 0.1 * size, domain.high[k] = corner[k] + 1.1 * size;
  return domain;
}

/// State of every particle by identity, whatever the order in the store.
template <int dim, class Real, class Read>
auto by_identity(const Store<dim, Real>& store, std::size_t particles, Read&& read) {
  std::vector<decltype(read(std::size_t(0)))> values(particles);
  for (std::size_t slot = 0; slot < store.slots(); ++slot)
    if (store.id[slot] != no_particle) values[store.id[slot]] = read(slot);
  return values;
}

/// Sum of the pair sweep for a slot: components 0..dim-1 acceleration, dim the density rate, per unit mass.
template <int dim, class Real>
auto sums_at(const Store<dim, Real>& store, std::size_t slot) {
  std::array<double, dim + 1> s;
  for (int k = 0; k <= dim; ++k) s[k] = double(store.sums_of(slot / cluster_size)[k * cluster_size + slot % cluster_size]);
  return s;
}

}  // namespace spindrift::sph
