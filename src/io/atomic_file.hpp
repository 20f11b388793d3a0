// Files that are whole or absent: written beside their place, forced to disk, then renamed over it.
// Used for summary.json, scene.toml and, by the same steps, checkpoints. Tested in tests/src/io/run_files_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace spindrift::io {

/// Where a file is written before it takes its place: PATH.tmp.
std::filesystem::path temporary_of(const std::filesystem::path& path);

/// Replaces `path` by `content`. On failure throws MachineFailure, leaves the old file as it was and no temporary behind.
void write_atomically(const std::filesystem::path& path, std::string_view content);

/// Forces `temporary` to disk and renames it to `path`, then makes the rename itself durable.
void commit_file(const std::filesystem::path& temporary, const std::filesystem::path& path);

/// Whole file; throws MachineFailure.
std::string read_file(const std::filesystem::path& path);

/// A file descriptor closed by its owner; writes all of a text or throws MachineFailure naming `path`.
class OutputFile {
 public:
  enum class Start {
    empty,  ///< a new file, or an old one emptied
    end     ///< what is there stays
  };
  OutputFile() = default;
  OutputFile(std::filesystem::path path, Start start);
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  ~OutputFile();

  bool is_open() const { return descriptor_ >= 0; }
  const std::filesystem::path& path() const { return path_; }
  void write(std::string_view text);
  /// Elsewhere in the file; several processes may write different places of one file.
  void write_at(long long offset, std::span<const std::byte> bytes);
  void sync();
  /// Cuts the file to `bytes` and goes on writing there.
  void cut(long long bytes);

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace spindrift::io
