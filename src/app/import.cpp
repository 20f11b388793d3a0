// spindrift import: a scene from another program's input.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "src/app/commands.hpp"
#include "src/app/scene_file.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/start.hpp"
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

/// What blade elements take from a wind [W], at the speed that the scene's table has there.
double power_in(const std::filesystem::path& file, double wind_m_s) {
  scene::Document document = load_scene(file.string(), {fmt::format("wind.speed_m_s={:.17g}", wind_m_s)});
  coupling::FloatingSystem floating(coupling::read_scenario(document));
  const coupling::Start start = make_start(floating);
  const coupling::FullLoads full(floating);
  const aero::RotorLoads& rotor = floating.rotors().front().loads;
  return rotor.load(0.0, rotor.state(0.0, start.state.motions)).power;
}

/// The wind at which blade elements have rated power, where that is within the table of a valid scene.
std::optional<double> rated_wind(const decks::Imported& imported) try {
  if (!imported.rating.power_W) return std::nullopt;
  const auto below = [&](double wind) { return power_in(imported.scene, wind) < *imported.rating.power_W; };
  double low = imported.rating.least_wind, high = imported.rating.most_wind;
  if (!below(low) || below(high)) return std::nullopt;
  constexpr int halvings = 10;
  for (int n = 0; n < halvings; ++n) {
    const double middle = 0.5 * (low + high);
    (below(middle) ? low : high) = middle;
  }
  return low;
} catch (const scene::SceneError&) { return std::nullopt; }  // require_valid says what

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
  decks::Imported result =
      windio ? decks::import_windio(arguments.file, arguments.out, tower)
             : decks::import_openfast(
                   arguments.file, arguments.out, tower,
                   arguments.rigid_blades ? decks::ImportedBlades::rigid : decks::ImportedBlades::as_in_deck,
                   arguments.quasi_static_lines ? decks::ImportedLines::quasi_static : decks::ImportedLines::as_in_deck);
  if (windio)
    if (const auto wind = rated_wind(result)) result = decks::import_windio(arguments.file, arguments.out, tower, wind);
  fmt::print("{}\n\nCarried over\n", result.scene.string());
  for (const std::string& what : result.carried) fmt::print("  {}\n", what);
  if (!result.left_out.empty()) fmt::print("\nLeft out\n");
  for (const std::string& what : result.left_out) fmt::print("  {}\n", what);
  require_valid(result.scene);
  return done;
}

}  // namespace spindrift::app
