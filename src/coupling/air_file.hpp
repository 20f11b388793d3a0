// The state of the resolved air in a checkpoint: tiles one after the other in the order of the tiling, whatever rank has them,
// and the march. Used by flow_run.cpp and resolved_air.cpp; tested through tests/coupled. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "src/aero/flow/flow_solver.hpp"
#include "src/coupling/saved_array.hpp"

namespace spindrift::coupling {

class AirFile {
 public:
  /// Both are to outlive it. `rank`: among those that have the air.
  AirFile(aero::FlowSolver& solver, const aero::GridStore& store, int rank);
  std::vector<SavedArray> arrays() const;
  /// Throws io::InputError where the file's air has another size.
  void read(const io::CheckpointReader& file) const;

 private:
  aero::FlowSolver& solver_;
  int rank_;
  std::vector<std::int64_t> starts_;  ///< by tile of the tiling
  std::int64_t total_ = 0;
};

}  // namespace spindrift::coupling
