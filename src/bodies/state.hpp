// Everything that a step carries to the next one, as plain values: saved and restored bit for bit.
// Used by system.hpp and by checkpoints; tested in tests/src/bodies/system_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/rigid/motion.hpp"

namespace spindrift::bodies {

/// What `work` of a state holds: the work of each source of load, in their order, then these. Kinetic energy is that of the
/// bodies alone, so what added mass takes up is work.
struct EnergyBalance {
  enum AfterSources : std::size_t {
    added_mass,  ///< work of the forces -A a
    joints,      ///< of joints and their drivers: what is left of the change of motion
    throughput,  ///< sum of the sizes of all sources' work
    error,       ///< kinetic energy gained beyond all work: made or lost by the steps themselves
    peak,        ///< largest kinetic energy so far
    count
  };
};

/// State of all bodies at one tick. Copy it to repeat a window; a step is a pure function of it and of the loads.
struct BodiesState {
  std::int64_t tick = 0;
  std::vector<Motion> motions;
  std::vector<double> joint_angles;  ///< [rad] of every joint, full turns included; zero for joints that do not turn
  std::vector<char> independent;     ///< by velocity coordinate (6 per body): 1 where independent (coordinate partitioning)
  std::vector<char> active;          ///< by constraint row: 1 where used, 0 where redundant
  std::vector<double> memory;        ///< of the sources of load that have one, in their order; empty before System::begin
  std::vector<double> work;          ///< [J] since the start, by EnergyBalance; empty before System::begin, then not counted

  /// Doubles that pack() writes; the same for all states of a system.
  std::size_t packed_size() const {
    return 1 + 13 * motions.size() + joint_angles.size() + independent.size() + active.size() + memory.size() + work.size();
  }
  void pack(std::span<double> out) const;
  /// Reads what pack() wrote into a state of the same system (sizes are those of this state).
  void unpack(std::span<const double> in);

  friend bool operator==(const BodiesState&, const BodiesState&) = default;
};

}  // namespace spindrift::bodies
