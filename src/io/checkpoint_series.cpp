// The folder of checkpoints: what to keep, and which to trust (declared in checkpoint.hpp).
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "src/io/checkpoint.hpp"
#include "src/io/collective.hpp"
#include "src/io/machine_failure.hpp"

namespace spindrift::io {

namespace fs = std::filesystem;

namespace {

/// Names of the folder's checkpoints, oldest first: ticks are written with all their zeros.
std::vector<std::string> listed(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ".h5" && entry.path().stem().string().starts_with("checkpoint_"))
      names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

CheckpointSeries::CheckpointSeries(MPI_Comm comm, fs::path folder, int keep)
    : comm_(comm), folder_(std::move(folder)), keep_(std::max(keep, 1)) {}

fs::path CheckpointSeries::path(std::int64_t tick) const { return folder_ / fmt::format("checkpoint_{:018}.h5", tick); }

void CheckpointSeries::save(std::int64_t tick, const std::function<void(CheckpointWriter&)>& fill) {
  CheckpointWriter writer(comm_, path(tick));
  writer.set("tick", tick);
  fill(writer);
  writer.commit();
  if (rank_of(comm_) != 0) return;
  const auto names = listed(folder_);
  std::error_code ignored;  // an old file that cannot be removed is no reason to stop
  for (std::size_t i = 0; i + static_cast<std::size_t>(keep_) < names.size(); ++i) fs::remove(folder_ / names[i], ignored);
}

std::optional<CheckpointReader> CheckpointSeries::newest() {
  for (;;) {
    std::string name;
    if (rank_of(comm_) == 0) {
      const auto names = listed(folder_);
      if (!names.empty()) name = names.back();
    }
    name = from_root(comm_, name);
    if (name.empty()) return std::nullopt;
    try {
      return CheckpointReader(comm_, folder_ / name);
    } catch (const MachineFailure& failure) {
      spdlog::warn("{}; set aside as {}.damaged, trying the checkpoint before", failure.what(), name);
      on_root(comm_, [&] {
        std::error_code error;
        fs::rename(folder_ / name, folder_ / (name + ".damaged"), error);
        if (error) throw MachineFailure("cannot rename " + (folder_ / name).string() + ": " + error.message());
      });
    }
  }
}

}  // namespace spindrift::io
