// The folder of one run: where it is, that nothing in it is lost by accident, and the names of the files in it.
// Made once by `spindrift run` before anything else is written. Contents: docs/user/outputs.md. Tested in
// tests/src/io/run_files_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "src/io/run_lock.hpp"

namespace spindrift::io {

/// What may be done with a folder that is there already.
enum class Existing {
  refuse,     ///< throw InputError unless it is empty
  overwrite,  ///< remove the files of the run in it, and only those
  resume      ///< keep everything where there is a checkpoint to go on from; where no run came that far, begin anew
};

class RunDirectory {
 public:
  /// Collective. Makes the folder and its parents and holds its lock (run_lock.hpp) for the object's life. Throws on all ranks
  /// alike, then with the folder as it was.
  RunDirectory(MPI_Comm comm, std::filesystem::path path, Existing existing);

  /// Whether there is a checkpoint to go on from: with Existing::resume alone, and not where the run begins anew.
  bool resumes() const { return resumes_; }

  /// What the run is made of, as checkpoints keep it to compare a restart with (src/scene/identity.hpp).
  void identify(std::string identity) { identity_ = std::move(identity); }
  const std::string& identity() const { return identity_; }

  /// runs/SCENE_2026-11-21_14-03-59 in the current folder; a number is added where that exists. Collective: rank 0's clock
  /// counts.
  static std::filesystem::path default_path(MPI_Comm comm, const std::filesystem::path& scene);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path scene() const { return path_ / "scene.toml"; }
  std::filesystem::path history() const { return path_ / "history.csv"; }
  std::filesystem::path summary() const { return path_ / "summary.json"; }
  std::filesystem::path log() const { return path_ / "log.txt"; }
  std::filesystem::path trace() const { return path_ / "trace.json.gz"; }
  std::filesystem::path report() const { return path_ / "report.html"; }
  std::filesystem::path checkpoints() const { return path_ / "checkpoints"; }
  std::filesystem::path settling() const { return path_ / "settling"; }  ///< of air that settles before the run
  std::filesystem::path stop() const { return path_ / "stop"; }          ///< made by who wants the run to stop
  std::filesystem::path fields() const { return path_ / "fields"; }

  /// The run has begun: what settled before is in its own checkpoints. Collective.
  void forget_settling(MPI_Comm comm) const;

  /// Rank 0 writes scene.toml: the scene with every default spelled out. Collective.
  void write_scene(MPI_Comm comm, std::string_view echo) const;

 private:
  std::filesystem::path path_;
  std::unique_ptr<RunLock> lock_;  ///< on rank 0
  bool resumes_ = false;
  std::string identity_;
};

}  // namespace spindrift::io
