// Writes what happened as a Chrome trace (JSON), to be opened in ui.perfetto.dev or chrome://tracing.
// Format: "Trace Event Format", Google (2016). A process is a rank, a thread a thread, module = category; messages have rows of
// their own below the threads; arrows for messages and for dependencies between modules; counters of busy threads by module and
// bytes under way. Used by the program's --trace; tested in tests/runtime/trace/chrome_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <span>
#include <string>

#include "runtime/trace/rank_trace.hpp"

namespace spindrift::runtime {

struct ChromeOptions {
  int counter_bins = 2000;  ///< points of each counter over the whole trace
};

/// Compressed where the path ends with .gz. Throws std::runtime_error with the system's message where the file cannot be written.
void write_chrome_trace(std::span<const RankTrace> traces, const std::string& path, ChromeOptions options = {});

}  // namespace spindrift::runtime
