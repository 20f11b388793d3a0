// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/blocks.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "runtime/trace/rank_trace.hpp"

namespace spindrift::runtime {

namespace {

constexpr int fields_of_tile = 3;  // a place with so many data is a tile; others follow the tile they are made from

}  // namespace

RunRecord without_nodes(const RunRecord& run) {
  RunRecord rest{.graph = run.graph, .window = run.window, .replays = run.replays, .begin_ns = run.begin_ns};
  rest.wall_ns = run.wall_ns, rest.task_ns = run.task_ns, rest.overhead_ns = run.overhead_ns;
  return rest;
}

void require_no_messages(const GraphRecord& graph, const std::string& done) {
  for (const NodeRecord& node : graph.nodes)
    if (node.kind == NodeKind::send || node.kind == NodeKind::receive)
      throw std::invalid_argument("the graph has messages (" + node.label + "): record on one rank what is to be " + done);
}

Blocks::Blocks(const GraphRecord& graph, const RunRecord& run) : graph_(graph), of_(graph.data.size(), no_block) {
  find_modules();
  find_tiles();
  follow_tiles();
  weigh(run);
}

int Blocks::written_by(const NodeRecord& node) const {
  if (node.kind != NodeKind::task) return no_block;
  const auto own =
      std::ranges::find_if(node.uses, [&](const UseRecord& use) { return writes_to(use) && of_[use.datum] != no_block; });
  return own == node.uses.end() ? no_block : of_[own->datum];
}

void Blocks::find_modules() {
  module_of_datum_.assign(graph_.data.size(), -1);
  for (const NodeRecord& node : graph_.nodes) {
    const std::string name(module_of(node.label));
    const auto found = std::ranges::find(modules_, name);
    const int module = int(found - modules_.begin());
    bool placed = false;
    for (const UseRecord& use : node.uses)
      if (graph_.data[use.datum].place >= 0 && module_of_datum_[use.datum] < 0)
        module_of_datum_[use.datum] = module, placed = true;
    if (placed && found == modules_.end()) modules_.push_back(name);
  }
}

void Blocks::find_tiles() {
  std::map<Place, int> fields;
  for (std::size_t d = 0; d < of_.size(); ++d)
    if (module_of_datum_[d] >= 0) ++fields[{module_of_datum_[d], graph_.data[d].place}];
  for (int module = 0; module < int(modules_.size()); ++module) {
    const bool tiles =
        std::ranges::any_of(fields, [&](const auto& f) { return f.first.first == module && f.second >= fields_of_tile; });
    for (const auto& [place, count] : fields)
      if (place.first == module && (!tiles || count >= fields_of_tile)) {
        place_.emplace(place, int(place_.size()));
        module_of_block_.push_back(module);
      }
  }
  for (std::size_t d = 0; d < of_.size(); ++d) {
    const auto block = place_.find({module_of_datum_[d], graph_.data[d].place});
    if (module_of_datum_[d] >= 0 && block != place_.end()) of_[d] = block->second;
  }
}

/// Data that stand at a place of their own (a sum by bundle of tiles): with the first tile that who writes them touches, else
/// with the nearest.
void Blocks::follow_tiles() {
  for (const NodeRecord& node : graph_.nodes) {
    if (node.kind == NodeKind::loop) continue;
    const auto tile = std::ranges::find_if(node.uses, [&](const UseRecord& use) { return of_[use.datum] != no_block; });
    for (const UseRecord& use : node.uses)
      if (writes_to(use) && of_[use.datum] == no_block && module_of_datum_[use.datum] >= 0)
        of_[use.datum] =
            tile != node.uses.end() ? of_[tile->datum] : nearest(module_of_datum_[use.datum], graph_.data[use.datum].place);
  }
}

int Blocks::nearest(int module, float place) const {
  const auto after = place_.upper_bound({module, place});
  return after == place_.begin() ? after->second : std::prev(after)->second;
}

void Blocks::weigh(const RunRecord& run) {
  weighted_.constraints = std::max(1, int(modules_.size()));
  weighted_.cost.assign(std::size_t(count()) * std::size_t(weighted_.constraints), 0.0);
  std::map<std::pair<int, int>, double> passing;
  for (std::uint32_t n = 0; n < graph_.nodes.size(); ++n) {
    const NodeRecord& node = graph_.nodes[n];
    const int block = written_by(node);
    if (block == no_block) continue;
    weighted_.cost[std::size_t(block * weighted_.constraints + module_of_block_[std::size_t(block)])] +=
        std::accumulate(run.ns[n].begin(), run.ns[n].end(), 0.0);
    for (const UseRecord& use : node.uses) {
      const int other = of_[use.datum];
      if (other == no_block || other == block || use.how == Access::write) continue;
      const std::uint64_t bytes = std::max({use.bytes, graph_.data[use.datum].bytes, unknown_bytes});
      passing[std::minmax(block, other)] += double(bytes) * double(run.ns[n].size());
    }
  }
  for (const auto& [pair, weight] : passing) weighted_.edges.push_back({pair.first, pair.second, weight});
}

}  // namespace spindrift::runtime
