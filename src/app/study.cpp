// spindrift study: runs the variants of a study, measures their error against their cost, prints the front and the cheapest run
// that meets the targets, and writes study.json and study.html. What a study file says: docs/user/scenes.md.
// SPDX-License-Identifier: Apache-2.0
#include "src/scene/study.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "src/app/commands.hpp"
#include "src/app/scene_file.hpp"
#include "src/app/scene_run.hpp"
#include "src/io/log.hpp"
#include "src/report/report.hpp"
#include "src/scene/columns.hpp"
#include "src/scene/study_front.hpp"

namespace spindrift::app {

namespace {

using Errors = std::vector<std::optional<double>>;

struct Outcome {
  std::string name;
  int exit_code = 0;
  std::string exit_reason;
  double core_seconds = 0.0;
  std::filesystem::path history;
  Errors errors;                    ///< by metric
  std::optional<double> shortfall;  ///< largest error over its target; at most 1 is good enough
};

Outcome run_variant(const scene::Study& study, const scene::StudyRun& variant, const std::filesystem::path& folder,
                    const runtime::World& world) {
  RunArguments arguments;
  arguments.scene = study.study.scene;
  arguments.overrides = variant.overrides;
  arguments.out = (folder / variant.name).string();
  arguments.overwrite = arguments.quiet = true;
  const SceneRun run = run_scene(arguments, world, {study.file, study.directory});
  return {.name = variant.name,
          .exit_code = run.summary.exit_code,
          .exit_reason = run.summary.exit_reason,
          .core_seconds = run.summary.wall_seconds * run.summary.ranks * run.summary.threads,
          .history = run.directory / "history.csv"};
}

/// Errors of all runs against the reference, metric by metric. A run that failed has none.
void judge(const scene::Study& study, std::vector<Outcome>& outcomes) {
  if (!study.reference) return;
  std::filesystem::path reference = study.reference->history;
  for (const Outcome& o : outcomes)
    if (o.name == study.reference->variant) reference = o.history;
  const scene::Columns truth = scene::read_columns(reference.string());
  for (Outcome& o : outcomes) {
    o.errors.assign(study.metrics.size(), std::nullopt);
    if (o.exit_code != done) continue;
    const scene::Columns run = scene::read_columns(o.history.string());
    for (std::size_t m = 0; m < study.metrics.size(); ++m) {
      const scene::MetricOptions& metric = study.metrics[m].options;
      o.errors[m] = metric_error(metric, {run["time_s"], run[metric.column]}, {truth["time_s"], truth[metric.column]});
    }
    o.shortfall = scene::shortfall(study.metrics, o.errors);
  }
}

/// One number to rank by: the error over its target where there are targets, else the first metric.
std::optional<double> overall(const Outcome& o) {
  if (o.shortfall) return o.shortfall;
  return o.errors.empty() ? std::nullopt : o.errors.front();
}

struct Verdict {
  std::vector<std::string> front;       ///< cheapest first
  std::optional<std::string> cheapest;  ///< that meets every target
};

Verdict verdict(const scene::Study& study, const std::vector<Outcome>& outcomes) {
  std::vector<scene::Judged> judged;
  std::vector<std::string> names;
  for (const Outcome& o : outcomes) {
    const std::optional<double> error = overall(o);
    const bool is_reference = study.reference && o.name == study.reference->variant;  // its error is zero by definition
    if (error && !is_reference) judged.push_back({*error, o.core_seconds}), names.push_back(o.name);
  }
  Verdict v;
  for (const std::size_t i : scene::front(judged)) v.front.push_back(names[i]);
  const bool targets =
      std::any_of(study.metrics.begin(), study.metrics.end(), [](const auto& m) { return m.options.target.has_value(); });
  if (targets)
    if (const auto best = scene::cheapest(judged, 1.0)) v.cheapest = names[*best];
  return v;
}

bool on(const std::vector<std::string>& front, const std::string& name) {
  return std::find(front.begin(), front.end(), name) != front.end();
}

void print(const scene::Study& study, const std::vector<Outcome>& outcomes, const Verdict& v) {
  fmt::print("\n{:<40}{:>12}", "run", "core-s");
  for (const auto& metric : study.metrics) fmt::print("{:>16}", metric.name);
  fmt::print("\n");
  for (const Outcome& o : outcomes) {
    fmt::print("{:<40}{:>12.4g}", o.name, o.core_seconds);
    for (const auto& error : o.errors) fmt::print("{:>16}", error ? fmt::format("{:.4g}", *error) : "-");
    fmt::print("{}{}\n", on(v.front, o.name) ? "  on the front" : "", o.exit_code == done ? "" : "  " + o.exit_reason);
  }
  if (v.cheapest) fmt::print("\ncheapest run that meets every target: {}\n", *v.cheapest);
}

void write_json(const scene::Study& study, const std::vector<Outcome>& outcomes, const Verdict& v,
                const std::filesystem::path& file) {
  nlohmann::ordered_json json;
  json["study"] = study.file;
  json["reference"] =
      study.reference ? (study.reference->variant.empty() ? study.reference->history : study.reference->variant) : "";
  for (const auto& metric : study.metrics)
    json["metrics"].push_back({{"name", metric.name},
                               {"column", metric.options.column},
                               {"target", metric.options.target ? nlohmann::ordered_json(*metric.options.target) : nullptr}});
  for (const Outcome& o : outcomes) {
    nlohmann::ordered_json run{{"name", o.name},
                               {"exit_code", o.exit_code},
                               {"exit_reason", o.exit_reason},
                               {"core_seconds", o.core_seconds},
                               {"on_front", on(v.front, o.name)}};
    for (std::size_t m = 0; m < o.errors.size(); ++m)
      run["errors"][study.metrics[m].name] = o.errors[m] ? nlohmann::ordered_json(*o.errors[m]) : nullptr;
    json["runs"].push_back(run);
  }
  json["cheapest_within_targets"] = v.cheapest ? nlohmann::ordered_json(*v.cheapest) : nullptr;
  std::ofstream(file) << json.dump(2) << "\n";
}

}  // namespace

int study(const StudyArguments& arguments, const runtime::World& world) {
  require_study(arguments.file);
  const scene::Study study = scene::read_study(arguments.file, arguments.overrides);
  const std::vector<scene::StudyRun> runs = expand(study);
  const std::filesystem::path folder = arguments.out.empty()
                                           ? std::filesystem::path("runs") / std::filesystem::path(arguments.file).stem()
                                           : std::filesystem::path(arguments.out);
  for (const scene::StudyRun& run : runs)
    read_scene(study.study.scene, run.overrides, {study.file, study.directory});  // every scene is right before the first runs

  std::vector<Outcome> outcomes;
  for (const scene::StudyRun& run : runs) {
    spdlog::info("run {} of {}: {}", outcomes.size() + 1, runs.size(), run.name);
    outcomes.push_back(run_variant(study, run, folder, world));
    io::start_log(world.rank, false);
  }
  if (world.rank != 0) return done;
  judge(study, outcomes);
  const Verdict v = verdict(study, outcomes);
  print(study, outcomes, v);
  write_json(study, outcomes, v, folder / "study.json");
  if (const report::Outcome made = report::write({.directories = {folder}}); !made.ok())
    spdlog::warn("no report: {}", made.trouble);
  else
    spdlog::info("report: {}", (folder / "study.html").string());
  const bool failed = std::any_of(outcomes.begin(), outcomes.end(), [](const Outcome& o) { return o.exit_code != done; });
  return failed ? numerical_failure : done;
}

}  // namespace spindrift::app
