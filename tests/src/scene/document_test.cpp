// Laws of src/scene/document.hpp: what a scene may say, and what it is told when it says something else.
// SPDX-License-Identifier: Apache-2.0
#include "src/scene/document.hpp"

#include <catch2/catch.hpp>

#include "tests/src/scene/example_sections.hpp"
#include "tests/src/scene/temporary.hpp"

using namespace spindrift::scene;

namespace {

using Lines = std::vector<std::string>;

/// The problems of a scene that has all example sections, as lines of text.
Lines problems(std::string_view text, const Lines& overrides = {}) {
  Lines lines;
  try {
    Document doc = parse(text, "s.toml", "/", overrides);
    for (const SectionBase* section : example::sections()) doc.read_any(*section);
    doc.finish();
  } catch (const SceneError& error) {
    for (const Problem& p : error.problems()) lines.push_back(p.text());
  }
  return lines;
}

const std::string good = "[time]\nend_s = 1.0\n";

}  // namespace

TEST_CASE("a value out of range is told with its line, value, range and meaning", "[scene][fast]") {
  CHECK(problems("[time]\nend_s = 1.0\nwindow_s = -0.1\n") ==
        Lines{"s.toml:3: time.window_s = -0.1: must be > 0 and <= 1000 s (length of a coupling window)"});
  CHECK(problems("[time]\nend_s = inf") == Lines{"s.toml:2: time.end_s = inf: must be > 0 s (end of the run)"});
  CHECK(problems("[time]\nend_s = nan") == Lines{"s.toml:2: time.end_s = nan: must be > 0 s (end of the run)"});
  CHECK(problems(good + "most_steps = 3000000000") ==
        Lines{"s.toml:3: time.most_steps = 3000000000: must be an integer of at most 31 bits (most steps in a window)"});
  CHECK(problems(good + "[bodies.a]\nmass_kg = 1\ncentre_m = [0.0, -2e4, 0.0]") ==
        Lines{"s.toml:5: bodies.a.centre_m[1] = -20000.0: must be >= -10000 and <= 10000 m (centre of mass at the start, earth "
              "frame)"});
}

TEST_CASE("an integer is a number, a number is no integer, a text is neither", "[scene][fast]") {
  CHECK(problems("[time]\nend_s = 3") == Lines{});
  CHECK(problems(good + "most_steps = 3.0") ==
        Lines{"s.toml:3: time.most_steps = 3.0: must be an integer, not a number with a decimal point (most steps in a window)"});
  CHECK(problems("[time]\nend_s = \"long\"") ==
        Lines{"s.toml:2: time.end_s = \"long\": must be a number in s, not a text (end of the run)"});
  CHECK(problems("[time]\nend_s = 2020-01-02T03:04:05Z") ==
        Lines{"s.toml:2: time.end_s = 2020-01-02T03:04:05Z: must be a number in s, not a date or time (end of the run)"});
  CHECK(problems(good + "[bodies.a]\nmass_kg = 1\ngyroscopic = 0") ==
        Lines{"s.toml:5: bodies.a.gyroscopic = 0: must be true or false, not an integer (whether gyroscopic terms act)"});
}

TEST_CASE("an unknown key is told its nearest neighbour, or where it belongs", "[scene][fast]") {
  CHECK(problems("[time]\nend = 3") == Lines{"s.toml:1: time.end_s: is missing and has no default (end of the run)",
                                             "s.toml:2: time.end = 3: unknown key; did you mean 'end_s'?"});
  CHECK(problems(good + "integartor = \"rk4\"") ==
        Lines{"s.toml:3: time.integartor = \"rk4\": unknown key; did you mean 'integrator'?"});
  CHECK(problems(good + "latest_seed = 3") == Lines{"s.toml:3: time.latest_seed = 3: unknown key; did you mean 'seed'?"});
  CHECK(problems(good + "steps = 3") == Lines{"s.toml:3: time.steps = 3: unknown key; did you mean 'most_steps'?"});
  CHECK(problems(good + "mass_kg = 3") ==
        Lines{"s.toml:3: time.mass_kg = 3: unknown key; [time] has: end_s, window_s, integrator, "
              "most_steps, seed (mass_kg is a key of [bodies.NAME])"});
  CHECK(problems(good + "[boddies.a]\nmass_kg = 3") == Lines{"s.toml:3: boddies: unknown section; did you mean [bodies]?"});
  CHECK(problems("end_s = 1\n" + good) == Lines{"s.toml:1: end_s = 1: unknown key outside any section; a scene has: time, sea, "
                                                "bodies, moorings (end_s is a key of [time])"});
}

TEST_CASE("a value that has no effect is an error that says why", "[scene][fast]") {
  CHECK(problems(good + "[sea]\ndrag_coefficient = 1.0") ==
        Lines{"s.toml:4: sea.drag_coefficient = 1.0: has no effect here: only where model is morison, and model is none "
              "(transverse drag of a member)"});
  CHECK(problems(good + "[sea]\nmodel = \"morison\"\ndrag_coefficient = 1.0") == Lines{});
}

TEST_CASE("of alternatives exactly one is given", "[scene][fast]") {
  const std::string line = good + "[moorings.l]\nbody = \"b\"\n";
  CHECK(problems(line) == Lines{"s.toml:3: moorings.l: give exactly one of: stiffness_N_m, axial_stiffness_N"});
  CHECK(problems(line + "stiffness_N_m = 1.0\naxial_stiffness_N = 1.0") ==
        Lines{"s.toml:6: moorings.l.axial_stiffness_N = 1.0: cannot stand beside stiffness_N_m; give one of: stiffness_N_m, "
              "axial_stiffness_N"});
}

TEST_CASE("lists have sizes, matrices are symmetric, choices are named", "[scene][fast]") {
  CHECK(problems(good + "[sea]\nprobes_m = [1, 2, 3, 4, 5]") ==
        Lines{"s.toml:4: sea.probes_m = [1, 2, 3, 4, 5]: must have 0 to 4 entries, not 5 (places of wave gauges along x)"});
  CHECK(
      problems(good + "[bodies.a]\nmass_kg = 1\ncentre_m = [0.0, 1.0]") ==
      Lines{"s.toml:5: bodies.a.centre_m = [0.0, 1.0]: must be a list of 3 numbers in m, not a list of 2 (centre of mass at the "
            "start, earth frame)"});
  CHECK(
      problems(good + "[bodies.a]\nmass_kg = 1\ninertia_kg_m2 = [[1, 0, 0], [1, 1, 0], [0, 0, 1]]") ==
      Lines{"s.toml:5: bodies.a.inertia_kg_m2 = [[1, 0, 0], [1, 1, 0], [0, 0, 1]]: must be symmetric; entries [0][1] and [1][0] "
            "differ (inertia about the centre of mass, body axes)"});
  CHECK(problems(good + "integrator = \"rk5\"") == Lines{"s.toml:3: time.integrator = \"rk5\": must be one of \"rk4\", "
                                                         "\"euler\"; did you mean \"rk4\"? (time integration of the bodies)"});
  CHECK(problems(good + "[sea]\nprofile_m = []") ==
        Lines{"s.toml:4: sea.profile_m = []: must have at least 1 entries, not 0 (sea bed as pairs x, z)"});
}

TEST_CASE("sections have the shape of their declaration", "[scene][fast]") {
  CHECK(problems("time = 3") == Lines{"s.toml:1: time = 3: must be a section, [time], not an integer"});
  CHECK(problems(good + "[bodies]\nmass_kg = 3.0") ==
        Lines{"s.toml:4: bodies.mass_kg = 3.0: must stand in a section [bodies.NAME]"});
  CHECK(problems(good + "[bodies.\"a b\"]\nmass_kg = 3.0") ==
        Lines{"s.toml:3: bodies.\"a b\": a name has letters, digits, '_' and '-' only"});
  CHECK(problems(good + "[bodies.a]\nmass_kg = 1\ncylinders = [{diameter_m = 1.0}, {diameter_m = -1}]") ==
        Lines{"s.toml:5: bodies.a.cylinders[1].diameter_m = -1: must be > 0 m (outer diameter)"});
}

TEST_CASE("a rule between keys speaks when the keys are well by themselves", "[scene][fast]") {
  CHECK(problems(good + "window_s = 2.0") == Lines{"s.toml:3: time.window_s = 2.0: is longer than the run, time.end_s"});
  CHECK(problems("[time]\nend_s = -1.0\nwindow_s = 2.0").size() == 1);
}

TEST_CASE("all problems of a scene come at once, by line", "[scene][fast]") {
  const Lines lines = problems("[bodies.a]\nmass_kg = -1\n[time]\nend_s = 0\nx = 1\n[foo]\n");
  REQUIRE(lines.size() == 4);
  CHECK(lines[0].starts_with("s.toml:2: bodies.a.mass_kg"));
  CHECK(lines[1].starts_with("s.toml:4: time.end_s"));
  CHECK(lines[2].starts_with("s.toml:5: time.x"));
  CHECK(lines[3].starts_with("s.toml:6: foo"));
}

TEST_CASE("a module's own problem is shown at the key, or at the nearest table around it", "[scene][fast]") {
  Document doc = parse(good + "[bodies.a]\nmass_kg = 1\n[[bodies.a.cylinders]]\ndiameter_m = 1.0\n", "s.toml", "/");
  doc.read(example::time_section());
  doc.read_named(example::body_section());
  CHECK(doc.given("bodies.a.cylinders[0].diameter_m"));
  CHECK_FALSE(doc.given("bodies.a.cylinders[1].diameter_m"));
  CHECK_FALSE(doc.given("sea"));
  doc.problem("bodies.a.cylinders[0].diameter_m", "is wide");
  doc.problem("bodies.a.cylinders[0].name", "is missing");
  doc.problem("joints.x", "is missing");
  REQUIRE_THROWS_WITH(doc.finish(),
                      "3 problems in the scene:\n  s.toml: joints.x: is missing\n  s.toml:5: bodies.a.cylinders[0].name: is "
                      "missing\n  s.toml:6: bodies.a.cylinders[0].diameter_m = 1.0: is wide");
}

TEST_CASE("a module's problem that follows from another one is not told", "[scene][fast]") {
  Document doc = parse(good + "[bodies.a]\nmass_kg = -1\n", "s.toml", "/");
  doc.read(example::time_section());
  doc.read_named(example::body_section());
  doc.problem("bodies.a.mass_kg", "is no mass for this sea");
  doc.problem("bodies.a", "is too light");
  doc.problem("bodies.a.mass_kg_2", "is another key");
  REQUIRE_THROWS_WITH(doc.finish(),
                      "2 problems in the scene:\n  s.toml:3: bodies.a.mass_kg_2: is another key\n  s.toml:4: "
                      "bodies.a.mass_kg = -1: must be > 0 kg (mass of the body)");
}

TEST_CASE("what follows from a key is told where that key is well, whatever the words and the order", "[scene][fast]") {
  const auto told = [](const std::string& mass) {
    Document doc = parse(good + "[bodies.a]\nmass_kg = " + mass + "\n", "s.toml", "/");
    doc.read(example::time_section());
    doc.problem("time", "is of no use", "bodies.a.mass_kg");
    doc.read_named(example::body_section());
    try {
      doc.finish();
    } catch (const SceneError& e) { return std::string(e.what()); }
    return std::string();
  };
  CHECK_THAT(told("1"), Catch::Contains("time: is of no use") && !Catch::Contains("mass_kg"));
  CHECK_THAT(told("-1"), !Catch::Contains("is of no use") && Catch::Contains("mass_kg = -1"));
}

TEST_CASE("problems found after the reading get the line of their key", "[scene][fast]") {
  const auto at = [](Document& doc, const std::string& source, int line, const std::string& key) {
    return std::string(doc.located(SceneError({{source, line, key, "7", "is too much"}})).what());
  };
  Document doc = parse("[time]\nend_s = 2.0\n[bodies.a]\nmass_kg = 1.0\n", "s.toml", "/", {"time.window_s=0.5"});
  doc.add_defaults({"time.most_steps=3"});
  CHECK(at(doc, "s.toml", 0, "bodies.a.mass_kg") == "s.toml:4: bodies.a.mass_kg = 7: is too much");
  CHECK(at(doc, "", 0, "time.end_s") == "s.toml:2: time.end_s = 7: is too much");
  CHECK(at(doc, "s.toml", 0, "time.window_s") == "command line: time.window_s = 7: is too much");
  CHECK(at(doc, "s.toml", 0, "bodies.a.inertia") == "s.toml:3: bodies.a.inertia = 7: is too much");  // the table around it
  CHECK(at(doc, "s.toml", 0, "time.most_steps") == "s.toml: time.most_steps = 7: is too much");      // the program's own
  CHECK(at(doc, "s.toml", 0, "sea.depth_m") == "s.toml: sea.depth_m = 7: is too much");
  CHECK(at(doc, "other.toml", 0, "time.end_s") == "other.toml: time.end_s = 7: is too much");
  CHECK(at(doc, "s.toml", 9, "time.end_s") == "s.toml:9: time.end_s = 7: is too much");
}

TEST_CASE("a section that the scene has no use for is told so, and not echoed", "[scene][fast]") {
  Document silent = parse(good, "s.toml", "/");
  silent.read(example::time_section());
  CHECK(silent.read_where(false, example::sea_section(), "there is no water", "waters.model").model == "none");
  CHECK_FALSE(silent.read_if_given(example::sea_section()));
  CHECK_NOTHROW(silent.finish());
  CHECK_THAT(silent.echo(), !Catch::Contains("[sea]"));
  Document doc = parse(good + "[sea]\nmodel = \"sph\"\n", "s.toml", "/");
  doc.read(example::time_section());
  doc.read_where(false, example::sea_section(), "there is no water", "waters.model");
  CHECK_THROWS_WITH(doc.finish(), "s.toml:3: sea: has no effect: there is no water");
}

TEST_CASE("text that is no TOML, or made to break its reader, is refused", "[scene][fast]") {
  using Catch::Contains;
  const auto only = [](std::string_view text) {
    const Lines lines = problems(text);
    REQUIRE(lines.size() == 1);
    return lines[0];
  };
  CHECK_THAT(only("[time\nend_s = 1"), Contains("s.toml:1: is not TOML"));
  CHECK(only("D\xef\xbb\xbf") ==
        "s.toml:1: has a character beyond ASCII outside quotes and comments; put texts and such keys into quotes");
  CHECK_THAT(only("D\xef\xbb\xbb"), Contains("s.toml:1: has a character beyond ASCII"));  // undefined behaviour in toml++ 3.3.0
  CHECK_THAT(only("s = \"\"\"\\\n\xc2\xa7\"\"\"\n"),
             Contains("s.toml:1: has a character beyond ASCII right after a line-ending backslash"));
  CHECK(only(std::string_view("D\xef\xbb", 3)) == "s.toml:1: is not UTF-8 text (byte 0xef at offset 1); save the file as UTF-8");
  CHECK_THAT(only("a = 1\nb = \"\xff\""), Contains("s.toml:2: is not UTF-8 text (byte 0xff"));
  CHECK_THAT(only("x = \"\xed\xa0\x80\""), Contains("is not UTF-8"));  // a surrogate
  CHECK_THAT(only("x = \"\xc0\xaf\""), Contains("is not UTF-8"));      // overlong
  CHECK_THAT(only("x = " + std::string(100000, '[')), Contains("s.toml:1: nests more than 32 brackets"));
  std::string dots = "x";
  for (int i = 0; i < 100000; ++i) dots += ".x";
  CHECK_THAT(only("\n" + dots + " = 1"), Contains("s.toml:2: has a key of more than 32 parts"));
  CHECK_THAT(only("[" + dots + "]"), Contains("parts"));
  CHECK_THAT(only("y = \"#\"\n[" + dots + "]"), Contains("s.toml:2: has a key of more than 32 parts"));
  CHECK_THAT(only("x = 99999999999999999999"), Contains("s.toml:1: is not TOML"));
  CHECK_THAT(only("x = 1\nx = 2"), Contains("s.toml:2: is not TOML"));
  CHECK_THAT(only(std::string(5 << 20, '\n')), Contains("s.toml: has 5242880 bytes; a scene has at most 4194304"));
  CHECK(problems("# " + dots + "\n" + good) == Lines{});
}

TEST_CASE("byte order mark and carriage returns are text", "[scene][fast]") {
  CHECK(problems("\xef\xbb\xbf[time]\r\nend_s = 1.0\r\nwindow_s = -1.0\r\n") ==
        Lines{"s.toml:3: time.window_s = -1.0: must be > 0 and <= 1000 s (length of a coupling window)"});
}

TEST_CASE("an empty scene lacks what it must have", "[scene][fast]") {
  CHECK(problems("") == Lines{"s.toml: time.end_s: is missing and has no default (end of the run)"});
}

TEST_CASE("a file that is no scene is told why", "[scene][fast]") {
  const Temporary dir;
  CHECK_THROWS_WITH(load(dir.path() + "/none.toml"), dir.path() + "/none.toml: no such file in " + dir.path());
  dir.file("spar_in_waves.toml", "");
  CHECK_THROWS_WITH(load(dir.path() + "/spar_in_wave.toml"),
                    Catch::Contains("no such file; did you mean '" + dir.path() + "/spar_in_waves.toml'?"));
  CHECK_THROWS_WITH(load(dir.path() + "/none/spar.toml"),
                    Catch::Contains("no such file: there is no folder " + dir.path() + "/none"));
  CHECK_THROWS_WITH(load(dir.path()), dir.path() + ": is a directory, not a scene file");
  CHECK_THROWS_WITH(load("/dev/zero"), Catch::Contains("bytes; a scene has at most"));
  CHECK_THROWS_WITH(load(dir.file("a.toml", "x = ") + "/b.toml"), Catch::Contains("a.toml/b.toml: Not a directory"));
}

TEST_CASE("a path is an existing file beside the scene that names it", "[scene][fast]") {
  const Temporary dir;
  dir.file("data/forces.csv", "0,1\n");
  Document doc = load(dir.file("sub/scene.toml", "[sea]\ntable = \"../data/forces.csv\"\n"));
  CHECK(doc.read(example::sea_section()).table == dir.path() + "/data/forces.csv");
  doc.finish();
  Document gone = load(dir.file("sub/gone.toml", "[sea]\ntable = \"forces.csv\"\n"));
  gone.read(example::sea_section());
  CHECK_THROWS_WITH(gone.finish(), Catch::Contains("gone.toml:2: sea.table = \"forces.csv\": " + dir.path() +
                                                   "/sub/forces.csv: no such file in " + dir.path() + "/sub"));
}

TEST_CASE("a default that follows from the rest of the scene counts where the scene says nothing", "[scene][fast]") {
  Document doc = parse("[time]\nend_s = 2.0\nmost_steps = 7\n", "s.toml", "/");
  doc.add_defaults({"time.most_steps=3", "time.window_s=0.5", "sea.depth_m=20.0"});
  const example::TimeOptions time = doc.read(example::time_section());
  CHECK(time.most_steps == 7);
  CHECK(time.window_s == 0.5);
  CHECK(doc.given("sea.depth_m"));
  CHECK_THAT(doc.echo(), Catch::Contains("window_s = 0.5"));
  Document wrong = parse("time = 3\n", "s.toml", "/");
  wrong.add_defaults({"time.window_s=0.5"});
  wrong.read(example::time_section());
  CHECK_THROWS_WITH(wrong.finish(), Catch::Contains("s.toml:1: time") && !Catch::Contains("window_s"));
}

TEST_CASE("a file beside the folder of a scene is found through a link to that folder, as a base is", "[scene][fast]") {
  const Temporary dir;
  const std::string right = dir.file("real/table.csv", "right");
  dir.file("table.csv", "wrong"), dir.file("real/base.toml", "[time]\nend_s = 1.0\n");
  dir.file("real/scenes/scene.toml", "base = \"../base.toml\"\n[sea]\ntable = \"../table.csv\"\n");
  std::filesystem::create_directory_symlink(dir.path() + "/real/scenes", dir.path() + "/link");
  Document linked = load(dir.path() + "/link/scene.toml");
  CHECK(linked.read(example::time_section()).end_s == 1.0);
  CHECK(linked.read(example::sea_section()).table == std::filesystem::canonical(right).string());
  std::filesystem::remove(right);
  Document gone = load(dir.path() + "/link/scene.toml");
  gone.read(example::sea_section());
  CHECK_THROWS_WITH(gone.finish(), Catch::Matchers::Contains("real/table.csv: no such file"));
}
