// The folder of one run: where it is, that nothing in it is lost by accident, and the names of the files in it.
// Made once by `spindrift run` before anything else is written. Contents: docs/user/outputs.md. Tested in
// tests/src/io/run_files_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace spindrift::io {

/// What may be done with a folder that is there already.
enum class Existing {
  refuse,     ///< throw InputError unless it is empty
  overwrite,  ///< remove the files of the run in it, and only those
  resume      ///< keep everything; throw InputError where there is no checkpoint to go on from
};

class RunDirectory {
 public:
  /// Collective. Makes the folder and its parents. Throws on all ranks alike.
  RunDirectory(MPI_Comm comm, std::filesystem::path path, Existing existing);

  /// runs/SCENE_2026-11-21_14-03-59 in the current folder; a number is added where that exists. Collective: rank 0's clock
  /// counts.
  static std::filesystem::path default_path(MPI_Comm comm, const std::filesystem::path& scene);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path scene() const { return path_ / "scene.toml"; }
  std::filesystem::path history() const { return path_ / "history.csv"; }
  std::filesystem::path summary() const { return path_ / "summary.json"; }
  std::filesystem::path log() const { return path_ / "log.txt"; }
  std::filesystem::path trace() const { return path_ / "trace.json"; }
  std::filesystem::path report() const { return path_ / "report.html"; }
  std::filesystem::path checkpoints() const { return path_ / "checkpoints"; }
  std::filesystem::path fields() const { return path_ / "fields"; }

  /// Rank 0 writes scene.toml: the scene with every default spelled out. Collective.
  void write_scene(MPI_Comm comm, std::string_view echo) const;

 private:
  std::filesystem::path path_;
};

}  // namespace spindrift::io
