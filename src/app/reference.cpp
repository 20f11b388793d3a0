// spindrift reference: every scene key from the declarations of the modules.
// SPDX-License-Identifier: Apache-2.0
#include "src/scene/reference.hpp"

#include <fmt/format.h>

#include "src/app/commands.hpp"
#include "src/coupling/scenario.hpp"

namespace spindrift::app {

int reference(const std::string& topic, bool markdown, const runtime::World& world) {
  const auto sections = coupling::all_sections();
  const std::string text = markdown ? scene::reference_markdown(sections) : scene::reference_text(sections, topic);
  if (world.rank == 0) fmt::print("{}", text);
  return done;
}

}  // namespace spindrift::app
