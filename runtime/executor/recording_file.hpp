// Writes a graph with what was measured on it as JSON, one file per rank: enough to replay it on a machine that is not there.
//   {"rank", "ranks", "threads",
//    "nodes": [{"id", "label", "kind", "loop": id or null, "runs", then by kind
//               "mean_ns" | "min", "max", "mean_iterations" | "peer", "tag", "mean_bytes", "mean_ns" (posting to completion)}],
//    "edges": [[from, to, distance in iterations]]}
// Called by the program when asked; tested in tests/runtime/record_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "runtime/executor/executor.hpp"

namespace spindrift::runtime {

/// Throws std::runtime_error with the system's reason if the file cannot be written.
void write_recording(const Executor& executor, const std::string& path);

}  // namespace spindrift::runtime
