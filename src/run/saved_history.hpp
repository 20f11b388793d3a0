// What checkpoints store of history.csv, so that a restart knows whether its rows are whole. Called by outputs.cpp; tested in
// tests/coupled/restart_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "src/io/checkpoint.hpp"
#include "src/io/history.hpp"

namespace spindrift::run {

/// Of what rank 0 wrote, after a flush. Collective.
void write(io::CheckpointCopy& copy, const io::History::Extent& extent);
std::optional<io::History::Extent> extent_in(const io::CheckpointReader& file);

}  // namespace spindrift::run
