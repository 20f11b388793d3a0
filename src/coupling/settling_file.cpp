// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/settling_file.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace spindrift::coupling {

namespace {

/// Longest time on the wall that a kill may cost, where saving takes less than a hundredth of it [s].
constexpr double most_lost_s = 60.0;

}  // namespace

SettlingFile::SettlingFile(const io::RunDirectory& directory, const runtime::World& world, double wall_interval_s)
    : folder_(directory.settling()),
      identity_(directory.identity()),
      world_(world),
      series_(world.comm, folder_, 1, directory.identity()),
      plan_(0.0, 1.0, std::min(wall_interval_s, most_lost_s)) {
  const auto now = io::CheckpointPlan::Clock::now();
  plan_.saved(now, now);
}

std::optional<io::CheckpointReader> SettlingFile::newest() {
  const std::string theirs = series_.newest_identity();
  if (theirs.empty()) return {};
  if (theirs != identity_) {
    if (world_.rank == 0) spdlog::warn("the air in {} settled for another scene: it begins anew", folder_.string());
    return {};
  }
  return series_.newest();
}

void SettlingFile::offer(int steps, const std::vector<SavedArray>& state) {
  if (!plan_.due(world_.comm, 0, 0)) return;
  const auto begin = io::CheckpointPlan::Clock::now();
  series_.save(steps, [&](io::CheckpointWriter& file) {
    for (const SavedArray& array : state) write(file, array);
  });
  saved_ = steps;
  plan_.saved(begin);
}

std::string SettlingFile::save_failed(int steps, const std::vector<SavedArray>& state) {
  io::CheckpointWriter file(world_.comm, folder_ / "failed.h5");
  file.set("tick", std::int64_t(steps));
  for (const SavedArray& array : state) write(file, array);
  file.commit();
  return saved_ > 0 ? fmt::format("; its state is kept as {}, that after {} pseudo-steps as {}", (folder_ / "failed.h5").string(),
                                  saved_, series_.path(saved_).string())
                    : fmt::format("; its state is kept as {}", (folder_ / "failed.h5").string());
}

}  // namespace spindrift::coupling
