// spindrift reference: every key of scenes, turbine files and studies, from the declarations of the modules.
// SPDX-License-Identifier: Apache-2.0
#include "src/scene/reference.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <ranges>
#include <string_view>

#include "src/aero/control_options.hpp"
#include "src/aero/turbine.hpp"
#include "src/app/commands.hpp"
#include "src/coupling/scenario.hpp"
#include "src/run/flow_columns.hpp"
#include "src/scene/error.hpp"
#include "src/scene/study.hpp"

namespace spindrift::app {

namespace {

using Sections = std::vector<const scene::SectionBase*>;

std::string markdown_pages(const Sections& of_scenes, const Sections& of_turbines, const Sections& of_controllers,
                           const Sections& of_studies) {
  return "# Scene reference\n\nEvery key of a scene, a turbine file, a controller file and a study; written by `spindrift "
         "reference --markdown`, not by hand. How scenes are composed: `docs/user/scenes.md`.\n" +
         reference_markdown(of_scenes) +
         "\n# Turbine files\n\nThe file that `rotor.turbine` of a scene names. An example: `inputs/turbines/dtu_10mw.toml`.\n" +
         reference_markdown(of_turbines) +
         "\n# Controller files\n\nThe file that `control.file` of a scene or `controller` of a turbine file names. An example: "
         "`inputs/turbines/dtu_10mw_controller.toml`.\n" +
         reference_markdown(of_controllers) +
         "\n# Studies\n\nThe file that `spindrift study` takes. Examples: `inputs/studies`.\n" + reference_markdown(of_studies);
}

}  // namespace

int reference(const std::string& topic, bool markdown, const runtime::World& world) {
  const auto scenes = coupling::all_sections();
  const Sections of_scenes(scenes.begin(), scenes.end()), of_turbines{&aero::turbine_section()},
      of_controllers{&aero::controller_section()}, of_studies = scene::study_sections();
  Sections all = of_scenes;
  all.insert(all.end(), of_turbines.begin(), of_turbines.end());
  all.insert(all.end(), of_controllers.begin(), of_controllers.end());
  all.insert(all.end(), of_studies.begin(), of_studies.end());
  const std::string text =
      markdown ? markdown_pages(of_scenes, of_turbines, of_controllers, of_studies) : scene::reference_text(all, topic);
  if (world.rank == 0) fmt::print("{}", text);
  return done;
}

namespace {

std::string lower(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// "rotor.blade_1" of "rotor.blade_1.".
std::string stem(const io::ColumnSection& section) { return section.prefix.substr(0, section.prefix.size() - 1); }

/// "BODY" of what a scene names itself.
bool is_placeholder(std::string_view part) {
  return std::ranges::none_of(part, [](char c) { return std::islower(static_cast<unsigned char>(c)); });
}

/// Is `name` a column of a scene that is `pattern` in general? "platform.x_m" of "BODY.x_m"
bool is_one_of(std::string_view pattern, std::string_view name) {
  const auto parts = [](std::string_view text) {
    std::vector<std::string_view> found;
    for (const auto part : text | std::views::split('.')) found.emplace_back(part.begin(), part.end());
    return found;
  };
  const std::vector<std::string_view> general = parts(pattern), given = parts(name);
  return std::ranges::equal(general, given, [](std::string_view g, std::string_view n) { return g == n || is_placeholder(g); });
}

/// Sections whose names begin with the topic; where there are none, the columns that have it in their name or in what is said, or
/// that it is one of.
std::vector<io::ColumnSection> sections_of(const std::string& topic) {
  const std::vector<io::ColumnSection> all = run::all_columns();
  const std::string word = lower(topic.ends_with('.') ? topic.substr(0, topic.size() - 1) : topic);
  std::vector<io::ColumnSection> found;
  for (const io::ColumnSection& section : all)
    if (lower(section.prefix).starts_with(word + ".")) found.push_back(section);
  if (!found.empty()) return found;
  const auto has = [&](const std::string& text) { return lower(text).find(word) != std::string::npos; };
  for (io::ColumnSection section : all) {
    if (!has(section.when))
      std::erase_if(section.columns, [&](const io::Column& c) { return !has(section.prefix + c.name) && !has(c.meaning); });
    if (!section.columns.empty()) found.push_back(section);
  }
  if (!found.empty()) return found;
  for (io::ColumnSection section : all) {
    std::erase_if(section.columns, [&](const io::Column& c) { return !is_one_of(section.prefix + c.name, topic); });
    if (!section.columns.empty()) found.push_back(section);
  }
  if (!found.empty()) return found;
  std::vector<std::string> known;
  for (const io::ColumnSection& section : all)
    if (std::ranges::find(known, stem(section)) == known.end()) known.push_back(stem(section));
  throw scene::SceneError(
      {{"command line", 0, topic, "",
        fmt::format("no column begins with it or speaks of it; columns begin with {}", fmt::join(known, ", "))}});
}

}  // namespace

int reference_columns(const std::string& topic, const runtime::World& world) {
  if (world.rank != 0) return done;
  if (topic.empty())
    fmt::print(
        "# Columns of history.csv\n\nMade from the program's declarations by `ci/reference`. `time_s` comes first. Words in "
        "capitals stand "
        "for names of the\nscene. A run has the columns of what its scene has; `summary.json` lists them with unit and "
        "meaning.\n");
  for (const io::ColumnSection& section : topic.empty() ? run::all_columns() : sections_of(topic)) {
    fmt::print("\n## {}* ({})\n\n| column | unit | meaning |\n|---|---|---|\n", section.prefix, section.when);
    for (const io::Column& c : section.columns) fmt::print("| `{}{}` | {} | {} |\n", section.prefix, c.name, c.unit, c.meaning);
  }
  return done;
}

}  // namespace spindrift::app
