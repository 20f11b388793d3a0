// The task graph: recorded once by calling these members in the order of the sequential algorithm, then replayed by an Executor.
// Order between tasks follows from the data they touch; each loop body is a cyclic graph whose iterations overlap through data.
// Used by every tasks.cpp; tested in tests/runtime/graph_test.cpp, read as an algorithm in tests/runtime/algorithms_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/graph/access.hpp"

namespace spindrift::runtime {

/// What a running task may know of its place in the replay.
struct Context {
  std::uint32_t replay;     ///< replays of the whole graph completed before this one
  std::uint32_t iteration;  ///< of the innermost loop, from 0 at each entry; at the top level equal to `replay` of this run
  int thread;
};
using Work = std::function<void(const Context&)>;

/// Iterations of a loop: never fewer than min, never more than max; between them its `until` decides.
struct Limits {
  std::uint32_t min = 1, max = std::numeric_limits<std::uint32_t>::max();
  int urgency = 0;  ///< tasks of a more urgent loop run before others that are ready too (a loop with global reductions first)
};

/// The memory of a message, asked for each time it is posted (it may move and its size may change). For a receive: capacity.
using Buffer = std::function<std::span<std::byte>()>;
template <class T>
Buffer buffer_of(std::span<T> values) {
  return [bytes = std::as_writable_bytes(values)] { return bytes; };
}
struct Message {
  int peer, tag;  ///< rank in the graph's communicator; a tag names one send and one receive between two ranks
  Buffer buffer;
  std::function<void(std::size_t bytes)> received = {};  ///< receive only: told the size that came, before successors run
  std::function<bool()> active = {};                     ///< as Reduction::active, the same answer on both sides
};

/// A reduction over all parts of all ranks, with the same bits for any distribution and order of the parts.
struct Reduction {
  enum class Operation : std::uint8_t { sum, min, max } operation = Operation::sum;
  std::span<const double> partials;  ///< [part][component]
  std::span<double> result;          ///< [component], on every rank
  /// Asked when it could start, the same answer on all ranks: where false nothing is sent and the result stays as it was, since
  /// nobody will read it. The uses must read what the answer depends on. None: always.
  std::function<bool()> active = {};
};

enum class NodeKind : std::uint8_t { task, send, receive, reduce, collective, until, loop };
inline constexpr std::uint32_t no_node = ~0u;

/// One recorded node. `loop` is the index of the loop node round it, no_node at the top level.
struct Node {
  std::string label;  ///< a path; its first component is the module
  NodeKind kind = NodeKind::task;
  std::uint32_t loop = no_node;
  std::uint32_t first_use = 0, last_use = 0;  ///< range in Graph::touched()
  float place = -1;                           ///< where on the thread team, 0 to 1; < 0: where it ran last
  std::string_view module() const { return std::string_view(label).substr(0, label.find('/')); }
};
/// One merged access of a node.
struct Touch {
  std::uint32_t datum;
  Access how;
};
/// `to` waits for `from` of the same iteration (distance 0) or of the one before (distance 1).
struct Edge {
  std::uint32_t from, to;
  std::uint8_t distance;
  bool operator==(const Edge&) const = default;
};

class Graph {
 public:
  /// `comm` carries the graph's messages and reductions; it is duplicated, so ranks must make their graphs in the same order.
  explicit Graph(MPI_Comm comm = MPI_COMM_SELF);
  Graph(Graph&&) noexcept;
  Graph& operator=(Graph&&) noexcept;
  ~Graph();

  /// `place` in [0,1): tasks that write it prefer that part of the thread team; < 0: no preference.
  Datum datum(float place = -1);
  /// n data spread evenly over the team: block i at place i/n.
  std::vector<Datum> data(std::size_t n);

  /// Records a task. Work is `void()` or `void(const Context&)`.
  template <class F>
  std::uint32_t task(std::string label, const Uses& uses, F&& work) {
    return add_work(NodeKind::task, std::move(label), uses, as_work(std::forward<F>(work)));
  }
  /// A blocking library call that all ranks make together: one task on a communicator of its module. On several ranks the calls
  /// of a module run in the order of recording, those of different modules in an order that the ranks agree on (mpi/turns.hpp);
  /// on one rank data order them alone. All ranks record the same calls. `active` as in Reduction: where false it is not made.
  std::uint32_t collective(std::string label, const Uses& uses, std::function<void(MPI_Comm)> work,
                           std::function<bool()> active = {});

  std::uint32_t send(std::string label, const Uses& uses, Message message);
  std::uint32_t receive(std::string label, const Uses& uses, Message message);
  /// The uses must read the partials and write the result. On several ranks the reductions of a module (the first component of
  /// the label) start in the order of recording.
  std::uint32_t reduce(std::string label, const Uses& uses, Reduction reduction);

  /// Records what `body` records as one loop. With min < max the body must call `until` once.
  template <class Body>
  std::uint32_t loop(std::string label, Limits limits, Body&& body) {
    const std::uint32_t node = open_loop(std::move(label), limits);
    body();
    close_loop(node);
    return node;
  }
  /// A loop of exactly n iterations.
  template <class Body>
  std::uint32_t repeat(std::string label, std::uint32_t n, Body&& body) {
    return loop(std::move(label), Limits{n, n}, std::forward<Body>(body));
  }
  /// The predicate of the loop being recorded: asked after each iteration from number `min` on; true ends the loop.
  std::uint32_t until(std::string label, const Uses& uses, std::function<bool()> stop);

  /// Orders two nodes of one body that share no datum (output after output); usually data should say it.
  void order(std::uint32_t before, std::uint32_t after);

  std::span<const Node> nodes() const;
  std::span<const Touch> touched() const;
  /// All edges, derived on the first call; throws CycleError (graph/errors.hpp).
  std::span<const Edge> edges() const;

  struct Recorded;  ///< graph/recorded.hpp, for the executor
  const Recorded& recorded() const { return *recorded_; }
  Recorded& recorded() { return *recorded_; }

 private:
  template <class F>
  static Work as_work(F&& work) {
    if constexpr (std::is_invocable_v<F&, const Context&>)
      return Work(std::forward<F>(work));
    else
      return Work([inner = std::forward<F>(work)](const Context&) mutable { inner(); });
  }
  std::uint32_t add_work(NodeKind kind, std::string label, const Uses& uses, Work work);
  std::uint32_t open_loop(std::string label, Limits limits);
  void close_loop(std::uint32_t node);

  std::unique_ptr<Recorded> recorded_;
};

}  // namespace spindrift::runtime
