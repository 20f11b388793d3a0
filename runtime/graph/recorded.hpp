// What a Graph holds: nodes, their merged accesses, and what each kind of node needs when it runs. Grows while recording,
// constant while replaying. Used by runtime/graph and runtime/executor. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "runtime/graph/graph.hpp"
#include "runtime/mpi/allreduce.hpp"
#include "runtime/mpi/communicator.hpp"

namespace spindrift::runtime {

struct Graph::Recorded {
  std::vector<Node> nodes;
  std::vector<Touch> touched;
  std::vector<std::uint32_t> payload;  ///< by node: index into the table of its kind below
  std::vector<Work> works;             ///< task, collective
  std::vector<Message> messages;       ///< send, receive
  std::vector<std::unique_ptr<Allreduce>> reductions;
  std::vector<std::function<bool()>> predicates;  ///< until
  std::vector<Limits> limits;                     ///< loop
  std::vector<std::uint32_t> until_of;            ///< by index of `limits`: the until node or no_node

  std::vector<std::uint64_t> message_bytes;  ///< by node: sent or received so far

  std::vector<float> place_of;  ///< by datum
  // For recordings (sizes.hpp): bytes of data, and of the parts that single nodes read; where nothing was said, none.
  std::map<std::uint32_t, std::uint64_t> bytes_of_datum;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint64_t> bytes_of_read;  ///< by node and datum
  std::vector<std::pair<std::uint32_t, std::uint32_t>> orders;
  std::uint32_t open = no_node;  ///< loop being recorded

  /// MPI takes the reductions of a communicator in one order on all ranks: that of recording, by a datum that each updates.
  struct Reductions {
    Communicator comm;
    Datum order;
  };
  std::map<std::string, Reductions, std::less<>> reductions_of;  ///< by module

  Communicator comm;         ///< messages and control
  Communicator collectives;  ///< of all collective tasks, which are in order
  Datum collective_order;
  std::set<std::tuple<NodeKind, int, int>> tags;  ///< to find two messages that could take each other's place

  std::vector<Edge> edges;  ///< valid if edges_known
  bool edges_known = false;

  // Merging the accesses of one node: last position in `touched` at which a datum was seen.
  std::vector<std::uint32_t> seen_at;
};

}  // namespace spindrift::runtime
