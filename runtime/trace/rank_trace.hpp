// One rank's records together with what is needed to read them: labels, edges, messages' partners, times of threads.
// Plain data, so that a trace can be sent to another rank, or written by hand in a test. Made by trace_of.hpp; read by
// occurrences.hpp, efficiency.hpp and chrome.hpp. Tested in tests/runtime/trace. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/graph/graph.hpp"
#include "runtime/trace/record.hpp"

namespace spindrift::runtime {

struct TraceNode {
  std::string label;
  NodeKind kind = NodeKind::task;
  std::uint32_t loop = no_node;  ///< loop round it, no_node at the top level
  int peer = -1, tag = -1;       ///< of a send or receive
  TaskCost cost = {};            ///< of the whole run, recorded or not
};

struct RankTrace {
  static constexpr std::int64_t always = std::numeric_limits<std::int64_t>::max();

  int rank = 0;
  std::vector<TraceNode> nodes;
  std::vector<Edge> edges;
  std::vector<Record> records;           ///< of all threads, in any order
  std::vector<ThreadTimes> threads;      ///< of the whole run, recorded or not
  std::int64_t complete_until = always;  ///< [ns] no thread's record that ended before was lost
};

/// First component of a label: `aero` of `aero/residual/12`.
inline std::string_view module_of(std::string_view label) { return label.substr(0, label.find('/')); }
/// A label without the numbers that tell one block from the next: `aero/residual` of `aero/residual/12`, `sea/force` of
/// `sea/force/3-7`.
std::string family_of(std::string_view label);

}  // namespace spindrift::runtime
