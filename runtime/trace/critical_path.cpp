// Longest path by dynamic programming in the order of endings: all that an occurrence waited for has ended before it.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/critical_path.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace spindrift::runtime {

namespace {

struct Paths {
  std::vector<std::int64_t> length;     ///< [ns] of the longest chain that ends with the occurrence
  std::vector<std::uint32_t> previous;  ///< the link before it
};

/// `joined(before, after)` says whether a link counts.
template <class Joined>
Paths longest_paths(const Occurrences& occurrences, Joined&& joined) {
  const auto& all = occurrences.all;
  Paths paths{std::vector<std::int64_t>(all.size(), 0), std::vector<std::uint32_t>(all.size(), no_occurrence)};
  std::vector<std::uint32_t> order(all.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return all[a].end < all[b].end; });
  for (const std::uint32_t o : order) {
    const auto extend = [&](std::uint32_t poster) {  // what had to end before `poster` could be posted
      for (const std::uint32_t before : occurrences.before_of(all[poster]))
        if (joined(before, o) && paths.length[before] > paths.length[o])
          paths.length[o] = paths.length[before], paths.previous[o] = before;
    };
    extend(o);
    for (const std::uint32_t partner : occurrences.partners_of(all[o])) extend(partner);
    paths.length[o] += all[o].duration();
  }
  return paths;
}

}  // namespace

CriticalPath critical_path(std::span<const RankTrace> traces, const Occurrences& occurrences) {
  CriticalPath path;
  if (occurrences.all.empty()) return path;
  const Paths paths = longest_paths(occurrences, [](std::uint32_t, std::uint32_t) { return true; });
  const auto last = std::max_element(paths.length.begin(), paths.length.end());
  path.seconds = 1e-9 * double(*last);
  std::map<std::string, std::int64_t> of_label;
  for (auto o = std::uint32_t(last - paths.length.begin()); o != no_occurrence; o = paths.previous[o]) {
    const Occurrence& link = occurrences.all[o];
    if (link.duration() > 0) of_label[family_of(traces[link.trace].nodes[link.node].label)] += link.duration();
  }
  for (const auto& [label, time] : of_label) path.by_label.push_back({label, 1e-9 * double(time)});
  std::ranges::stable_sort(path.by_label, [](const auto& a, const auto& b) { return a.seconds > b.seconds; });
  return path;
}

std::vector<std::int64_t> paths_within_modules(std::span<const RankTrace> traces, const Occurrences& occurrences) {
  const auto module = [&](const Occurrence& o) { return module_of(traces[o.trace].nodes[o.node].label); };
  // The beginning or end of a loop belongs to the replay of whatever asks: the chain through it is cut by its members' replays.
  std::vector<std::uint32_t> replay(occurrences.all.size(), 0);
  for (std::size_t o = 0; o < occurrences.all.size(); ++o) {
    if (occurrences.all[o].record != nullptr)
      replay[o] = occurrences.all[o].record->replay;
    else
      for (const std::uint32_t before : occurrences.before_of(occurrences.all[o]))
        replay[o] = std::max(replay[o], replay[before]);
  }
  return longest_paths(occurrences,
                       [&](std::uint32_t before, std::uint32_t after) {
                         return replay[before] == replay[after] &&
                                module(occurrences.all[before]) == module(occurrences.all[after]);
                       })
      .length;
}

}  // namespace spindrift::runtime
