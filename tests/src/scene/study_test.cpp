// Laws of src/scene/study.hpp and study_front.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/scene/study.hpp"

#include <catch2/catch.hpp>

#include <cmath>

#include "kernels/base/constants.hpp"
#include "src/scene/study_front.hpp"
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
  CHECK(complaint(dir, "[metrics.m]\ncolumn = \"x\"\n") == file + ":3: metrics: need a [reference] to measure against");
  CHECK(complaint(dir, "[axes.a]\nkey = \"x.y\"\nvalues = [\"a\", \"a\"]\n") ==
        file + ": variants: two runs would be called 'base-a_a'");
  CHECK(complaint(dir, "[study2]\n") == file + ":3: study2: unknown section; did you mean [study]?");
  std::string many;
  for (char c = 'a'; c < 'f'; ++c)
    many += std::string("[axes.") + c + "]\nkey = \"x.y\"\nvalues = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n";
  CHECK(complaint(dir, many) == file + ":3: axes: give 100000 runs; at most 10000");
}

TEST_CASE("the declarations of a study are sound", "[scene][fast]") {
  for (const SectionBase* section : study_sections()) CHECK(section->faults() == std::vector<std::string>{});
}

TEST_CASE("an error of a sine against its shifted self is known", "[scene][fast]") {
  // sin(t) + 0.1 against sin(t) on other times: rms, max, mean and last are all 0.1 up to the interpolation's h^2/8.
  std::vector<double> t, x, t_ref, x_ref;
  for (int i = 0; i <= 1000; ++i) t.push_back(2 * pi * i / 1000), x.push_back(std::sin(t.back()) + 0.1);
  for (int i = 0; i <= 1700; ++i) t_ref.push_back(2 * pi * i / 1700), x_ref.push_back(std::sin(t_ref.back()));
  for (const Measure measure : {Measure::rms, Measure::max, Measure::mean, Measure::last})
    CHECK(metric_error({.column = "x", .measure = measure}, {t, x}, {t_ref, x_ref}).value() == Approx(0.1).epsilon(2e-5));
  // The mean forgives what swings, the root mean square of it is 1/sqrt(2).
  const std::vector<double> zero(t.size(), 0.1);
  CHECK(metric_error({.column = "x", .measure = Measure::mean}, {t, x}, {t, zero}).value() == Approx(0.0).margin(1e-12));
  CHECK(metric_error({.column = "x", .divide_by = 0.5}, {t, x}, {t, zero}).value() == Approx(2 / std::sqrt(2.0)));
  CHECK(metric_error({.column = "x", .measure = Measure::max, .from_s = 0.0, .until_s = 0.5}, {t, x}, {t, zero}).value() ==
        Approx(std::sin(0.5)).epsilon(0.01));
}

TEST_CASE("uneven steps weigh by their length", "[scene][fast]") {
  const std::vector<double> t = {0.0, 1.0, 1.0 + 1e-9, 1.5, 2.0}, x = {0.0, 0.0, 1.0, 1.0, 1.0}, zero(5, 0.0);
  CHECK(metric_error({.column = "x", .measure = Measure::mean}, {t, x}, {t, zero}).value() == Approx(0.5));
  CHECK(metric_error({.column = "x", .measure = Measure::rms}, {t, x}, {t, zero}).value() == Approx(std::sqrt(0.5)));
}

TEST_CASE("an error that cannot be said is not said", "[scene][fast]") {
  const std::vector<double> t = {0.0, 1.0}, x = {0.0, 1.0}, later = {5.0, 6.0}, bad = {0.0, NAN};
  CHECK_FALSE(metric_error({.column = "x"}, {t, x}, {later, x}));
  CHECK_FALSE(metric_error({.column = "x"}, {t, bad}, {t, x}));
  CHECK_FALSE(metric_error({.column = "x"}, {{}, {}}, {t, x}));
}

TEST_CASE("the front holds what nothing beats, cheapest first; the cheapest good enough is on it", "[scene][fast]") {
  const std::vector<Judged> runs = {{0.10, 1.0}, {0.01, 10.0}, {0.05, 20.0}, {0.001, 100.0}, {0.2, 2.0}, {NAN, 0.1}};
  CHECK(front(runs) == std::vector<std::size_t>{0, 1, 3});
  CHECK(cheapest(runs, 0.05) == std::optional<std::size_t>(1));
  CHECK(cheapest(runs, 0.5) == std::optional<std::size_t>(0));
  CHECK_FALSE(cheapest(runs, 1e-4));
  const std::vector<Named<MetricOptions>> metrics = {
      {"a", {.column = "x", .target = 0.1}}, {"b", {.column = "y", .target = 2.0}}, {"c", {.column = "z"}}};
  CHECK(shortfall(metrics, std::vector<std::optional<double>>{0.05, 3.0, std::nullopt}).value() == Approx(1.5));
  CHECK_FALSE(shortfall(metrics, std::vector<std::optional<double>>{std::nullopt, 3.0, 1.0}));
}
