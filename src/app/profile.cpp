// spindrift profile: the same scene with its air alone, its sea alone, both in turns, shared and split; where the time of a
// window goes in each, and what doing both at once gains. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>

#include "runtime/mpi/stop_request.hpp"
#include "runtime/trace/clock.hpp"
#include "runtime/trace/efficiency.hpp"
#include "src/app/commands.hpp"
#include "src/app/scene_run.hpp"
#include "src/app/timeline.hpp"
#include "src/coupling/placement.hpp"
#include "src/io/log.hpp"
#include "src/io/machine_failure.hpp"
#include "src/run/driver.hpp"
#include "src/run/system_simulation.hpp"

namespace spindrift::app {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr int warm_up = 2;  // windows that are not counted: graphs are recorded, priorities follow costs

struct Mode {
  const char* name;
  const char* folder;
  std::vector<std::string> overrides;
  run::Moves moves = run::Moves::both;
};

std::vector<Mode> modes(int ranks, int air_ranks) {
  // Each side on what the other had at the window's start: the plainest way to do both at once, and the least that can go wrong.
  const std::string both = "coupling.scheme=\"cps\"", shared = "coupling.placement=\"shared\"";
  std::vector<Mode> all{{"air alone", "air", {both, shared}, run::Moves::air},
                        {"sea alone", "sea", {both, shared}, run::Moves::sea},
                        {"in turns", "turns", {"coupling.scheme=\"css\"", "coupling.predictor_order=0", shared}},
                        {"shared", "shared", {both, shared}}};
  if (ranks > 1)
    all.push_back({"split", "split", {both, "coupling.placement=\"split\"", fmt::format("coupling.air_ranks={}", air_ranks)}});
  return all;
}

/// Of the counted windows of one mode, all ranks together; core-seconds and seconds of one window.
struct Profile {
  std::string name;
  int ranks = 1, threads = 1, air_ranks = 0, windows = 0;
  double mean_s = 0.0, median_s = 0.0;             ///< wall of a window
  std::map<std::string, double> parts;             ///< [core-s]
  double busy_s = 0.0;                             ///< of them, in tasks
  double load_balance = 1.0, communication = 1.0;  ///< parallel efficiency is their product
  std::map<std::string, double> run_parts;         ///< [core-s] of the whole run, from reading the scene on, by phase
  double run_s = 0.0, run_core_s = 0.0;            ///< of it: wall; wall x cores, summed over the ranks
  double all_s = 0.0;                              ///< [core-s] of a window: wall x cores, summed over the ranks
  double processor_share = 1.0;                    ///< of the run, see runtime/trace/processor_share.hpp
  Json timeline;
  double efficiency() const { return load_balance * communication; }
  /// Parts over wall x cores. Modules come from the records of tasks, the rest from the sums of threads and windows.
  double accounted() const { return sum(parts) / all_s; }
  /// The same of the whole run: phases over all of its time.
  double run_accounted() const { return sum(run_parts) / run_core_s; }

 private:
  static double sum(const std::map<std::string, double>& of) {
    double all = 0.0;
    for (const auto& [name, s] : of) all += s;
    return all;
  }
};

const std::vector<std::string> phases{"start-up", "settling", "first windows", "windows", "output", "sums and records"};

/// What one rank's clock saw of a run, in seconds of wall by phase.
struct Phases {
  std::map<std::string, double> wall_s;
  std::int64_t left_ns = 0;  ///< when all was known, and the run was taken down
};

/// The ledger's phases; of its windows those that are counted are a phase by themselves.
void add_phases(Phases& to, const runtime::Ledger& ledger) {
  for (const auto& [name, ns] : ledger.phases()) to.wall_s[name] += 1e-9 * double(ns);
  double counted = 0.0;
  for (const runtime::WindowRecord& window : ledger.windows()) counted += 1e-9 * double(window.wall_ns);
  to.wall_s["first windows"] = to.wall_s["windows"] - counted, to.wall_s["windows"] = counted;
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t n = values.size();
  return n == 0 ? 0.0 : 0.5 * (values[n / 2] + values[(n - 1) / 2]);
}

/// Times in tasks by module and by thread, from the records of the windows.
void add_tasks(Profile& p, const std::vector<runtime::RankTrace>& traces) {
  double most = 0.0;
  std::map<std::string, double> busy;
  for (const runtime::RankTrace& trace : traces) {
    std::vector<double> of_thread(trace.threads.size(), 0.0);
    for (const runtime::Record& record : trace.records) {
      if (record.activity != runtime::Activity::task || record.task >= trace.nodes.size()) continue;
      const std::string& label = trace.nodes[record.task].label;
      if (label.starts_with("run/") || (label.starts_with("output/") && label != "output/write")) continue;  // outside the graphs
      const double s = 1e-9 * double(record.end_ns - record.begin_ns);
      busy[std::string(runtime::module_of(label))] += s;
      of_thread[record.thread] += s;
    }
    most = std::max(most, *std::ranges::max_element(of_thread));
  }
  for (const auto& [module, s] : busy) p.parts[module] += s / p.windows, p.busy_s += s / p.windows;
  const double mean = p.busy_s / (double(p.ranks) * p.threads);
  p.load_balance = most > 0.0 ? mean / (most / p.windows) : 1.0;
  p.communication = most / p.windows / p.mean_s;
}

/// Busy cores in the last window.
Json last_window(const std::vector<runtime::RankTrace>& traces, std::int64_t begin_ns, std::int64_t end_ns) {
  std::vector<runtime::Slice> slices;
  for (const runtime::RankTrace& trace : traces)
    for (const runtime::Record& record : trace.records)
      if (record.activity == runtime::Activity::task && record.begin_ns >= begin_ns && record.begin_ns < end_ns &&
          record.task < trace.nodes.size())
        slices.push_back({trace.rank, record.thread, 1e-9 * double(record.begin_ns - begin_ns),
                          1e-9 * double(record.end_ns - begin_ns),
                          std::string(runtime::module_of(trace.nodes[record.task].label))});
  return timeline(slices, 1e-9 * double(end_ns - begin_ns));
}

/// The sums of all ranks' threads in the counted windows: waiting, completing messages, the runtime, and between the graphs.
/// Threads that a graph does not use, or that stand by between graphs, wait; so do ranks of a split run until the other side is
/// done.
void add_rest(Profile& p, const runtime::Ledger& ledger, const runtime::Parts& parts, int threads) {
  const runtime::RankRecording own = ledger.recording(parts.world().rank);
  double wall = 0.0, idle = 0.0, poll = 0.0, overhead = 0.0, in_graphs = 0.0, executors = 0.0;
  for (const runtime::WindowRecord& window : ledger.windows()) wall += 1e-9 * double(window.wall_ns);
  for (const runtime::RunRecord& run : own.runs) {
    in_graphs += 1e-9 * double(run.wall_ns);
    idle += 1e-9 * double(run.idle_ns);
    poll += 1e-9 * double(run.poll_ns), overhead += 1e-9 * double(run.overhead_ns);
    executors += 1e-9 * double(run.task_ns + run.idle_ns + run.poll_ns + run.overhead_ns);
  }
  const double between = std::max(0.0, wall - in_graphs), waits_for_side = parts.split() ? between : 0.0;
  const std::vector<double> all =
      runtime::summed(parts.world().comm, {idle + (in_graphs * threads - executors) + between * (threads - 1) + waits_for_side,
                                           poll, overhead, between - waits_for_side, wall * threads});
  p.parts["waiting"] = all[0] / p.windows, p.parts["messages"] = all[1] / p.windows, p.parts["runtime"] = all[2] / p.windows;
  p.parts["exchange"] += all[3] / p.windows;  // beside that which is tasks
  p.all_s = all[4] / p.windows;
}

Profile windows_of(const ProfileArguments& arguments, const Mode& mode, const runtime::World& world, const fs::path& folder,
                   Phases& seen) {
  const std::int64_t begin_ns = runtime::Clock::now_ns();
  std::vector<std::string> overrides = arguments.overrides;
  overrides.insert(overrides.end(), mode.overrides.begin(), mode.overrides.end());
  const ReadyScene ready = read_scene(arguments.scene, overrides);
  const coupling::Scenario& scenario = ready.floating->scenario();
  const runtime::Parts parts = coupling::place(scenario, world, "");
  io::RunDirectory directory(parts.world().comm, folder / mode.folder, io::Existing::overwrite);
  directory.write_scene(parts.world().comm, ready.echo);
  run::RunSettings settings{.trace = false, .quiet = true};
  const std::int64_t last = warm_up + arguments.windows;
  settings.until_s = double(last) * scenario.time.window_s;
  settings.keep_runs = true, settings.windows = std::pair<std::int64_t, std::int64_t>(warm_up + 1, last);
  runtime::StopRequest stop(scenario.runtime.wall_limit_s, directory.stop());
  run::Driver driver(directory, parts, settings, stop);
  seen.wall_s["start-up"] = runtime::Clock::seconds_since(begin_ns);
  std::optional<run::SystemSimulation> simulation;
  {
    const runtime::Phase start("start-up");
    simulation.emplace(*ready.floating, ready.start.state, parts, settings.records(), mode.moves);
  }
  const io::Summary summary = driver.run(*simulation);
  const std::int64_t ended_ns = runtime::Clock::now_ns();
  if (summary.exit_code != 0) throw io::MachineFailure(fmt::format("{}: {}", mode.name, summary.exit_reason));

  Profile p{.name = mode.name, .ranks = world.size, .threads = summary.threads};
  if (parts.split()) p.air_ranks = scenario.coupling.air_ranks;
  std::vector<double> walls;
  for (const runtime::WindowRecord& window : driver.ledger().windows()) walls.push_back(1e-9 * double(window.wall_ns));
  p.windows = int(walls.size());
  if (p.windows == 0) throw io::MachineFailure(fmt::format("{}: no window was recorded", mode.name));
  p.median_s = median(walls);
  for (const double wall : walls) p.mean_s += wall / p.windows;
  add_rest(p, driver.ledger(), parts, p.threads);
  if (world.rank == 0 || parts.world().rank == 0) {
    add_tasks(p, driver.traces());
    const runtime::RankRecording own = driver.ledger().recording(0);
    std::int64_t begin = std::numeric_limits<std::int64_t>::max(), end = 0;
    for (const runtime::RunRecord& run : own.runs)
      if (run.window == last) begin = std::min(begin, run.begin_ns), end = std::max(end, run.begin_ns + run.wall_ns);
    if (end > begin) p.timeline = last_window(driver.traces(), begin, end);
  }
  p.processor_share = driver.processor_share();
  add_phases(seen, driver.ledger());
  seen.left_ns = runtime::Clock::now_ns();
  seen.wall_s["sums and records"] += 1e-9 * double(seen.left_ns - ended_ns);
  return p;
}

Profile measured(const ProfileArguments& arguments, const Mode& mode, const runtime::World& world, const fs::path& folder) {
  const std::int64_t begin_ns = runtime::Clock::now_ns();
  Phases seen;
  Profile p = windows_of(arguments, mode, world, folder, seen);
  runtime::summed(world.comm, {1.0});  // all have written their records, which rank 0 reads
  seen.wall_s["sums and records"] += runtime::Clock::seconds_since(seen.left_ns);
  p.run_s = runtime::Clock::seconds_since(begin_ns);
  std::vector<double> mine{p.run_s * p.threads};
  for (const std::string& phase : phases) mine.push_back(seen.wall_s[phase] * p.threads);
  const std::vector<double> all = runtime::summed(world.comm, mine);
  p.run_core_s = all[0];
  for (std::size_t n = 0; n < phases.size(); ++n) p.run_parts[phases[n]] = all[n + 1];
  return p;
}

void print(const std::vector<Profile>& all) {
  std::vector<std::string> names;
  for (const Profile& p : all)
    for (const auto& [part, s] : p.parts)
      if (std::ranges::find(names, part) == names.end()) names.push_back(part);
  fmt::print("{:<30}", "of a window");
  for (const Profile& p : all) fmt::print("{:>12}", p.name);
  const auto row = [&](const std::string& name, auto&& value) {
    fmt::print("\n{:<30}", name);
    for (const Profile& p : all) fmt::print("{:>12.4g}", value(p));
  };
  row("wall, median [ms]", [](const Profile& p) { return 1e3 * p.median_s; });
  row("wall, mean [ms]", [](const Profile& p) { return 1e3 * p.mean_s; });
  row("parallel efficiency [%]", [](const Profile& p) { return 100.0 * p.efficiency(); });
  row("  load balance [%]", [](const Profile& p) { return 100.0 * p.load_balance; });
  row("  communication efficiency [%]", [](const Profile& p) { return 100.0 * p.communication; });
  for (const std::string& name : names)
    row(name + " [core-ms]", [&](const Profile& p) { return p.parts.count(name) ? 1e3 * p.parts.at(name) : 0.0; });
  row("parts over wall x cores [%]", [](const Profile& p) { return 100.0 * p.accounted(); });
  fmt::print("\nof the run");
  for (const std::string& phase : phases) row(phase + " [core-s]", [&](const Profile& p) { return p.run_parts.at(phase); });
  row("wall [s]", [](const Profile& p) { return p.run_s; });
  row("parts over wall x cores [%]", [](const Profile& p) { return 100.0 * p.run_accounted(); });
  fmt::print("\n");
}

Json figures_of(const Profile& p) {
  Json json{{"placement", p.name},
            {"ranks", p.ranks},
            {"threads", p.threads},
            {"air_ranks", p.air_ranks > 0 ? Json(p.air_ranks) : Json(nullptr)},
            {"windows", p.windows},
            {"wall_s", p.mean_s},
            {"median_wall_s", p.median_s},
            {"efficiency", p.efficiency()},
            {"load_balance", p.load_balance},
            {"communication_efficiency", p.communication},
            {"parts_core_s", p.parts},
            {"accounted", p.accounted()},
            {"run_s", p.run_s},
            {"run_core_s", p.run_core_s},
            {"run_parts_core_s", p.run_parts},
            {"run_accounted", p.run_accounted()},
            {"processor_share", p.processor_share}};
  if (!p.timeline.is_null()) json["timeline"] = p.timeline;
  return json;
}

std::vector<std::string> sentences(const std::vector<Profile>& all) {
  const auto of = [&](std::string_view name) {
    const auto found = std::ranges::find(all, name, &Profile::name);
    return found == all.end() ? nullptr : &*found;
  };
  const Profile &air = *of("air alone"), &sea = *of("sea alone"), &turns = *of("in turns"), &shared = *of("shared");
  std::vector<std::string> text;
  if (const std::string told = runtime::told_share(std::ranges::min(all, {}, &Profile::processor_share).processor_share);
      !told.empty())
    text.push_back(told);
  const std::string times = fmt::format("air and sea alone take {:.4g} + {:.4g} ms, shared {:.4g} ms", 1e3 * air.median_s,
                                        1e3 * sea.median_s, 1e3 * shared.median_s);
  if (shared.ranks * shared.threads > 1)
    text.push_back(fmt::format("Overlap: {}: a gain of {:.3f}; in turns {:.4g} ms.", times,
                               (air.median_s + sea.median_s) / shared.median_s, 1e3 * turns.median_s));
  else
    text.push_back(
        fmt::format("One core: {}, in turns {:.4g} ms; what overlap gains shows on two or more.", times, 1e3 * turns.median_s));
  if (const Profile* split = of("split"))
    text.push_back(
        fmt::format("Split: {:.4g} ms, {:.3f} times shared.", 1e3 * split->median_s, split->median_s / shared.median_s));
  text.push_back(fmt::format("Exchange and scheme: {:.2g} % of a shared window's wall time.",
                             100.0 * shared.parts.at("exchange") / (shared.ranks * shared.mean_s)));
  return text;
}

}  // namespace

int profile(const ProfileArguments& arguments, const runtime::World& world) {
  const std::int64_t begin_ns = runtime::Clock::now_ns();
  io::start_log(world.rank, true);
  const fs::path folder = arguments.out.empty() ? fs::path("runs") / (fs::path(arguments.scene).stem().string() + "_profile")
                                                : fs::path(arguments.out);
  {
    const ReadyScene ready = read_scene(arguments.scene, arguments.overrides);
    if (!ready.floating->scenario().resolves_air() || !ready.floating->particle_plan() || !ready.floating->has_interface())
      throw io::InputError(
          fmt::format("{}: profile sets the air of a resolved rotor beside a sea of particles, and this scene lacks one of "
                      "them; spindrift run ends with a table of where its time went",
                      arguments.scene));
    const coupling::TimeOptions& time = ready.floating->scenario().time;
    if (double(warm_up + arguments.windows) * time.window_s > time.end_s * (1 + 1e-9))
      throw io::InputError(fmt::format("--windows {}: with {} that are not counted they go beyond time.end_s = {:g} s",
                                       arguments.windows, warm_up, time.end_s));
  }
  const double scene_s = runtime::Clock::seconds_since(begin_ns);
  std::vector<Profile> all;
  int air_ranks = 1;
  for (std::size_t n = 0; n < modes(world.size, air_ranks).size(); ++n) {
    const Mode mode = modes(world.size, air_ranks)[n];
    if (world.rank == 0) fmt::print("{} ...\n", mode.name), std::fflush(stdout);
    all.push_back(measured(arguments, mode, world, folder));
    if (all.size() == 2) {  // in proportion to the work of both
      const std::vector<double> work =
          runtime::summed(world.comm, world.rank == 0 ? std::vector{all[0].busy_s, all[1].busy_s} : std::vector{0.0, 0.0});
      air_ranks = std::clamp(int(std::lround(world.size * work[0] / (work[0] + work[1]))), 1, std::max(1, world.size - 1));
    }
  }
  if (world.rank != 0) return done;
  print(all);
  Json json{
      {"kind", "profile"}, {"version", 1}, {"title", arguments.scene}, {"sentences", sentences(all)}, {"modes", Json::array()}};
  for (const std::string& sentence : sentences(all)) fmt::print("{}\n", sentence);
  if (world.size == 1) fmt::print("Split needs two ranks: mpirun -n 2 spindrift profile ...\n");
  for (const Profile& p : all) json["modes"].push_back(figures_of(p));
  const std::int64_t drawn_from_ns = runtime::Clock::now_ns();
  draw(json, folder / "profile.html");
  draw(json, folder / "profile.png");
  const double pictures_s = runtime::Clock::seconds_since(drawn_from_ns), wall_s = runtime::Clock::seconds_since(begin_ns);
  double runs_s = 0.0;
  for (const Profile& p : all) runs_s += p.run_s;
  json["command"] = {{"scene_s", scene_s}, {"runs_s", runs_s}, {"pictures_s", pictures_s}, {"wall_s", wall_s}};
  write(json, folder / "profile.json");
  fmt::print("the profile took {:.4g} s: looking at the scene {:.4g} s, runs {:.4g} s, pictures {:.4g} s\n", wall_s, scene_s,
             runs_s, pictures_s);
  fmt::print("figures: {}, profile.html and profile.png beside it\n", (folder / "profile.json").string());
  return done;
}

}  // namespace spindrift::app
