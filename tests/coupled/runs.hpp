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
#include "tests/replica.hpp"

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

/// With particles the start is that of the replica: tests/replica.hpp
inline io::Summary run_scene(const std::string& file, std::vector<std::string> overrides, const std::filesystem::path& out,
                             const run::RunSettings& settings = {.quiet = true}) {
  const testing::Replica replica = testing::replica();
  if (replica.seed > 0 && scene::load(file, overrides).given("sea.particles"))
    overrides.insert(overrides.end(), {"sea.particles.jitter=" + std::to_string(replica.jitter),
                                       "sea.particles.jitter_seed=" + std::to_string(replica.seed)});
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

/// A text that scenes of several tests end with; those in Python read it too.
inline std::string shared_scene(const std::string& name) { return text_of(SPINDRIFT_SOURCE_DIR "/tests/coupled/scenes/" + name); }

/// Of a text; files are those of inputs/.
inline Scenario scenario_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  scene::Document document = scene::parse(text, "test.toml", SPINDRIFT_SOURCE_DIR "/inputs", overrides);
  return read_scenario(document);
}

/// The rotor of case 3 on its platform in still water.
inline const std::string rotor_on_platform = R"(
base = "leble_barakos/platform.toml"
[time]
end_s = 12.0
window_s = 0.1
step_s = 0.05
[sea]
model = "hydrostatic"
[wind]
speed_m_s = 11.0
[rotor]
turbine = "turbines/dtu_10mw.toml"
)";

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
