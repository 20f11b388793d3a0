// What a run is made of: its scene with every default spelled out, and a digest of every file that it names. Checkpoints keep it,
// so that a restart goes on with the same run or says what differs. Made and compared by src/app/run.cpp; what may change:
// docs/user/restart.md. Tested in tests/src/scene/identity_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace spindrift::scene {

/// Notes the files that sections name (Section::path) and the bases that are read while it lives, those in files of files too.
/// A scene is loaded before: its echo has what its own bases say. States that a run starts from (*.h5) stand apart: a restart of
/// that run has no need of them.
class FileRecord {
 public:
  FileRecord();
  ~FileRecord();
  FileRecord(const FileRecord&) = delete;
  FileRecord& operator=(const FileRecord&) = delete;
  const std::vector<std::string>& files() const { return files_; }  ///< absolute, each once, in order
  const std::vector<std::string>& states() const { return states_; }

  /// By the reader.
  static void note(const std::string& path);

 private:
  std::vector<std::string> files_, states_;
};

struct FileDigest {
  std::string path;
  std::int64_t bytes = 0;
  std::uint64_t digest = 0;
};
/// 64-bit FNV-1a of a file's bytes; zeros where it cannot be read.
FileDigest digest_of(const std::string& path);

struct Identity {
  std::string echo;  ///< Document::echo
  std::vector<FileDigest> files;

  std::string text() const;  ///< as checkpoints keep it
  static Identity of(std::string echo, const std::vector<std::string>& files);
  static Identity parsed(const std::string& text);
};

/// Whether `name` is a key or a section of the scene, or one of its files.
bool names_part_of(const Identity& identity, const std::string& name);

/// A key or a file that is not as it was.
struct Difference {
  std::string what;         ///< "wind.speed_m_s", or a file's path
  std::string before, now;  ///< as TOML; sizes and digests of files
};
/// All of them but those of the keys and files `free`, or of keys within these ("output"). A path that changed is none where the
/// file is the same.
std::vector<Difference> differences(const Identity& before, const Identity& now, std::span<const std::string> free);

}  // namespace spindrift::scene
