// SPDX-License-Identifier: Apache-2.0
#include "src/run/saved_history.hpp"

#include <array>

namespace spindrift::run {

namespace {
constexpr const char* extent_name = "history/rows";
}

void write(io::CheckpointCopy& copy, const io::History::Extent& extent) {
  const std::array<std::int64_t, 3> values{extent.bytes, extent.rows, extent.digest};
  copy.write<std::int64_t>(extent_name, values);
}

std::optional<io::History::Extent> extent_in(const io::CheckpointReader& file) {
  if (!file.has(extent_name)) return std::nullopt;
  const std::vector<std::int64_t> values = file.read<std::int64_t>(extent_name);
  return io::History::Extent{values.at(0), values.at(1), values.at(2)};
}

}  // namespace spindrift::run
