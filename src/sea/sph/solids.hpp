// Solids made of particles: which particles belong to a body, moving them with it, and the force of the water on it.
// Forces come from pairs with water only: contact of bodies with walls and with each other is in contact.hpp.
// Loads are summed group by group, then over groups in their order: the same bits for any number of threads and ranks.
// Called by sea_sph.cpp and body_tasks.cpp; tested in tests/src/sea/sph/solids_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernels/rigid/motion.hpp"
#include "kernels/rigid/wrench.hpp"
#include "kernels/sph/time_step.hpp"
#include "runtime/mpi/exchange.hpp"
#include "src/sea/sph/parameters.hpp"
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
  Motion motion;        ///< in which its particles were placed last
  double radius = 0.0;  ///< of its farthest particle [m]
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = Eigen::Vector3d::Constant(-1e300);  ///< box of `local`
  Eigen::Quaterniond built = Eigen::Quaterniond::Identity();  ///< attitude in which it was added

  /// Particles across it where it is thinnest: those it has over those it shows along the axis that shows most.
  double layers(double spacing, int dim) const {
    const Eigen::Array3d across = ((high - low).array() + spacing) / spacing;
    double largest_face = 0.0;
    for (int axis = 0; axis < 3; ++axis)
      if (dim == 3 || axis != 1) largest_face = std::max(largest_face, across.prod() / across[axis]);
    return std::max(1.0, double(local.size()) / largest_face);
  }

  /// A bound on how far any particle goes from the motion now to another one [m]: the same on all ranks.
  double travel_to(const Motion& to) const {
    const double half_chord = (motion.attitude.conjugate() * to.attitude).vec().norm();
    return (to.position - motion.position).norm() + 2.0 * half_chord * radius;
  }
};

/// Of a body of this mass [kg], in 2-D per metre of width, over as many particles of water.
inline double relative_weight(const Solid& solid, double mass, const Parameters& p, int dim) {
  return mass / (double(solid.local.size()) * p.mass(dim));
}

/// Largest step of a floating body of this mass [kg], in 2-D per metre of width: half of what is stable for a body pressed from
/// one side, since it is wet all round, and turns.
inline double body_step_limit(const Solid& solid, double mass, const Parameters& p, int dim) {
  return 0.5 * step_limit_body(relative_weight(solid, mass, p, dim), solid.layers(p.spacing, dim), p.spacing, p.eos.c0);
}

/// Reads a body's particles where they are now, on all ranks, under its motion now. Collective.
template <int dim, class Real>
Solid solid_from(const Store<dim, Real>& store, std::uint16_t owner, const Motion& motion, MPI_Comm comm = MPI_COMM_SELF) {
  struct Point {
    std::uint32_t id;
    std::array<double, dim> x;
  };
  runtime::Packer mine;
  for (std::size_t slot = 0; slot < store.slots(); ++slot) {
    if (store.owner[slot / cluster_size] != owner || store.id[slot] == no_particle) continue;
    Point point{store.id[slot], {}};
    for (int k = 0; k < dim; ++k) point.x[k] = store.x[k][slot];
    mine.put_one(point);
  }
  std::vector<Point> points;
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take()))
    for (runtime::Unpacker from(bytes); !from.done();) points.push_back(from.one<Point>());
  if (points.empty()) throw std::invalid_argument("sph: solid " + std::to_string(owner) + " has no particles");
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.id < b.id; });
  if (points.back().id - points.front().id + 1 != points.size())
    throw std::invalid_argument("sph: the particles of solid " + std::to_string(owner) + " must be added in one run");
  Solid solid{.owner = owner, .first_id = points.front().id, .local = {}, .motion = motion, .built = motion.attitude};
  for (const Point& point : points) {
    solid.local.push_back(motion.attitude.conjugate() * (to_earth<dim>(point.x) - motion.position));
    solid.radius = std::max(solid.radius, solid.local.back().norm());
    solid.low = solid.low.cwiseMin(solid.local.back()), solid.high = solid.high.cwiseMax(solid.local.back());
  }
  return solid;
}

/// Calls visit(cluster) for the clusters of an owner in a group.
template <int dim, class Real, class Visit>
void for_clusters_of(const Store<dim, Real>& store, std::uint16_t owner, int group, Visit&& visit) {
  const Group& range = store.groups[std::size_t(group)];
  for (std::size_t cluster = range.solid; cluster < range.end; ++cluster)
    if (store.owner[cluster] == owner) visit(cluster);
}

/// Puts a body's particles in a group where its motion has them, on periodic axes at the image nearest to where they were.
template <int dim, class Real>
void place(Store<dim, Real>& store, const Domain<dim>& domain, const Solid& solid, int group) {
  for_clusters_of(store, solid.owner, group, [&](std::size_t cluster) {
    for (std::size_t slot = cluster * cluster_size; slot < (cluster + 1) * cluster_size && store.id[slot] != no_particle;
         ++slot) {
      const Eigen::Vector3d& local = solid.local[store.id[slot] - solid.first_id];
      auto x = from_earth<dim>(solid.motion.point(local));
      const auto v = from_earth<dim>(solid.motion.point_velocity(local));
      for (int k = 0; k < dim; ++k) {
        if (domain.periodic[k]) {
          const double length = domain.high[k] - domain.low[k];
          x[k] += length * std::round((store.x[k][slot] - x[k]) / length);
        }
        store.x[k][slot] = x[k], store.v[k][slot] = v[k];
      }
    }
  });
}

/// Force of the water on the part of a solid in a group and its moment about a point, from the sums of the last pair sweep; per
/// metre of width in 2-D. mass: of a particle of water [kg].
template <int dim, class Real>
Wrench load(const Store<dim, Real>& store, std::uint16_t owner, double mass, const Eigen::Vector3d& about, int group) {
  Wrench total{.point = about};
  for_clusters_of(store, owner, group, [&](std::size_t cluster) {
    const Real* planes = store.pack_of(cluster);
    const Real* sums = store.sums_of(cluster);
    const double own_mass = mass * store.weight_of(cluster);
    for (int lane = 0; lane < cluster_size && store.id[cluster * cluster_size + lane] != no_particle; ++lane) {
      std::array<double, dim> at, force;
      for (int k = 0; k < dim; ++k) {
        at[k] = store.anchor[k][cluster] + double(planes[k * cluster_size + lane]);
        force[k] = own_mass * mass * double(sums[k * cluster_size + lane]);
      }
      total.add_force(to_earth<dim>(force), to_earth<dim>(at));
    }
  });
  return total;
}

}  // namespace spindrift::sph
