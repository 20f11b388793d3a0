// The particles of a sea on one rank: who owns which arrays. One entry ("slot") per lane of a cluster; empty lanes carry
// no_particle. The state at the last full step is in double; what pair sweeps read is `pack`, in Real, relative to the anchor of
// the cluster, and holds the state at n or at n + 1/2, so that the predictor needs no second copy of the state. Called by
// ordering.cpp (which alone changes the order), step.hpp, sweep_pairs.hpp and sea_sph.hpp; tested in tests/src/sea/sph.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "src/sea/sph/columns.hpp"
#include "src/sea/sph/layout.hpp"

namespace spindrift::sph {

/// Planes of `pack` per cluster: position relative to the anchor, velocity, density deviation, p/rho^2.
template <int dim>
inline constexpr int pack_planes = 2 * dim + 2;
/// Planes of `sums` per cluster: acceleration, density rate (both per unit mass of a partner until scaled).
template <int dim>
inline constexpr int sum_planes = dim + 1;
/// Places in Store::extra_sums.
inline constexpr std::size_t of_filter = 0, of_shifting = 1, of_strain = 2;

/// A particle that left the domain: counted and located, never dropped silently.
template <int dim>
struct LostParticle {
  std::uint32_t id;
  std::array<double, dim> position, velocity;
};

template <int dim, class Real>
struct Store {
  // per slot
  std::array<Array<double>, dim> x, v;      ///< [m], [m/s], earth frame; in 2-D x and z
  Array<double> deviation;                  ///< rho - rho0 [kg/m3]
  Array<std::uint32_t> id;                  ///< of the halo's particles too
  std::array<Array<double>, dim> v_before;  ///< one step earlier; empty unless the step is Verlet's
  Array<double> deviation_before;
  // per cluster, those of own groups first, then those of the halo; of sums own groups alone
  Array<Real> pack, sums;
  std::array<Array<Real>, 3> extra_sums;    ///< of the density filter, of shifting, of strain; empty without
  Array<Real> carried;                      ///< what a sweep adds to the next row of columns, until it is joined; else zero
  Array<Real> stress;                       ///< tau/rho^2 of the sub-particle model; empty without it
  Array<std::uint16_t> owner;               ///< 0 water, 1 + n the solid n
  std::array<Array<double>, dim> anchor;    ///< multiples of a power of two, so that differences are exact in Real [m]
  std::array<Array<float>, dim> low, high;  ///< bounding box of the packed particles, from the corner of the domain [m]
  // per group
  std::vector<Group> groups;
  std::vector<LostParticle<dim>> lost;  ///< of all ranks
  int owners = 1;                       ///< water and solids of the scene
  std::vector<double> weights;          ///< by owner, of its particles over those of water (laws.hpp); empty: 1
  std::array<int, 3> extra_planes{};    ///< of extra_sums
  int stress_planes = 0;
  std::size_t longest = 0;           ///< clusters of the largest group
  std::array<double, dim> corner{};  ///< lowest corner of the domain, where boxes are measured from [m]

  /// Planes of `carried`: of the sweep that has most.
  int carried_planes() const { return std::max(sum_planes<dim>, *std::max_element(extra_planes.begin(), extra_planes.end())); }
  double weight_of(std::size_t cluster) const { return weights.empty() ? 1.0 : weights[owner[cluster]]; }
  /// Anchor of a cluster from the corner of the domain [m].
  float frame(int axis, std::size_t cluster) const { return float(anchor[axis][cluster] - corner[axis]); }
  std::size_t slots() const { return deviation.size(); }           ///< of own groups
  std::size_t clusters() const { return slots() / cluster_size; }  ///< of own groups
  std::size_t all_clusters() const { return owner.size(); }        ///< of own groups and the halo
  Real* pack_of(std::size_t cluster) { return pack.data() + cluster * pack_planes<dim> * cluster_size; }
  const Real* pack_of(std::size_t cluster) const { return pack.data() + cluster * pack_planes<dim> * cluster_size; }
  Real* sums_of(std::size_t cluster) { return sums.data() + cluster * sum_planes<dim> * cluster_size; }
  const Real* sums_of(std::size_t cluster) const { return sums.data() + cluster * sum_planes<dim> * cluster_size; }

  std::size_t bytes() const {
    std::size_t total = deviation.capacity() * 8 + id.capacity() * 4 +
                        (pack.capacity() + sums.capacity() + carried.capacity() + stress.capacity()) * sizeof(Real) +
                        owner.capacity() * 2 + groups.capacity() * sizeof(Group);
    for (const Array<Real>& array : extra_sums) total += array.capacity() * sizeof(Real);
    total += deviation_before.capacity() * 8;
    for (int k = 0; k < dim; ++k)
      total += (x[k].capacity() + v[k].capacity() + v_before[k].capacity() + anchor[k].capacity()) * 8 +
               (low[k].capacity() + high[k].capacity()) * 4;
    return total;
  }
};

}  // namespace spindrift::sph
