// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/run.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <chrono>
#include <cmath>

#include "runtime/executor/executor.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "runtime/trace/chrome.hpp"
#include "runtime/trace/efficiency.hpp"
#include "runtime/trace/trace_of.hpp"
#include "src/coupling/recorder.hpp"
#include "src/coupling/saved_air.hpp"
#include "src/coupling/saved_history.hpp"
#include "src/coupling/sea_output.hpp"
#include "src/coupling/sea_window.hpp"
#include "src/coupling/start.hpp"
#include "src/coupling/window.hpp"
#include "src/io/checkpoint.hpp"
#include "src/io/checkpoint_plan.hpp"
#include "src/io/history.hpp"
#include "src/io/machine_failure.hpp"
#include "src/io/progress.hpp"

namespace spindrift::coupling {

namespace {

/// The window of a scene without fluid solvers: the bodies' steps in order, then a row of history. Recorded once, replayed per
/// window.
struct Window {
  bodies::BodiesState start, state;        ///< at the window's start; now
  bodies::StepReport trouble;              ///< of the first step that failed; `state` is then the last good one
  std::int64_t steps = 0;                  ///< of all runs so far
  std::optional<CoupledWindow> coupled{};  ///< where the rotor is a part of its own
  std::unique_ptr<BodySide> side{};        ///< of a sea of particles that shares the window with no such part,
  std::unique_ptr<WindowTasks> tasks{};    ///< and its tasks
  std::array<double, 4> core_seconds{};    ///< of air, sea, bodies and waiting so far, as last logged
  std::string failure{};                   ///< of the window as a whole, in words; empty when all is well
  bool ok() const { return trouble.ok() && failure.empty(); }
  const BodySide& body_side() const { return coupled ? coupled->bodies() : *side; }
  const WindowTasks* shared_tasks() const { return coupled ? &coupled->tasks() : tasks.get(); }
};

/// A line of log.txt for a window: how it went, and core-seconds of each side on all ranks; not for loose windows of a machine
/// without tasks, which are too short to be spoken of. Collective.
void log_window(const Machine& machine, Window& window, const runtime::Parts& parts, const WindowReport& report, double end_s,
                double wall_s) {
  const bool tasked = machine.scenario().resolves_air() || machine.particle_plan();
  if (!tasked && window.coupled->loose()) return;
  const WindowTasks& tasks = window.coupled->tasks();
  const double bodies = parts.has(sea_part) ? 1e-9 * double(window.body_side().own_ns()) : 0.0;
  const double air = parts.has(air_part) ? 1e-9 * double(window.coupled->totals().answer_ns) : 0.0;
  const std::vector<double> now =
      runtime::summed(parts.world().comm, {machine.scenario().resolves_air() ? tasks.core_seconds("aero") : air,
                                           tasks.core_seconds("sea"), bodies, 1e-9 * double(parts.waited_ns())});
  std::array<double, 4> spent;
  for (std::size_t n = 0; n < now.size(); ++n) spent[n] = now[n] - window.core_seconds[n], window.core_seconds[n] = now[n];
  // Bodies beside particles move within tasks of the sea.
  const double sea = spent[1] > 0.0 ? spent[1] - spent[2] : 0.0;
  const WindowLog& log = report.log;
  std::string how = fmt::format("{} evaluations, mismatch {:.3g}", log.evaluations, report.mismatch);
  if (!window.coupled->loose())
    how += fmt::format(", residual {:.3g} of {:.3g} at first, {} columns, {} retries, {} cuts, ended by {}", log.residual,
                       log.first_residual, log.columns, log.retries, log.cuts, bound_name(log.bound));
  spdlog::debug("window to t = {:g} s: {}; {:.3g} s; core-s: air {:.3g}, sea {:.3g}, bodies {:.3g}{}", end_s, how, wall_s,
                spent[0], sea, spent[2],
                parts.split() ? fmt::format("; ranks waited {:.3g} s for the other side", spent[3]) : std::string());
}

/// The window of a rotor and a machine that exchange data: one task, which may evaluate the window more than once.
runtime::Graph record_coupled_window(Machine& machine, Window& window, const runtime::Parts& parts) {
  runtime::Graph graph;
  const runtime::Datum state = graph.datum();
  graph.task("coupling/window", {runtime::updates(state)}, [&machine, &window, &parts] {
    const auto begin = std::chrono::steady_clock::now();
    const std::int64_t steps = window.coupled->bodies().steps();
    WindowReport report = window.coupled->advance(window.state);
    const double end_s = double(window.start.tick) * machine.timeline().tick_s() + machine.timeline().window_s();
    log_window(machine, window, parts, report, end_s, seconds_since(begin));
    if (report.ok())
      window.steps += machine.particle_plan() ? window.coupled->bodies().steps() - steps : machine.timeline().steps_per_window();
    if (report.log.retries > 0)
      spdlog::warn("window that ends at t = {:g} s: {} retries and {} cuts, {} evaluations, ended by {}", end_s,
                   report.log.retries, report.log.cuts, report.log.evaluations, bound_name(report.log.bound));
    window.failure = std::move(report.failure);
  });
  return graph;
}

/// The window of a scene with a sea of particles: one task, which runs those of the sea.
runtime::Graph record_particle_window(Machine& machine, Window& window) {
  runtime::Graph graph;
  const runtime::Datum state = graph.datum();
  graph.task("sea/window", {runtime::updates(state)}, [&machine, &window] {
    const std::int64_t steps = window.side->steps();
    try {
      window.side->keep(0);
      window.side->aim(window.state, window.state.tick + machine.timeline().steps_per_window());
      window.tasks->run(false, true);
      window.state = window.side->finish();
      window.steps += window.side->steps() - steps;
    } catch (const NumericalFailure& failure) {
      window.failure = failure.what();
      window.side->back(0);
    }
  });
  return graph;
}

runtime::Graph record_window(Machine& machine, Window& window, const runtime::Parts& parts) {
  if (window.coupled) return record_coupled_window(machine, window, parts);
  if (machine.particles()) return record_particle_window(machine, window);
  const double tick_s = machine.timeline().tick_s();
  const auto steps = std::uint32_t(machine.timeline().steps_per_window());
  runtime::Graph graph;
  const runtime::Datum state = graph.datum();
  const auto step = [&] {
    graph.task("bodies/step", {runtime::updates(state)}, [&machine, &window, tick_s] {
      window.trouble = machine.system().advance(window.state, tick_s, 1);
      window.steps += window.trouble.ok();
    });
  };
  if (steps == 1) {
    step();
    return graph;
  }
  graph.loop("bodies/steps", {.min = 1, .max = steps}, [&] {
    step();
    graph.until("bodies/trouble", {runtime::reads(state)}, [&window] { return !window.trouble.ok(); });
  });
  return graph;
}

/// The particles of a checkpoint into the machine's sea, which must be the same sea.
void restore_particles(const Machine& machine, const io::CheckpointReader& file) {
  if (!machine.particles()) return;
  try {
    sea::ParticleState state = machine.particles()->room();
    if (file.size("sea/particles") != state.total)
      throw std::invalid_argument("its sea has " + std::to_string(file.size("sea/particles")) +
                                  " values of particles, this one " + std::to_string(state.total));
    const io::Slice<double> mine{state.first, state.values};
    file.read<double>("sea/particles", std::span(&mine, 1));
    state.time_s = file.number("sea/time_s"), state.steps = file.integer("sea/steps");
    machine.particles()->restore(state);
  } catch (const std::invalid_argument& e) { throw io::InputError(file.path().string() + ": " + e.what()); }
}

/// Air and water of a checkpoint into the window and the machine. Collective.
void restore_fluids(const runtime::Parts& parts, const Machine& machine, Window& window, const io::CheckpointReader& file) {
  on_parts(parts, [&] {
    if (window.coupled) window.coupled->air().restore(file);
    restore_particles(machine, file);
  });
}

class Checkpoints {
 public:
  Checkpoints(const runtime::Parts& parts, const Machine& machine, const io::RunDirectory& directory, const io::History& history)
      : parts_(parts),
        machine_(machine),
        history_(history),
        series_(parts.world().comm, directory.checkpoints(), machine.scenario().checkpoint.keep, directory.identity()) {}

  void save(Window& window, std::int64_t number, int restarts) {
    const bodies::BodiesState& state = window.ok() ? window.state : window.start;  // a restart begins at a window's start
    std::vector<double> packed(state.packed_size());
    state.pack(packed);
    const double tick_s = machine_.timeline().tick_s();
    series_.save(state.tick - machine_.first_tick(), [&](io::CheckpointWriter& file) {
      file.set("window", number);
      file.set("time_s", machine_.timeline().window_end_s(number));
      file.set("window_s", machine_.timeline().window_s());
      file.set("steps", window.steps);
      file.set("restarts", std::int64_t(restarts));
      file.write<double>("time/tick_s", std::span<const double>(&tick_s, 1));
      file.write<double>("bodies/state", packed);
      write(file, history_.extent());
      if (window.coupled) {
        file.set("coupling/scheme", std::int64_t(machine_.scenario().coupling.scheme));
        file.write<double>("coupling/history", window.coupled->history());
        write(file, parts_, air_part, window.coupled->air().saved());
        if (machine_.scenario().resolves_air()) write_air_settings(file, machine_.scenario());
      }
      if (!machine_.particle_plan()) return;
      sea::ParticleState particles;
      if (parts_.has(sea_part)) particles = machine_.particles()->save();
      file.set("sea/time_s", particles.time_s);  // as rank 0 has it, which has the sea
      file.set("sea/steps", particles.steps);
      write(file, parts_, sea_part, {{"sea/particles", particles.total, {{particles.first, std::move(particles.values)}}}});
    });
    saved_ = number;
  }
  bool is_saved(std::int64_t number) const { return saved_ == number; }
  /// Of history.csv, when the checkpoint that was resumed was written.
  const std::optional<io::History::Extent>& rows() const { return rows_; }

  /// The window to go on from.
  std::int64_t resume(Window& window, int& restarts) {
    const std::optional<io::CheckpointReader> file = series_.newest();
    if (!file) throw io::InputError("--restart: no valid checkpoint in the run directory");
    if (file->has("time/tick_s"))
      if (const double theirs = file->read<double>("time/tick_s").at(0), ours = machine_.timeline().tick_s(); theirs != ours)
        throw io::InputError(fmt::format(
            "{}: its time is counted in units of {:.6g} s, this scene's in {:.6g} s: a restart keeps time.window_s and "
            "time.step_s (given or not)",
            file->path().string(), theirs, ours));
    window.state.unpack(file->read<double>("bodies/state"));
    window.steps = file->integer("steps");
    restarts = int(file->integer("restarts")) + 1;
    if (window.coupled && !window.coupled->restore(file->read<double>("coupling/history")))
      throw io::InputError(file->path().string() + ": its coupling history is that of another coupling.scheme");
    restore_fluids(parts_, machine_, window, *file);
    rows_ = extent_in(*file);
    return saved_ = file->integer("window");
  }

 private:
  const runtime::Parts& parts_;
  const Machine& machine_;
  const io::History& history_;
  io::CheckpointSeries series_;
  std::optional<io::History::Extent> rows_;
  std::int64_t saved_ = -1;
};

/// start.file: the state that another run of the same machine left, whatever its windows and its march; the window to go on from.
std::int64_t take_over(const Machine& machine, Window& window, const runtime::Parts& parts) {
  const io::CheckpointReader file(parts.world().comm, machine.scenario().start.file);
  const auto refuse = [&](const std::string& why) {
    throw io::InputError(fmt::format("{} (start.file): {}", file.path().string(), why));
  };

  const Timeline& timeline = machine.timeline();
  const double t = file.number("time_s");
  const std::optional<std::int64_t> windows = t == 0.0 ? std::optional<std::int64_t>(0) : whole_ratio(t, timeline.window_s());
  if (!windows)
    refuse(fmt::format("its state is that of t = {:g} s, which is no whole number of windows of {:g} s", t, timeline.window_s()));
  if (*windows >= timeline.windows())
    refuse(fmt::format("its state is that of t = {:g} s, the run ends at {:g} s", t, timeline.window_end_s(timeline.windows())));
  const std::vector<double> bodies = file.read<double>("bodies/state");
  if (bodies.size() != window.state.packed_size()) refuse("its bodies and joints are not those of this scene");
  window.state.unpack(bodies);
  window.state.tick = timeline.tick_of_window(*windows);
  restore_fluids(parts, machine, window, file);
  if (window.coupled) {
    // What the scheme has learnt goes along where scheme and window are the same; else it begins with the state alone.
    const bool same = file.has("coupling/history") &&
                      file.integer("coupling/scheme") == std::int64_t(machine.scenario().coupling.scheme) &&
                      file.number("window_s") == timeline.window_s();
    if (!same || !window.coupled->restore(file.read<double>("coupling/history"))) window.coupled->begin(window.state);
  }
  spdlog::info("from t = {:g} s of {}", t, file.path().string());
  return *windows;
}

/// What a restart must find unchanged, since otherwise the run would not be the one that was interrupted.
std::int64_t windows_until(const Timeline& timeline, const std::optional<double>& until_s) {
  if (!until_s) return timeline.windows();
  const auto windows = std::int64_t(std::ceil(*until_s / timeline.window_s() * (1.0 - 1e-12)));
  return std::min<std::int64_t>(windows, timeline.windows());
}

/// Core-seconds of all ranks, and seconds as if they were shared out evenly. Sources of load are asked within the steps of the
/// bodies, all of them within the windows; what is left of those is waiting and, where parts have tasks, the runtime's own work.
/// Collective.
std::vector<io::PartTime> part_times(Machine& machine, const Window& window, const runtime::Parts& parts, double window_seconds,
                                     double output_seconds) {
  const WindowTasks* tasks = window.shared_tasks();
  const bool in_tasks = machine.scenario().resolves_air() || machine.particle_plan();
  const int own_threads = tasks && tasks->executor() ? tasks->executor()->threads() : 1;
  // Bodies and the loads that they ask for are advanced alike by all ranks that have them; only particles are shared out.
  std::vector<double> mine{double(own_threads), tasks ? tasks->core_seconds("aero") : 0.0,
                           tasks ? tasks->core_seconds("sea") : 0.0};
  const auto clocks = machine.clocks();
  if (in_tasks) mine.push_back(parts.has(sea_part) ? 1e-9 * double(window.body_side().own_ns()) : 0.0);
  for (const SourceClock& clock : clocks) mine.push_back(1e-9 * double(clock.ns));
  const std::vector<double> all = runtime::summed(parts.world().comm, mine);
  const double threads = all[0], *asked = all.data() + (in_tasks ? 4 : 3);
  double all_asked = 0.0, known = 0.0;
  for (std::size_t s = 0; s < clocks.size(); ++s) all_asked += asked[s];

  std::vector<io::PartTime> times;
  const auto add = [&](const std::string& name, double core_seconds, std::int64_t calls) {
    times.push_back({name, core_seconds / threads, core_seconds, calls});
    known += core_seconds / threads;
  };
  if (in_tasks) {
    add("bodies", std::max(0.0, all[3] - all_asked), window.steps);
    if (window.coupled) add("air", all[1], window.coupled->totals().rotor_calls);
  } else {
    add("bodies", window_seconds * threads - all_asked, window.steps);
  }
  for (std::size_t s = 0; s < clocks.size(); ++s) {
    const bool particles = machine.particle_plan() && machine.system().loads()[s].name == "sea";
    add(machine.system().loads()[s].name, (particles ? all[2] - all[3] : 0.0) + asked[s],
        particles ? window.body_side().steps() : clocks[s].calls);
  }
  if (threads > 1.0 || in_tasks)
    times.push_back({"idle_and_runtime", window_seconds - known, (window_seconds - known) * threads, 0});
  times.push_back({"output", output_seconds, output_seconds, 0});
  return times;
}

/// Where the core-seconds of each side's ranks went, into the summary and as lines under the table. Collective; split runs.
void tell_sides(const Window& window, const runtime::Parts& parts, std::int64_t waited_ns, double window_seconds,
                io::Summary& summary) {
  const WindowTasks& tasks = window.coupled->tasks();
  const int threads = tasks.executor() ? tasks.executor()->threads() : 1;
  const double busy =
      tasks.executor() ? tasks.core_seconds("aero") + tasks.core_seconds("sea") : 1e-9 * double(window.body_side().own_ns());
  std::vector<double> mine(8, 0.0);  // by part: ranks, core-seconds in all, busy, waiting for the other side
  double* at = mine.data() + 4 * parts.part();
  at[0] = 1.0, at[1] = threads * window_seconds, at[2] = busy, at[3] = 1e-9 * double(waited_ns) * threads;
  const std::vector<double> all = runtime::summed(parts.world().comm, mine);
  for (const auto& [part, name, other] : {std::tuple{air_part, "air", "sea"}, std::tuple{sea_part, "sea", "air"}}) {
    const double *of = all.data() + 4 * part, core_s = of[1];
    spdlog::info(
        "  {} on {} rank{}: {:5.1f} % busy, {:5.1f} % waiting for the {}, {:5.1f} % other idle and runtime; of {:.4g} core-s",
        name, of[0], of[0] == 1.0 ? "" : "s", 100.0 * of[2] / core_s, 100.0 * of[3] / core_s, other,
        100.0 * (core_s - of[2] - of[3]) / core_s, core_s);
    summary.efficiency.push_back(
        {fmt::format("{} busy", name), of[2] / core_s, fmt::format("useful part of the core-seconds of the {}'s ranks", name)});
    summary.efficiency.push_back(
        {fmt::format("{} waiting", name), of[3] / core_s, fmt::format("part of them spent until the {} was done", other)});
  }
}

/// Efficiencies into the summary and, as a table, into the log; trace.json where asked for. Collective.
void finish_trace(const runtime::Executor& executor, const io::RunDirectory& directory, const runtime::Parts& parts, bool write,
                  io::Summary& summary) {
  const runtime::World& world = parts.world();
  runtime::RankTrace own = trace_of(executor, world.rank);
  for (runtime::TraceNode& node : own.nodes)  // a side's tasks count its own ranks
    if (node.peer >= 0) node.peer += world.rank - parts.mine().rank;
  const std::vector<runtime::RankTrace> traces = gather_traces(own, world.comm);
  if (world.rank != 0) return;
  const runtime::Efficiency e = efficiency_of(traces);
  for (const auto& [name, value, meaning] : std::initializer_list<std::tuple<const char*, double, const char*>>{
           {"parallel efficiency", e.parallel, "useful core-seconds over all core-seconds; load balance x communication"},
           {"load balance", e.load_balance, "mean over largest useful time of a thread"},
           {"communication efficiency", e.communication, "largest useful time of a thread over elapsed time"},
           {"serialisation efficiency", e.serialisation, "what dependencies leave on an ideal network"},
           {"transfer efficiency", e.transfer, "what moving data leaves"}})
    if (std::isfinite(value)) summary.efficiency.push_back({name, value, meaning});
  spdlog::info("{}", efficiency_table(e));
  if (write) write_chrome_trace(traces, directory.trace().string());
}

/// The particles that the scene starts from, on the ranks that have the sea. Collective; throws on all ranks alike.
void fill_sea(Machine& machine, std::span<const Motion> start, const runtime::Parts& parts) {
  on_parts(parts, [&] {
    if (parts.has(sea_part)) machine.fill_sea(start, parts.mine());
  });
  const auto& initial = machine.scenario().sea.initial;
  if (!machine.particle_plan() || !initial || initial->state != "file") return;
  const io::CheckpointReader file = open_saved(parts.world().comm, initial->file);
  on_parts(parts, [&] { restore_particles(machine, file); });
}

}  // namespace

io::Summary run(Machine& machine, const Start& start, const io::RunDirectory& directory, const runtime::Parts& parts,
                const RunSettings& settings) {
  const runtime::World& world = parts.world();
  const auto begin = std::chrono::steady_clock::now();
  const Timeline& timeline = machine.timeline();
  const CheckpointOptions& checkpoint = machine.scenario().checkpoint;
  runtime::StopRequest stop(machine.scenario().runtime.wall_limit_s, directory.stop());

  io::Summary summary;
  Window window;
  const std::size_t records = settings.trace ? std::size_t(1) << 20 : 0;
  io::History history;
  Checkpoints checkpoints(parts, machine, directory, history);
  fill_sea(machine, start.state.motions, parts);
  Recorder recorder(machine, history);
  std::int64_t first = -machine.held_windows();
  const bool takes_over = !settings.restart && !machine.scenario().start.file.empty(), begins = !settings.restart && !takes_over;
  window.state = start.state;
  if (machine.rotor() && machine.scenario().coupling.scheme != SchemeKind::monolithic) {
    window.coupled.emplace(machine, make_sides(machine, machine.rotor()->state(0.0, start.state.motions), parts),
                           parts.mine().comm, records);
    if (begins) window.coupled->begin(start.state);
    window.coupled->declare(history);
  }
  if (machine.particles() && !window.coupled) {
    window.side = make_body_side(machine);
    window.tasks = std::make_unique<WindowTasks>(nullptr, *window.side, world.comm, records);
  }
  const std::function<void(std::span<double>)> coupling_columns =
      window.coupled ? [&window](std::span<double> row) { window.coupled->put(row); } : std::function<void(std::span<double>)>();
  window.state.tick = machine.first_tick();
  if (settings.restart) {
    first = checkpoints.resume(window, summary.restarts);
    spdlog::info("restart from t = {} s", timeline.window_end_s(first));
  } else if (takes_over) {
    first = take_over(machine, window, parts);
  }
  if (window.coupled)
    for (const std::string& sentence : window.coupled->air().news()) spdlog::info("{}", sentence);
  const auto write_row = [&](std::int64_t number) {  // where bodies and water are known
    if (parts.has(sea_part)) recorder.write(window.state, timeline.window_end_s(number), coupling_columns);
  };
  open_history(world.comm, history, directory, settings, timeline.window_end_s(first), checkpoints.rows());
  SeaOutput sea_output(machine, directory.fields(), parts.mine(),
                       settings.restart ? timeline.window_end_s(first) : io::from_the_start);
  const double air_every = machine.scenario().output.air_interval_s;
  const std::int64_t air_windows = air_every > 0.0 ? std::max<std::int64_t>(1, std::llround(air_every / timeline.window_s())) : 0;
  const auto write_air = [&](std::int64_t number) {
    if (window.coupled)
      window.coupled->air().write_fields(timeline.tick_of_window(number) - machine.first_tick(), timeline.window_end_s(number));
  };
  if (window.coupled)
    window.coupled->air().open_output(directory, settings.restart ? timeline.window_end_s(first) : io::from_the_start);
  if (!settings.restart) {
    if (machine.particles()) evaluate_particles(machine, window.state);
    write_row(first);
    sea_output.write_if_due(first);
  }

  const std::int64_t last = windows_until(timeline, settings.until_s);
  const int every = machine.scenario().output.history_every;
  io::CheckpointPlan plan(checkpoint.interval_s, timeline.window_s(), checkpoint.wall_interval_s);
  const auto save = [&](std::int64_t number) {
    const auto save_begin = io::CheckpointPlan::Clock::now();
    history.flush(), checkpoints.save(window, number, summary.restarts);
    plan.saved(save_begin), stop.keep_margin(2.0 * plan.cost_s());
  };
  if (plan.at_start() && !settings.restart) save(first);
  runtime::Executor executor(record_window(machine, window, parts), {.threads = 1, .records = records});
  io::Progress progress(timeline.window_end_s(first), timeline.window_end_s(last),
                        io::progress_style(world.rank, settings.quiet));
  machine.reset_clocks();
  window.core_seconds[3] = runtime::summed(world.comm, {1e-9 * double(parts.waited_ns())})[0];

  double window_seconds = 0.0;
  std::int64_t number = first, waited_ns = 0;
  while (number < last && summary.exit_code == 0) {
    const auto window_begin = std::chrono::steady_clock::now();
    const std::int64_t waited_before = parts.waited_ns();
    window.start = window.state;
    executor.run();
    window_seconds += seconds_since(window_begin);
    waited_ns += parts.waited_ns() - waited_before;
    if (!window.ok()) {
      if (window.failure.empty())
        window.failure = machine.system().failure(window.trouble, window.state, timeline.tick_s()).what();
      summary.exit_code = 3;
      summary.exit_reason = window.failure;
      summary.numerical_trouble.push_back(window.failure);
      break;
    }
    ++number;
    if (number % every == 0 || number == last) write_row(number);
    sea_output.write_if_due(number);
    if (air_windows > 0 && number > 0 && number < last && number % air_windows == 0) write_air(number);
    progress.update(timeline.window_end_s(number));
    if (std::string why = stop.agreed(world.comm); !why.empty() && number < last) {
      summary.exit_code = 5;
      summary.exit_reason = why;
    }
    if (plan.due(world.comm, number - 1, number)) save(number);
  }
  history.flush();
  if (!checkpoints.is_saved(number)) checkpoints.save(window, number, summary.restarts);
  write_air(number);
  if (window.coupled) window.coupled->air().write_span();

  if (summary.exit_code == 0)
    summary.exit_reason =
        last < timeline.windows() ? fmt::format("done until t = {} s as asked", timeline.window_end_s(last)) : "done";
  summary.start_time_s = timeline.window_end_s(first);
  summary.end_time_s = double(window.state.tick) * timeline.tick_s();
  summary.window_s = timeline.window_s();
  summary.counts = {{"windows", number - first}, {"steps", window.steps}};
  if (window.coupled) {
    const CoupledWindow::Totals& totals = window.coupled->totals();
    summary.counts.emplace_back("coupling_evaluations", totals.evaluations);
    summary.counts.emplace_back("coupling_retries", totals.retries);
    summary.counts.emplace_back("coupling_cuts", totals.cuts);
    summary.counts.emplace_back("rotor_evaluations", totals.rotor_calls);
    summary.counts.emplace_back("step_evaluations", totals.body_steps);
  }
  if (const sea::ParticleSea* sea = machine.particles())
    for (const auto& [name, count] :
         std::initializer_list<std::pair<const char*, std::int64_t>>{{"particles", std::int64_t(sea->particles())},
                                                                     {"particle_evaluations", sea->evaluations()},
                                                                     {"particle_sorts", sea->sorts()},
                                                                     {"particles_lost", std::int64_t(sea->lost())}})
      summary.counts.emplace_back(name, count);
  summary.wall_seconds = seconds_since(begin);
  summary.parts = part_times(machine, window, parts, window_seconds, summary.wall_seconds - window_seconds);
  // Where parts have tasks of their own, these tell more than the one task that runs them.
  const WindowTasks* tasks = window.shared_tasks();
  const runtime::Executor& traced = tasks && tasks->executor() ? *tasks->executor() : executor;
  finish_trace(traced, directory, parts, settings.trace, summary);
  if (parts.split()) tell_sides(window, parts, waited_ns, window_seconds, summary);
  summary.ranks = world.size;
  summary.threads = traced.threads();
  summary.columns = history.columns();
  return summary;
}

}  // namespace spindrift::coupling
