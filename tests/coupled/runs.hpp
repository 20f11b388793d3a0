// Running a scene of inputs/ inside a test and reading its history back.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "src/run/driver.hpp"
#include "src/scene/columns.hpp"
#include "src/scene/document.hpp"

namespace spindrift::coupling::test {

/// A folder of this process, removed at the end.
class Folder {
 public:
  explicit Folder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("spindrift_" + name + "_" + std::to_string(getpid()))) {
    std::filesystem::remove_all(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string input(const std::string& name) { return std::string(SPINDRIFT_SOURCE_DIR "/inputs/") + name; }

inline io::Summary run_scene(const std::string& file, const std::vector<std::string>& overrides, const std::filesystem::path& out,
                             const run::RunSettings& settings = {.quiet = true}) {
  scene::Document document = scene::load(file, overrides);
  FloatingSystem floating(read_scenario(document));
  const Start start = make_start(floating);
  const runtime::World world{MPI_COMM_WORLD, 0, 1};
  const io::RunDirectory directory(world.comm, out, settings.restart ? io::Existing::resume : io::Existing::refuse);
  runtime::StopRequest stop;
  return run::run(floating, start, directory, world, settings, stop);
}

inline std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Mean of a history column over its last `length` seconds.
inline double mean_of_last(const scene::Columns& history, const std::string& column, double length) {
  const auto time = history["time_s"], value = history[column];
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < time.size(); ++i)
    if (time[i] > time.back() - length) sum += value[i], ++count;
  return sum / double(count);
}

}  // namespace spindrift::coupling::test
