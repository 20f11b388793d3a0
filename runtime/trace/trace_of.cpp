// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/trace_of.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>

#include "runtime/executor/executor.hpp"
#include "runtime/executor/worker.hpp"
#include "runtime/graph/recorded.hpp"
#include "runtime/trace/clock.hpp"

namespace spindrift::runtime {

namespace {

/// Bytes of a trace for the journey to rank 0: sizes and values as they lie in memory (all ranks run the same program).
class Parcel {
 public:
  Parcel() = default;
  explicit Parcel(std::vector<char> bytes) : bytes_(std::move(bytes)) {}
  const std::vector<char>& bytes() const { return bytes_; }

  template <class T>
  void put(const T* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* from = reinterpret_cast<const char*>(values);
    bytes_.insert(bytes_.end(), from, from + count * sizeof(T));
  }
  template <class Sequence>
  void put_all(const Sequence& values) {
    const std::size_t count = values.size();
    put(&count, 1);
    put(values.data(), count);
  }
  template <class T>
  void get(T* values, std::size_t count) {
    std::memcpy(values, bytes_.data() + at_, count * sizeof(T));
    at_ += count * sizeof(T);
  }
  template <class Sequence>
  void get_all(Sequence& values) {
    std::size_t count = 0;
    get(&count, 1);
    values.resize(count);
    if (count > 0) get(values.data(), count);
  }

 private:
  std::vector<char> bytes_;
  std::size_t at_ = 0;
};

Parcel packed(const RankTrace& trace) {
  Parcel parcel;
  const std::size_t nodes = trace.nodes.size();
  parcel.put(&trace.rank, 1), parcel.put(&trace.complete_until, 1), parcel.put(&nodes, 1);
  for (const TraceNode& node : trace.nodes) {
    parcel.put_all(node.label);
    parcel.put(&node.kind, 1), parcel.put(&node.loop, 1), parcel.put(&node.peer, 1), parcel.put(&node.tag, 1);
    parcel.put(&node.cost, 1);
  }
  parcel.put_all(trace.edges), parcel.put_all(trace.records), parcel.put_all(trace.threads);
  return parcel;
}

RankTrace unpacked(Parcel parcel) {
  RankTrace trace;
  std::size_t nodes = 0;
  parcel.get(&trace.rank, 1), parcel.get(&trace.complete_until, 1), parcel.get(&nodes, 1);
  trace.nodes.resize(nodes);
  for (TraceNode& node : trace.nodes) {
    parcel.get_all(node.label);
    parcel.get(&node.kind, 1), parcel.get(&node.loop, 1), parcel.get(&node.peer, 1), parcel.get(&node.tag, 1);
    parcel.get(&node.cost, 1);
  }
  parcel.get_all(trace.edges), parcel.get_all(trace.records), parcel.get_all(trace.threads);
  return trace;
}

constexpr int clock_tag = 1, size_tag = 2, bytes_tag = 3;
constexpr std::size_t chunk = std::size_t(1) << 30;  ///< MPI counts are int

/// On rank 0: what to add to the clock of `other` to get the own clock. Cristian, Distributed Computing 3 (1989): the other's
/// reading belongs to the middle of the round trip, best of the shortest one.
std::int64_t clock_difference(int other, MPI_Comm comm) {
  std::int64_t shortest = RankTrace::always, difference = 0;
  for (int trip = 0; trip < 20; ++trip) {
    std::int64_t there = 0;
    const std::int64_t start = Clock::now_ns();
    MPI_Send(nullptr, 0, MPI_BYTE, other, clock_tag, comm);
    MPI_Recv(&there, 1, MPI_INT64_T, other, clock_tag, comm, MPI_STATUS_IGNORE);
    const std::int64_t end = Clock::now_ns();
    if (end - start < shortest) shortest = end - start, difference = start + (end - start) / 2 - there;
  }
  return difference;
}

void answer_clock(MPI_Comm comm) {
  for (int trip = 0; trip < 20; ++trip) {
    MPI_Recv(nullptr, 0, MPI_BYTE, 0, clock_tag, comm, MPI_STATUS_IGNORE);
    const std::int64_t here = Clock::now_ns();
    MPI_Send(&here, 1, MPI_INT64_T, 0, clock_tag, comm);
  }
}

class ModuleSums {
 public:
  void add(std::string_view label, NodeKind kind, TaskCost cost) {
    TaskCost& sum = sums_[{module_of(label), kind}];
    sum.total_ns += cost.total_ns, sum.count += cost.count;
  }
  std::vector<TraceNode> nodes() const {
    std::vector<TraceNode> nodes;
    for (const auto& [of, cost] : sums_) nodes.push_back({.label = std::string(of.first), .kind = of.second, .cost = cost});
    return nodes;
  }

 private:
  std::map<std::pair<std::string_view, NodeKind>, TaskCost> sums_;
};

TaskCost cost_of(const Slot& slot) { return {slot.cost_ns, slot.step}; }

void add_threads(RankTrace& trace, const Team& team) {
  for (const auto& worker : team.workers) {
    trace.threads.push_back(worker->times);
    const auto records = worker->records.records();
    if (worker->records.lost() > 0)
      trace.complete_until = std::min(trace.complete_until, records.empty() ? 0 : records.back().end_ns);
  }
}

void shift(RankTrace& trace, std::int64_t by) {
  for (Record& record : trace.records) record.begin_ns += by, record.end_ns += by;
  if (trace.complete_until != RankTrace::always) trace.complete_until += by;
}

}  // namespace

RankTrace trace_of(const Executor& executor, int rank) { return trace_of(executor.team(), rank); }

RankTrace trace_of(const Team& team, int rank) {
  RankTrace trace;
  trace.rank = rank;
  const Graph& graph = team.graph;
  const auto edges = graph.edges();
  trace.edges.assign(edges.begin(), edges.end());
  const auto& recorded = graph.recorded();
  for (std::uint32_t n = 0; n < graph.nodes().size(); ++n) {
    const Node& node = graph.nodes()[n];
    TraceNode of{node.label, node.kind, node.loop, -1, -1, cost_of(team.program.slots[n])};
    if (node.kind == NodeKind::send || node.kind == NodeKind::receive) {
      const Message& message = recorded.messages[recorded.payload[n]];
      of.peer = message.peer, of.tag = message.tag;
    }
    trace.nodes.push_back(std::move(of));
  }
  for (const auto& worker : team.workers) {
    const auto records = worker->records.records();
    trace.records.insert(trace.records.end(), records.begin(), records.end());
  }
  add_threads(trace, team);
  return trace;
}

RankTrace by_module(const Team& team, int rank) {
  RankTrace out{.rank = rank};
  const auto nodes = team.graph.nodes();
  ModuleSums sums;
  for (std::size_t n = 0; n < nodes.size(); ++n) sums.add(nodes[n].label, nodes[n].kind, cost_of(team.program.slots[n]));
  out.nodes = sums.nodes();
  add_threads(out, team);
  return out;
}

RankTrace by_module(const RankTrace& trace) {
  RankTrace out{.rank = trace.rank, .threads = trace.threads, .complete_until = trace.complete_until};
  ModuleSums sums;
  for (const TraceNode& node : trace.nodes) sums.add(node.label, node.kind, node.cost);
  out.nodes = sums.nodes();
  return out;
}

std::vector<RankTrace> gather_traces(RankTrace mine, MPI_Comm comm) {
  RankTrace own = mine.records.empty() ? by_module(mine) : std::move(mine);
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  std::vector<RankTrace> all;
  if (rank > 0) {
    answer_clock(comm);
    const Parcel parcel = packed(own);
    const std::uint64_t bytes = parcel.bytes().size();
    MPI_Send(&bytes, 1, MPI_UINT64_T, 0, size_tag, comm);
    for (std::size_t at = 0; at < bytes; at += chunk)
      MPI_Send(parcel.bytes().data() + at, int(std::min(chunk, bytes - at)), MPI_BYTE, 0, bytes_tag, comm);
    return all;
  }
  all.push_back(std::move(own));
  for (int other = 1; other < size; ++other) {
    const std::int64_t difference = clock_difference(other, comm);
    std::uint64_t bytes = 0;
    MPI_Recv(&bytes, 1, MPI_UINT64_T, other, size_tag, comm, MPI_STATUS_IGNORE);
    std::vector<char> buffer(bytes);
    for (std::size_t at = 0; at < bytes; at += chunk)
      MPI_Recv(buffer.data() + at, int(std::min(chunk, bytes - at)), MPI_BYTE, other, bytes_tag, comm, MPI_STATUS_IGNORE);
    all.push_back(unpacked(Parcel(std::move(buffer))));
    shift(all.back(), difference);
  }
  return all;
}

}  // namespace spindrift::runtime
