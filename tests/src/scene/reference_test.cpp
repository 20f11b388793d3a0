// The reference says of every key what its declaration says.
// SPDX-License-Identifier: Apache-2.0
#include "src/scene/reference.hpp"

#include <catch2/catch.hpp>

#include "src/scene/error.hpp"
#include "tests/src/scene/example_sections.hpp"

using namespace spindrift::scene;
using Catch::Contains;

TEST_CASE("the reference has a row for every key", "[scene][fast]") {
  const auto sections = example::sections();
  const std::string text = reference_markdown(sections);
  CHECK_THAT(text, Contains("## `[time]`\n\nHow long, in which steps.\n"));
  CHECK_THAT(text, Contains("| `end_s` | number | s | required | > 0 | End of the run. |\n"));
  CHECK_THAT(text, Contains("| `window_s` | number | s | `0.1` | > 0 and <= 1000 | Length of a coupling window. |\n"));
  CHECK_THAT(
      text,
      Contains(
          "| `integrator` | choice |  | `\"rk4\"` |  | Time integration of the bodies.<br>`\"rk4\"`: classical Runge-Kutta<br>"));
  CHECK_THAT(text, Contains("| `seed` | integer | - | none |  | Seed of the random phases. |\n"));
  CHECK_THAT(text, Contains("| `drag_coefficient` | number | - | `1.0` | >= 0 and <= 10; only if model is morison |"));
  CHECK_THAT(text, Contains("## `[[bodies.NAME.cylinders]]`\n\nShapes that meet the water.\n"));
  CHECK_THAT(text, Contains("## `[moorings.NAME]`\n\nA mooring line.\n\nExactly one of: stiffness_N_m, axial_stiffness_N.\n"));
  CHECK_THAT(text, Contains("| `probes_m` | list of numbers | m | `[]` | 0 to 4 entries |"));
}

TEST_CASE("the terminal's reference answers for a section, a key, or a key without its section", "[scene][fast]") {
  const auto sections = example::sections();
  CHECK(reference_text(sections, "time.window_s") ==
        "[time]\n  window_s  (number; s; > 0 and <= 1000; default 0.1)\n      Length of a coupling window.\n");
  CHECK(reference_text(sections, "window_s") == reference_text(sections, "time.window_s"));
  CHECK(reference_text(sections, "bodies.mass_kg") == reference_text(sections, "bodies.NAME.mass_kg"));
  CHECK(reference_text(sections, "bodies.platform.mass_kg") == reference_text(sections, "bodies.NAME.mass_kg"));
  CHECK(reference_text(sections, "bodies.platform") == reference_text(sections, "bodies.NAME"));
  CHECK_THROWS_WITH(reference_text(sections, "bodies.platform.mas_kg"), Contains("did you mean 'bodies.NAME.mass_kg'?"));
  CHECK_THROWS_WITH(reference_text(sections, "bodies.mas_kg"), Contains("did you mean 'mass_kg'?"));
  CHECK_THAT(reference_text(sections, "bodies"),
             Contains("[bodies.NAME]  A rigid body.\n") && Contains("[[bodies.NAME.cylinders]]") && !Contains("[time]"));
  CHECK(reference_text(sections, "[time]") == reference_text(sections, "time"));
  CHECK_THAT(reference_text(sections), Contains("[time]") && Contains("[sea.grid]"));
  CHECK_THROWS_WITH(reference_text(sections, "windw_s"),
                    "command line: windw_s: no such section or key; did you mean 'window_s'?");
  CHECK_THROWS_WITH(reference_text(sections, "Runge"),
                    "command line: Runge: no such section or key; keys that speak of it: time.integrator");
  CHECK_THROWS_WITH(reference_text(sections, "Name stiffness"),
                    "command line: Name stiffness: no such section or key; keys that speak of it: moorings.NAME.stiffness_N_m");
}
