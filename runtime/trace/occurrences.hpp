// What happened, as one graph over all ranks: every record with the records it waited for, and every message with its other end.
// The recorded graph says which node follows which; here each execution of a node is joined to the executions it followed.
// Used by critical_path.hpp, efficiency.hpp and chrome.hpp; tested in tests/runtime/trace/occurrences_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/trace/rank_trace.hpp"

namespace spindrift::runtime {

inline constexpr std::uint32_t no_occurrence = ~0u;

/// One execution of a node (a task or a message), or the beginning or end of a loop, which takes no time.
struct Occurrence {
  std::uint32_t trace;             ///< index of the rank's trace
  std::uint32_t node;              ///< of that trace
  const Record* record = nullptr;  ///< nothing for the beginning or end of a loop
  std::int64_t begin, end;         ///< [ns]
  std::int64_t ready;              ///< of a message: when the last of its partners had posted too; otherwise `begin`
  std::uint32_t first_before = 0, last_before = 0;    ///< range in Occurrences::before
  std::uint32_t first_partner = 0, last_partner = 0;  ///< range in Occurrences::partners

  bool is_message() const {
    return record != nullptr &&
           (record->activity == Activity::send || record->activity == Activity::receive || record->activity == Activity::reduce);
  }
  /// Time it took by itself: a message is under way from the moment both ends are posted.
  std::int64_t duration() const { return end - (ready < end ? ready : end); }
};

struct Occurrences {
  std::vector<Occurrence> all;          ///< rank by rank, each by time of beginning
  std::vector<std::uint32_t> before;    ///< indices of occurrences that had to end first
  std::vector<std::uint32_t> partners;  ///< of a receive its send, of a reduction its other ranks' ends: they had to be posted

  std::span<const std::uint32_t> before_of(const Occurrence& o) const {
    return std::span(before).subspan(o.first_before, o.last_before - o.first_before);
  }
  std::span<const std::uint32_t> partners_of(const Occurrence& o) const {
    return std::span(partners).subspan(o.first_partner, o.last_partner - o.first_partner);
  }
};

/// Keeps pointers into `traces`. Records that ended after the time up to which all ranks are complete are left out.
Occurrences occurrences_of(std::span<const RankTrace> traces);

/// Time [ns] up to which no rank lost a record.
std::int64_t complete_until(std::span<const RankTrace> traces);

}  // namespace spindrift::runtime
