// spindrift reference: every key of scenes, turbine files and studies, from the declarations of the modules.
// SPDX-License-Identifier: Apache-2.0
#include "src/scene/reference.hpp"

#include <fmt/format.h>

#include "src/aero/control_options.hpp"
#include "src/aero/turbine.hpp"
#include "src/app/commands.hpp"
#include "src/coupling/scenario.hpp"
#include "src/run/flow_columns.hpp"
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

int reference_columns(const runtime::World& world) {
  if (world.rank != 0) return done;
  fmt::print(
      "# Columns of history.csv\n\nMade from the program's declarations by `ci/reference`. `time_s` comes first. Words in "
      "capitals stand "
      "for names of the\nscene. A run has the columns of what its scene has; `summary.json` lists them with unit and meaning.\n");
  for (const io::ColumnSection& section : run::all_columns()) {
    fmt::print("\n## {}* ({})\n\n| column | unit | meaning |\n|---|---|---|\n", section.prefix, section.when);
    for (const io::Column& c : section.columns) fmt::print("| `{}{}` | {} | {} |\n", section.prefix, c.name, c.unit, c.meaning);
  }
  return done;
}

}  // namespace spindrift::app
