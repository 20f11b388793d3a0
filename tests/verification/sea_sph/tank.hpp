// A 2-D tank of water at rest, which the verification scenes start from.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernels/base/random.hpp"
#include "src/sea/sph/lattice.hpp"
#include "src/sea/sph/sea_sph.hpp"
#include "tests/replica.hpp"

namespace spindrift::sph {

/// Water of depth H has its surface half a spacing above its top row and its bottom half a spacing under its lowest one.
struct Tank {
  Parameters p;
  double depth;
  int columns, rows;
  static constexpr int wall_layers = 3;

  Tank(double spacing, double length, double water_depth, double c0_over_wave_speed = 10.0)
      : depth(water_depth), columns(int(std::lround(length / spacing))), rows(int(std::lround(water_depth / spacing))) {
    p.spacing = spacing, p.h_over_d = 1.5, p.diffusion = DiffusionChoice::fourtakas;
    p.eos = {1000.0, c0_over_wave_speed * std::sqrt(p.gravity * water_depth)};
    p.mass_factor = p.eos.mean_density_ratio(rows * spacing, p.gravity);
  }
  double surface() const { return (rows - 0.5) * p.spacing; }
  double bottom() const { return -0.5 * p.spacing; }

  void add_water_to(std::vector<Seed<2>>& seeds) const {
    const std::size_t first = seeds.size();
    add_water_at_rest<2>(seeds, {0, 0}, p, {0, 0}, {columns, rows});
    const testing::Replica replica = testing::replica();
    Random random(replica.seed);
    for (std::size_t n = first; n < seeds.size(); ++n)
      for (double& x : seeds[n].position) x += replica.jitter * p.spacing * (2.0 * random.uniform() - 1.0);
  }
  /// `modified`: with ghost nodes mirrored in the walls' surfaces, half a spacing inside their first layer.
  void add_walls_to(std::vector<Seed<2>>& seeds, int length, int height, bool modified = false) const {
    const std::size_t first = seeds.size();
    add_tank<2>(seeds, {0, 0}, p.spacing, {0, 0}, {length, height}, wall_layers, p.eos, p.gravity, surface());
    for (std::size_t n = first; n < seeds.size() && modified; ++n)
      seeds[n].ghost = mirror_in_box<2>(seeds[n].position, {bottom(), bottom()}, {(length - 0.5) * p.spacing, 1e300});
  }
};

template <class Sea, class Visit>
void for_water_of(const Sea& sea, Visit&& visit) {
  for (std::size_t slot = 0; slot < sea.store().slots(); ++slot)
    if (sea.store().id[slot] != no_particle && sea.store().owner[slot / cluster_size] == 0) visit(slot);
}

}  // namespace spindrift::sph
