// The longest chain of work and messages through what happened: no number of threads could have been faster than it.
// Used by efficiency.hpp; tested in tests/runtime/trace/critical_path_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/trace/occurrences.hpp"

namespace spindrift::runtime {

struct LabelTime {
  std::string label;
  double seconds;
};

struct CriticalPath {
  double seconds = 0.0;
  std::vector<LabelTime> by_label;  ///< families of labels (messages: time under way), longest first
};

CriticalPath critical_path(std::span<const RankTrace> traces, const Occurrences& occurrences);

/// Longest chain [ns] that ends with each occurrence, counting only what belongs to the same module and the same replay.
std::vector<std::int64_t> paths_within_modules(std::span<const RankTrace> traces, const Occurrences& occurrences);

}  // namespace spindrift::runtime
