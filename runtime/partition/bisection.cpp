// Recursive bisection along a walk through the graph, closed to a circle.
// Why a circle: for two measures on a circle and any fraction f there is an arc that holds the fraction f of both. (Take all arcs
// with the fraction f of the first, one for each start; their share of the second is f on average and changes continuously, so
// one has exactly f: the circle case of Stone & Tukey, Duke Math. J. 9 (1942); for f = 1/2 it is the splitting of a necklace,
// Goldberg & West, SIAM J. Alg. Disc. Meth. 6 (1985).) Blocks make the measures granular: the best arc misses f by about one
// block at an end. The walk is breadth first from a far end (as Cuthill & McKee order a matrix), so that arcs are slices of the
// domain. SPDX-License-Identifier: Apache-2.0
#include "runtime/partition/bisection.hpp"

#include <algorithm>

namespace spindrift::runtime {

namespace {

class Bisection {
 public:
  explicit Bisection(const WorkGraph& graph) : graph_(graph), rank_(graph.blocks, 0), unseen_(graph.blocks, false) {}

  std::vector<int> run() {
    std::vector<int> all(graph_.blocks);
    for (int n = 0; n < graph_.blocks; ++n) all[n] = n;
    divide(std::move(all), 0, graph_.ranks);
    return rank_;
  }

 private:
  /// Gives `blocks` (ascending) to the ranks first ... first + ranks - 1.
  void divide(std::vector<int> blocks, int first, int ranks) {
    if (ranks == 1 || blocks.empty()) {
      for (const int block : blocks) rank_[block] = first;
      return;
    }
    const auto order = walk(blocks);
    const int lower = ranks / 2;
    const auto [begin, length] = best_arc(order, double(lower) / ranks);
    std::vector<int> inside, outside;
    for (int n = 0; n < int(order.size()); ++n) {
      const int from_begin = (n - begin + int(order.size())) % int(order.size());
      (from_begin < length ? inside : outside).push_back(order[n]);
    }
    std::sort(inside.begin(), inside.end());
    std::sort(outside.begin(), outside.end());
    divide(std::move(inside), first, lower);
    divide(std::move(outside), first + lower, ranks - lower);
  }

  /// Breadth-first order of `blocks`, each connected part begun at a far end of it.
  std::vector<int> walk(const std::vector<int>& blocks) {
    const auto mark = [&](const std::vector<int>& some) {
      for (const int block : some) unseen_[block] = true;
    };
    mark(blocks);
    std::vector<int> order;
    for (const int seed : blocks) {
      if (!unseen_[seed]) continue;
      std::vector<int> part = breadth_first(seed);
      mark(part);
      part = breadth_first(part.back());
      order.insert(order.end(), part.begin(), part.end());
    }
    return order;
  }

  /// Unseen blocks reached from `seed`, nearest first; they become seen.
  std::vector<int> breadth_first(int seed) {
    std::vector<int> order{seed};
    unseen_[seed] = false;
    for (std::size_t n = 0; n < order.size(); ++n)
      for (const auto& neighbour : graph_.around(order[n]))
        if (unseen_[neighbour.block]) {
          unseen_[neighbour.block] = false;
          order.push_back(neighbour.block);
        }
    return order;
  }

  struct Arc {
    int begin, length;
  };

  /// Arc of the closed walk whose worst deviation from `fraction` over the constraints is least. The arc that begins at 0 cuts
  /// the walk once, all others twice: they must be better by `second_cut` to be worth it.
  Arc best_arc(const std::vector<int>& order, double fraction) const {
    const int count = int(order.size()), constraints = graph_.constraints;
    std::vector<double> sum(std::size_t(2 * count + 1) * constraints, 0.0);  // running, twice round
    for (int n = 0; n < 2 * count; ++n)
      for (int c = 0; c < constraints; ++c)
        sum[std::size_t(n + 1) * constraints + c] = sum[std::size_t(n) * constraints + c] + graph_.share(order[n % count])[c];
    struct Range {
      double low, high;
    };
    const auto excess = [&](int begin, int length) {  // smallest and largest share of the arc minus `fraction`
      Range range{1.0, -1.0};
      for (int c = 0; c < constraints; ++c) {
        const double whole = sum[std::size_t(count) * constraints + c];
        if (whole <= 0.0) continue;
        const double part =
            (sum[std::size_t(begin + length) * constraints + c] - sum[std::size_t(begin) * constraints + c]) / whole;
        range = {std::min(range.low, part - fraction), std::max(range.high, part - fraction)};
      }
      if (range.low > range.high) range.low = range.high = double(length) / count - fraction;  // nothing costs: count blocks
      return range;
    };
    constexpr double second_cut = 0.005;
    Arc best{0, 0};
    double least = 2.0;
    for (int begin = 0; begin < count; ++begin) {
      int low = 0, high = count;  // both ends of the range grow with length: the optimum is where they balance
      while (low < high) {
        const int middle = (low + high) / 2;
        const Range range = excess(begin, middle);
        if (range.high + range.low >= 0.0)
          high = middle;
        else
          low = middle + 1;
      }
      for (const int length : {low - 1, low}) {
        if (length < 0) continue;
        const Range range = excess(begin, length);
        const double deviation = std::max(range.high, -range.low) + (begin > 0 ? second_cut : 0.0);
        if (deviation < least - 1e-9) least = deviation, best = {begin, length};
      }
    }
    return best;
  }

  const WorkGraph& graph_;
  std::vector<int> rank_;
  std::vector<char> unseen_;
};

}  // namespace

std::vector<int> partition_by_bisection(const WorkGraph& graph) { return Bisection(graph).run(); }

}  // namespace spindrift::runtime
