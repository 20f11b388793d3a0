// Sums of the energy that goes into and out of the water, as they are kept, saved and added over ranks. Filled by
// energy_flow.hpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace spindrift::sph {

/// Sums in quanta since the sea was made, of this rank's groups.
struct EnergyFlow {
  std::int64_t onto_water = 0;   ///< work of pairs and of the drive on the water, compression included
  std::int64_t from_solids = 0;  ///< work of walls, bodies, paddle and drive
  std::int64_t absorbed = 0;     ///< by damping zones
  /// By tasks that run together.
  void add_from_task(const EnergyFlow& e) {
    std::atomic_ref(onto_water).fetch_add(e.onto_water, std::memory_order_relaxed);
    std::atomic_ref(from_solids).fetch_add(e.from_solids, std::memory_order_relaxed);
    std::atomic_ref(absorbed).fetch_add(e.absorbed, std::memory_order_relaxed);
  }
};

inline EnergyFlow sum(const EnergyFlow& a, const EnergyFlow& b) {
  return {a.onto_water + b.onto_water, a.from_solids + b.from_solids, a.absorbed + b.absorbed};
}

}  // namespace spindrift::sph
