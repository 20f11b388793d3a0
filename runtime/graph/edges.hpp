// Edges from accesses. Within a loop body (or the top level) a node waits for the last writer of what it reads, and a writer for
// all readers since the last write. Walking the body twice gives the edges into the next iteration as well: distance 1 at most,
// because every datum of the body is touched in every iteration.
// Any two nodes that touch a datum, one of them writing, are thereby ordered in every pair of iterations; the executor counts on
// it (executor/program.hpp). Called by Graph::edges; tested in tests/runtime/graph_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "runtime/graph/graph.hpp"

namespace spindrift::runtime {

/// Nodes by the loop they are in, in the order of recording.
class Bodies {
 public:
  explicit Bodies(std::span<const Node> nodes);
  std::span<const std::uint32_t> of(std::uint32_t loop) const;  ///< no_node: top level

 private:
  std::vector<std::uint32_t> first_, members_;
};

/// Grouped by body, otherwise in no order. Throws CycleError where explicit orders contradict the data or each other.
std::vector<Edge> derive_edges(std::span<const Node> nodes, std::span<const Touch> touched, std::size_t data,
                               std::span<const std::pair<std::uint32_t, std::uint32_t>> orders);

}  // namespace spindrift::runtime
