// SPDX-License-Identifier: Apache-2.0
#include "src/app/scene_file.hpp"

#include <filesystem>

namespace spindrift::app {

namespace {
[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw scene::SceneError({scene::Problem{path, 0, "", "", why}});
}
}  // namespace

scene::Document load_scene(const std::string& path, const std::vector<std::string>& overrides, const scene::Source& overrider) {
  namespace fs = std::filesystem;
  if (fs::is_directory(path) && fs::exists(fs::path(path) / "scene.toml"))
    refuse(path, "is the folder of a run; the scene that ran is in it: " + (fs::path(path) / "scene.toml").string());
  if (!fs::exists(path) && fs::exists(path + ".toml")) refuse(path, "no such file; did you mean '" + path + ".toml'?");
  scene::Document document = scene::load(path, overrides, overrider);
  if (!document.given("time")) {
    if (document.given("study")) refuse(path, "this is a study, not a scene: spindrift study " + path);
    if (document.given("turbine.blades") || document.given("turbine.planform"))
      refuse(path, "this is a turbine file, not a scene: a scene names it by the key rotor.turbine");
  }
  return document;
}

void require_study(const std::string& path) {
  const scene::Document document = scene::load(path);
  if (!document.given("study") && document.given("time")) refuse(path, "this is a scene, not a study: spindrift run " + path);
}

}  // namespace spindrift::app
