// SPDX-License-Identifier: Apache-2.0
#include "src/io/run_directory.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <ctime>

#include "src/io/atomic_file.hpp"
#include "src/io/checkpoint.hpp"
#include "src/io/collective.hpp"
#include "src/io/machine_failure.hpp"
#include "src/io/summary.hpp"

namespace spindrift::io {

namespace fs = std::filesystem;

namespace {

/// Everything a run writes, or wrote once, and what is drawn of it; --overwrite removes these and leaves a user's own files
/// alone.
constexpr std::string_view files_of_a_run[] = {"scene.toml",  "history.csv",  "summary.json", "log.txt",     "trace.json.gz",
                                               "trace.json",  "report.html",  "checkpoints",  "fields",      "spanwise.csv",
                                               "history.out", "history.outb", "settling",     "picture.png", "film.mp4"};

/// Throws where a folder that exists cannot be read: what it holds is not nothing.
bool holds(const fs::path& folder, std::string_view extension) {
  if (!fs::exists(folder)) return false;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == extension) return true;
  return false;
}

/// Whether something is there besides locks.
bool is_used(const fs::path& path) {
  if (!fs::exists(path)) return false;
  for (const auto& entry : fs::directory_iterator(path))
    if (!entry.path().filename().string().starts_with(RunLock::file_name)) return true;
  return false;
}

/// Rows of the n-th run that came to no checkpoint.
fs::path rows_before(const fs::path& path, int n) {
  return path / (n == 1 ? "history_before_restart.csv" : fmt::format("history_before_restart_{}.csv", n));
}

void remove_run(const fs::path& path, std::string_view but = {}) {
  for (const auto name : files_of_a_run)
    if (name != but) fs::remove_all(path / name);
}

/// One of these is in every folder that a run began to write in.
bool is_of_a_run(const fs::path& path) {
  for (const auto name : {"log.txt", "summary.json", "history.csv", "checkpoints", "settling"})
    if (fs::exists(path / name)) return true;
  return false;
}

/// Before files of a run are removed: that they are, and not the user's own of such names.
void require_a_run(const fs::path& path) {
  if (is_of_a_run(path)) return;
  for (const auto name : files_of_a_run)
    if (fs::exists(path / name))
      throw InputError("run directory " + path.string() + ": its " + std::string(name) +
                       " would be replaced, but no run left it there (there is no log.txt); choose another with --out");
}

/// A folder that --restart finds without a checkpoint: a run that never came that far left nothing worth keeping but its rows.
void begin_anew(const fs::path& path) {
  const fs::path checkpoints = path / "checkpoints";
  if (holds(checkpoints, ".damaged")) throw only_damaged(checkpoints);
  require_a_run(path);
  if (exit_code_in(path / "summary.json") == 0)
    throw InputError("run directory " + path.string() +
                     ": its run came to its end, but the checkpoints are gone; choose another with --out, or say --overwrite to "
                     "begin anew and replace its results");
  int n = 1;
  while (fs::exists(rows_before(path, n))) ++n;
  const fs::path history = path / "history.csv", kept = rows_before(path, n);
  spdlog::warn("--restart: no run in {} came as far as a checkpoint: THIS RUN BEGINS ANEW, at the scene's start{}", path.string(),
               fs::exists(history) ? "; the rows that are there are kept as " + kept.filename().string() : std::string());
  if (fs::exists(history)) fs::rename(history, kept);
  remove_run(path, "settling");  // air that was settling goes on from there
}

/// Before anything is changed.
void refuse_early(const fs::path& path, Existing existing) {
  if (fs::exists(path) && !fs::is_directory(path))
    throw InputError("run directory " + path.string() + ": a file of that name exists; choose another with --out");
  if (existing == Existing::refuse && is_used(path))
    throw InputError("run directory " + path.string() +
                     " is not empty; choose another with --out, or say --restart to go on from its last checkpoint or " +
                     "--overwrite to replace its results");
}

/// With the lock held; whether there is a checkpoint to go on from.
bool prepare(const fs::path& path, Existing existing) {
  refuse_early(path, existing);  // another run may have been here and gone since
  const bool resumes = existing == Existing::resume && holds(path / "checkpoints", ".h5");
  if (existing == Existing::resume && !resumes) begin_anew(path);
  if (existing == Existing::overwrite) {
    require_a_run(path);
    remove_run(path);
    for (int n = 1; fs::remove(rows_before(path, n)); ++n) {}
  }
  // Find out now, not after an hour, that nothing can be written here.
  const fs::path probe = path / ".writable";
  write_atomically(probe, "");
  fs::remove(probe);
  return resumes;
}

}  // namespace

RunDirectory::RunDirectory(MPI_Comm comm, fs::path path, Existing existing) : path_(std::move(path)) {
  on_root(comm, [&] {
    try {
      refuse_early(path_, existing);
      fs::create_directories(path_);
      lock_ = std::make_unique<RunLock>(path_);
      resumes_ = prepare(path_, existing);
    } catch (const fs::filesystem_error& error) {
      throw MachineFailure("run directory " + path_.string() + ": " + error.code().message() +
                           (error.path1().empty() || error.path1() == path_ ? "" : ": " + error.path1().string()));
    }
  });
  resumes_ = from_root(comm, resumes_ ? "resumes" : "") == "resumes";
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

void RunDirectory::forget_settling(MPI_Comm comm) const {
  on_root(comm, [&] {
    std::error_code ignored;
    fs::remove_all(settling(), ignored);
  });
}

void RunDirectory::write_scene(MPI_Comm comm, std::string_view echo) const {
  on_root(comm, [&] { write_atomically(scene(), echo); });
}

}  // namespace spindrift::io
