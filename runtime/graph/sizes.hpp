// What a recording is cut by for more ranks (runtime/replay): how many bytes of a datum another rank would need, and what work
// each rank would have a share of. Said while recording the graph, by whoever knows the arrays; nothing else reads it. Used by
// src/aero/flow and src/sea/sph; tested in tests/runtime/replay/recording_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "runtime/graph/graph.hpp"

namespace spindrift::runtime {

/// The datum travels as a whole: once per writing, however many tasks of a rank read it.
void set_bytes(Graph& graph, Datum datum, std::size_t bytes);
/// Of the datum this node needs a part of its own (the ghosts of one tile): parts of several nodes travel one beside the other.
void set_bytes(Graph& graph, std::uint32_t node, Datum datum, std::size_t bytes);
/// A task or collective call that writes nothing with a place, and yet works on all that its rank holds (a sort): on more ranks
/// each does its share of it.
void set_on_all(Graph& graph, std::uint32_t node);
/// A task whose work is in parts, one for each datum with a place that it writes (pairs of a column with its neighbours). On more
/// ranks the rank of the first does all, the others only the parts of their own.
void set_in_parts(Graph& graph, std::uint32_t node);

}  // namespace spindrift::runtime
