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
  std::vector<Work> works;             ///< task
  std::vector<Message> messages;       ///< send, receive
  std::vector<std::shared_ptr<Allreduce>> reductions;
  struct Collective {
    std::function<void(MPI_Comm)> work;
    std::function<bool()> active;
    MPI_Comm comm;
    std::uint32_t node;
    bool needed() const { return !active || active(); }
    void make() const { work(comm); }
  };
  std::vector<Collective> collectives;            ///< the same on all ranks
  bool takes_turns = false;                       ///< there are collective calls and several ranks to agree on their order
  std::vector<std::function<bool()>> predicates;  ///< until
  std::vector<Limits> limits;                     ///< loop
  std::vector<std::uint32_t> until_of;            ///< by index of `limits`: the until node or no_node

  std::vector<std::uint64_t> message_bytes;  ///< by node: sent or received so far
  std::vector<std::uint32_t> messages_made;  ///< by node: in so many messages

  std::vector<float> place_of;  ///< by datum
  // For recordings (sizes.hpp): bytes of data, and of the parts that single nodes read, where something was said; nodes that work
  // on all that the rank holds, or in parts.
  std::map<std::uint32_t, std::uint64_t> bytes_of_datum;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint64_t> bytes_of_read;  ///< by node and datum
  std::set<std::uint32_t> on_all, in_parts;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> orders;
  std::uint32_t open = no_node;  ///< loop being recorded

  /// MPI takes what all ranks do on a communicator in one order: that of recording, by a datum that each updates.
  struct InOrder {
    Communicator comm;
    Datum order;
  };
  using OfModules = std::map<std::string, InOrder, std::less<>>;
  OfModules reductions_of, collectives_of;

  Communicator comm;                              ///< messages and control
  Communicator turns;                             ///< announcements of mpi/turns
  std::set<std::tuple<NodeKind, int, int>> tags;  ///< to find two messages that could take each other's place

  std::vector<Edge> edges;  ///< valid if edges_known
  bool edges_known = false;

  // Merging the accesses of one node: last position in `touched` of a datum.
  std::vector<std::uint32_t> seen_at;
};

}  // namespace spindrift::runtime
