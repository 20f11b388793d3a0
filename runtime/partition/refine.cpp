// Greedy refinement. Balance: steepest descent of the sum of squared deviations from the fair share, so it ends; cut: passes of
// positive-gain moves under the balance reached (the greedy part of Fiduccia & Mattheyses, 1982).
// SPDX-License-Identifier: Apache-2.0
#include "runtime/partition/refine.hpp"

#include <algorithm>

namespace spindrift::runtime {

namespace {

class Refinement {
 public:
  Refinement(const WorkGraph& graph, double tolerance, std::vector<int>& rank)
      : graph_(graph),
        limit_(1.0 + tolerance),
        rank_(rank),
        load_(std::size_t(graph.ranks) * graph.constraints, 0.0),
        blocks_on_(graph.ranks) {
    for (int block = 0; block < graph.blocks; ++block) {
      blocks_on_[rank_[block]].push_back(block);
      add(rank_[block], block, 1.0);
    }
  }

  void fill_empty_ranks() {
    if (graph_.blocks < graph_.ranks) return;
    for (int empty = 0; empty < graph_.ranks; ++empty) {
      if (!blocks_on_[empty].empty()) continue;
      int donor = -1;
      for (int r = 0; r < graph_.ranks; ++r)
        if (blocks_on_[r].size() > 1 && (donor < 0 || worst(r) > worst(donor))) donor = r;
      const auto cheaper = [&](int a, int b) { return heaviest(a) < heaviest(b); };
      move(*std::min_element(blocks_on_[donor].begin(), blocks_on_[donor].end(), cheaper), empty);
    }
  }

  void balance() {
    for (int step = 0; step < 4 * graph_.blocks; ++step) {
      int from = 0;
      for (int r = 1; r < graph_.ranks; ++r)
        if (worst(r) > worst(from)) from = r;
      if (worst(from) <= limit_ || !(move_off(from) || swap_off(from))) return;
    }
  }

  void lessen_cut() {
    std::vector<double> limit(graph_.constraints, limit_);  // what balance() could not reach is kept, not worsened
    for (std::size_t n = 0; n < load_.size(); ++n)
      limit[n % graph_.constraints] = std::max(limit[n % graph_.constraints], load_[n]);
    for (int pass = 0, moves = 1; pass < 10 && moves > 0; ++pass) {
      moves = 0;
      for (int block = 0; block < graph_.blocks; ++block) {
        const int to = nearest_rank(block, limit);
        if (to != rank_[block]) move(block, to), ++moves;
      }
    }
  }

 private:
  double& load(int r, int c) { return load_[std::size_t(r) * graph_.constraints + c]; }
  double load(int r, int c) const { return load_[std::size_t(r) * graph_.constraints + c]; }
  double worst(int r) const {
    double most = 0.0;
    for (int c = 0; c < graph_.constraints; ++c) most = std::max(most, load(r, c));
    return most;
  }
  double heaviest(int block) const {
    double most = 0.0;
    for (const double share : graph_.share(block)) most = std::max(most, share);
    return most;
  }
  void add(int r, int block, double sign) {
    for (int c = 0; c < graph_.constraints; ++c) load(r, c) += sign * graph_.share(block)[c];
  }
  void move(int block, int to) {
    auto& old = blocks_on_[rank_[block]];
    old.erase(std::find(old.begin(), old.end(), block));
    add(rank_[block], block, -1.0);
    blocks_on_[to].push_back(block);
    add(to, block, 1.0);
    rank_[block] = to;
  }

  /// Change of the sum of squared loads when `out` goes from one rank to the other and `back` (or -1: nothing) returns.
  double change(int from, int to, int out, int back) const {
    double sum = 0.0;
    for (int c = 0; c < graph_.constraints; ++c) {
      const double delta = graph_.share(out)[c] - (back < 0 ? 0.0 : graph_.share(back)[c]);
      sum += 2.0 * delta * (delta + load(to, c) - load(from, c));
    }
    return sum;
  }

  static constexpr double improvement = -1e-9;  // less is rounding and could go round in circles

  bool move_off(int from) {
    double best = improvement;
    int block = -1, target = -1;
    for (const int candidate : blocks_on_[from]) {
      if (blocks_on_[from].size() == 1 && graph_.blocks >= graph_.ranks) break;
      for (int to = 0; to < graph_.ranks; ++to) {
        const double gain = to == from ? 0.0 : change(from, to, candidate, -1);
        if (gain < best) best = gain, block = candidate, target = to;
      }
    }
    if (block >= 0) move(block, target);
    return block >= 0;
  }

  bool swap_off(int from) {
    double best = improvement;
    int out = -1, back = -1;
    for (const int candidate : blocks_on_[from])
      for (int other = 0; other < graph_.blocks; ++other) {
        const double gain = rank_[other] == from ? 0.0 : change(from, rank_[other], candidate, other);
        if (gain < best) best = gain, out = candidate, back = other;
      }
    if (out < 0) return false;
    const int to = rank_[back];
    move(out, to), move(back, from);
    return true;
  }

  /// The rank that `block` shares most with, among its own and those with room; its own where none is better.
  int nearest_rank(int block, const std::vector<double>& limit) const {
    const int own = rank_[block];
    if (blocks_on_[own].size() == 1) return own;
    const auto tie = [&](int r) {
      double weight = 0.0;
      for (const auto& neighbour : graph_.around(block)) weight += rank_[neighbour.block] == r ? neighbour.weight : 0.0;
      return weight;
    };
    const auto has_room = [&](int r) {
      for (int c = 0; c < graph_.constraints; ++c)
        if (load(r, c) + graph_.share(block)[c] > limit[c]) return false;
      return true;
    };
    int best = own;
    double most = tie(own);
    for (const auto& neighbour : graph_.around(block)) {
      const int r = rank_[neighbour.block];
      if (r == own || r == best) continue;
      const double weight = tie(r);
      if (weight > most * (1.0 + 1e-12) && has_room(r)) most = weight, best = r;
    }
    return best;
  }

  const WorkGraph& graph_;
  double limit_;
  std::vector<int>& rank_;
  std::vector<double> load_;
  std::vector<std::vector<int>> blocks_on_;
};

}  // namespace

void refine(const WorkGraph& graph, double tolerance, std::vector<int>& rank_of_block) {
  Refinement refinement(graph, tolerance, rank_of_block);
  refinement.fill_empty_ranks();
  refinement.balance();
  refinement.lessen_cut();
}

}  // namespace spindrift::runtime
