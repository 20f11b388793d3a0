// SPDX-License-Identifier: Apache-2.0
#include "src/io/run_directory.hpp"

#include <ctime>

#include "src/io/atomic_file.hpp"
#include "src/io/collective.hpp"
#include "src/io/machine_failure.hpp"

namespace spindrift::io {

namespace fs = std::filesystem;

namespace {

/// Everything a run writes; --overwrite removes these and leaves a user's own files alone.
constexpr std::string_view files_of_a_run[] = {"scene.toml", "history.csv", "summary.json", "log.txt",
                                               "trace.json", "report.html", "checkpoints",  "fields"};

bool holds_a_checkpoint(const fs::path& folder) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ".h5") return true;
  return false;
}

void prepare(const fs::path& path, Existing existing) {
  if (fs::exists(path) && !fs::is_directory(path))
    throw InputError("run directory " + path.string() + ": a file of that name exists; choose another with --out");
  const bool used = fs::exists(path) && !fs::is_empty(path);
  if (existing == Existing::resume && !holds_a_checkpoint(path / "checkpoints"))
    throw InputError("run directory " + path.string() + ": --restart finds no checkpoint in " + (path / "checkpoints").string() +
                     "; give the directory of the interrupted run with --out, or run without --restart");
  if (existing == Existing::refuse && used)
    throw InputError("run directory " + path.string() +
                     " is not empty; choose another with --out, or say --restart to go on from its last checkpoint or " +
                     "--overwrite to replace its results");
  if (existing == Existing::overwrite && used)
    for (const auto name : files_of_a_run) fs::remove_all(path / name);
  fs::create_directories(path);
  // Find out now, not after an hour, that nothing can be written here.
  const fs::path probe = path / ".writable";
  write_atomically(probe, "");
  fs::remove(probe);
}

}  // namespace

RunDirectory::RunDirectory(MPI_Comm comm, fs::path path, Existing existing) : path_(std::move(path)) {
  on_root(comm, [&] {
    try {
      prepare(path_, existing);
    } catch (const fs::filesystem_error& error) {
      throw MachineFailure("run directory " + path_.string() + ": " + error.code().message());
    }
  });
}

fs::path RunDirectory::default_path(MPI_Comm comm, const fs::path& scene) {
  std::string chosen;
  if (rank_of(comm) == 0) {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    char stamp[32];
    std::strftime(stamp, sizeof stamp, "_%Y-%m-%d_%H-%M-%S", &local);
    const std::string name = scene.stem().string() + stamp;
    fs::path path = fs::path("runs") / name;
    std::error_code none;
    for (int again = 2; fs::exists(path, none); ++again) path = fs::path("runs") / (name + "_" + std::to_string(again));
    chosen = path.string();
  }
  return from_root(comm, chosen);
}

void RunDirectory::write_scene(MPI_Comm comm, std::string_view echo) const {
  on_root(comm, [&] { write_atomically(scene(), echo); });
}

}  // namespace spindrift::io
