// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/recorder.hpp"

#include <algorithm>
#include <map>

#include "runtime/executor/worker.hpp"
#include "runtime/graph/edges.hpp"

namespace spindrift::runtime {

namespace {

/// Iterations of each entry of the loops: from the answers of `until`, whose last one of an entry is in its last iteration; of
/// loops of a fixed number of iterations from how often anything in them ran.
void count_iterations(const Team& team, const std::vector<std::vector<const Record*>>& of_node, RunRecord& run) {
  const auto nodes = team.graph.nodes();
  const Graph::Recorded& g = team.graph.recorded();
  const Bodies bodies(nodes);
  for (std::uint32_t n = std::uint32_t(nodes.size()); n-- > 0;) {  // inner loops were recorded after the loops round them
    if (nodes[n].kind != NodeKind::loop) continue;
    auto& entries = run.iterations[n];
    if (const std::uint32_t until = g.until_of[g.payload[n]]; until != no_node) {
      const auto& answers = of_node[until];
      for (std::size_t a = 0; a < answers.size(); ++a)
        if (a + 1 == answers.size() || answers[a + 1]->iteration <= answers[a]->iteration)
          entries.push_back(answers[a]->iteration + 1);
      continue;
    }
    const std::uint32_t member = bodies.of(n).front(), times = g.limits[g.payload[n]].min;
    const auto& inner = run.iterations[member];
    const std::size_t ran = nodes[member].kind == NodeKind::loop ? inner.size() : of_node[member].size();
    entries.assign(ran / times, times);
  }
}

}  // namespace

bool RunRecord::skips(std::uint32_t node, std::size_t execution) const {
  const auto of_node = skipped.find(node);
  return of_node != skipped.end() && std::ranges::binary_search(of_node->second, std::uint32_t(execution));
}

void RunRecord::skip_as(std::uint32_t node, const RunRecord& other, std::uint32_t of_other) {
  if (const auto found = other.skipped.find(of_other); found != other.skipped.end()) skipped[node] = found->second;
}

std::uint64_t GraphRecord::bytes(const Edge& edge) const {
  std::uint64_t sum = 0;
  for (const UseRecord& read : nodes[edge.to].uses) {
    if (read.how == Access::write) continue;
    for (const UseRecord& written : nodes[edge.from].uses)
      if (written.datum == read.datum && written.how != Access::read) {
        sum += read.bytes > 0 ? read.bytes : data[read.datum].bytes;
        break;
      }
  }
  return sum;
}

GraphRecord graph_record(const Team& team) {
  const Graph::Recorded& g = team.graph.recorded();
  GraphRecord out;
  out.data.resize(g.place_of.size());
  for (std::size_t d = 0; d < g.place_of.size(); ++d) out.data[d].place = g.place_of[d];
  for (const auto& [datum, bytes] : g.bytes_of_datum) out.data[datum].bytes = bytes;
  const auto edges = team.graph.edges();
  out.edges.assign(edges.begin(), edges.end());
  for (std::uint32_t n = 0; n < g.nodes.size(); ++n) {
    const Node& node = g.nodes[n];
    NodeRecord& to =
        out.nodes.emplace_back(NodeRecord{.label = node.label, .kind = node.kind, .loop = node.loop, .place = node.place});
    for (std::uint32_t u = node.first_use; u < node.last_use; ++u) {
      const auto part = g.bytes_of_read.find({n, g.touched[u].datum});
      to.uses.push_back({g.touched[u].datum, g.touched[u].how, part == g.bytes_of_read.end() ? 0 : part->second});
    }
    to.on_all = g.on_all.contains(n), to.in_parts = g.in_parts.contains(n);
    const std::uint32_t at = g.payload[n];
    if (node.kind == NodeKind::loop) to.limits = g.limits[at];
    if (node.kind == NodeKind::send || node.kind == NodeKind::receive) to.peer = g.messages[at].peer, to.tag = g.messages[at].tag;
    if (node.kind == NodeKind::reduce) to.bytes = g.reductions[at]->bytes();
    if (const std::uint32_t made = g.messages_made[n]; to.peer >= 0 && made > 0) to.bytes = g.message_bytes[n] / made;
  }
  return out;
}

void fill_runs(const Team& team, std::vector<std::uint32_t>& first_replay, std::vector<RunRecord>& runs) {
  const std::size_t nodes = team.graph.nodes().size();
  std::uint32_t complete = ~0u;  // replays before this one lost nothing
  for (const auto& worker : team.workers)
    if (worker->records.lost() > 0 && !worker->records.records().empty())
      complete = std::min(complete, worker->records.records().back().replay);
  std::vector<RunRecord> kept;
  std::vector<std::uint32_t> kept_first;
  for (std::size_t r = 0; r < runs.size(); ++r)
    if (first_replay[r] + runs[r].replays <= complete) kept.push_back(std::move(runs[r])), kept_first.push_back(first_replay[r]);
  runs = std::move(kept), first_replay = std::move(kept_first);

  std::vector<std::vector<const Record*>> of_node(nodes);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (auto& records : of_node) records.clear();
    for (const auto& worker : team.workers)
      for (const Record& record : worker->records.records())
        if (record.task < nodes && record.replay >= first_replay[r] && record.replay < first_replay[r] + runs[r].replays)
          of_node[record.task].push_back(&record);
    runs[r].ns.resize(nodes), runs[r].iterations.resize(nodes);
    for (std::size_t n = 0; n < nodes; ++n) {
      std::ranges::sort(of_node[n], {}, &Record::begin_ns);
      runs[r].ns[n].reserve(of_node[n].size());
      for (const Record* record : of_node[n]) {
        if (!record->needed) runs[r].skipped[std::uint32_t(n)].push_back(std::uint32_t(runs[r].ns[n].size()));
        runs[r].ns[n].push_back(record->end_ns - record->begin_ns);
      }
    }
    count_iterations(team, of_node, runs[r]);
  }
}

}  // namespace spindrift::runtime
