// Laws of src/scene/layers.hpp: base files, overrides, and what takes precedence.
// SPDX-License-Identifier: Apache-2.0
#include "src/scene/layers.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "tests/src/scene/example_sections.hpp"
#include "tests/src/scene/temporary.hpp"

using namespace spindrift;
using namespace spindrift::scene;

namespace {
/// The problems of a scene from memory with overrides, one text.
std::string complaint(const std::vector<std::string>& overrides, std::string_view text = "[time]\nend_s = 1.0\n") {
  try {
    Document doc = parse(text, "s.toml", "/", overrides);
    for (const SectionBase* section : example::sections()) doc.read_any(*section);
    doc.finish();
  } catch (const SceneError& error) { return error.what(); }
  return "";
}
}  // namespace

TEST_CASE("a scene lies on its bases key by key, the later one on top", "[scene][fast]") {
  const Temporary dir;
  dir.file("parts/time.toml", "[time]\nend_s = 10.0\nwindow_s = 0.5\n");
  dir.file("parts/body.toml",
           "[time]\nwindow_s = 0.25\n[bodies.a]\nmass_kg = 1.0\n[[bodies.a.cylinders]]\ndiameter_m = 1.0\n"
           "[[bodies.a.cylinders]]\ndiameter_m = 2.0\n");
  dir.file("middle.toml", "base = [\"parts/time.toml\", \"parts/body.toml\"]\n[bodies.b]\nmass_kg = 2.0\n");
  Document doc =
      load(dir.file("scene.toml", "base = \"middle.toml\"\n[time]\nend_s = 20.0\n[[bodies.a.cylinders]]\ndiameter_m = 3.0\n"));
  const auto time = doc.read(example::time_section());
  CHECK(time.end_s == 20.0);
  CHECK(time.window_s == 0.25);
  const auto bodies = doc.read_named(example::body_section());
  REQUIRE(bodies.size() == 2);
  CHECK(bodies[0].options.mass_kg == 1.0);
  REQUIRE(bodies[0].options.cylinders.size() == 1);  // a list of tables is replaced as a whole
  CHECK(bodies[0].options.cylinders[0].diameter_m == 3.0);
  CHECK_NOTHROW(doc.finish());
}

TEST_CASE("a problem in a base is told with the base's file and line", "[scene][fast]") {
  const Temporary dir;
  dir.file("base.toml", "[time]\n\nend_s = -1.0\n");
  Document doc = load(dir.file("scene.toml", "base = \"base.toml\"\n"));
  doc.read(example::time_section());
  CHECK_THROWS_WITH(doc.finish(), dir.path() + "/base.toml:3: time.end_s = -1.0: must be > 0 s (end of the run)");
}

TEST_CASE("bases in a cycle are told with the chain", "[scene][fast]") {
  const Temporary dir;
  dir.file("b.toml", "\nbase = \"./c.toml\"\n");
  dir.file("c.toml", "base = \"a.toml\"\n");
  CHECK_THROWS_WITH(
      load(dir.file("a.toml", "base = \"b.toml\"\n")),
      dir.path() + "/c.toml:1: base = \"a.toml\": the base files form a cycle: a.toml -> b.toml -> c.toml -> a.toml");
  CHECK_THROWS_WITH(load(dir.file("d.toml", "base = \"d.toml\"\n")), Catch::Contains("a cycle: d.toml -> d.toml"));
}

TEST_CASE("a base that cannot be read is told at the line that names it", "[scene][fast]") {
  const Temporary dir;
  CHECK_THROWS_WITH(load(dir.file("a.toml", "\nbase = [\"gone.toml\"]\n")),
                    dir.path() + "/a.toml:2: base = \"gone.toml\": " + dir.path() + "/gone.toml: no such file in " + dir.path());
  CHECK_THROWS_WITH(load(dir.file("b.toml", "base = 3\n")),
                    dir.path() + "/b.toml:1: base = 3: must be a text or a list of texts, not an integer");
  dir.file("0.toml", "[time]\nend_s = 1.0\n");
  for (int i = 1; i < 12; ++i) dir.file(fmt::format("{}.toml", i), fmt::format("base = [\"{0}.toml\", \"{0}.toml\"]\n", i - 1));
  CHECK_THROWS_WITH(load(dir.path() + "/11.toml"), Catch::Contains("is based on more than 64 files"));
}

TEST_CASE("what a base says can be taken away", "[scene][fast]") {
  const Temporary dir;
  dir.file("base.toml", "[time]\nend_s = 1.0\n[sea]\nmodel = \"morison\"\ndrag_coefficient = 2.0\n[bodies.a]\nmass_kg = 1.0\n");
  Document doc = load(dir.file(
      "scene.toml", "base = \"base.toml\"\nwithout = [\"sea.drag_coefficient\", \"bodies\"]\n[sea]\nmodel = \"none\"\n"));
  doc.read(example::time_section());
  CHECK(doc.read(example::sea_section()).model == "none");
  CHECK(doc.read_named(example::body_section()).empty());
  CHECK_NOTHROW(doc.finish());
  Document wrong = load(dir.file("wrong.toml", "base = \"base.toml\"\nwithout = \"sea.drag\"\n"));
  for (const SectionBase* section : example::sections()) wrong.read_any(*section);
  CHECK_THROWS_WITH(wrong.finish(),
                    dir.path() + "/wrong.toml:2: without = \"sea.drag\": names a key that the base does not have");
}

TEST_CASE("an override is TOML, or a bare word", "[scene][fast]") {
  Document doc = parse(
      "[time]\nend_s = 1.0\n[bodies.a]\nmass_kg = 1.0\n[[bodies.a.cylinders]]\ndiameter_m = 1.0\n[sea]\nmodel = \"morison\"\n"
      "drag_coefficient = 2.0\n",
      "s.toml", "/",
      {"time.end_s=60", "time.integrator=euler", "bodies.a.centre_m=[1, 2.5, 3]", "bodies.a.cylinders[0].diameter_m = 4",
       "bodies.a.cylinders[0].name=\"x=y\"", "without=[\"sea.drag_coefficient\"]", "sea.model = none ", "bodies.b={mass_kg=7}",
       "bodies.a={pitch_deg=90}"});
  const auto time = doc.read(example::time_section());
  CHECK(time.end_s == 60.0);
  CHECK(time.integrator == example::Integrator::euler);
  const auto bodies = doc.read_named(example::body_section());
  REQUIRE(bodies.size() == 2);
  CHECK(bodies[0].options.centre_m == Eigen::Vector3d(1, 2.5, 3));
  CHECK(bodies[0].options.cylinders.at(0).diameter_m == 4.0);
  CHECK(bodies[0].options.cylinders.at(0).name == "x=y");
  CHECK(bodies[0].options.mass_kg == 1.0);  // a table is laid over the one that is there
  CHECK(bodies[0].options.pitch == Approx(pi / 2));
  CHECK(bodies[1].options.mass_kg == 7.0);
  CHECK(doc.read(example::sea_section()).model == "none");
  CHECK_NOTHROW(doc.finish());
}

TEST_CASE("a bad override is told like a bad line, as of the command line", "[scene][fast]") {
  CHECK(complaint({"time.end_s=-1"}) == "command line: time.end_s = -1: must be > 0 s (end of the run)");
  CHECK(complaint({"time.ends_s=1"}) == "command line: time.ends_s = 1: unknown key; did you mean 'end_s'?");
  CHECK(complaint({"time.end_s"}) ==
        "command line: time.end_s: is no override; write SECTION.KEY=VALUE or bodies.NAME.KEY=VALUE");
  CHECK(complaint({"time.end_s="}) == "command line: time.end_s: has no value; write KEY=VALUE");
  CHECK(complaint({"=3"}) == "command line: =3: is no override; write SECTION.KEY=VALUE or bodies.NAME.KEY=VALUE");
  CHECK_THAT(complaint({"time..x=3"}), Catch::Contains("is no override"));
  CHECK_THAT(complaint({"time.end_s=1.2.3"}), Catch::StartsWith("command line: time.end_s = 1.2.3: is not TOML"));
  CHECK_THAT(complaint({"time.end_s=1\ntime.window_s=1"}),
             Catch::StartsWith("command line: time.end_s = 1\ntime.window_s=1: is more than one value"));
  CHECK(complaint({"bodies.a.cylinders[0].diameter_m=3"}) ==
        "command line: bodies.a.cylinders[0].diameter_m = 3: 'cylinders' is not a list in the scene");
  CHECK(complaint({"base=x.toml"}) == "command line: base = \"x.toml\": base files are named in scene files only");
  CHECK(complaint({"without=sea"}) == "command line: without = \"sea\": names a key that the base does not have");
  CHECK(complaint({"time.window_s=0.5", "time.window_s=0.25"}) == "");
}
