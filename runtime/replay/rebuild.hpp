// A graph whose tasks do nothing, as it was recorded: what the executor's own program and priorities are made of when a recording
// is simulated. Used by simulate.cpp; tested through tests/runtime/replay/simulate_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/executor/program.hpp"
#include "runtime/replay/recording.hpp"

namespace spindrift::runtime {

/// `ranks` that share its reductions: with one they are tasks.
Graph rebuilt(const GraphRecord& record, int ranks);

/// Costs and iterations of a run into the program, as the executor has them when it sets its priorities.
void measure(Program& program, const RunRecord& run);

}  // namespace spindrift::runtime
