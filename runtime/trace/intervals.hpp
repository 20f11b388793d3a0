// Sets of time as sorted disjoint intervals: union and overlap. Used by efficiency.cpp; tested in tests/runtime/trace.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace spindrift::runtime {

struct Interval {
  std::int64_t begin, end;
};

/// The same set of time, sorted, without overlaps and empty intervals.
inline std::vector<Interval> united(std::vector<Interval> intervals) {
  std::erase_if(intervals, [](const Interval& i) { return i.end <= i.begin; });
  std::sort(intervals.begin(), intervals.end(), [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
  std::vector<Interval> out;
  for (const Interval& next : intervals) {
    if (!out.empty() && next.begin <= out.back().end)
      out.back().end = std::max(out.back().end, next.end);
    else
      out.push_back(next);
  }
  return out;
}

/// Length of `one` that lies inside a united set.
inline std::int64_t overlap(Interval one, const std::vector<Interval>& set) {
  auto next = std::partition_point(set.begin(), set.end(), [&](const Interval& i) { return i.end <= one.begin; });
  std::int64_t inside = 0;
  for (; next != set.end() && next->begin < one.end; ++next)
    inside += std::min(one.end, next->end) - std::max(one.begin, next->begin);
  return inside;
}

}  // namespace spindrift::runtime
