// spindrift reference: every scene key from the declarations of the modules.
// SPDX-License-Identifier: Apache-2.0
#include "src/scene/reference.hpp"

#include <fmt/format.h>

#include "src/app/commands.hpp"
#include "src/coupling/scenario.hpp"
#include "src/run/flow_columns.hpp"

namespace spindrift::app {

int reference(const std::string& topic, bool markdown, const runtime::World& world) {
  const auto sections = coupling::all_sections();
  const std::string text = markdown ? scene::reference_markdown(sections) : scene::reference_text(sections, topic);
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
