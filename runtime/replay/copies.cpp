// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/copies.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/partition/partition.hpp"
#include "runtime/replay/blocks.hpp"
#include "runtime/trace/rank_trace.hpp"

namespace spindrift::runtime {

namespace {

class Copier {
 public:
  Copier(const GraphRecord& graph, const RunRecord& run, int count, double serial)
      : graph_(graph),
        run_(run),
        count_(count),
        serial_(serial),
        blocks_(graph, run),
        first_(graph.data.size()),
        as_(graph.nodes.size(), no_node) {
    half_of_block_.assign(std::size_t(blocks_.count()), 0);
    if (blocks_.count() > 1) half_of_block_ = partition_blocks(blocks_.weighted(), {.ranks = 2}).rank_of_block;
    out_.run = without_nodes(run);
    copy_data();
    for (std::uint32_t n = 0; n < graph.nodes.size(); ++n) {
      if (!across_.empty() && !alike(across_.front(), n)) add_across();
      copy(n);
    }
    add_across();
  }
  RankRun take() { return std::move(out_); }

 private:
  /// A datum with a place stands once in each copy, the copies' places one after the other; what has none is of all.
  void copy_data() {
    std::vector<DatumRecord>& data = out_.graph.data;
    for (std::size_t d = 0; d < graph_.data.size(); ++d) {
      first_[d] = std::uint32_t(data.size());
      const DatumRecord& datum = graph_.data[d];
      for (int k = 0; k < (datum.place < 0 ? 1 : count_); ++k)
        data.push_back({datum.place < 0 ? datum.place : (float(k) + datum.place) / float(count_), datum.bytes});
    }
  }

  std::uint32_t datum(std::uint32_t d, int copy) const {
    return graph_.data[d].place < 0 ? first_[d] : first_[d] + std::uint32_t((copy + count_) % count_);
  }

  /// 0 or 1; -1 of what is in no block.
  int half(std::uint32_t d) const {
    const int block = blocks_.of_datum()[d];
    return block == no_block ? -1 : half_of_block_[std::size_t(block)];
  }

  /// What is written stands all round, no half of the places is without any of it: work on all of the copy, which has no border.
  bool everywhere(const NodeRecord& node) const {
    std::vector<float> places;
    for (const UseRecord& use : node.uses)
      if (writes_to(use) && half(use.datum) >= 0) places.push_back(graph_.data[use.datum].place);
    std::ranges::sort(places);
    float widest = places.front() + 1.0F - places.back();
    for (std::size_t n = 1; n < places.size(); ++n) widest = std::max(widest, places[n] - places[n - 1]);
    return widest < 0.5F;
  }

  void copy(std::uint32_t n) {
    const NodeRecord& node = graph_.nodes[n];
    if (blocks_.written_by(node) == no_block) return of_all(n);
    const bool borders = count_ > 1 && !everywhere(node);
    bool writes[2] = {};
    for (const UseRecord& use : node.uses)
      if (writes_to(use) && half(use.datum) >= 0) writes[half(use.datum)] = true;
    for (int k = 0; k < count_; ++k) {
      add(n, [&](const UseRecord& use) { return datum(use.datum, k); });
      if (borders && !(writes[0] && writes[1])) read_across(node, k, writes[0] ? 0 : 1);
    }
    if (borders && writes[0] && writes[1]) across_.push_back(n);
  }

  bool alike(std::uint32_t a, std::uint32_t b) const {
    const NodeRecord &one = graph_.nodes[a], &other = graph_.nodes[b];
    return one.loop == other.loop && one.kind == other.kind && family_of(one.label) == family_of(other.label);
  }

  /// Tasks over the borders to the next copies, when all of their family are done: those of a colour stay together.
  void add_across() {
    for (const std::uint32_t n : across_)
      for (int k = 0; k < count_; ++k) {
        add(n, [&](const UseRecord& use) { return datum(use.datum, half(use.datum) == 0 ? k + 1 : k); });
        if (graph_.nodes[n].in_parts) times(crossing(graph_.nodes[n]));
      }
    across_.clear();
  }

  /// Of a task in parts, those that cross the border: the other half has the rest of them once already.
  double crossing(const NodeRecord& node) const {
    int parts[2] = {};
    for (const UseRecord& use : node.uses)
      if (writes_to(use) && half(use.datum) >= 0) ++parts[half(use.datum)];
    return double(std::min(parts[0], parts[1])) / double(parts[0] + parts[1]);
  }

  /// The last task added takes so many times as long.
  void times(double factor) {
    for (std::int64_t& ns : out_.run.ns.back()) ns = std::llround(factor * double(ns));
  }

  void add(std::uint32_t n, auto&& as) {
    const NodeRecord& node = graph_.nodes[n];
    NodeRecord& to = out_.graph.nodes.emplace_back(node);
    to.loop = node.loop == no_node ? no_node : as_[node.loop];
    for (UseRecord& use : to.uses) use.datum = as(use);
    out_.run.ns.push_back(run_.ns[n]), out_.run.iterations.push_back(run_.iterations[n]);
    as_[n] = std::uint32_t(out_.graph.nodes.size() - 1);
    out_.run.skip_as(as_[n], run_, n);
  }

  /// The last task added, of copy `k`, writes `own` half: what it reads of the other it reads of the neighbour's on that side.
  void read_across(const NodeRecord& node, int k, int own) {
    for (const UseRecord& use : node.uses)
      if (use.how == Access::read && half(use.datum) == 1 - own)
        out_.graph.nodes.back().uses.push_back({datum(use.datum, own == 0 ? k - 1 : k + 1), Access::read, use.bytes});
  }

  void of_all(std::uint32_t n) {
    add(n, [&](const UseRecord& use) { return first_[use.datum]; });
    NodeRecord& to = out_.graph.nodes.back();
    to.uses.clear();
    for (const UseRecord& use : graph_.nodes[n].uses)
      for (int k = 0; k < (graph_.data[use.datum].place < 0 ? 1 : count_); ++k)
        to.uses.push_back({datum(use.datum, k), use.how, use.bytes});
    if (const double factor = graph_.nodes[n].on_all ? double(count_) : serial_; factor != 1.0) times(factor);
  }

  const GraphRecord& graph_;
  const RunRecord& run_;
  const int count_;
  const double serial_;
  Blocks blocks_;
  std::vector<int> half_of_block_;
  std::vector<std::uint32_t> first_;   ///< by datum: its first copy
  std::vector<std::uint32_t> as_;      ///< by node
  std::vector<std::uint32_t> across_;  ///< tasks of both halves, of the family that is copied
  RankRun out_;
};

}  // namespace

RankRun copies(const GraphRecord& graph, const RunRecord& run, int count, double serial) {
  require_no_messages(graph, "copied");
  return Copier(graph, run, count, serial).take();
}

}  // namespace spindrift::runtime
