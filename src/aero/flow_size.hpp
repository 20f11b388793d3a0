// How large the flow on a grid is and what a pseudo-step of it costs, for `spindrift check` and `spindrift study`: as that of a
// resolved rotor, in resolved_rotor_size.cpp. Tested in tests/coupled/program_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/aero/flow_options.hpp"
#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

struct FlowSize {
  long cells = 0;
  double bytes = 0.0;                         ///< of solver and grid
  double bytes_each = 0.0;                    ///< besides on every rank: factors of a coarse level that all have
  double bytes_of_output = 0.0;               ///< more while fields are written
  double bytes_of_checkpoint = 0.0;           ///< more while one is written
  double core_seconds_per_pseudo_step = 0.0;  ///< by the stated rate
};
FlowSize flow_size(const FlowOptions& flow, const MultiBlockGrid& grid);
/// The stated rate of a pseudo-step on a grid in space: core-seconds per cell.
double seconds_per_cell(const FlowOptions& flow);

}  // namespace spindrift::aero
