// Sorting particles into groups and clusters. Inside a group each owner's particles are halved along their longest extent until
// 16 are left: compact clusters in bulk, in sheets of wall particles and in splashes alike, and only the last one has empty
// lanes. The result depends on positions and identities alone (ties by identity, 16 sorted by identity), not on the order before
// and not on the ranks. In pieces, so that it runs as tasks: those that say "part" may run at once for different parts.
// Called by tasks.cpp when the drift since the last sort nears its margin; tested in tests/src/sea/sph/ordering_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>

#include "runtime/mpi/exchange.hpp"
#include "src/sea/sph/seeds.hpp"
#include "src/sea/sph/store.hpp"
#include "src/sea/sph/subdomain.hpp"

namespace spindrift::sph {

template <int dim, class Real>
class Sorting {
 public:
  static constexpr int parts = 32;
  Sorting(Store<dim, Real>& store, const Columns<dim>& columns, const Subdomain& subdomain, double anchor_step)
      : store_(store),
        columns_(columns),
        subdomain_(subdomain),
        anchor_step_(anchor_step),
        arrays_(store.deviation_before.empty() ? 2 * dim + 2 : 3 * dim + 3) {}

  void begin();                       ///< gives the planes back: they hold nothing between steps, and their room serves the sort
  void classify(int part);            ///< finds the group of each particle
  void migrate(MPI_Comm comm);        ///< sends away, takes in, lists lost ones; collective
  void halve(int part);               ///< orders the particles of some groups
  void lay_out();                     ///< clusters of groups
  void reorder(int array);            ///< one array of the state, 0 to arrays() - 1
  void make_anchors();                ///< room for them
  void anchor(int part);              ///< anchors of some clusters
  void exchange_halo(MPI_Comm comm);  ///< the structure of the halo, room for the planes; collective
  int arrays() const { return arrays_; }
  void all(MPI_Comm comm);  ///< the whole, one after the other

 private:
  struct Item {
    std::array<double, dim> x;
    std::uint32_t id, slot;
  };
  static void halve(std::span<Item> items);
  std::pair<std::size_t, std::size_t> range(std::size_t count, int part) const {
    return {count * std::size_t(part) / parts, count * std::size_t(part + 1) / parts};
  }
  std::vector<Array<double>*> state();
  std::size_t bin(std::size_t own, int owner) const { return own * std::size_t(store_.owners) + std::size_t(owner); }
  std::size_t clusters_of(std::size_t bin) const { return (first_[bin + 1] - first_[bin] + cluster_size - 1) / cluster_size; }

  Store<dim, Real>& store_;
  const Columns<dim>& columns_;
  const Subdomain& subdomain_;
  double anchor_step_;
  int arrays_;  // of a particle: position, velocity, deviation, those of one step earlier with Verlet's step, identity
  std::vector<std::uint32_t> key_;  // group * owners + owner, of each slot
  std::vector<Item> items_;         // by bin: (own group, owner)
  std::vector<std::size_t> first_;  // of each bin, and the end
  Array<std::uint32_t> source_;     // slot before, of each slot after
};

/// Shows and sees the structure of the halo (clusters, owners, identities, anchors) and makes room for the planes. Collective.
template <int dim, class Real>
void exchange_halo_structure(Store<dim, Real>& store, const Columns<dim>& columns, const Subdomain& subdomain, MPI_Comm comm);

/// Fills an empty store with the seeds in the subdomain's groups; all ranks give the same stream, and keep no others. Collective.
template <int dim, class Real>
void fill(Store<dim, Real>& store, const SeedStream<dim>& seeds, const Columns<dim>& columns, const Subdomain& subdomain,
          MPI_Comm comm, double anchor_step);

/// The same where one rank has all.
template <int dim, class Real>
void fill(Store<dim, Real>& store, const SeedStream<dim>& seeds, const Columns<dim>& columns, double anchor_step) {
  fill(store, seeds, columns, whole_subdomain(columns), MPI_COMM_SELF, anchor_step);
}
template <int dim, class Real>
void sort(Store<dim, Real>& store, const Columns<dim>& columns, double anchor_step) {
  const Subdomain whole = whole_subdomain(columns);
  Sorting<dim, Real>(store, columns, whole, anchor_step).all(MPI_COMM_SELF);
}

}  // namespace spindrift::sph
