// Laws of src/scene/study.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/scene/study.hpp"

#include <catch2/catch.hpp>

#include "tests/src/scene/example_sections.hpp"
#include "tests/src/scene/temporary.hpp"

using namespace spindrift;
using namespace spindrift::scene;

namespace {
std::string complaint(const Temporary& dir, std::string_view study) {
  dir.file("scene.toml", "[time]\nend_s = 1.0\n");
  try {
    read_study(dir.file("study.toml", "[study]\nscene = \"scene.toml\"\n" + std::string(study)));
  } catch (const SceneError& error) { return error.what(); }
  return "";
}
}  // namespace

TEST_CASE("a study is the product of its variants and axes, the last axis fastest", "[scene][fast]") {
  const Temporary dir;
  dir.file("scene.toml", "[time]\nend_s = 1.0\n");
  const Study study = read_study(dir.file("study.toml", R"(
[study]
scene = "scene.toml"
set = ["time.end_s=60"]
[variants.fine]
alone = true
set = ["time.window_s=0.001"]
[variants.strips]
set = ["sea.model=morison"]
[variants.calm]
[axes.step]
key = "time.window_s"
values = [0.1, 0.05]
[axes.sea]
[[axes.sea.points]]
name = "mild"
set = ["bodies.a.mass_kg=1"]
[[axes.sea.points]]
name = "very rough"
set = ["bodies.a.mass_kg=2", "bodies.a.pitch_deg=3"]
[reference]
variant = "fine"
[metrics.pitch]
column = "platform.pitch_deg"
target = 0.01
)"));
  std::vector<std::string> names;
  const auto runs = expand(study);
  for (const StudyRun& run : runs) names.push_back(run.name);
  CHECK(names == std::vector<std::string>{"fine", "strips-step_0.1-sea_mild", "strips-step_0.1-sea_very_rough",
                                          "strips-step_0.05-sea_mild", "strips-step_0.05-sea_very_rough",
                                          "calm-step_0.1-sea_mild", "calm-step_0.1-sea_very_rough", "calm-step_0.05-sea_mild",
                                          "calm-step_0.05-sea_very_rough"});
  CHECK(runs[0].overrides == std::vector<std::string>{"time.end_s=60", "time.window_s=0.001"});
  CHECK(runs[4].overrides == std::vector<std::string>{"time.end_s=60", "sea.model=morison", "time.window_s=0.05",
                                                      "bodies.a.mass_kg=2", "bodies.a.pitch_deg=3"});
  Document doc = load(study.study.scene, runs[4].overrides, {study.file, study.directory});
  CHECK(doc.read(example::time_section()).window_s == 0.05);
  CHECK(doc.read(example::sea_section()).model == "morison");
}

TEST_CASE("a study without variants or axes is its scene", "[scene][fast]") {
  const Temporary dir;
  dir.file("scene.toml", "");
  const auto runs = expand(read_study(dir.file("study.toml", "[study]\nscene = \"scene.toml\"\n")));
  REQUIRE(runs.size() == 1);
  CHECK(runs[0].name == "base");
  CHECK(runs[0].overrides.empty());
}

TEST_CASE("what is wrong with a study is told like what is wrong with a scene", "[scene][fast]") {
  const Temporary dir;
  const std::string file = dir.path() + "/study.toml";
  CHECK(complaint(dir, "set = [\"time.end_s\"]\n") ==
        file + ":3: study.set[0] = \"time.end_s\": is no override; write SECTION.KEY=VALUE");
  CHECK(complaint(dir, "[axes.a]\nkey = \"x.y\"\n") == file + ":3: axes.a: give exactly one of: values, points");
  CHECK(complaint(dir, "[axes.a]\nkey = \"x..y\"\nvalues = [1]\n") == file + ":4: axes.a.key = \"x..y\": is no key of a scene");
  CHECK(complaint(dir, "[variants.fine]\n[reference]\nvariant = \"fime\"\n") ==
        file + ":5: reference.variant = \"fime\": is no run of this study; did you mean 'fine'?");
  CHECK(complaint(dir, "[metrics.m]\ncolumn = \"x\"\n") ==
        file + ":3: metrics.m.measure: rms and max compare two histories and need a [reference]; mean and the others do not");
  CHECK(
      complaint(dir, "[axes.h]\nkey = \"x.h\"\nvalues = [1, 2, 3]\n[reference]\nlimit = \"h\"\n[metrics.m]\ncolumn = \"x\"\n") ==
      file +
          ":8: metrics.m.measure: rms and max compare two histories, and reference.limit is that of a number; take mean, "
          "peak, amplitude or another one");
  CHECK(complaint(dir, "[metrics.m]\ncolumn = \"x\"\nmeasure = \"mean\"\ntarget = 1.0\n") ==
        file + ":6: metrics.m.target = 1.0: needs a [reference] to measure against");
  CHECK(complaint(dir, "[axes.a]\nkey = \"x.y\"\nvalues = [\"a\", \"a\"]\n") ==
        file + ": variants: two runs would be called 'base-a_a'");
  CHECK(complaint(dir, "[study2]\n") == file + ":3: study2: unknown section; did you mean [study]?");
  std::string many;
  for (char c = 'a'; c < 'f'; ++c)
    many += std::string("[axes.") + c + "]\nkey = \"x." + c + "\"\nvalues = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n";
  CHECK(complaint(dir, "[axes.a]\nkey = \"x.y\"\nvalues = [1, 2]\n[axes.b]\nkey = \"x\"\nvalues = [1, 2]\n") ==
        file + ":7: axes.b.key = \"x\": sets x.y, as axes.a does: a key is on one axis alone");
  CHECK(complaint(dir, many) == file + ":3: axes: give 100000 runs; at most 10000");
}

TEST_CASE("the declarations of a study are sound", "[scene][fast]") {
  for (const SectionBase* section : study_sections()) CHECK(section->faults() == std::vector<std::string>{});
}

TEST_CASE("designs take the pivot and what leaves it on one axis, or on two", "[scene][fast]") {
  const Temporary dir;
  dir.file("scene.toml", "");
  dir.file("dear.toml", "");
  const auto runs = [&](const std::string& design) {
    return expand(read_study(dir.file("study.toml", R"(
[study]
scene = "scene.toml"
design = ")" + design + R"("
[variants.a]
[variants.dear]
scene = "dear.toml"
alone = true
replicas = 1
[axes.x]
key = "s.x"
values = [1, 2]
[axes.y]
key = "s.y"
values = [1, 2, 3]
[replicas]
key = "s.seed"
values = [7, 8]
)")));
  };
  const auto names = [](const std::vector<StudyRun>& all) {
    std::vector<std::string> result;
    for (const StudyRun& run : all) result.push_back(run.name + (run.later ? " later" : ""));
    return result;
  };
  CHECK(names(runs("one_at_a_time")) == std::vector<std::string>{"a", "a-y_2", "a-y_3", "a-x_2", "dear"});
  CHECK(names(runs("pairs")) ==
        std::vector<std::string>{"a", "a-y_2", "a-y_3", "a-x_2", "a-x_2-y_2 later", "a-x_2-y_3 later", "dear"});
  CHECK(names(runs("product")).size() == 7);
  const std::vector<StudyRun> all = runs("one_at_a_time");
  CHECK(all[3].overrides == std::vector<std::string>{"s.x=2", "s.y=1"});
  CHECK(all[3].replicas == 2);
  CHECK(all[4].replicas == 1);
  CHECK(all[4].scene.ends_with("dear.toml"));
  CHECK(all[4].overrides.empty());
}

TEST_CASE("a limit needs an axis of three numbers, a measure what it looks at", "[scene][fast]") {
  const Temporary dir;
  const std::string limit = "[axes.h]\nkey = \"x.h\"\nvalues = [1, 2]\n[reference]\nlimit = ";
  CHECK_THAT(complaint(dir, limit + "\"h\"\n"), Catch::Contains("needs at least three values"));
  CHECK_THAT(complaint(dir, limit + "\"k\"\n"), Catch::Contains("is no axis of this study"));
  const std::string metric = "[variants.a]\n[reference]\nvariant = \"a\"\n[metrics.m]\ncolumn = \"x\"\n";
  CHECK_THAT(complaint(dir, metric + "measure = \"phase\"\n"), Catch::Contains("frequency_Hz"));
  CHECK_THAT(complaint(dir, metric + "relative = true\n"), Catch::Contains("rms and max compare histories"));
  CHECK(complaint(dir, metric + "measure = \"damage\"\nwohler_exponent = 10.0\nrelative = true\n") == "");
}
