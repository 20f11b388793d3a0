// The folder of checkpoints: what to keep, and which to trust (declared in checkpoint.hpp).
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "src/io/checkpoint.hpp"
#include "src/io/checksum.hpp"
#include "src/io/collective.hpp"
#include "src/io/hdf5.hpp"
#include "src/io/machine_failure.hpp"

namespace spindrift::io {

namespace fs = std::filesystem;

namespace {

constexpr const char* identity_name = "identity";

/// Names of the folder's checkpoints, oldest first: ticks are written with all their zeros. Throws where a folder that exists
/// cannot be read.
std::vector<std::string> listed(const fs::path& folder) {
  std::vector<std::string> names;
  try {
    if (!fs::exists(folder)) return names;
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".h5" && entry.path().stem().string().starts_with("checkpoint_"))
        names.push_back(entry.path().filename());
  } catch (const fs::filesystem_error& error) {
    throw MachineFailure("cannot list the checkpoints in " + folder.string() + ": " + error.code().message());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Of one file; empty where it has none that is whole, whatever the reason.
std::string identity_in(const fs::path& path) {
  try {
    const hdf5::File file = hdf5::open(path);
    const hdf5::Dataset data(hdf5::checked(H5Dopen2(file.get(), identity_name, H5P_DEFAULT), identity_name));
    const hdf5::Space space(H5Dget_space(data.get()));
    std::vector<std::byte> bytes(std::size_t(H5Sget_simple_extent_npoints(space.get())));
    hdf5::read(data.get(), H5T_NATIVE_UINT8, 0, std::int64_t(bytes.size()), bytes.data(), path.string());
    std::uint64_t stored = 0;
    hdf5::get_attribute(data.get(), "checksum", H5T_NATIVE_UINT64, &stored);
    if (checksum<std::byte>(0, bytes) != stored) return "";
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  } catch (const MachineFailure&) { return ""; }
}

}  // namespace

InputError only_damaged(const fs::path& folder) {
  return InputError("run directory " + folder.parent_path().string() + ": --restart finds damaged checkpoints only in " +
                    folder.string() + "; put a copy of one back, or say --overwrite to begin anew");
}

CheckpointSeries::CheckpointSeries(MPI_Comm comm, fs::path folder, int keep, std::string identity)
    : comm_(comm), folder_(std::move(folder)), keep_(std::max(keep, 1)), identity_(std::move(identity)) {}

fs::path CheckpointSeries::path(std::int64_t tick) const { return folder_ / fmt::format("checkpoint_{:018}.h5", tick); }

void CheckpointSeries::save(std::int64_t tick, const std::function<void(CheckpointWriter&)>& fill) {
  CheckpointWriter writer(comm_, path(tick));
  writer.set("tick", tick);
  if (!identity_.empty()) writer.write<std::byte>(identity_name, std::as_bytes(std::span(identity_)));
  fill(writer);
  writer.commit();
  if (rank_of(comm_) != 0) return;
  try {
    const auto names = listed(folder_);
    std::error_code ignored;
    for (std::size_t i = 0; i + static_cast<std::size_t>(keep_) < names.size(); ++i) fs::remove(folder_ / names[i], ignored);
  } catch (const MachineFailure& failure) { spdlog::warn("old checkpoints stay: {}", failure.what()); }  // no reason to stop
}

std::optional<CheckpointReader> CheckpointSeries::newest(Damaged damaged) {
  std::size_t passed = 0;  // damaged ones that were left
  for (;;) {
    std::string name;
    on_root(comm_, [&] {
      const auto names = listed(folder_);
      if (names.size() > passed) name = names[names.size() - 1 - passed];
    });
    name = from_root(comm_, name);
    if (name.empty()) return std::nullopt;
    try {
      return CheckpointReader(comm_, folder_ / name);
    } catch (const DamagedFile& failure) {
      if (damaged == Damaged::leave) {
        spdlog::warn("{}; trying the checkpoint before", failure.what());
        ++passed;
        continue;
      }
      spdlog::warn("{}; set aside as {}.damaged, trying the checkpoint before", failure.what(), name);
      on_root(comm_, [&] {
        std::error_code error;
        fs::rename(folder_ / name, folder_ / (name + ".damaged"), error);
        if (error) throw MachineFailure("cannot rename " + (folder_ / name).string() + ": " + error.message());
      });
    }
  }
}

std::string CheckpointSeries::newest_identity() const {
  std::string identity;
  on_root(comm_, [&] {
    std::vector<std::string> names = listed(folder_);
    for (; identity.empty() && !names.empty(); names.pop_back()) identity = identity_in(folder_ / names.back());
  });
  return from_root(comm_, identity);
}

}  // namespace spindrift::io
