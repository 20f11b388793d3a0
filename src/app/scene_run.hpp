// Reading and running one scene, for the commands `run` and `study`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "src/app/commands.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/start.hpp"
#include "src/io/summary.hpp"
#include "src/scene/document.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::app {

/// A scene ready to run: every check has passed, stability of the step among them.
struct ReadyScene {
  std::string echo;  ///< the scene with every default
  std::unique_ptr<coupling::FloatingSystem> floating;
  coupling::Start start;
  scene::Doubts doubts;  ///< what looks like a slip
  std::vector<bodies::Mode> modes;
};
/// `overrider`: whose overrides they are; names of files in them start at its folder.
ReadyScene read_scene(const std::string& path, const std::vector<std::string>& overrides,
                      const scene::Source& overrider = scene::command_line());

struct SceneRun {
  io::Summary summary;
  std::filesystem::path directory;
  bool writes = false;  ///< this rank is the one that writes
};
/// Runs into the run directory and writes everything but the report. Collective.
SceneRun run_scene(const RunArguments& arguments, const runtime::World& world,
                   const scene::Source& overrider = scene::command_line());

}  // namespace spindrift::app
