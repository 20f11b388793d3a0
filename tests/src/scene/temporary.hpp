// A directory of files that lives as long as a test.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace spindrift::scene {

class Temporary {
 public:
  Temporary() : path_(std::filesystem::temp_directory_path() / ("spindrift_scene_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  Temporary(const Temporary&) = delete;
  ~Temporary() { std::filesystem::remove_all(path_); }

  /// Writes a file and returns its full name.
  std::string file(const std::string& name, std::string_view text) const {
    const std::filesystem::path path = path_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace spindrift::scene
