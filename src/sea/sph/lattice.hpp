// Particles on a lattice: blocks of water with hydrostatic density, and tanks of wall particles. Whole cells, so that scenes have
// round counts. Called by scenes of tests, perf/sea and later the scene options; tested in tests/src/sea/sph/lattice_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "kernels/sph/eos_tait.hpp"
#include "src/sea/sph/parameters.hpp"
#include "src/sea/sph/seeds.hpp"

namespace spindrift::sph {

/// Calls visit(index) for every index in [low, high) of each axis, the last axis fastest.
template <int dim, class Visit>
void for_lattice(const std::array<int, dim>& low, const std::array<int, dim>& high, Visit&& visit) {
  for (int k = 0; k < dim; ++k)
    if (low[k] >= high[k]) return;
  std::array<int, dim> index = low;
  for (;;) {
    visit(index);
    int k = dim - 1;
    for (; k >= 0 && ++index[k] == high[k]; --k) index[k] = low[k];
    if (k < 0) return;
  }
}

template <int dim>
std::array<double, dim> lattice_point(const std::array<double, dim>& origin, double spacing, const std::array<int, dim>& index) {
  std::array<double, dim> x;
  for (int k = 0; k < dim; ++k) x[k] = origin[k] + spacing * index[k];
  return x;
}

/// Water on the points [low, high) of a lattice, with the density of rest under a surface at the height `surface` [m].
template <int dim>
void add_water(std::vector<Seed<dim>>& seeds, const std::array<double, dim>& origin, double spacing,
               const std::array<int, dim>& low, const std::array<int, dim>& high, const EosTait& eos, double gravity,
               double surface) {
  for_lattice<dim>(low, high, [&](const std::array<int, dim>& index) {
    Seed<dim> seed{.position = lattice_point<dim>(origin, spacing, index)};
    seed.deviation = eos.hydrostatic_deviation(std::max(0.0, surface - seed.position[dim - 1]), gravity);
    seeds.push_back(seed);
  });
}

/// Water at rest on the points [low, high) of a lattice, its rows moved together as its own weight compresses it: the mass of the
/// rows above each one is what water at rest has above that height. The bottom lies half a spacing under the lowest row, the
/// surface half a spacing over the highest one, and the mass of a particle (Parameters::mass_factor) is taken from the depth, so
/// that the column fills it; shallower columns of the same scene take the same mass.
template <int dim>
void add_water_at_rest(std::vector<Seed<dim>>& seeds, const std::array<double, dim>& origin, const Parameters& p,
                       const std::array<int, dim>& low, const std::array<int, dim>& high) {
  const int rows = high[dim - 1] - low[dim - 1];
  const double bottom = origin[dim - 1] + (low[dim - 1] - 0.5) * p.spacing, mass_of_row = p.mass(1);
  const double depth = p.gravity > 0.0 ? p.eos.depth_of_mass(rows * mass_of_row, p.gravity) : rows * p.spacing;
  for_lattice<dim>(low, high, [&](const std::array<int, dim>& index) {
    Seed<dim> seed{.position = lattice_point<dim>(origin, p.spacing, index)};
    if (p.gravity > 0.0) {
      const double below_surface = p.eos.depth_of_mass((high[dim - 1] - index[dim - 1] - 0.5) * mass_of_row, p.gravity);
      seed.position[dim - 1] = bottom + depth - below_surface;
      seed.deviation = p.eos.hydrostatic_deviation(below_surface, p.gravity);
    }
    seeds.push_back(seed);
  });
}

/// Walls round the points [low, high): `layers` of particles outside them, below and on all sides up to the last axis' high[dim -
/// 1]; open at the top. Their density is that of rest where they stand beside water.
template <int dim>
void add_tank(std::vector<Seed<dim>>& seeds, const std::array<double, dim>& origin, double spacing,
              const std::array<int, dim>& low, const std::array<int, dim>& high, int layers, const EosTait& eos, double gravity,
              double surface, std::uint16_t owner = 1) {
  std::array<int, dim> outer_low = low, outer_high = high;
  for (int k = 0; k < dim; ++k) outer_low[k] -= layers, outer_high[k] += k < dim - 1 ? layers : 0;
  for_lattice<dim>(outer_low, outer_high, [&](const std::array<int, dim>& index) {
    bool inside = true;
    for (int k = 0; k < dim; ++k) inside = inside && index[k] >= low[k] && index[k] < high[k];
    if (inside) return;
    Seed<dim> seed{.position = lattice_point<dim>(origin, spacing, index)};
    seed.deviation = eos.hydrostatic_deviation(std::max(0.0, surface - seed.position[dim - 1]), gravity);
    seed.owner = owner;
    seeds.push_back(seed);
  });
}

}  // namespace spindrift::sph
