// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/predict.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "runtime/replay/copies.hpp"
#include "runtime/replay/recut.hpp"
#include "runtime/trace/rank_trace.hpp"

namespace spindrift::runtime {

namespace {

/// The runs of a rank in a window.
std::vector<const RunRecord*> runs_in(const RankRecording& rank, std::int64_t window) {
  std::vector<const RunRecord*> runs;
  for (const RunRecord& run : rank.runs)
    if (run.window == window) runs.push_back(&run);
  return runs;
}

bool has(const GraphRecord& graph, Side side, const SideOf& side_of) {
  return std::ranges::any_of(graph.nodes, [&](const NodeRecord& node) { return side_of(module_of(node.label)) == side; });
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t n = values.size();
  return n == 0 ? 0.0 : 0.5 * (values[n / 2] + values[(n - 1) / 2]);
}

double task_s(const RunRecord& run) { return 1e-9 * double(run.task_ns); }

/// Sums up what windows come to.
class Windows {
 public:
  Windows(const Recording& recording, const Cluster& cluster, Placement placement, const SideOf& side_of, int most_units)
      : recording_(recording), side_of_(side_of), units_(units_of(cluster)), simulated_(std::min(units_.count, most_units)) {
    out_.placement = placement, out_.cluster = cluster;
    out_.cluster.times = double(units_.count) / simulated_;
    out_.simulated_copies = simulated_ * units_.copies;
  }

  Prediction predict() {
    for (const WindowRecord& window : recording_.windows) {
      const auto runs = runs_in(recording_.ranks[0], window.number);
      if (runs.empty()) continue;  // a record was lost
      double in_graphs = 0.0;
      for (const RunRecord* run : runs) in_graphs += 1e-9 * double(run->wall_ns);
      const Cluster& c = out_.cluster;
      // What was done on all that the rank held, if that was one rank, is shared out like it; the rest is of every rank.
      const double outside = std::max(0.0, 1e-9 * double(window.wall_ns) - in_graphs), of_a_rank = double(c.copies) / c.ranks;
      const double on_all = recording_.ranks.size() > 1 ? 0.0 : std::min(outside, 1e-9 * double(window.on_all_ns));
      out_.outside_s += (outside - on_all) * std::max(1.0, of_a_rank) + on_all * of_a_rank;
      if (recording_.ranks.size() == 1)
        for (const RunRecord* run : runs) out_.work_s += c.copies * task_s(*run);
      ++out_.windows;
      recording_.ranks.size() > 1 ? as_recorded(window.number) : recut_window(runs);
      if (out_.windows > 1 || simulated_ < units_.count) out_.tasks.slices.resize(slices_);
      slices_ = out_.tasks.slices.size();
    }
    if (out_.windows == 0) throw std::invalid_argument("the recording has no window");
    return mean();
  }

 private:
  Simulated simulated(std::span<const RankRun> ranks) const {
    return out_.placement == Placement::bulk_synchronous ? simulate_bulk_synchronous(ranks, out_.cluster)
                                                         : simulate(ranks, out_.cluster);
  }

  /// Recorded on several ranks: these.
  void as_recorded(std::int64_t window) {
    const auto first = runs_in(recording_.ranks[0], window);
    for (std::size_t n = 0; n < first.size(); ++n) {
      std::vector<RankRun> ranks;
      for (const RankRecording& rank : recording_.ranks) {
        const auto runs = runs_in(rank, window);
        if (runs.size() != first.size())
          throw std::invalid_argument(
              "the ranks of the recording ran different graphs; record with coupling.placement = \"shared\"");
        ranks.push_back({rank.graphs[runs[n]->graph], *runs[n]});
      }
      out_.tasks += simulated(ranks);
    }
  }

  void recut_window(const std::vector<const RunRecord*>& runs) {
    // Pieces of both sides in the order in which they ran.
    std::array<std::vector<RankRun>, 2> pieces;
    for (const RunRecord* run : runs) {
      const GraphRecord& graph = recording_.ranks[0].graphs[run->graph];
      const Side either = has(graph, Side::first, side_of_) ? Side::first : Side::second;
      for (const Side side : {Side::first, Side::second})
        if (has(graph, side, side_of_))
          pieces[std::size_t(side)].push_back(part_of(graph, *run, [&](std::string_view module) {
            const Side of = side_of_(module);
            return (of == Side::either ? either : of) == side;
          }));
    }
    const std::size_t most = std::max(pieces[0].size(), pieces[1].size());
    for (std::size_t n = 0; n < most; ++n) {
      const RankRun* const first = n < pieces[0].size() ? &pieces[0][n] : nullptr;
      const RankRun* const second = n < pieces[1].size() ? &pieces[1][n] : nullptr;
      switch (out_.placement) {
        case Placement::in_turns:
        case Placement::bulk_synchronous:
          for (const RankRun* piece : {first, second})
            if (piece) out_.tasks += simulated(numbered(cut(*piece, units_.ranks)));
          break;
        case Placement::shared:
          out_.tasks += simulated(numbered(cut(first && second ? joined(*first, *second)
                                               : first         ? *first
                                                               : *second,
                                               units_.ranks)));
          break;
        case Placement::split: {
          std::vector<RankRun> all;
          const int second_ranks = ranks_of_second(pieces);
          const int first_ranks = units_.ranks - second_ranks;
          for (const auto& [piece, ranks, from, group] :
               {std::tuple{first, first_ranks, 0, 0}, std::tuple{second, second_ranks, first_ranks, 1}})
            if (piece)
              for (RankRun& rank : cut(*piece, ranks, from, int(all.size()))) rank.group = group, all.push_back(std::move(rank));
          out_.tasks += simulated(numbered(std::move(all)));
          break;
        }
      }
    }
  }

  /// In proportion to the work, at least one each.
  int ranks_of_second(const std::array<std::vector<RankRun>, 2>& pieces) {
    if (out_.second_side_ranks > 0) return out_.second_side_ranks;
    std::array<double, 2> work{};
    for (std::size_t side = 0; side < 2; ++side)
      for (const RankRun& piece : pieces[side])
        for (const auto& ns : piece.run.ns)
          for (const std::int64_t one : ns) work[side] += double(one);
    const int ranks = units_.ranks;
    return out_.second_side_ranks =
               std::clamp(int(std::lround(ranks * work[1] / std::max(1.0, work[0] + work[1]))), 1, ranks - 1);
  }

  /// For so many ranks of each unit that is simulated, those from `first` on. `listed`: ranks that stand in the list before.
  std::vector<RankRun> cut(const RankRun& piece, int ranks, int first = 0, int listed = 0) {
    std::optional<RankRun> many;
    if (out_.cluster.copies > 1)
      many = copies(piece.graph, piece.run, out_.simulated_copies, std::max(1.0, double(units_.copies) / ranks));
    const RankRun& whole = many ? *many : piece;
    Recut made = recut(whole.graph, whole.run, simulated_ * ranks, listed, simulated_);
    for (const double imbalance : made.quality.imbalance) out_.imbalance = std::max(out_.imbalance, imbalance);
    for (std::size_t m = 0; m < made.modules.size(); ++m) {
      int& pieces = out_.pieces[made.modules[m]];
      pieces = std::max(pieces, made.blocks_of[m] * units_.count / simulated_);
    }
    double work = 0.0;
    for (const auto& ns : whole.run.ns)
      for (const std::int64_t one : ns) work += 1e-9 * double(one);
    repeated_s_ += made.repeated * work;
    for (int n = 0; n < simulated_ * ranks; ++n) made.ranks[std::size_t(n)].number = n / ranks * units_.ranks + first + n % ranks;
    return std::move(made.ranks);
  }

  /// The units that are simulated become the one whose most loaded rank is the slowest of all and those that follow it.
  std::vector<RankRun> numbered(std::vector<RankRun> ranks) const {
    std::vector<double> load(std::size_t(units_.ranks), 0.0);
    for (const RankRun& rank : ranks)
      if (rank.number < units_.ranks)
        for (const auto& ns : rank.run.ns) load[std::size_t(rank.number)] += std::accumulate(ns.begin(), ns.end(), 0.0);
    int slowest = 0;
    double longest = 0.0;
    for (int r = 0; r < units_.count * units_.ranks; ++r)
      if (const double s = load[std::size_t(r % units_.ranks)] * speed_factor(out_.cluster, r); s > longest)
        longest = s, slowest = r / units_.ranks;
    for (RankRun& rank : ranks) {
      const int unit = rank.number / units_.ranks;
      rank.number += ((slowest + unit) % units_.count - unit) * units_.ranks;
    }
    return ranks;
  }

  Prediction mean() {
    const double n = out_.windows;
    Simulated& tasks = out_.tasks;
    out_.second_side_ranks *= units_.count;
    // Collective calls of several ranks contain the wait for each other: what they did is what is simulated.
    if (recording_.ranks.size() > 1) out_.work_s = tasks.busy_s;
    for (double* sum : {&tasks.busy_s, &tasks.overhead_s, &tasks.waiting_s, &tasks.bytes, &repeated_s_})
      *sum *= out_.cluster.times;
    for (auto& [module, s] : tasks.busy_of) s *= out_.cluster.times;
    for (long* sum : {&tasks.messages, &tasks.tasks}) *sum = std::lround(double(*sum) * out_.cluster.times);
    out_.repeated = out_.work_s > 0.0 ? repeated_s_ / out_.work_s : 0.0;
    for (double* sum : {&out_.outside_s, &out_.work_s, &tasks.wall_s, &tasks.busy_s, &tasks.overhead_s, &tasks.waiting_s,
                        &tasks.critical_path_s, &tasks.bytes})
      *sum /= n;
    for (auto& [module, s] : tasks.busy_of) s /= n;
    for (Link& link : tasks.critical_path) link.s /= n, link.executions = std::lround(double(link.executions) / n);
    for (long* sum : {&tasks.messages, &tasks.reductions, &tasks.tasks}) *sum = std::lround(double(*sum) / n);
    out_.wall_s = tasks.wall_s + out_.outside_s;
    const double cores = double(out_.cluster.ranks) * out_.cluster.threads;
    out_.efficiency = out_.work_s / (cores * out_.wall_s);
    return std::move(out_);
  }

  const Recording& recording_;
  const SideOf& side_of_;
  const Units units_;
  const int simulated_;  ///< units
  std::size_t slices_ = 0;
  double repeated_s_ = 0.0;
  Prediction out_;
};

}  // namespace

std::string_view name_of(Placement placement) {
  switch (placement) {
    case Placement::in_turns:
      return "in turns";
    case Placement::shared:
      return "shared";
    case Placement::split:
      return "split";
    case Placement::bulk_synchronous:
      return "bulk-synchronous";
  }
  return "";
}

Recording typical(const Recording& recording) {
  Recording out = recording;
  if (out.windows.empty()) throw std::invalid_argument("the recording has no window");
  const std::int64_t number = out.windows[0].number;
  std::vector<double> outside, on_all;
  for (const WindowRecord& window : recording.windows) {
    on_all.push_back(double(window.on_all_ns));
    std::int64_t in_graphs = 0;
    for (const RunRecord* run : runs_in(recording.ranks[0], window.number)) in_graphs += run->wall_ns;
    outside.push_back(double(window.wall_ns - in_graphs));
  }
  double wall = median(outside);
  for (RankRecording& rank : out.ranks) {
    std::erase_if(rank.runs, [&](const RunRecord& run) { return run.window != number; });
    for (std::size_t r = 0; r < rank.runs.size(); ++r) {
      RunRecord& run = rank.runs[r];
      std::vector<const RunRecord*> alike;
      for (const WindowRecord& window : recording.windows) {
        const auto runs = runs_in(recording.ranks[std::size_t(rank.rank)], window.number);
        if (r < runs.size() && runs[r]->graph == run.graph && runs[r]->iterations == run.iterations &&
            runs[r]->skipped == run.skipped)
          alike.push_back(runs[r]);
      }
      double task = 0.0;
      for (std::size_t n = 0; n < run.ns.size(); ++n)
        for (std::size_t e = 0; e < run.ns[n].size(); ++e) {
          std::vector<double> took;
          for (const RunRecord* other : alike)
            if (e < other->ns[n].size()) took.push_back(double(other->ns[n][e]));
          run.ns[n][e] = std::llround(median(took));
          if (rank.graphs[run.graph].nodes[n].peer < 0) task += double(run.ns[n][e]);
        }
      run.task_ns = std::llround(task);
      double least = double(run.overhead_ns);  // what others took from the computer between two tasks is in it too
      for (const RunRecord* other : alike) least = std::min(least, double(other->overhead_ns));
      run.overhead_ns = std::llround(least);
      if (rank.rank == 0) wall += double(run.wall_ns = (run.task_ns + run.overhead_ns) / recording.threads);
    }
  }
  out.windows = {{number, std::llround(wall), std::llround(median(on_all))}};
  return out;
}

double task_overhead_s(const Recording& recording) {
  double overhead = 0.0, tasks = 0.0;
  for (const RankRecording& rank : recording.ranks)
    for (const RunRecord& run : rank.runs) {
      overhead += 1e-9 * double(run.overhead_ns);
      for (std::size_t n = 0; n < run.ns.size(); ++n)
        if (rank.graphs[run.graph].nodes[n].peer < 0) tasks += double(run.ns[n].size());
    }
  return tasks > 0.0 ? std::max(0.0, overhead / tasks) : 0.0;
}

std::vector<Placement> possible(const Recording& recording, int ranks, const SideOf& side_of) {
  if (recording.ranks.size() > 1) return {Placement::shared, Placement::bulk_synchronous};
  bool sides[2] = {};
  for (const GraphRecord& graph : recording.ranks[0].graphs)
    for (const Side side : {Side::first, Side::second}) sides[int(side)] = sides[int(side)] || has(graph, side, side_of);
  if (!(sides[0] && sides[1])) return {Placement::shared, Placement::bulk_synchronous};
  if (ranks < 2) return {Placement::in_turns, Placement::shared, Placement::bulk_synchronous};
  return {std::begin(placements), std::end(placements)};
}

Units units_of(const Cluster& cluster) {
  const int count = cluster.copies == 1 ? 1 : std::gcd(std::gcd(cluster.copies, cluster.nodes), cluster.ranks);
  return {count, cluster.copies / count, cluster.ranks / count};
}

Prediction predict(const Recording& recording, const Cluster& cluster, Placement placement, const SideOf& side_of,
                   int most_units) {
  if (recording.ranks.size() > 1 && cluster.copies > 1)
    throw std::invalid_argument("was recorded on " + std::to_string(recording.ranks.size()) +
                                " ranks; copies are made of a recording of one rank");
  if (recording.ranks.size() > 1 && int(recording.ranks.size()) != cluster.ranks)
    throw std::invalid_argument("was recorded on " + std::to_string(recording.ranks.size()) +
                                " ranks and is replayed on these alone, not on " + std::to_string(cluster.ranks) +
                                "; a recording of one rank can be cut for any number");
  return Windows(recording, cluster, placement, side_of, most_units).predict();
}

}  // namespace spindrift::runtime
