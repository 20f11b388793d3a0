// How many bytes of a datum another rank would need: said while recording, by whoever knows the arrays, read by recordings alone
// (runtime/replay). Used by src/aero/flow and src/sea/sph; tested in tests/runtime/replay/recording_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "runtime/graph/graph.hpp"

namespace spindrift::runtime {

/// The datum travels as a whole: once per writing, however many tasks of a rank read it.
void set_bytes(Graph& graph, Datum datum, std::size_t bytes);
/// Of the datum this node needs a part of its own (the ghosts of one tile): parts of several nodes travel one beside the other.
void set_bytes(Graph& graph, std::uint32_t node, Datum datum, std::size_t bytes);

}  // namespace spindrift::runtime
