// Solids made of particles: which particles belong to a body, moving them with it, and the force of the water on it.
// These forces come from pairs with water only: contact of bodies with walls and with each other is contact.hpp's.
// The reduction runs over clusters in their order, which the scene and the state fix: the same bits for any number of threads.
// Called by sea_sph.cpp; tested in tests/src/sea/sph/solids_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernels/rigid/motion.hpp"
#include "kernels/rigid/wrench.hpp"
#include "src/sea/sph/store.hpp"

namespace spindrift::sph {

/// Position or vector of the earth frame; a 2-D scene is its x-z plane.
template <int dim>
Eigen::Vector3d to_earth(const std::array<double, dim>& x) {
  if constexpr (dim == 2)
    return {x[0], 0.0, x[1]};
  else
    return {x[0], x[1], x[2]};
}
template <int dim>
std::array<double, dim> from_earth(const Eigen::Vector3d& x) {
  if constexpr (dim == 2)
    return {x[0], x[2]};
  else
    return {x[0], x[1], x[2]};
}

/// The particles of one body, identities first_id, first_id + 1, ..., in body axes from the centre of mass [m].
struct Solid {
  std::uint16_t owner = 0;
  std::uint32_t first_id = 0;
  std::vector<Eigen::Vector3d> local;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = Eigen::Vector3d::Constant(-1e300);  ///< box of `local`

  /// Particles across it where it is thinnest: those it has over those it shows along the axis that shows most.
  double layers(double spacing) const {
    const Eigen::Vector3d extent = (high - low).array() + spacing;
    double volume = 0.0, largest_face = 0.0;
    for (int k = 0; k < 3; ++k) {
      if (high[k] == low[k]) continue;  // the axis that a 2-D scene lacks
      const double face = (extent / spacing).prod() / (extent[k] / spacing);
      largest_face = std::max(largest_face, face);
    }
    volume = double(local.size());
    return std::max(1.0, largest_face > 0.0 ? volume / largest_face : 1.0);
  }
};

/// Reads a body's particles where they are now, under its motion now.
template <int dim, class Real>
Solid solid_from(const Store<dim, Real>& store, std::uint16_t owner, const Motion& motion) {
  Solid solid{.owner = owner, .first_id = no_particle, .local = {}};
  std::uint32_t last = 0, count = 0;
  const auto visit = [&](auto&& with) {
    for (std::size_t slot = 0; slot < store.slots(); ++slot)
      if (store.owner[slot / cluster_size] == owner && store.id[slot] != no_particle) with(slot);
  };
  visit([&](std::size_t slot) {
    solid.first_id = std::min(solid.first_id, store.id[slot]), last = std::max(last, store.id[slot]), ++count;
  });
  if (count == 0) throw std::invalid_argument("sph: solid " + std::to_string(owner) + " has no particles");
  if (last - solid.first_id + 1 != count)
    throw std::invalid_argument("sph: the particles of solid " + std::to_string(owner) + " must be added in one run");
  solid.local.resize(count);
  visit([&](std::size_t slot) {
    std::array<double, dim> x;
    for (int k = 0; k < dim; ++k) x[k] = store.x[k][slot];
    const Eigen::Vector3d local = motion.attitude.conjugate() * (to_earth<dim>(x) - motion.position);
    solid.local[store.id[slot] - solid.first_id] = local;
    solid.low = solid.low.cwiseMin(local), solid.high = solid.high.cwiseMax(local);
  });
  return solid;
}

/// Puts a body's particles where its motion has them, on periodic axes at the image nearest to where they were; returns the
/// longest way any of them went [m].
template <int dim, class Real>
double place(Store<dim, Real>& store, const Domain<dim>& domain, const Solid& solid, const Motion& motion) {
  double farthest2 = 0.0;
  for (std::size_t cluster = 0; cluster < store.clusters(); ++cluster) {
    if (store.owner[cluster] != solid.owner) continue;
    for (std::size_t slot = cluster * cluster_size; slot < (cluster + 1) * cluster_size && store.id[slot] != no_particle;
         ++slot) {
      const Eigen::Vector3d& local = solid.local[store.id[slot] - solid.first_id];
      auto x = from_earth<dim>(motion.point(local));
      const auto v = from_earth<dim>(motion.point_velocity(local));
      double way2 = 0.0;
      for (int k = 0; k < dim; ++k) {
        if (domain.periodic[k]) {
          const double length = domain.high[k] - domain.low[k];
          x[k] += length * std::round((store.x[k][slot] - x[k]) / length);
        }
        way2 += (x[k] - store.x[k][slot]) * (x[k] - store.x[k][slot]);
        store.x[k][slot] = x[k], store.v[k][slot] = v[k];
      }
      farthest2 = std::max(farthest2, way2);
    }
  }
  return std::sqrt(farthest2);
}

/// Force of the water on a solid and its moment about a point, from the sums of the last pair sweep; per metre of width in 2-D.
template <int dim, class Real>
Wrench load(const Store<dim, Real>& store, std::uint16_t owner, double mass, const Eigen::Vector3d& about) {
  Wrench total{.point = about};
  for (std::size_t cluster = 0; cluster < store.clusters(); ++cluster) {
    if (store.owner[cluster] != owner) continue;
    const Real* planes = store.pack_of(cluster);
    const Real* sums = store.sums_of(cluster);
    for (int lane = 0; lane < cluster_size && store.id[cluster * cluster_size + lane] != no_particle; ++lane) {
      std::array<double, dim> at, force;
      for (int k = 0; k < dim; ++k) {
        at[k] = store.anchor[k][cluster] + double(planes[k * cluster_size + lane]);
        force[k] = mass * mass * double(sums[k * cluster_size + lane]);
      }
      total.add_force(to_earth<dim>(force), to_earth<dim>(at));
    }
  }
  return total;
}

}  // namespace spindrift::sph
