// SPDX-License-Identifier: Apache-2.0
#include "src/app/forecast.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "runtime/trace/clock.hpp"
#include "src/aero/flow_grid.hpp"
#include "src/aero/flow_size.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/recorder.hpp"
#include "src/run/flow_columns.hpp"
#include "src/scene/value.hpp"

namespace spindrift::app {

namespace {

using coupling::FloatingSystem;

/// Least processor time of one call, over blocks of calls that take about a tenth of a second together.
template <class Call>
double least_seconds(Call&& call) {
  constexpr int block = 10, most_blocks = 40;
  double least = std::numeric_limits<double>::infinity();
  const double begin = processor_seconds();
  for (int n = 0; n < most_blocks && processor_seconds() - begin < 0.1; ++n) {
    const double before = processor_seconds();
    int calls = 0;
    while (calls < block && call()) ++calls;
    if (calls == 0) return 0.0;
    least = std::min(least, (processor_seconds() - before) / calls);
    if (calls < block) break;
  }
  return least;
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

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

StepCost measured_steps(FloatingSystem& floating, const coupling::Start& start) {
  const coupling::Timeline& t = floating.timeline();
  const coupling::Scenario& s = floating.scenario();
  StepCost cost;
  cost.steps = double(t.windows()) * double(t.steps_per_window()) * iterations(s);
  cost.rows = std::ceil(double(t.windows()) / floating.scenario().output.history_every) + 1.0;
  const coupling::FullLoads full(floating);
  bodies::BodiesState state = start.state;
  floating.reset_clocks();
  const std::int64_t begin_ns = runtime::Clock::now_ns();
  cost.step_s = least_seconds([&] { return floating.multibody().advance(state, t.tick_s(), 1).ok(); });
  const double step_alone = cost.step_s;
  if (exchanges(s)) {
    const double wall_ns = double(runtime::Clock::now_ns() - begin_ns);
    for (std::size_t n = 0; n < floating.clocks().size(); ++n) {
      const coupling::SourceClock clock = floating.clocks()[n];
      if (floating.multibody().loads()[n].name != "rotor" || clock.calls == 0) continue;
      const double share = std::min(1.0, double(clock.ns) / wall_ns);
      cost.exchanges = double(t.windows()) * iterations(s);
      cost.exchange_s = cost.step_s * share / (s.time.integrator == Integrator::rk4 ? 4.0 : 1.0);
      cost.step_s *= 1.0 - share;
    }
  }
  floating.reset_clocks();
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
  const double step = std::min({time.step_s.value_or(census.step_s), floating.body_step_limit(), census.step_s, time.window_s});
  return std::ceil(time.window_s / step * (1.0 - 1e-9));
}

PartCost cost_of_particles(const FloatingSystem& floating, const sea::ParticleCensus& census, double steps_per_window) {
  const coupling::Scenario& s = floating.scenario();
  const sph::Parameters& p = floating.particle_plan()->parameters;
  const double evaluations = steps_per_window / s.time.window_s * (p.step == sph::StepChoice::verlet ? 1.0 : 2.0);
  const int notes = floating.rotor() && is_strong(s.coupling.scheme) ? 2 : 1;
  return {.name = "sea",
          .count = double(census.particles()),
          .things = "particles",
          .bytes = census.bytes + notes * sea::bytes_of_note * double(census.particles()),
          .checkpoint_bytes = sea::bytes_of_note * double(census.particles()),
          .work_per_second = evaluations,
          .work = "evaluations of all",
          .core_seconds_per_work = double(census.particles()) / census.evaluations_per_second,
          .rate = fmt::format("{:.3g} M particles per core-s, measured now on a small sea", 1e-6 * census.evaluations_per_second),
          .work_before = s.sea.settle_s() * evaluations};
}

PartCost cost_of_air(const aero::ResolvedRotorSetup& setup, const aero::ResolvedRotorSize& size, double per_second, double before,
                     int notes, bool calibrate) {
  PartCost cost{.name = "air",
                .count = double(size.cells),
                .things = "cells",
                .bytes = size.bytes + (notes - 1) * size.bytes_of_checkpoint,
                .checkpoint_bytes = size.bytes_of_checkpoint,
                .work_per_second = per_second,
                .work = "pseudo-steps at most",
                .core_seconds_per_work = size.core_seconds_per_pseudo_step,
                .rate = {},
                .work_before = before};
  std::string source = "stated; --calibrate measures it";
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

void require_expected_columns(scene::Document& document, const coupling::OutputOptions& output,
                              const std::vector<std::string>& known) {
  for (std::size_t n = 0; n < output.expected.size(); ++n) {
    const std::string& column = output.expected[n].column;
    if (std::ranges::find(known, column) != known.end()) continue;
    const std::string near = scene::nearest(column, known);
    document.problem(fmt::format("output.expected[{}].column", n),
                     "is no column of this scene" + (near.empty() ? "" : "; did you mean \"" + near + "\"?"));
  }
  document.finish();
}

Forecast forecast(FloatingSystem& floating, const coupling::Start& start) {
  const coupling::Scenario& s = floating.scenario();
  Forecast f{.core_seconds = output_seconds, .columns = columns_of(floating)};
  const auto add = [&](const PartCost& part) {
    f.core_seconds += part.core_seconds_per_work * (part.work_before + part.work_per_second * s.time.end_s);
    f.bytes += part.bytes + part.checkpoint_bytes;
  };
  if (s.has_actuator()) add(cost_of_flow(s, aero::flow_grid(*s.aero.flow)));
  if (has_resolved_rotor(s)) {
    aero::ResolvedRotorSetup setup = coupling::resolved_rotor_setup(s);
    setup.rotor.speed = floating.rotor()->state(0.0, start.state.motions).speed;
    const bool strong = is_strong(s.coupling.scheme);
    add(cost_of_air(setup, aero::resolved_rotor_size(setup),
                    (strong ? s.coupling.samples : 1.0) * setup.flow.max_pseudo_steps / s.time.window_s, s.start.air_steps,
                    strong ? 2 : 1, true));
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

/// Flow without walls on a standing grid falls by about an order in a pseudo-step: the implicit steps are as large as they may
/// be.
bool steps_expected(const coupling::Scenario& s) {
  return s.has_actuator() && s.aero.flow->time != "steady" && s.aero.flow->drop > 0.0;
}

double pseudo_steps_per_second(const coupling::Scenario& s) {
  const aero::FlowOptions& flow = *s.aero.flow;
  const double most = flow.time == "steady" ? 1.0 : flow.max_pseudo_steps;
  return (steps_expected(s) ? std::min(most, std::ceil(-std::log10(flow.drop))) : most) / s.time.window_s;
}

PartCost cost_of_flow(const coupling::Scenario& s, const aero::MultiBlockGrid& grid) {
  const aero::FlowSize size = aero::flow_size(*s.aero.flow, grid);
  const bool strong = !s.bodies.empty() && is_strong(s.coupling.scheme);
  return {.name = "air",
          .count = double(size.cells),
          .things = "cells",
          .bytes = size.bytes + (strong ? size.bytes_of_checkpoint : 0.0),
          .checkpoint_bytes = size.bytes_of_checkpoint,
          .work_per_second = (strong ? s.coupling.samples : 1.0) * pseudo_steps_per_second(s),
          .work = steps_expected(s) ? "pseudo-steps, one to an order of drop" : "pseudo-steps at most",
          .core_seconds_per_work = size.core_seconds_per_pseudo_step,
          .rate = fmt::format("{:.3g} us per cell, stated", 1e6 * size.core_seconds_per_pseudo_step / double(size.cells)),
          .work_before = double(s.start.air_steps)};
}

Forecast forecast_of_air(const coupling::Scenario& s) {
  PartCost cost;
  if (has_resolved_rotor(s)) {
    const aero::ResolvedRotorSetup setup = coupling::resolved_rotor_setup(s);
    cost = cost_of_air(setup, aero::resolved_rotor_size(setup), pseudo_steps_per_second(s), 0.0, 1, true);
  } else {
    cost = cost_of_flow(s, aero::flow_grid(*s.aero.flow));
  }
  Forecast f{.core_seconds = cost.core_seconds_per_work * cost.work_per_second * s.time.end_s,
             .bytes = cost.bytes + cost.checkpoint_bytes + resident_memory() + output_bytes};
  f.columns = columns_of_air_alone();
  return f;
}

}  // namespace spindrift::app
