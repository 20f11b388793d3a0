// spindrift import: a scene from another program's input.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "src/app/commands.hpp"
#include "src/app/scene_file.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/import/openfast.hpp"
#include "src/import/windio.hpp"
#include "src/io/machine_failure.hpp"
#include "src/scene/error.hpp"
#include "src/scene/value.hpp"

namespace spindrift::app {

namespace {

/// What was written must be a scene: read as `check` reads it, with the files that it names.
void require_valid(const std::filesystem::path& file) {
  try {
    scene::Document document = load_scene(file.string(), {});
    const coupling::FloatingSystem floating(coupling::read_scenario(document));
  } catch (const scene::SceneError&) {
    fmt::print("\nNot yet a valid scene: mend what follows in {}, or in the deck\n", file.string());
    throw;
  }
}

}  // namespace

int import_deck(const ImportArguments& arguments, const runtime::World& world) {
  if (world.rank != 0) return done;
  if (!std::filesystem::exists(arguments.file))
    throw scene::SceneError({{arguments.file, 0, "", "", scene::absent_file(arguments.file)}});
  const std::string ending = std::filesystem::path(arguments.file).extension().string();
  const bool windio = ending == ".yaml" || ending == ".yml";
  if (windio && arguments.rigid_blades)
    throw scene::SceneError({{"command line", 0, "--rigid-blades", "", "has no effect: windIO's blades are carried over rigid"}});
  if (windio && arguments.quasi_static_lines)
    throw scene::SceneError({{"command line", 0, "--quasi-static-lines", "", "has no effect: a windIO turbine has no lines"}});
  if (const auto scene = std::filesystem::path(arguments.out) / "scene.toml";
      !arguments.overwrite && std::filesystem::exists(scene))
    throw io::InputError(scene.string() +
                         ": is there already; choose another folder with --out, or say --overwrite to replace it");
  const auto tower = arguments.rigid_tower ? decks::ImportedTower::rigid : decks::ImportedTower::as_in_deck;
  const decks::Imported result =
      windio ? decks::import_windio(arguments.file, arguments.out, tower)
             : decks::import_openfast(
                   arguments.file, arguments.out, tower,
                   arguments.rigid_blades ? decks::ImportedBlades::rigid : decks::ImportedBlades::as_in_deck,
                   arguments.quasi_static_lines ? decks::ImportedLines::quasi_static : decks::ImportedLines::as_in_deck);
  fmt::print("{}\n\nCarried over\n", result.scene.string());
  for (const std::string& what : result.carried) fmt::print("  {}\n", what);
  if (!result.left_out.empty()) fmt::print("\nLeft out\n");
  for (const std::string& what : result.left_out) fmt::print("  {}\n", what);
  require_valid(result.scene);
  return done;
}

}  // namespace spindrift::app
