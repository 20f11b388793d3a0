// The state of some groups outside the store: a window's snapshot, a checkpoint, groups sent to another rank. It holds
// the order of the particles too, so that what follows has the same bits. Plain arrays, to be written as they are. Called by
// sea_sph.cpp; tested in tests/src/sea/sph/tasks_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/mpi/exchange.hpp"
#include "src/sea/sph/state.hpp"

namespace spindrift::sph {

template <int dim>
struct Saved {
  static constexpr int numbers = 17;
  std::array<double, numbers> plan{};   ///< time, drifts, counters (plan_numbers); the same on all ranks
  EnergyFlow energy;                    ///< of the rank
  std::vector<double> motions;          ///< 13 per body: position, attitude (x, y, z, w), velocity, omega
  std::vector<std::int32_t> groups;     ///< 3 per group: index, clusters of water, clusters of solids
  std::vector<std::uint16_t> owner;     ///< per cluster
  std::vector<double> anchor;           ///< dim per cluster
  std::vector<std::uint32_t> id;        ///< per slot, 16 per cluster
  std::vector<double> values;           ///< per group, plane by plane: positions, velocities, deviation [, those one step before]
  std::vector<LostParticle<dim>> lost;  ///< of all ranks

  std::size_t bytes() const {
    return sizeof plan + sizeof energy + motions.size() * 8 + groups.size() * 4 + owner.size() * 2 +
           (anchor.size() + values.size()) * 8 + id.size() * 4 + lost.size() * sizeof(LostParticle<dim>);
  }
  void put(runtime::Packer& packer) const;
  static Saved take(runtime::Unpacker& from);
};

/// The named groups of a store, which must be own ones.
template <int dim, class Real>
Saved<dim> save_groups(const SeaState<dim, Real>& sea, std::span<const int> groups);

/// Makes the store hold the own groups of the subdomain, found in the pieces; then exchange_halo_structure must follow. Throws
/// std::invalid_argument where a group is missing or given twice.
template <int dim, class Real>
void restore_groups(SeaState<dim, Real>& sea, std::span<const Saved<dim>> pieces);

}  // namespace spindrift::sph
