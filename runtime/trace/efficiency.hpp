// How well a run used its cores, in the terms of POP and TALP (docs/developer/efficiency.md has every formula and its source).
// Computed at the end of a run from the times of all threads, and, as far as records were kept, from what happened; printed by
// efficiency_table.hpp and written to summary.json by the program. Tested in tests/runtime/trace/efficiency_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "runtime/trace/critical_path.hpp"
#include "runtime/trace/rank_trace.hpp"

namespace spindrift::runtime {

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();  ///< where no records were kept

/// Core-seconds of one module (first component of the labels), all ranks.
struct ModuleTimes {
  std::string module;
  double busy_s = 0.0;
  std::int64_t calls = 0;      ///< executions of its tasks
  double idle_s = unknown;     ///< idle time that ended when one of its tasks could begin
  double exposed_s = unknown;  ///< idle time while one of its messages was under way
  double alone_s = unknown;    ///< wall time it would take at least if it ran by itself, window by window (recorded part)
};

struct Efficiency {
  int ranks = 0, threads = 0;  ///< threads of all ranks
  double elapsed_s = 0.0;      ///< inside the graph, of the thread that was longest in it
  double recorded = 0.0;  ///< part of elapsed_s that the records cover; what follows from them is taken to hold for the whole

  // parallel = load_balance x communication; communication = serialisation x transfer
  double parallel = 1.0, load_balance = 1.0, communication = 1.0;
  double serialisation = unknown, transfer = unknown;

  // Core-seconds, together threads x elapsed_s but for threads that came later or left earlier.
  double busy_s = 0.0, idle_s = 0.0, poll_s = 0.0, overhead_s = 0.0;
  double wall_s = 0.0;               ///< of all threads together
  double exposed_s = unknown;        ///< of idle_s: a message of the rank was under way
  double partner_wait_s = unknown;   ///< of idle_s: a message was posted here, its other end not yet
  double overlap_gain = unknown;     ///< sum of the modules' alone_s over the time taken together, at least
  double critical_path_s = unknown;  ///< of the recorded part

  std::vector<ModuleTimes> modules;      ///< busiest first
  std::vector<LabelTime> critical_path;  ///< by family of labels, longest first
};

Efficiency efficiency_of(std::span<const RankTrace> traces);

/// For terminal and log, lines of at most 120 characters: a table where records were kept, else one line.
std::string efficiency_table(const Efficiency& efficiency);

}  // namespace spindrift::runtime
