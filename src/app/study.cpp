// spindrift study: checks every scene of a study, forecasts each run, and hands the plan to the program that runs and judges it
// (src/report/spindrift_study.py). What a study file says: docs/user/studies.md. SPDX-License-Identifier: Apache-2.0
#include "src/scene/study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "kernels/base/failure.hpp"
#include "src/app/commands.hpp"
#include "src/app/forecast.hpp"
#include "src/app/scene_file.hpp"
#include "src/app/scene_run.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/saved_start.hpp"
#include "src/io/build_info.hpp"
#include "src/io/machine_failure.hpp"
#include "src/report/report.hpp"
#include "src/scene/columns.hpp"
#include "src/scene/error.hpp"
#include "src/scene/identity.hpp"
#include "src/scene/text_check.hpp"

namespace spindrift::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json of_options(const scene::StudyOptions& o) {
  return {{"design", name(o.design)},
          {"crossed", o.crossed},
          {"threads", o.threads},
          {"at_once", or_null(o.at_once)},
          {"budget_core_h", or_null(o.budget_core_h)},
          {"confidence", o.confidence},
          {"repeats", o.repeats}};
}

Json of_axis(const std::string& name, const scene::AxisOptions& axis) {
  Json points = Json::array();
  for (const scene::StudyPoint& point : points_of(name, axis)) points.push_back(point.name);
  return {{"name", name}, {"key", axis.key}, {"values", axis.values}, {"points", points}};
}

Json of_metric(const std::string& metric_name, const scene::MetricOptions& o) {
  return {{"name", metric_name},
          {"column", o.column},
          {"measure", name(o.measure)},
          {"from_s", o.from_s},
          {"until_s", or_null(o.until_s)},
          {"frequency_Hz", or_null(o.frequency_Hz)},
          {"wohler_exponent", o.wohler_exponent},
          {"relative", o.relative},
          {"divide_by", o.divide_by},
          {"target", or_null(o.target)}};
}

Json of_load_cases(const scene::LoadCasesOptions& o) {
  return {{"columns", o.columns},
          {"from_s", o.from_s},
          {"wind_axis", o.wind_axis},
          {"mean_wind_m_s", o.mean_wind_m_s},
          {"weibull_shape", o.weibull_shape},
          {"years", o.years},
          {"equivalent_cycles", o.equivalent_cycles},
          {"wohler_exponents", o.wohler_exponents}};
}

/// A scene that every check has passed, with the identity by which a finished run is known again.
struct Checked {
  std::string identity;
  Forecast forecast;
  std::optional<double> end_s;  ///< of its history; a march that ends where it has settled has none
};

/// Digests of files, each read once however many runs name it.
using Digests = std::map<std::string, scene::FileDigest>;

std::string identity_of(const std::string& echo, const scene::FileRecord& read, const coupling::Scenario& scenario,
                        Digests& digests) {
  scene::Identity identity{echo, {}};
  for (const auto* files : {&read.files(), &read.states()})
    for (const std::string& file : *files) {
      if (!digests.contains(file)) digests[file] = scene::digest_of(file);
      identity.files.push_back(digests[file]);
    }
  const auto& sea = scenario.sea.initial;
  for (const coupling::NamedState& named : {coupling::NamedState{"start.file", scenario.start.file},
                                            {"start.air", scenario.start.air},
                                            {"sea.initial.file", sea ? sea->file : std::string()}}) {
    const std::string& file = named.file;
    if (file.empty() || file.ends_with(".h5")) continue;
    const std::string newest = "newest of " + file;  // it stands for the newest checkpoint beside it, which a run replaces
    if (!digests.contains(newest))
      digests[newest] = scene::digest_of(coupling::open_saved(MPI_COMM_SELF, scenario, named).path());
    identity.files.push_back(digests[newest]);
  }
  return identity.text();
}

/// `forecasts`: with its forecast, for which the floating system is made; the replicas of a rung have that of the first.
Checked checked(const std::string& file, const std::vector<std::string>& overrides, const scene::Source& overrider,
                bool forecasts, Digests& digests) {
  scene::Document document = scene::load(file, overrides, overrider);
  const scene::FileRecord read;
  const coupling::Scenario scenario = coupling::read_scenario(document);
  const std::string identity = identity_of(document.echo(), read, scenario, digests);
  if (!forecasts) return {identity, {}, {}};
  const double before = processor_seconds(), end_s = scenario.time.end_s;
  if (scenario.has_flow())
    return {identity, forecast_of_air(scenario), scenario.aero.flow->time == "steady" ? std::nullopt : std::optional(end_s)};
  const ReadyScene ready = read_scene(file, overrides, overrider);
  const double start_s = processor_seconds() - before;
  Checked checked{identity, forecast(*ready.floating, ready.start), end_s};
  checked.forecast.core_seconds += start_s;
  return checked;
}

/// Of many runs of a study, the one whose scene is wrong.
template <class Check>
auto naming(const std::string& run, Check&& check) {
  const std::string of = fmt::format(" (in configuration {})", run);
  try {
    return check();
  } catch (const scene::SceneError& e) {
    std::vector<scene::Problem> problems = e.problems();
    for (scene::Problem& problem : problems) problem.message += of;
    throw scene::SceneError(std::move(problems));
  } catch (const io::InputError& e) { throw io::InputError(e.what() + of); } catch (const NumericalFailure& e) {
    throw NumericalFailure(e.what() + of, e.place, e.step, e.time_s, e.limit);
  }
}

/// Once, whatever number of runs has it.
void add_once(std::vector<scene::Problem>& problems, const scene::Problem& problem) {
  if (std::ranges::none_of(problems, [&](const scene::Problem& p) { return p.key == problem.key && p.value == problem.value; }))
    problems.push_back(problem);
}

/// Misspelt columns are found before anything runs.
void check_columns(const scene::Study& study, const std::string& rung, const std::vector<std::string>& columns,
                   std::vector<scene::Problem>& problems) {
  if (columns.empty()) return;
  const auto check = [&](const std::string& key, const std::string& column) {
    if (std::find(columns.begin(), columns.end(), column) != columns.end()) return;
    const std::string near = scene::nearest(column, columns);
    add_once(problems, {study.file, 0, key, fmt::format("\"{}\"", column),
                        fmt::format("is no column of {}{}", rung, near.empty() ? "" : "; did you mean \"" + near + "\"?")});
  };
  for (const auto& [metric, options] : study.metrics) check(fmt::format("metrics.{}.column", metric), options.column);
  if (study.load_cases)
    for (const std::string& column : study.load_cases->columns) check("load_cases.columns", column);
}

/// What is taken of a run begins before its end.
void check_starts(const scene::Study& study, const std::string& rung, double end_s, std::vector<scene::Problem>& problems) {
  const auto check = [&](const std::string& key, double from_s) {
    if (from_s >= end_s)
      add_once(problems, {study.file, 0, key, fmt::format("{:g}", from_s),
                          fmt::format("must be before the end of {}, {:g} s", rung, end_s)});
  };
  for (const auto& [metric, options] : study.metrics) check(fmt::format("metrics.{}.from_s", metric), options.from_s);
  if (study.load_cases) check("load_cases.from_s", study.load_cases->from_s);
}

struct TimeRange {
  double from_s, to_s;
};

/// Times of a reference from elsewhere, which must have the columns too.
std::optional<TimeRange> range_of_history(const scene::Study& study) {
  if (!study.reference || study.reference->history.empty()) return {};
  const scene::Columns columns = scene::read_columns(study.reference->history);
  for (const auto& [metric, options] : study.metrics) static_cast<void>(columns[options.column]);
  columns.require_rows(2);
  columns.require_increasing("time_s", "a history goes forward in time");
  return TimeRange{columns["time_s"].front(), columns["time_s"].back()};
}

/// A reference from elsewhere covers the time that each metric takes of a run, so that both are of the same time.
void check_range(const scene::Study& study, const std::string& rung, double end_s, const TimeRange& reference,
                 std::vector<scene::Problem>& problems) {
  constexpr double least = 0.95;
  for (const auto& [metric, options] : study.metrics) {
    const double from_s = options.from_s, until_s = std::min(options.until_s.value_or(end_s), end_s);
    const double both_s = std::min(until_s, reference.to_s) - std::max(from_s, reference.from_s);
    if (until_s <= from_s || both_s >= least * (until_s - from_s)) continue;
    add_once(problems,
             {study.file, 0, "metrics." + metric, "",
              fmt::format(
                  "the reference {} covers {:g} to {:g} s, which is {:.3g} % of the {:g} to {:g} s taken of {}; at least {:g} % "
                  "are needed: give a longer history, or from_s and until_s within it",
                  study.reference->history, reference.from_s, reference.to_s, 100.0 * std::max(0.0, both_s) / (until_s - from_s),
                  from_s, until_s, rung, 100.0 * least)});
  }
}

Json of_rung(const scene::Study& study, const scene::StudyRun& rung, const std::optional<TimeRange>& reference, Digests& digests,
             std::vector<scene::Problem>& problems) {
  Json out{{"name", rung.name},
           {"variant", rung.variant},
           {"scene", fs::absolute(rung.scene).string()},
           {"at", rung.at},
           {"later", rung.later},
           {"fixed", study.replicas && rung.replicas == 0},
           {"safety_factor", rung.safety_factor},
           {"fatigue", rung.fatigue},
           {"runs", Json::array()}};
  const std::vector<scene::StudyPoint> replicas =
      study.replicas && rung.replicas > 0 ? points_of("replica", *study.replicas) : std::vector<scene::StudyPoint>{{}};
  std::optional<Forecast> first;
  for (int n = 0; n < std::max(rung.replicas, 1); ++n) {
    std::vector<std::string> set = rung.overrides;
    set.insert(set.end(), replicas[std::size_t(n)].set.begin(), replicas[std::size_t(n)].set.end());
    const std::string& replica = replicas[std::size_t(n)].name;
    const std::string name = replica.empty() ? rung.name : rung.name + "/" + replica;
    const Checked scene = naming(name, [&] { return checked(rung.scene, set, {study.file, study.directory}, n == 0, digests); });
    if (!first) {
      first = scene.forecast;
      check_columns(study, rung.name, first->columns, problems);
      if (scene.end_s) check_starts(study, rung.name, *scene.end_s, problems);
      if (reference && scene.end_s) check_range(study, rung.name, *scene.end_s, *reference, problems);
    }
    out["runs"].push_back({{"name", name},
                           {"set", set},
                           {"identity", scene.identity},
                           {"forecast_core_s", first->core_seconds},
                           {"forecast_bytes", first->bytes}});
  }
  return out;
}

}  // namespace

int study(const StudyArguments& arguments, const runtime::World& world) {
  require_study(arguments.file);
  if (world.size > 1)
    throw scene::SceneError({{arguments.file, 0, "", "", "a study starts its runs itself: call spindrift study without mpirun"}});
  const scene::Study study = scene::read_study(arguments.file, arguments.overrides);
  const std::optional<TimeRange> reference = range_of_history(study);
  const fs::path folder = arguments.out.empty() ? fs::path("runs") / fs::path(arguments.file).stem() : fs::path(arguments.out);
  if (fs::exists(folder / "history.csv") && !fs::exists(folder / "plan.json"))
    throw io::InputError(fmt::format("--out {}: is the folder of a run; a study has a folder of its own, name another with --out",
                                     folder.string()));
  Json plan{{"study", study.file},
            {"program", fs::read_symlink("/proc/self/exe").string()},
            {"commit", io::build_info().commit},
            {"directory", fs::absolute(study.directory.empty() ? "." : study.directory).string()},
            {"options", of_options(study.study)},
            {"axes", Json::array()},
            {"replicas", study.replicas ? of_axis("replica", *study.replicas) : Json(nullptr)},
            {"reference", nullptr},
            {"metrics", Json::array()},
            {"load_cases", study.load_cases ? of_load_cases(*study.load_cases) : Json(nullptr)},
            {"rungs", Json::array()}};
  for (const auto& [name, axis] : study.axes) plan["axes"].push_back(of_axis(name, axis));
  for (const auto& [name, metric] : study.metrics) plan["metrics"].push_back(of_metric(name, metric));
  if (const auto& r = study.reference)
    plan["reference"] = {
        {"variant", r->variant}, {"history", r->history.empty() ? "" : fs::absolute(r->history).string()}, {"limit", r->limit}};
  std::vector<scene::Problem> problems;
  Digests digests;
  for (const scene::StudyRun& rung : expand(study)) plan["rungs"].push_back(of_rung(study, rung, reference, digests, problems));
  if (!problems.empty()) throw scene::SceneError(problems);

  if (!arguments.dry_run) fs::create_directories(folder);
  const fs::path file =
      arguments.dry_run ? fs::temp_directory_path() / fmt::format("spindrift_plan_{}.json", getpid()) : folder / "plan.json";
  std::ofstream(file) << plan.dump(1) << "\n";
  std::vector<std::string> words{file};
  if (arguments.dry_run) words.insert(words.end(), {"--dry-run", folder});
  hand_over([words] { report::become("spindrift_study.py", words); });
  return done;
}

}  // namespace spindrift::app
