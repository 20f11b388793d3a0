// spindrift run: reads the scene, runs it into a run directory, writes summary and report.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <optional>
#include <utility>

#include "src/app/scene_file.hpp"
#include "src/app/scene_run.hpp"
#include "src/coupling/flow_run.hpp"
#include "src/coupling/placement.hpp"
#include "src/coupling/run.hpp"
#include "src/io/build_info.hpp"
#include "src/io/history_statistics.hpp"
#include "src/io/log.hpp"
#include "src/report/report.hpp"
#include "src/scene/document.hpp"

namespace spindrift::app {

namespace {

io::RunDirectory open_directory(const RunArguments& arguments, MPI_Comm world) {
  const std::filesystem::path path =
      arguments.out.empty() ? io::RunDirectory::default_path(world, arguments.scene) : std::filesystem::path(arguments.out);
  const io::Existing existing = arguments.restart     ? io::Existing::resume
                                : arguments.overwrite ? io::Existing::overwrite
                                                      : io::Existing::refuse;
  return io::RunDirectory(world, path, existing);
}

/// Over which the summary gives means: the whole run, and (the one that the report shows) the end of it.
std::vector<io::TimeRange> mean_ranges(const coupling::Scenario& scenario, double end_s) {
  const double length = scenario.output.mean_length(end_s);
  return {{"whole_run", 0.0, end_s}, {fmt::format("last_{:g}_s", length), end_s - length, end_s}};
}

void print_summary(const io::Summary& summary, const io::RunDirectory& directory) {
  spdlog::info("{}: {:g} s simulated in {:.3g} s, {:.3g} times real time", summary.exit_reason,
               summary.end_time_s - summary.start_time_s, summary.wall_seconds, io::real_time_factor(summary));
  for (const io::PartTime& part : summary.parts)
    spdlog::info("  {:<12}{:9.4f} s  {:5.1f} %", part.name, part.seconds, 100.0 * part.seconds / summary.wall_seconds);
  spdlog::info("results in {}", directory.path().string());
}

}  // namespace

namespace {
/// Machine and start of a scene that is not of the air alone.
ReadyScene made_ready(coupling::Scenario scenario, std::string echo) {
  ReadyScene ready;
  ready.machine = std::make_unique<coupling::Machine>(std::move(scenario));
  ready.start = make_start(*ready.machine);
  require_stable(*ready.machine, stability(*ready.machine, ready.start.state));
  ready.echo = std::move(echo);
  return ready;
}
}  // namespace

ReadyScene read_scene(const std::string& path, const std::vector<std::string>& overrides, const scene::Source& overrider) {
  scene::Document document = load_scene(path, overrides, overrider);
  coupling::Scenario scenario = coupling::read_scenario(document);
  return made_ready(std::move(scenario), document.echo());
}

namespace {
/// A scene of the air alone has no machine of bodies.
SceneRun run_flow_scene(const coupling::Scenario& scenario, const std::string& echo, const RunArguments& arguments,
                        const runtime::World& world) {
  const io::RunDirectory directory = open_directory(arguments, world.comm);
  io::log_to_file(world.rank, directory.log());
  directory.write_scene(world.comm, echo);
  coupling::RunSettings settings{.restart = arguments.restart, .trace = arguments.trace, .quiet = arguments.quiet};
  if (arguments.until_s >= 0.0) settings.until_s = arguments.until_s;
  io::Summary summary = coupling::run_flow(scenario, directory, world, settings);
  summary.title = scenario.output.title.empty() ? std::filesystem::path(arguments.scene).stem().string() : scenario.output.title;
  summary.scene = arguments.scene;
  if (world.rank == 0) {
    for (const std::string& trouble : summary.numerical_trouble) spdlog::error("{}", trouble);
    summary.warnings = io::warnings_logged();
    write_summary(directory.summary(), summary,
                  io::history_statistics(directory.history(), mean_ranges(scenario, summary.end_time_s)));
    print_summary(summary, directory);
  }
  return {std::move(summary), directory.path(), world.rank == 0};
}
}  // namespace

SceneRun run_scene(const RunArguments& arguments, const runtime::World& started, const scene::Source& overrider) {
  io::start_log(started.rank, arguments.quiet);
  std::optional<coupling::Scenario> scenario;
  std::string echo;
  coupling::agree(started, [&] {
    scene::Document document = load_scene(arguments.scene, arguments.overrides, overrider);
    scenario = coupling::read_scenario(document);
    echo = document.echo();
    return coupling::Started{arguments.fluid, echo,
                             fmt::format("--out {}\n--until {}\n--restart {}\n--overwrite {}\n--trace {}\n", arguments.out,
                                         arguments.until_s, arguments.restart, arguments.overwrite, arguments.trace)};
  });
  const runtime::Parts parts = coupling::place(*scenario, started, arguments.fluid);
  const runtime::World& world = parts.world();
  io::start_log(world.rank, arguments.quiet);
  if (scenario->has_flow()) return run_flow_scene(*scenario, echo, arguments, world);
  const ReadyScene scene = made_ready(std::move(*scenario), std::move(echo));
  const io::RunDirectory directory = open_directory(arguments, world.comm);
  io::log_to_file(world.rank, directory.log());
  directory.write_scene(world.comm, scene.echo);
  const io::BuildInfo& build = io::build_info();
  spdlog::info("spindrift {} ({}), {} rank{}: {}", build.version, build.commit, world.size, world.size == 1 ? "" : "s",
               arguments.scene);
  for (const std::string& note : scene.start.notes) spdlog::info("{}", note);

  coupling::RunSettings settings{.restart = arguments.restart, .trace = arguments.trace, .quiet = arguments.quiet};
  if (arguments.until_s >= 0.0) settings.until_s = arguments.until_s;
  io::Summary summary = coupling::run(*scene.machine, scene.start, directory, parts, settings);
  const std::string& title = scene.machine->scenario().output.title;
  summary.title = title.empty() ? std::filesystem::path(arguments.scene).stem().string() : title;
  summary.scene = arguments.scene;
  if (world.rank == 0) {
    for (const std::string& trouble : summary.numerical_trouble) spdlog::error("{}", trouble);
    summary.warnings = io::warnings_logged();
    write_summary(directory.summary(), summary,
                  io::history_statistics(directory.history(), mean_ranges(scene.machine->scenario(), summary.end_time_s)));
    print_summary(summary, directory);
  }
  return {std::move(summary), directory.path(), world.rank == 0};
}

int run(const RunArguments& arguments, const runtime::World& world) {
  const SceneRun run = run_scene(arguments, world);
  if (run.writes && !arguments.no_report) {
    spdlog::info("making the report");
    if (const report::Outcome made = report::write({.directories = {run.directory}}); !made.ok())
      spdlog::warn("no report: {}", made.trouble);
    else
      spdlog::info("report: {}", (run.directory / "report.html").string());
  }
  return run.summary.exit_code;
}

}  // namespace spindrift::app
