// spindrift run: reads the scene, runs it into a run directory, writes summary and report.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <omp.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

#include "kernels/base/failure.hpp"
#include "runtime/executor/watchdog.hpp"
#include "runtime/mpi/affinity.hpp"
#include "runtime/mpi/heartbeat.hpp"
#include "runtime/mpi/parts.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "src/app/forecast.hpp"
#include "src/app/scene_file.hpp"
#include "src/app/scene_run.hpp"
#include "src/coupling/doubts.hpp"
#include "src/coupling/limits.hpp"
#include "src/coupling/memory_limits.hpp"
#include "src/coupling/placement.hpp"
#include "src/io/build_info.hpp"
#include "src/io/checkpoint.hpp"
#include "src/io/collective.hpp"
#include "src/io/history_statistics.hpp"
#include "src/io/log.hpp"
#include "src/io/machine_failure.hpp"
#include "src/io/openfast_file.hpp"
#include "src/report/report.hpp"
#include "src/run/driver.hpp"
#include "src/run/outputs.hpp"
#include "src/scene/angle_doubts.hpp"
#include "src/scene/document.hpp"
#include "src/scene/error.hpp"
#include "src/scene/identity.hpp"
#include "src/scene/toml_reader.hpp"

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

/// What a restart may change without being told so: how long the run is, what it writes, and where it is computed.
const std::vector<std::string> free_at_restart = {"time.end_s",         "output",     "checkpoint",         "runtime",
                                                  "coupling.placement", "sea.fields", "aero.flow.surfaces", "coupling.air_ranks"};

/// What no restart can change: a checkpoint has those states of steps before that its own scheme needs.
bool is_of_scheme_in_time(const scene::Difference& d) {
  const bool comes_or_goes = d.before == "absent" || d.now == "absent";
  return d.what == "aero.flow.time" || (d.what == "aero.flow.time_tolerance" && comes_or_goes);
}

/// A restart goes on with the run that the checkpoint is of: refused before anything is written where it would be another one.
/// Returns whether the scene changed by what is allowed.
bool require_same_run(io::RunDirectory& directory, const scene::Identity& now, const RunArguments& arguments, MPI_Comm world) {
  directory.identify(now.text());
  if (!directory.resumes()) return false;
  const std::string saved = io::CheckpointSeries(world, directory.checkpoints(), 1).newest_identity();
  if (saved.empty()) {  // where none can be read, this says which and why
    if (!io::CheckpointSeries(world, directory.checkpoints(), 1).newest()) throw io::only_damaged(directory.checkpoints());
    return false;
  }
  const scene::Identity first = scene::Identity::parsed(saved);
  const std::vector<scene::Difference> changed = differences(first, now, free_at_restart);
  for (const std::string& key : arguments.allowed)
    if (key != "history.csv" && !names_part_of(now, key) && !names_part_of(first, key))
      throw io::InputError("--allow-change " + key +
                           ": neither this scene nor that of the first run has a key or file of that name");
  if (!arguments.allowed.empty())
    for (const scene::Difference& d : changed)
      if (is_of_scheme_in_time(d))
        throw io::InputError(
            fmt::format("--restart: {}: was {}, is {}: a checkpoint has the steps that its own scheme needs, so "
                        "--allow-change cannot let this pass; begin anew",
                        d.what, d.before, d.now));
  std::vector<std::string> free = free_at_restart;
  free.insert(free.end(), arguments.allowed.begin(), arguments.allowed.end());
  const std::vector<scene::Difference> all = differences(first, now, free);
  if (all.empty()) return !changed.empty();
  std::string text = fmt::format("--restart: {} of this scene {} not as in the run in {}:", all.size() == 1 ? "a part" : "parts",
                                 all.size() == 1 ? "is" : "are", directory.path().string());
  for (const scene::Difference& d : all) text += fmt::format("\n  {}: was {}, is {}", d.what, d.before, d.now);
  throw io::InputError(text + "\ngo on with the scene of the first run, or say --allow-change KEY for each key or file above");
}

/// "3:12" or "3".
std::optional<std::pair<std::int64_t, std::int64_t>> windows_of(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::size_t colon = text.find(':');
  const std::int64_t first = std::stoll(text), last = colon == std::string::npos ? first : std::stoll(text.substr(colon + 1));
  return std::pair(first, last);
}

/// `held`: windows before t = 0, in which bodies are held.
void require_first_window(const std::string& windows, std::int64_t held) {
  const auto range = windows_of(windows);
  if (range && range->first < 1 - held)
    throw io::InputError(fmt::format("--windows {}: the first window of this run is {}", windows, 1 - held));
}

/// A file that is written at the end of the run can be written at its start.
void require_writable(const RunArguments& arguments, MPI_Comm world) {
  const std::string& file = arguments.record_graph;
  if (!arguments.windows.empty() && !arguments.trace && file.empty())
    throw io::InputError("--windows " + arguments.windows +
                         ": says which windows --trace and --record-graph take down; give one of these");
  if (file.empty()) return;
  io::on_root(world, [&] {
    errno = 0;
    if (!std::ofstream(file, std::ios::app))
      throw io::InputError(fmt::format("--record-graph {}: {}", file, std::strerror(errno)));
  });
}

/// Of the rows in the file, where the run did not come to its end; none where it did not come to a row.
io::HistoryStatistics statistics(const io::RunDirectory& directory, const coupling::Scenario& scenario, double end_s) {
  if (!std::filesystem::exists(directory.history())) return {};
  return io::history_statistics(directory.history(), run::mean_ranges(scenario.output, end_s));
}

/// The last time in a history.csv; 0 where there is none.
double last_time_s(const std::filesystem::path& history) {
  if (!std::filesystem::exists(history)) return 0.0;
  const io::HistoryStatistics rows = io::history_statistics(history, {});
  return rows.rows > 0 ? rows.columns.at(0).final : 0.0;
}

/// The summary of a run that began, however it ended: what is thrown becomes an exit code, and a sentence in summary.json, before
/// it goes on (a failure of the system, which the other ranks may not know of) or ends the run (what all ranks know). `known`:
/// what stands in it then, of which `run` may learn more.
io::Summary summary_of(const io::RunDirectory& directory, const runtime::World& world, io::Summary& known,
                       const std::function<io::Summary()>& run) {
  const io::SummaryOfOthers before(directory.summary());  // of all ranks but the first
  const auto end = [&](int code, const std::string& why) {
    known.exit_code = code, known.exit_reason = why;
    known.ranks = world.size;
    if (code == numerical_failure) known.numerical_trouble.push_back(why);
  };
  // A new run says what it was refused for; one that goes on keeps the summary that it has.
  const auto write = [&](int code, const std::string& why) {
    end(code, world.rank == 0 ? why : fmt::format("rank {}: {}", world.rank, why));
    if (world.rank == 0)
      write_summary(directory.summary(), known);
    else
      before.write_instead(known, world.rank);
  };
  const auto refused = [&](const std::string& why) {
    if (!directory.resumes()) write(bad_input, why);
  };
  try {
    return run();
  } catch (const io::InputError& refusal) {
    refused(refusal.what());
    throw;
  } catch (const scene::SceneError& refusal) {
    refused(refusal.what());
    throw;
  } catch (const runtime::StopAsked& why) {
    end(stopped,
        fmt::format("{}, before the first window; with --restart the run {}", why.what(),
                    directory.resumes() ? "goes on from its newest checkpoint" : "begins anew, air that settles where it was"));
    if (directory.resumes() && world.rank == 0) known.start_time_s = known.end_time_s = last_time_s(directory.history());
  } catch (const NumericalFailure& failure) { end(numerical_failure, failure.what()); } catch (const std::exception& failure) {
    write(machine_failure, failure.what());
    throw;
  }
  return known;
}

/// What the watchdog says, which ends a run that cannot end by itself, in summary.json. By whichever rank comes first, beside a
/// thread that waits in MPI.
std::function<void(const std::string&)> summary_by_force(const io::RunDirectory& directory, const runtime::World& world,
                                                         io::Summary summary) {
  summary.exit_code = machine_failure;
  return [summary = std::move(summary), found = io::SummaryOfOthers(directory.summary()), history = directory.history(),
          rank = world.rank, since = std::chrono::steady_clock::now()](const std::string& why) {
    try {
      io::Summary ended = summary;
      ended.exit_reason = "ended by the watchdog: " + why;
      ended.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
      ended.end_time_s = last_time_s(history);
      found.write_instead(ended, rank);
    } catch (const std::exception&) {}  // the process ends all the same
  };
}

/// Processor time of all ranks since each one's clock was at `since`, and memory. Collective.
void take_stock(io::Summary& summary, double since, const runtime::World& world) {
  const std::vector<double> all = runtime::summed(world.comm, {processor_seconds() - since, peak_memory()});
  summary.processor_seconds = all[0], summary.peak_memory_bytes = all[1];
}

/// What a run of the scene is called: its own title, or the name of its file. The title of a base, which this scene changes,
/// comes behind that name: "my_spar (on: A spar in waves)".
std::string title_of(const RunArguments& arguments, const std::string& title) {
  const std::string name = std::filesystem::path(arguments.scene).stem().string();
  if (title.empty()) return name;
  const bool given = std::ranges::any_of(arguments.overrides, [](const std::string& o) { return o.starts_with("output.title"); });
  std::ifstream file(arguments.scene);
  const scene::Value root = scene::read_toml(std::string{std::istreambuf_iterator<char>(file), {}}, 0, arguments.scene);
  const scene::Value* output = root.find("output");
  return given || (output != nullptr && output->find("title") != nullptr) ? title : fmt::format("{} (on: {})", name, title);
}

/// history.csv in a format of OpenFAST, where one is asked for. A file that cannot be written is said in the summary, and is the
/// end of a run that came to no worse one. Collective.
void write_openfast_file(io::Summary& summary, const io::RunDirectory& directory, const std::string& format,
                         const std::string& title, MPI_Comm world) {
  using Format = io::OpenFastFormat;
  if (format == "none" || summary.columns.empty()) return;  // no row was written
  try {
    io::on_root(world, [&] {
      write_openfast(directory.history(), summary.columns, format == "text" ? Format::text : Format::binary, title);
    });
  } catch (const io::MachineFailure& failure) {
    if (io::rank_of(world) == 0) spdlog::error("{}", failure.what());
    if (summary.exit_code == done) summary.exit_code = machine_failure, summary.exit_reason = failure.what();
  }
}

void print_summary(const io::Summary& summary, const io::RunDirectory& directory) {
  const double span = summary.end_time_s - summary.start_time_s;
  if (summary.pseudo_steps)
    spdlog::info("{}: {:g} pseudo-steps in {:.3g} s", summary.exit_reason, span, summary.wall_seconds);
  else
    spdlog::info("{}: {:g} s simulated in {:.3g} s, {:.3g} times real time", summary.exit_reason, span, summary.wall_seconds,
                 io::real_time_factor(summary));
  constexpr double least = 0.005;  // of the run's time; summary.json has all
  for (const io::PartTime& part : summary.parts)
    if (part.seconds >= least * summary.wall_seconds)
      spdlog::info("  {:<12}{:9.4f} s  {:5.1f} %", part.name, part.seconds, 100.0 * part.seconds / summary.wall_seconds);
  spdlog::info("results in {}", directory.path().string());
}

}  // namespace

namespace {
void warn(const scene::Doubts& doubts) {
  for (const scene::Doubt& doubt : doubts) spdlog::warn("{}", text(doubt));
}
/// Floating system and start of a scene that is not of the air alone.
ReadyScene made_ready(coupling::Scenario scenario, scene::Document& document) {
  ReadyScene ready;
  ready.floating = std::make_unique<coupling::FloatingSystem>(std::move(scenario));
  require_expected_columns(document, ready.floating->scenario().output, columns_of(*ready.floating));
  ready.echo = document.echo();
  ready.doubts = scene::angle_doubts(ready.echo);
  coupling::Stability found;
  try {
    ready.start = make_start(*ready.floating);
    found = stability(*ready.floating, ready.start.state);
    append(ready.doubts, coupling::doubts(*ready.floating, ready.start, found));
    append(ready.doubts, require_limits(*ready.floating, ready.start.state, found));
  } catch (const std::exception&) {  // what looks like the slip behind it
    if (found.linearisation.matrix.size() == 0) append(ready.doubts, coupling::doubts_as_described(*ready.floating));
    warn(ready.doubts);
    throw;
  }
  ready.modes = found.shown().modes;
  ready.floating->multibody().open_chart(ready.start.state, 0.0);  // the first solution begins from it
  return ready;
}
/// Those that have a stiffness or a damping.
std::vector<io::ModeLine> lines_of(const std::vector<bodies::Mode>& modes) {
  std::vector<io::ModeLine> lines;
  for (const bodies::Mode& mode : modes) {
    if (mode.eigenvalue == 0.0) continue;
    const bool oscillates = std::abs(mode.eigenvalue.imag()) > 1e-6;
    lines.push_back(
        {mode.name, oscillates ? 1.0 / mode.period_s() : 0.0, oscillates ? mode.damping_ratio() : mode.eigenvalue.real()});
  }
  return lines;
}
}  // namespace

ReadyScene read_scene(const std::string& path, const std::vector<std::string>& overrides, const scene::Source& overrider) {
  scene::Document document = load_scene(path, overrides, overrider);
  coupling::Scenario scenario = coupling::read_scenario(document);
  return by_lines_at_rest(document, [&] {
    coupling::require_memory(scenario, coupling::machine_memory());
    return made_ready(std::move(scenario), document);
  });
}

SceneRun run_scene(const RunArguments& arguments, const runtime::World& started, const scene::Source& overrider) {
  const double since = processor_seconds();
  runtime::StopRequest stop;  // a run that is asked to stop before it begins ends as one that was stopped, with its summary
  io::start_log(started.rank, arguments.quiet);
  std::optional<scene::Document> document;
  std::optional<coupling::Scenario> scenario;
  std::string echo;
  std::optional<scene::FileRecord> read;
  coupling::agree(started, [&] {
    document = load_scene(arguments.scene, arguments.overrides, overrider);
    read.emplace();
    scenario = coupling::read_scenario(*document);
    runtime::Watchdog::set_limit(scenario->runtime.watchdog_s);  // to the end of the program, whatever ranks do
    by_lines(*document, [&] {
      coupling::require_memory(*scenario, coupling::machine_memory() * started.size);  // of as many machines as there may be
    });
    echo = document->echo();
    return coupling::Started{
        arguments.fluid, echo,
        fmt::format("--out {}\n--until {}\n--restart {}\n--overwrite {}\n--trace {}\n--record-graph {}\n--windows {}\n",
                    arguments.out, arguments.until_s, arguments.restart, arguments.overwrite, arguments.trace,
                    arguments.record_graph, arguments.windows)};
  });
  const runtime::Parts parts = by_lines(*document, [&] { return coupling::place(*scenario, started, arguments.fluid); });
  const runtime::World& world = parts.world();
  io::start_log(world.rank, arguments.quiet);
  // Every check has passed before the run directory is made.
  std::optional<ReadyScene> system;
  if (!scenario->has_flow())
    system = by_lines_at_rest(*document, [&] { return made_ready(*scenario, *document); });
  else
    require_expected_columns(*document, scenario->output, columns_of_air_alone());
  require_first_window(arguments.windows, system ? system->floating->timeline().held_windows() : 0);
  require_writable(arguments, world.comm);
  io::RunDirectory directory = open_directory(arguments, world.comm);
  stop.watch(scenario->runtime.wall_limit_s, directory.stop());
  const bool changed = require_same_run(directory, scene::Identity::of(echo, read->files()), arguments, world.comm);
  io::log_to_file(world.rank, directory.log());
  directory.write_scene(world.comm, echo);
  const io::BuildInfo& build = io::build_info();
  spdlog::info("spindrift {} ({}), {} rank{}: {}", build.version, build.commit, world.size, world.size == 1 ? "" : "s",
               arguments.scene);
  const bool fluids = scenario->has_particles() || scenario->resolves_air();  // bodies take one thread
  const int threads = fluids ? omp_get_max_threads() : 1;
  const runtime::Affinity affinity = runtime::affinity(world, threads);
  spdlog::info("{}", affinity.places);
  if (world.rank == 0)
    for (const std::string& crowded : affinity.crowding) spdlog::warn("{}", crowded);

  run::RunSettings settings{
      .restart = directory.resumes(), .changed = changed, .trace = arguments.trace, .quiet = arguments.quiet, .threads = threads};
  settings.scene = arguments.scene, settings.record_graph = arguments.record_graph,
  settings.windows = windows_of(arguments.windows);
  settings.accept_history = std::ranges::find(arguments.allowed, "history.csv") != arguments.allowed.end();
  if (arguments.until_s >= 0.0) settings.until_s = arguments.until_s;
  if (arguments.until_s > scenario->time.end_s)
    spdlog::info(
        "--until {:g} s lies beyond the scene's end: the run ends at time.end_s = {:g} s, which --set time.end_s={:g} changes",
        arguments.until_s, scenario->time.end_s, arguments.until_s);
  if (system) {
    for (const std::string& note : system->start.notes) spdlog::info("{}", note);
    for (const std::string& note : coupling::resolution_notes(*system->floating)) spdlog::info("{}", note);
    if (!system->floating->rotors().empty())
      if (const std::string spread = system->floating->rotors()[0].loads.wind().spread(); !spread.empty())
        spdlog::info("wind: {}", spread);
    warn(system->doubts);
  } else {
    warn(scene::angle_doubts(echo));
    warn(coupling::air_doubts(*scenario));
  }
  // Before the run: meanwhile the file may be edited or gone.
  const std::string title = world.rank == 0 ? title_of(arguments, scenario->output.title) : "";
  io::Summary begun;
  begun.title = title, begun.scene = arguments.scene, begun.overrides = arguments.overrides;
  begun.ranks = world.size, begun.threads = threads;
  const auto says_begun = [&] { write_summary_of_start(directory.summary(), begun); };
  // Until a restart has begun the summary of the run before stands; one beside a new run is of a rank that ends it already.
  if (world.rank == 0 && directory.resumes())
    settings.began = says_begun;
  else if (world.rank == 0 && !std::filesystem::exists(directory.summary()))
    says_begun();
  const runtime::Heartbeat::LastWords last_words(summary_by_force(directory, world, begun));
  const auto complete = [&](io::Summary& summary) {
    summary.title = title;
    summary.scene = arguments.scene, summary.overrides = arguments.overrides;
    if (system) summary.modes = lines_of(system->modes);
    take_stock(summary, since, world);
    if (world.rank != 0) return;
    summary.warnings = io::warnings_logged();
    if (!summary.statistics) summary.statistics = statistics(directory, *scenario, summary.end_time_s);
    write_summary(directory.summary(), summary);
  };
  settings.ended = [&](const io::Summary& summary) { complete(begun = summary); };
  io::Summary summary = summary_of(directory, world, begun, [&] {
    return by_lines(*document, [&] {
      return system ? run::run(*system->floating, system->start, directory, parts, settings, stop)
                    : run::run_flow(*scenario, directory, parts, settings, stop);
    });
  });
  if (world.rank == 0 && summary.exit_code != done)  // else it was warned of
    for (const std::string& trouble : summary.numerical_trouble) spdlog::error("{}", trouble);
  write_openfast_file(summary, directory, scenario->output.openfast, title, world.comm);
  complete(summary);
  if (world.rank == 0) print_summary(summary, directory);
  stop.over();
  return {std::move(summary), directory.path(), world.rank == 0};
}

int run(const RunArguments& arguments, const runtime::World& world) {
  const SceneRun run = run_scene(arguments, world);
  if (run.writes && !arguments.no_report && run.summary.exit_code == stopped) {  // there may be no time for one
    spdlog::info("no report of a run that was stopped: spindrift report {} makes it", run.directory.string());
  } else if (run.writes && !arguments.no_report) {
    spdlog::info("making the report");
    runtime::StopRequest::give_signals_back();
    if (const report::Outcome made = report::write({.directories = {run.directory}, .says_verdict = !arguments.quiet});
        !made.ok())
      spdlog::warn("no report: {}", made.trouble);
    else
      spdlog::info("report: {}", (run.directory / "report.html").string());
  }
  return run.summary.exit_code;
}

}  // namespace spindrift::app
