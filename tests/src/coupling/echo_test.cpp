// Every section of the program: what a scene says in it is echoed so that it reads back to the same bits.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "src/coupling/scenario.hpp"
#include "tests/src/scene/sample_scene.hpp"
#include "tests/src/scene/temporary.hpp"

using namespace spindrift;

namespace {
/// The echo of one section, or the problems.
std::string echo(const scene::SectionBase& section, const std::string& text) {
  scene::Document doc = scene::parse(text, "sample.toml", "/");
  doc.read_any(section);
  doc.finish();
  return doc.echo();
}
}  // namespace

TEST_CASE("every section's echo reads back to itself", "[coupling][fast]") {
  const scene::Temporary dir;
  const std::string file = dir.file("some \"file\".csv", "");
  for (const scene::SectionBase* section : coupling::all_sections()) {
    INFO(section->name());
    int well = 0;
    for (unsigned seed = 0; seed < 200; ++seed) {
      const std::string text = scene::SampleScene(seed, file).section(*section);
      std::string once;
      try {
        once = echo(*section, text);
      } catch (const scene::SceneError&) { continue; }  // refused by a rule that the sample does not know
      INFO(text);
      ++well;
      REQUIRE(echo(*section, once) == once);  // numbers are printed to their last bit: the same text is the same options
    }
    CHECK(well >= 5);
  }
}
