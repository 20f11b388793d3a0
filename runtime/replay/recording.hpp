// A recorded run as plain data: the graphs of every rank with accesses, edges and bytes, and what each execution of each node
// took in the windows that were recorded. Made by recorder.hpp, written and read by recording_file.hpp
// (docs/developer/recording.md has the format), replayed by simulate.hpp. Tested in tests/runtime/replay.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "runtime/graph/graph.hpp"

namespace spindrift::runtime {

struct UseRecord {
  std::uint32_t datum;
  Access how;
  std::uint64_t bytes = 0;  ///< that this node alone reads of it; 0: nothing was said
};

struct NodeRecord {
  std::string label;
  NodeKind kind = NodeKind::task;
  std::uint32_t loop = no_node;  ///< loop round it
  float place = -1;
  Limits limits = {};       ///< of a loop
  int peer = -1, tag = -1;  ///< of a send or receive
  std::uint64_t bytes = 0;  ///< of a message or reduction, on average
  bool on_all = false;      ///< works on all that its rank holds (graph/sizes.hpp)
  bool in_parts = false;    ///< works in parts, one for each block that it writes
  std::vector<UseRecord> uses;
};

struct DatumRecord {
  float place = -1;
  std::uint64_t bytes = 0;  ///< that travel where another rank reads it; 0: nothing was said
};

struct GraphRecord {
  std::vector<NodeRecord> nodes;
  std::vector<DatumRecord> data;
  std::vector<Edge> edges;
  /// What the later node of an edge reads of the data that the earlier one writes; 0 where it waits for another reason.
  std::uint64_t bytes(const Edge& edge) const;
};

/// One run of an executor.
struct RunRecord {
  std::uint32_t graph = 0;  ///< of the rank's
  std::int64_t window = 0;
  std::uint32_t replays = 1;  ///< of the graph, overlapping
  std::int64_t begin_ns = 0, wall_ns = 0;
  std::int64_t task_ns = 0, idle_ns = 0, poll_ns = 0, overhead_ns = 0;  ///< of all threads together
  std::vector<std::vector<std::int64_t>> ns;           ///< [node][execution]; of messages: from posting to completion
  std::vector<std::vector<std::uint32_t>> iterations;  ///< [node][entry] of loops
  /// By node, where there are any: executions, rising, in which a reduction, message or collective call was not needed (its
  /// `active` said no), so that nothing was sent.
  std::map<std::uint32_t, std::vector<std::uint32_t>> skipped = {};
  bool skips(std::uint32_t node, std::size_t execution) const;
  /// The node skips what one of another run does.
  void skip_as(std::uint32_t node, const RunRecord& other, std::uint32_t of_other);
};

struct RankRecording {
  int rank = 0;
  std::vector<GraphRecord> graphs;
  std::vector<RunRecord> runs;  ///< in the order of time
};

struct WindowRecord {
  std::int64_t number = 0;     ///< from 1 at the start of the scene
  std::int64_t wall_ns = 0;    ///< of rank 0, with what it does between the runs of its executors; without output
  std::int64_t on_all_ns = 0;  ///< of that, between runs, on all that the rank holds (Ledger::on_all)
};

struct Recording {
  std::string scene, program;  ///< file of the scene; version of the program
  int threads = 1;             ///< of each rank
  std::vector<WindowRecord> windows;
  std::vector<RankRecording> ranks;
};

}  // namespace spindrift::runtime
