// SPDX-License-Identifier: Apache-2.0
#include "src/app/forecast.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "runtime/trace/clock.hpp"
#include "src/aero/actuator.hpp"
#include "src/aero/flow/sweep_model.hpp"
#include "src/aero/flow_grid.hpp"
#include "src/aero/flow_size.hpp"
#include "src/app/aside.hpp"
#include "src/coupling/air_march.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/recorder.hpp"
#include "src/run/flow_columns.hpp"
#include "src/run/flow_simulation.hpp"
#include "src/scene/value.hpp"
#include "src/sea/sph/step_plan.hpp"

namespace spindrift::app {

namespace {

using coupling::FloatingSystem;

/// Least processor time of one call, over blocks of calls that take about a tenth of a second together. A call that fails ends
/// them, and has taken its time.
template <class Call>
double least_seconds(Call&& call) {
  constexpr int block = 10, most_blocks = 40;
  double least = std::numeric_limits<double>::infinity();
  const double begin = processor_seconds();
  for (int n = 0; n < most_blocks && processor_seconds() - begin < 0.1; ++n) {
    const double before = processor_seconds();
    int calls = 0;
    bool well = true;
    while (calls < block && well) well = call(), ++calls;
    least = std::min(least, (processor_seconds() - before) / calls);
    if (!well) break;
  }
  return least;
}

/// Mean over half a second, of calls that are not all alike.
template <class Call>
double mean_seconds(Call&& call) {
  const double begin = processor_seconds();
  int calls = 0;
  bool well = true;
  while (processor_seconds() - begin < 0.5 && well) well = call(), ++calls;
  return (processor_seconds() - begin) / calls;
}

std::vector<std::string> names(const io::History& history) {
  std::vector<std::string> result;
  for (const io::Column& column : history.columns()) result.push_back(column.name);
  return result;
}

/// Columns that the air and the exchange with it add, by the beginnings of their names. Some scenes have fewer of them: a name
/// that none has is a mistake all the same.
void add_columns_of_air(std::vector<std::string>& names, std::initializer_list<std::string_view> prefixes) {
  constexpr int most_blades = 3;
  for (const io::ColumnSection& section : run::all_columns())
    for (const io::Column& column : section.columns) {
      if (std::ranges::find(prefixes, section.prefix) != prefixes.end()) names.push_back(section.prefix + column.name);
      for (int blade = 1; blade <= most_blades && section.prefix == "rotor.blade_1."; ++blade)
        names.push_back(fmt::format("rotor.blade_{}.{}", blade, column.name));
    }
}

/// Has a rotor whose loads come once in an iteration of a window, not in every evaluation of the bodies.
bool exchanges(const coupling::Scenario& s) { return s.has_rotor() && s.coupling.scheme != coupling::SchemeKind::monolithic; }

/// Pseudo-steps of a steady flow, as air settles before t = 0, in those of this one.
double settling_steps(const aero::FlowOptions& flow, double steps, double seconds_per_cell) {
  aero::FlowOptions steady = flow;
  steady.time = "steady";
  return steps * aero::seconds_per_cell(steady) / seconds_per_cell;
}

double iterations(const coupling::Scenario& s) {
  constexpr double usual = 2.5;  // of a window by the schemes that iterate: 2.2 to 3 in inputs/studies/case3_coupling.toml
  return exchanges(s) && is_strong(s.coupling.scheme) ? usual : 1.0;
}

}  // namespace

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * double(usage.ru_maxrss);
}

double resident_memory() {
  std::size_t pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return double(resident) * double(::sysconf(_SC_PAGESIZE));
}

StepCost measured_steps(FloatingSystem& floating, const coupling::Start& start) {
  const coupling::Timeline& t = floating.timeline();
  const coupling::Scenario& s = floating.scenario();
  StepCost cost;
  cost.steps = double(t.windows()) * double(t.steps_per_window()) * iterations(s);
  cost.rows = std::ceil(double(t.windows()) / floating.scenario().output.history_every) + 1.0;
  const coupling::FullLoads full(floating);
  bodies::BodiesState state = start.state;
  floating.sources.reset_clocks();
  const std::int64_t begin_ns = runtime::Clock::now_ns();
  const auto step = [&] {
    const bodies::StepReport report = floating.multibody().advance(state, t.tick_s(), 1);
    if (!report.ok() && cost.trouble.empty())
      cost.trouble = fmt::format("the step from t = {:.4g} s does not hold: {}", double(state.tick) * t.tick_s(),
                                 floating.multibody().describe(report));
    return report.ok();
  };
  const double step_alone = least_seconds(step);
  cost.step_s = s.aero.dynamic_inflow == "free_vortex" ? mean_seconds(step) : step_alone;  // a wake has steps of its own
  if (exchanges(s)) {
    const double wall_ns = double(runtime::Clock::now_ns() - begin_ns);
    for (std::size_t n = 0; n < floating.sources.clocks.size(); ++n) {
      const coupling::LoadSources::Clock clock = floating.sources.clocks[n];
      if (floating.multibody().loads()[n].name != "rotor" || clock.calls == 0) continue;
      const double share = std::min(1.0, double(clock.ns) / wall_ns);
      cost.exchanges = double(t.windows()) * iterations(s);
      cost.exchange_s = cost.step_s * share / (s.time.integrator == Integrator::rk4 ? 4.0 : 1.0);
      cost.step_s *= 1.0 - share;
    }
  }
  floating.sources.reset_clocks();
  io::History history;
  coupling::Recorder recorder(floating, history);
  const std::filesystem::path file = std::filesystem::temp_directory_path() / fmt::format("spindrift_rows_{}.csv", ::getpid());
  history.open(file);
  state = start.state;
  // A row after each step, as in a run: the step that follows begins with what the row had to know.
  const double both = least_seconds([&] {
    if (!floating.multibody().advance(state, t.tick_s(), 1).ok()) return false;
    const double now = double(state.tick) * t.tick_s();
    recorder.fill(history.row(now), state, now), history.write();
    return true;
  });
  cost.row_s = std::max(0.0, both - step_alone);
  std::filesystem::remove(file);
  return cost;
}

double particle_steps(const FloatingSystem& floating, const sea::ParticleCensus& census) {
  const coupling::TimeOptions& time = floating.scenario().time;
  const bool some_at_a_time = floating.particle_plan()->options.limits_every > 1 && !time.step_s;
  const double share = some_at_a_time ? sph::share_between_checks : 1.0;
  const double step =
      std::min({time.step_s.value_or(share * census.step_s), share * floating.body_step_limit_s, census.step_s, time.window_s});
  return std::ceil(time.window_s / step * (1.0 - 1e-9));
}

/// In a run beside the store, the note of a window's start and the copy for a checkpoint [bytes]: of each rank (its task graph),
/// and of a particle what arrays below a megabyte leave free between them, which does not go back to the system (main.cpp).
/// Recorded with both: 8 % less to 9 % more.
constexpr double bytes_of_tasks = 5e6, bytes_between = 110.0, most_in_a_megabyte = 131072.0;

/// Of the cost of a sea that is at rest: in motion steps shorten and groups are sorted anew. Recorded: 0.8 to 1.5.
constexpr double in_motion = 1.15;

PartCost cost_of_particles(const FloatingSystem& floating, const sea::ParticleCensus& census, double steps_per_window) {
  const coupling::Scenario& s = floating.scenario();
  const sph::Parameters& p = floating.particle_plan()->parameters;
  const double of_step = p.step == sph::StepChoice::verlet ? 1.0 : 2.0,
               evaluations = of_step * steps_per_window / s.time.window_s;
  const int notes = floating.rotor() && is_strong(s.coupling.scheme) ? 2 : 1;
  return {.name = "sea",
          .count = double(census.particles()),
          .things = "particles",
          .bytes = census.bytes + notes * sea::bytes_of_note * double(census.particles()) +
                   bytes_between * std::min(double(census.particles()), most_in_a_megabyte),
          .bytes_each = bytes_of_tasks,
          .checkpoint_bytes = sea::bytes_of_note * double(census.particles()),
          .work_per_second = evaluations,
          .work = "evaluations of all",
          .core_seconds_per_work = in_motion * double(census.particles()) / census.evaluations_per_second +
                                   census.leading_s * double(census.water) / of_step,
          .rate = fmt::format("{:.3g} M particles per core-s, measured now on a small sea", 1e-6 * census.evaluations_per_second),
          .work_before = s.sea.settle_s() * evaluations};
}

PartCost cost_of_air(const aero::ResolvedRotorSetup& setup, const aero::ResolvedRotorSize& size, const PseudoSteps& steps,
                     double before, int notes, bool calibrate) {
  PartCost cost{.name = "air",
                .count = double(size.cells),
                .things = "cells",
                .bytes = size.bytes + size.bytes_of_output + (notes - 1) * size.bytes_of_checkpoint,
                .bytes_each = size.bytes_each,
                .checkpoint_bytes = size.bytes_of_checkpoint,
                .work_per_second = steps.per_second,
                .work = steps.work,
                .core_seconds_per_work = size.core_seconds_per_pseudo_step,
                .rate = {},
                .work_before = settling_steps(setup.flow, before, size.core_seconds_per_pseudo_step / double(size.cells))};
  // A steady march begins on a grid of half the cells along each direction.
  if (setup.flow.time == "steady") cost.work_before += 0.125 * setup.flow.coarse_steps.value_or(0);
  std::string source = "stated for a core of 50 GFLOP/s; --calibrate measures it";
  if (calibrate) {
    const aero::AirRate rate = aero::measured_air_rate(setup);
    cost.core_seconds_per_work = rate.core_seconds * double(size.cells);
    source = fmt::format("measured now: {} pseudo-steps of {} cells", rate.pseudo_steps, rate.cells);
  }
  cost.rate = fmt::format("{:.3g} us per cell, {}", 1e6 * cost.core_seconds_per_work / double(size.cells), source);
  return cost;
}

std::vector<std::string> columns_of(FloatingSystem& floating) {
  io::History history;
  const coupling::Recorder recorder(floating, history);
  std::vector<std::string> found = names(history);
  const coupling::Scenario& s = floating.scenario();
  if (s.resolves_air() || exchanges(s)) add_columns_of_air(found, {"air.", "coupling."});
  return found;
}

std::vector<std::string> columns_of_air_alone() {
  std::vector<std::string> found;
  add_columns_of_air(found, {"flow.", "rotor."});
  return found;
}

std::string no_column(const std::string& name, const std::vector<std::string>& known) {
  const std::string text = "is no column of this scene; ";
  if (const std::string near = scene::nearest(name, known); !near.empty()) return text + "did you mean \"" + near + "\"?";
  constexpr std::size_t most = 3;
  const auto first = [](const std::string& column) { return column.substr(0, column.find('.')); };
  const auto rest = [](const std::string& column) { return column.substr(column.find('.') + 1); };
  std::vector<std::string> alike, beginnings;  // of another body or rotor
  for (const std::string& column : known) {
    if (column.find('.') != std::string::npos && !scene::nearest(rest(name), {rest(column)}).empty()) alike.push_back(column);
    const std::string start = column.find('.') == std::string::npos ? column : first(column) + ".";
    if (std::ranges::find(beginnings, start) == beginnings.end()) beginnings.push_back(start);
  }
  if (!alike.empty() && alike.size() <= most) return text + fmt::format("did you mean {}?", fmt::join(alike, " or "));
  return text + fmt::format("its columns begin with {}", fmt::join(beginnings, ", "));
}

void require_expected_columns(scene::Document& document, const coupling::OutputOptions& output,
                              const std::vector<std::string>& known) {
  for (std::size_t n = 0; n < output.expected.size(); ++n) {
    const std::string& column = output.expected[n].column;
    if (std::ranges::find(known, column) != known.end()) continue;
    document.problem(fmt::format("output.expected[{}].column", n), no_column(column, known));
  }
  document.finish();
}

Forecast forecast(FloatingSystem& floating, const coupling::Start& start) {
  const coupling::Scenario& s = floating.scenario();
  Forecast f{.core_seconds = output_seconds, .columns = columns_of(floating)};
  const auto add = [&](const PartCost& part) {
    f.core_seconds += part.core_seconds_per_work * (part.work_before + part.work_per_second * s.time.end_s);
    f.bytes += part.bytes + part.bytes_each + part.checkpoint_bytes;
  };
  if (s.has_actuator()) add(cost_of_flow(s, aero::flow_grid(*s.aero.flow)));
  if (has_resolved_rotor(s)) {
    const aero::ResolvedRotorSetup setup = resolved_rotor_on(floating, start);
    const bool strong = is_strong(s.coupling.scheme);
    add(cost_of_air(setup, aero::resolved_rotor_size(setup), coupled_pseudo_steps(s, &setup), s.start.air_steps, strong ? 2 : 1,
                    true));
  }
  if (floating.particle_plan()) {
    const sea::ParticleCensus census = particle_census(*floating.particle_plan(), start.state.motions);
    add(cost_of_particles(floating, census, particle_steps(floating, census)));
  } else {
    f.core_seconds += measured_steps(floating, start).core_seconds();
  }
  f.bytes += resident_memory() + output_bytes;
  return f;
}

// Pseudo-steps that recorded runs with the default march took (docs/developer/notes/coupled_system.md). A steady rotor until its
// loads settle: 64 to 141 from 6 to 20 m/s; parked 284, with blades at 90 degrees. The steady flow of a disc: 23 to a drop of
// 1e-2, 60 to 1e-3. Any other steady flow: 60 to 92, whether its flux balance is to fall by 1e-3 or by 1e-5. A physical step for
// each order: 3, of lines 2, of a disc 1; of a rotor with friction 2 after the first step, where it turns by 5.5 degrees in one 8
// and 9, by 13.7 degrees 2.6 to 7.
constexpr double steps_of_rotor = 85.0, steps_of_parked_rotor = 280.0, steps_of_steady = 75.0,
                 steady_steps_per_order_of_disc = 18.0, unsteady_steps_per_order = 3.0, steps_per_order_of_rotor = 2.0,
                 steps_per_order_of_far_turns = 9.0, steps_per_order_of_lines = 2.0, steps_per_order_of_disc = 1.0;

double orders(double drop) { return -std::log10(std::clamp(drop, 1e-16, 0.5)); }

PseudoSteps expected_pseudo_steps(const coupling::Scenario& s, const aero::ResolvedRotorSetup* rotor) {
  const aero::FlowOptions& flow = *s.aero.flow;
  const double windows = s.time.end_s / s.time.window_s;
  if (flow.time == "steady") {
    const bool by_loads = has_resolved_rotor(s) && coupling::resolved_rotor_setup(s).flow.load_change.value_or(0.0) > 0.0;
    if (!by_loads && flow.drop <= 0.0) return {1.0 / s.time.window_s, "pseudo-steps"};
    if (by_loads && rotor && rotor->rotor.speed == 0.0)
      return {std::min(windows, steps_of_parked_rotor) / s.time.end_s,
              "pseudo-steps until it has settled, as parked rotors may take,"};
    const double usual = by_loads           ? steps_of_rotor
                         : s.has_actuator() ? steady_steps_per_order_of_disc * orders(flow.drop)
                                            : steps_of_steady;
    return {std::min(windows, usual) / s.time.end_s, "pseudo-steps until it has settled, as flows usually do,"};
  }
  const double most = flow.max_pseudo_steps;
  if (flow.drop <= 0.0) return {most / s.time.window_s, "pseudo-steps"};
  const auto of_window = [&](double per_order) { return std::min(most, std::ceil(per_order * orders(flow.drop))); };
  if (rotor && aero::turns_far(*rotor)) {
    const double least = of_window(steps_per_order_of_rotor), up_to = of_window(steps_per_order_of_far_turns);
    return {up_to / s.time.window_s,
            fmt::format("pseudo-steps, up to {:.0f} and down to {:.0f} of a step in which the rotor turns by {:.3g} degrees,",
                        up_to, least, std::abs(rotor->rotor.speed) * rotor->dt / radians_per_degree)};
  }
  const double per_order = rotor && flow.viscous != "none"   ? steps_per_order_of_rotor
                           : s.aero.model == "actuator_disc" ? steps_per_order_of_disc
                           : s.aero.model == "actuator_line" ? steps_per_order_of_lines
                                                             : unsteady_steps_per_order;
  return {of_window(per_order) / s.time.window_s, "pseudo-steps, as many as are usual to the drop,"};
}

aero::ResolvedRotorSetup resolved_rotor_on(const FloatingSystem& floating, const coupling::Start& start) {
  const coupling::Scenario& s = floating.scenario();
  aero::ResolvedRotorSetup setup = coupling::resolved_rotor_setup(s);
  setup.rotor.speed = floating.rotor()->state(0.0, start.state.motions).speed;
  setup.dt = coupling::step_of(s);
  return setup;
}

PseudoSteps coupled_pseudo_steps(const coupling::Scenario& s, const aero::ResolvedRotorSetup* rotor) {
  PseudoSteps steps = expected_pseudo_steps(s, rotor);
  if (is_strong(s.coupling.scheme)) steps.per_second *= s.coupling.samples;
  return steps;
}

namespace {

/// A short march of a flow alone, as a run begins it.
struct FlowTrial {
  double begin_s = 0.0;           ///< processor time up to the first pseudo-step
  double step_s = 0.0;            ///< of a pseudo-step
  int steps = 0;                  ///< made
  double expected_windows = 0.0;  ///< of a steady flow: until it has settled
  double most_windows = 0.0;      ///< of the slowest that were recorded
  double steps_per_window = 1.0;
  bool settled = false;
};

/// Steady marches slow down on their way: at the rate of the first steps the rest takes longer than the orders that are left say.
/// Recorded: 1.0 to 3.6 times; with a closure of one equation to 5.1, of two to 7.7, and some of these stay at a drop of 1e-5 for
/// hundreds of steps.
constexpr double slower = 2.0;
double slowest(const aero::FlowOptions& flow) {
  const int equations = aero::model_sweeps(flow.turbulence).equations;
  return equations == 2 ? 25.0 : equations == 1 ? 8.0 : 4.0;
}

// A trial goes on for so long [s], for so many pseudo-steps of a steady flow at least (its balance first rises) or windows; it is
// made where these take no longer than that by the stated rates.
// Where a flow converges in none of its windows, they take many times as long: it is given up then.
constexpr double trial_s = 0.5, longest_trial_s = 1.5, given_up_s = 2.0 * longest_trial_s;
constexpr int least_steps = 8, least_windows = 2, steps_at_once = 4;

/// Nothing where the march fails.
std::optional<FlowTrial> try_flow(const coupling::Scenario& s) {
  const Aside aside;
  const runtime::World alone{MPI_COMM_SELF, 0, 1};
  const io::RunDirectory directory(MPI_COMM_SELF, aside.folder, io::Existing::overwrite);
  FlowTrial trial;
  const double before = processor_seconds();
  run::FlowSimulation flow(s, directory, alone, 0, steps_at_once);
  flow.begin(directory);
  const double begun = processor_seconds();
  trial.begin_s = begun - before;
  const bool steady = flow.counts_pseudo_steps();
  const std::int64_t windows = flow.timeline().windows(),
                     least = std::min<std::int64_t>(windows, steady ? least_steps : least_windows);
  double started = begun;  // the first window starts the flow, and takes more
  int at_start = 0;
  for (std::int64_t window = 0;
       window < windows && !trial.settled && processor_seconds() - before < (window < least ? given_up_s : trial_s);) {
    const run::Advance advance = flow.advance(window, windows);
    if (!advance.failure.empty() || advance.windows == 0) {
      if (steady || trial.steps == 0) return std::nullopt;
      break;  // the physical steps before count
    }
    window += advance.windows;
    const aero::MarchState& march = flow.solver().march();
    const double now = processor_seconds();
    if (steady) {
      trial.steps = int(window), trial.step_s = (now - begun) / double(window);
      trial.settled = !advance.settled.empty();
      const double left = orders(s.aero.flow->drop) / orders(march.balance_drop());
      const auto windows_if = [&](double times) { return double(window) * (left > 1.0 ? 1.0 + times * (left - 1.0) : 1.0); };
      trial.expected_windows = trial.settled ? double(window) : windows_if(slower);
      trial.most_windows = std::min(double(windows), windows_if(slowest(*s.aero.flow)));
    } else {
      trial.steps += march.steps - 1;
      if (window == 1) at_start = march.steps - 1, started = now;
      const int since = trial.steps - at_start;
      trial.steps_per_window = since > 0 ? double(since) / double(window - 1) : double(trial.steps);
      trial.step_s = since > 0 ? (now - started) / since : (now - begun) / trial.steps;
    }
  }
  return trial;
}

/// What the shortest trial takes by the stated rate; a steady flow begins on coarser grids, which takes as long as its first
/// steps.
double shortest_trial_s(const coupling::Scenario& s, const aero::FlowSize& size, const PseudoSteps& steps) {
  const bool steady = s.aero.flow->time == "steady";
  return size.core_seconds_per_pseudo_step *
         (steady ? 2.0 * least_steps : double(least_windows) * steps.per_second * s.time.window_s);
}

}  // namespace

PartCost cost_of_flow(const coupling::Scenario& s, const aero::MultiBlockGrid& grid) {
  const aero::FlowSize size = aero::flow_size(*s.aero.flow, grid);
  const double notes = s.bodies.empty() ? 0.0 : is_strong(s.coupling.scheme) ? 2.0 : 1.0;  // of a window's start
  const double actuator = s.has_actuator() ? aero::actuator_bytes(s.aero, coupling::placed_rotor(s).rotor, grid) : 0.0;
  const PseudoSteps steps = s.bodies.empty() ? expected_pseudo_steps(s) : coupled_pseudo_steps(s);
  PartCost cost{.name = "air",
                .count = double(size.cells),
                .things = "cells",
                .bytes = size.bytes + size.bytes_of_output + notes * size.bytes_of_checkpoint + actuator,
                .bytes_each = size.bytes_each,
                .checkpoint_bytes = size.bytes_of_checkpoint,
                .work_per_second = steps.per_second,
                .work = steps.work,
                .core_seconds_per_work = size.core_seconds_per_pseudo_step,
                .rate = {},
                .work_before = settling_steps(*s.aero.flow, s.start.air_steps, seconds_per_cell(*s.aero.flow))};
  std::string source = "stated for a core of 50 GFLOP/s";
  if (s.has_flow() && shortest_trial_s(s, size, steps) < longest_trial_s) {
    if (const std::optional<FlowTrial> trial = try_flow(s)) {
      cost.core_seconds_per_work = trial->step_s;
      cost.work_before = trial->begin_s / trial->step_s;
      if (s.aero.flow->time != "steady")
        cost.work_per_second = trial->steps_per_window / s.time.window_s, cost.work = "pseudo-steps";
      else if (s.aero.flow->drop > 0.0)
        cost.work_per_second = std::min(trial->expected_windows, s.time.end_s / s.time.window_s) / s.time.end_s,
        cost.work = trial->settled
                        ? "pseudo-steps until it has settled"
                        : fmt::format("pseudo-steps until it has settled at its rate, up to {:.0f} where that slows down,",
                                      std::max(trial->expected_windows, trial->most_windows));
      source = fmt::format("measured now: {} pseudo-steps of this flow", trial->steps);
    }
  }
  cost.rate = fmt::format("{:.3g} us per cell, {}", 1e6 * cost.core_seconds_per_work / double(size.cells), source);
  return cost;
}

Forecast forecast_of_air(const coupling::Scenario& s) {
  const double resident = resident_memory();  // before what a trial leaves behind
  PartCost cost;
  if (has_resolved_rotor(s)) {
    const aero::ResolvedRotorSetup setup = coupling::resolved_rotor_setup(s);
    cost = cost_of_air(setup, aero::resolved_rotor_size(setup), expected_pseudo_steps(s, &setup), 0.0, 1, true);
  } else {
    cost = cost_of_flow(s, aero::flow_grid(*s.aero.flow));
  }
  Forecast f{
      .core_seconds = output_seconds + cost.core_seconds_per_work * (cost.work_before + cost.work_per_second * s.time.end_s),
      .bytes = cost.bytes + cost.bytes_each + cost.checkpoint_bytes + resident + output_bytes};
  f.columns = columns_of_air_alone();
  return f;
}

}  // namespace spindrift::app
