// From an executor to a recording: its graph, and what its records say of one run. Used by runtime/trace/ledger; tested in
// tests/runtime/replay/recording_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "runtime/replay/recording.hpp"

namespace spindrift::runtime {

struct Team;

GraphRecord graph_record(const Team& team);

/// Fills `ns` and `iterations` of runs of this team, of which the first replay of each is given, from the records that the
/// threads kept. Runs that lost a record are taken out of both lists.
void fill_runs(const Team& team, std::vector<std::uint32_t>& first_replay, std::vector<RunRecord>& runs);

}  // namespace spindrift::runtime
