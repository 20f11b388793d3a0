// The state of the resolved air in a checkpoint: tiles one after the other in the order of the tiling, whatever rank has them,
// and the march. Used by src/run, air_march.cpp and air_settling.cpp; tested through tests/coupled. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/mpi/environment.hpp"
#include "src/aero/flow/flow_solver.hpp"
#include "src/coupling/saved_array.hpp"

namespace spindrift::coupling {

/// Throws io::InputError where the file's air was cut into other tiles: its values would go to other cells.
void require_same_tiles(const io::CheckpointReader& file, const aero::Tiling& tiling);

class AirFile {
 public:
  /// The solver is to outlive it. `world`: of those that have the air; all members are for all of them together.
  AirFile(aero::FlowSolver& solver, const runtime::World& world);
  std::vector<SavedArray> arrays() const;
  /// Throws io::InputError where the file's air has another size or other tiles.
  void read(const io::CheckpointReader& file) const;

 private:
  /// By tile, and their end: where what the preconditioner's set-up was made of begins; its sizes are known to the owners alone.
  std::vector<std::int64_t> set_up_starts() const;

  aero::FlowSolver& solver_;
  runtime::World world_;
  std::vector<std::int64_t> starts_;  ///< by tile of the tiling
  std::int64_t total_ = 0;
};

}  // namespace spindrift::coupling
