// What a restart, or a window that is made again, needs of the solver besides its geometry: state and past by tile, the march,
// and what a kept set-up of the preconditioner was made of. Owned by FlowSolver; used by whoever saves the air; tested in
// tests/src/aero/flow/solver_test.cpp and kept_set_up_test.cpp there. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "src/aero/flow/control.hpp"
#include "src/aero/flow/implicit_system.hpp"
#include "src/aero/flow/tile_motion.hpp"

namespace spindrift::aero {

/// Where a set-up of the preconditioner outlives a physical step (PreconditionerOptions::common_steps), what it was made of.
struct SetUpNote {
  std::uint64_t number = 0;                ///< of this solver's set-ups; 0: of another solver
  std::vector<std::vector<double>> tiles;  ///< by owned tile
};

/// By owned tile: state, then past.
using TileStates = std::vector<std::vector<double>>;

/// All of a solver on this rank, in memory.
struct FlowSnapshot {
  TileStates tiles;
  std::vector<double> march;
  SetUpNote set_up;
};

class FlowRestart {
 public:
  /// All are to outlive it.
  FlowRestart(TileArrays& arrays, TileMotion& motion, PhysicalTime& time, March& march, ImplicitSystem& system, int common_steps)
      : arrays_(arrays), motion_(motion), time_(time), march_(march), system_(system), common_steps_(common_steps) {}

  FlowSnapshot snapshot() const;
  void restore(const FlowSnapshot& from);

  TileStates save_tiles() const;
  /// States of a solver on the same tiles that has less past or none: what it lacks is zero.
  void load_tiles(const TileStates& from);
  /// State and past of an owned tile.
  std::size_t size(int owned) const;
  void save(int owned, std::span<double> to) const;
  void load(int owned, std::span<const double> from);
  /// Decisions, time, and rigid poses of a moving grid.
  std::vector<double> save_march() const;
  void load_march(std::span<const double> from);
  bool keeps_set_up() const { return common_steps_ > 1 && system_.preconditioner().has_coarse_level(); }
  std::size_t set_up_size(int owned) const { return system_.preconditioner().kept_size(arrays_.tiles[std::size_t(owned)]); }
  SetUpNote save_set_up() const;
  void load_set_up(const SetUpNote& from);

 private:
  TileArrays& arrays_;
  TileMotion& motion_;
  PhysicalTime& time_;
  March& march_;
  ImplicitSystem& system_;
  int common_steps_;
};

}  // namespace spindrift::aero
