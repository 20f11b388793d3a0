// Sorting particles into groups and clusters. Inside a group each owner's particles are halved along their longest extent until
// 16 are left: compact clusters in bulk, in sheets of wall particles and in splashes alike, and only the last one has empty
// lanes. The result depends on positions and identities alone (ties by identity, 16 sorted by identity), not on the order before
// and not on the ranks. In pieces, so that it runs as tasks: those that say "part" may run at once for different parts.
// Called by tasks.cpp when the drift since the last sort nears its margin; tested in tests/src/sea/sph/ordering_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
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

  void begin();                       ///< empties the bins
  void classify(int part);            ///< finds the bin of each particle, counts it there
  void migrate(MPI_Comm comm);        ///< sends away, takes in, lists lost ones; collective
  void put(int part);                 ///< particles into their bins, in any order
  void lay_out();                     ///< clusters of groups
  void halve(int part);               ///< orders the particles of some bins
  void give_back();                   ///< room that is no longer needed, once all bins are in order
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
  /// A particle that is not of an own group, or of none.
  struct Leaver {
    std::uint32_t slot, group;
    int owner;
  };
  static void halve(std::span<Item> items);
  std::pair<std::size_t, std::size_t> range(std::size_t count, int part) const {
    return {count * std::size_t(part) / parts, count * std::size_t(part + 1) / parts};
  }
  std::vector<Array<double>*> state();
  std::size_t bin(std::size_t own, int owner) const { return own * std::size_t(store_.owners) + std::size_t(owner); }
  std::size_t size_of(std::size_t bin) const { return first_[bin + 1] - first_[bin]; }
  std::size_t clusters_of(std::size_t bin) const { return (size_of(bin) + cluster_size - 1) / cluster_size; }
  /// visit(bin, first slot, end) for slots of one bin that follow each other.
  template <class Visit>
  void for_runs(int part, Visit&& visit) const;

  Store<dim, Real>& store_;
  const Columns<dim>& columns_;
  const Subdomain& subdomain_;
  double anchor_step_;
  int arrays_;  // of a particle: position, velocity, deviation, those of one step earlier with Verlet's step, identity
  std::vector<std::uint32_t> place_;                  // of a group among the own ones
  Array<std::uint32_t> bin_of_;                       // (own group, owner) of each slot
  std::vector<std::size_t> first_;                    // item of each bin, and the end; counts to begin with
  std::vector<std::size_t> next_;                     // item to be written
  std::array<std::vector<Leaver>, parts> leaving_{};  // by part
  std::span<Item> items_;                             // by bin; in the room of Store::pack, which holds nothing between steps
  std::vector<std::size_t> slot_;                     // first one of each bin, after
  Array<std::uint32_t> source_;                       // slot before, of each slot after
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
