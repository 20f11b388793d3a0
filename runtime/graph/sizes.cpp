// SPDX-License-Identifier: Apache-2.0
#include "runtime/graph/sizes.hpp"

#include "runtime/graph/recorded.hpp"

namespace spindrift::runtime {

void set_bytes(Graph& graph, Datum datum, std::size_t bytes) { graph.recorded().bytes_of_datum[datum.index] = bytes; }

void set_bytes(Graph& graph, std::uint32_t node, Datum datum, std::size_t bytes) {
  graph.recorded().bytes_of_read[{node, datum.index}] += bytes;
}

void set_on_all(Graph& graph, std::uint32_t node) { graph.recorded().on_all.insert(node); }

void set_in_parts(Graph& graph, std::uint32_t node) { graph.recorded().in_parts.insert(node); }

}  // namespace spindrift::runtime
