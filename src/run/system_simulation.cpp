// SPDX-License-Identifier: Apache-2.0
#include "src/run/system_simulation.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <string_view>
#include <tuple>
#include <utility>

#include "runtime/trace/ledger.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/retries.hpp"
#include "src/coupling/saved_air.hpp"
#include "src/coupling/sea_output.hpp"
#include "src/coupling/sea_window.hpp"
#include "src/io/machine_failure.hpp"
#include "src/run/stand_in.hpp"

namespace spindrift::run {

using coupling::air_part, coupling::sea_part, coupling::library_of, coupling::library_log;

namespace {

/// The particles of a checkpoint into the floating system's sea, which must be the same sea. `named`: none where the checkpoint
/// is the run's own.
void restore_particles(const coupling::FloatingSystem& floating, const io::CheckpointReader& file,
                       const std::optional<coupling::NamedState>& named = {}) {
  if (!floating.particles()) return;
  sea::ParticleState state = floating.particles()->layout();
  if (const std::string why = coupling::other_sea(file, state.total); !why.empty()) {
    if (named) coupling::refuse_saved(floating.scenario(), *named, why);
    throw io::InputError(why);
  }
  try {
    const io::Slice<double> mine{state.first, state.values};
    file.read<double>(coupling::particles_name, std::span(&mine, 1));
    state.time_s = file.number("sea/time_s"), state.steps = file.integer("sea/steps");
    if (file.has("sea/sensors")) state.sensors = file.read<double>("sea/sensors");
    if (file.has("sea/energy")) {
      const std::vector<std::int64_t> sums = file.read<std::int64_t>("sea/energy");
      if (sums.size() == 3) state.energy = {sums[0], sums[1], sums[2]};
    }
    if (file.has("sea/made_J")) state.made_J = file.read<double>("sea/made_J").at(0);
    floating.particles()->restore(state);
  } catch (const std::invalid_argument& e) { throw io::InputError(file.path().string() + ": " + e.what()); }
}

/// What the history of a coupling scheme follows from.
std::vector<double> form_of(const coupling::CouplingOptions& o) {
  return {double(o.scheme),        double(o.composition), double(o.predictor_order),
          double(o.reuse_windows), double(o.samples),     double(o.interpolation)};
}
/// Of the history in a checkpoint. An older program saved its scheme alone, and took the rest to be as it is `now`.
std::vector<double> form_of(const io::CheckpointReader& file, const coupling::CouplingOptions& now) {
  if (file.has("coupling/form")) return file.read<double>("coupling/form");
  std::vector<double> form = form_of(now);
  form[0] = double(file.integer("coupling/scheme"));
  return form;
}

void save_library(const coupling::FloatingSystem& floating, io::CheckpointCopy& copy) {
  const aero::BladedLibrary* library = library_of(floating);
  if (library) copy.write<std::byte>(library_log, std::as_bytes(library->log()));
}

void restore_library(const coupling::FloatingSystem& floating, const io::CheckpointReader& file) {
  aero::BladedLibrary* library = library_of(floating);
  if (!library) return;
  const std::vector<std::byte> bytes = file.read<std::byte>(library_log);
  std::vector<aero::BladedLibrary::Told> log(bytes.size() / sizeof(aero::BladedLibrary::Told));
  if (log.size() * sizeof(aero::BladedLibrary::Told) != bytes.size())
    throw io::InputError(
        fmt::format("{}: array {} is that of another version of the program", file.path().string(), library_log));
  std::memcpy(log.data(), bytes.data(), bytes.size());
  library->set_log(log);
}

/// The particles that the scene starts from, on the ranks that have the sea. Collective; throws on all ranks alike.
void fill_sea(coupling::FloatingSystem& floating, std::span<const Motion> start, const runtime::Parts& parts) {
  coupling::on_parts(parts, [&] {
    if (parts.has(sea_part)) floating.fill_sea(start, parts.mine());
  });
  const auto& initial = floating.scenario().sea.initial;
  if (!floating.particle_plan() || !initial || initial->state != "file") return;
  const io::CheckpointReader file = coupling::open_sea(parts.world().comm, floating);
  coupling::on_parts(parts, [&] { restore_particles(floating, file, coupling::NamedState{"sea.initial.file", initial->file}); });
}

coupling::Sides sides_in_filled_sea(coupling::FloatingSystem& floating, std::span<const Motion> start,
                                    const runtime::Parts& parts, Moves moves) {
  if (floating.particle_plan()) {
    const runtime::Span span("sea/start");
    fill_sea(floating, start, parts);
  }
  switch (moves) {
    case Moves::both:
      break;
    case Moves::air:
      return {make_air(floating, floating.rotor()->state(0.0, start), parts.mine()), make_still_bodies()};
    case Moves::sea:
      return {make_silent_air(), make_body_side(floating)};
  }
  return make_sides(floating, start, parts);
}

/// Particles and surface, as [sea.fields] asks for them.
class SeaFields final : public Output {
 public:
  SeaFields(const coupling::FloatingSystem& floating, coupling::OutputTask& task, const std::filesystem::path& folder,
            const runtime::World& world, double resume_s)
      : floating_(floating), task_(task), output_(floating, folder, world, resume_s) {
    const auto& options = floating.scenario().sea.fields;
    if (!floating.particles() || !options) return;
    const coupling::Timeline& timeline = floating.timeline();
    every_.windows = Every::count(options->interval_s, timeline);
    every_.origin = every_.from = std::llround(options->from_s / timeline.window_s());
    every_.to = options->to_s ? std::llround(*options->to_s / timeline.window_s()) : timeline.windows();
  }
  std::string_view label() const override { return "output/sea"; }
  void begin(std::int64_t window) override {
    if (every_.due(window)) write(window);
  }
  void resume(std::int64_t window) override { begin(window); }
  bool due(const Windows& done) const override { return every_.due(done); }
  void take(const Windows& done) override { write(done.now); }

 private:
  void write(std::int64_t window) {
    task_.hand_on(output_.copy(floating_.timeline().tick_of_window(window) - floating_.timeline().first_tick(),
                               floating_.timeline().window_end_s(window)));
  }
  const coupling::FloatingSystem& floating_;
  coupling::OutputTask& task_;
  coupling::SeaOutput output_;
  Every every_;
};

/// Fields of the air at intervals after t = 0 and at the end, where loads along the blades are written too.
class AirFields final : public Output {
 public:
  AirFields(const coupling::FloatingSystem& floating, coupling::OutputTask& task, coupling::AirSide& air)
      : floating_(floating), task_(task), air_(air) {
    every_.windows = every_.from = Every::count(floating.scenario().air_interval_s(), floating.timeline());
  }
  std::string_view label() const override { return "output/air"; }
  void resume(std::int64_t window) override {
    if (!every_.due(window)) return;
    air_.fill_gradients();
    write(window);
  }
  bool due(const Windows& done) const override { return every_.due(done) && done.now < done.last; }
  void take(const Windows& done) override { write(done.now); }
  void finish(std::int64_t window) override { write(window), air_.write_span(); }

 private:
  void write(std::int64_t window) {
    task_.hand_on(air_.copy_fields(floating_.timeline().tick_of_window(window) - floating_.timeline().first_tick(),
                                   floating_.timeline().window_end_s(window)));
  }
  const coupling::FloatingSystem& floating_;
  coupling::OutputTask& task_;
  coupling::AirSide& air_;
  Every every_;
};

void write_lines(const std::vector<std::string>& sentences) {
  constexpr std::string_view warns = "warning: ";
  for (const std::string& sentence : sentences)
    if (sentence.starts_with(warns))
      spdlog::warn("{}", sentence.substr(warns.size()));
    else
      spdlog::info("{}", sentence);
}

/// Of what the scene has.
std::string smaller_steps(const coupling::FloatingSystem& floating, int retry) {
  std::string words = fmt::format("bodies by {} pieces of a step", coupling::pieces_of_step(retry));
  if (floating.particle_plan()) words += fmt::format(", sea by {:g} of its limit", coupling::share_of_substep(retry));
  if (floating.scenario().resolves_air())
    words += fmt::format(", CFL number of the air {:g} as large", coupling::share_of_cfl(retry));
  return words;
}

}  // namespace

SystemSimulation::SystemSimulation(coupling::FloatingSystem& floating, bodies::BodiesState start, const runtime::Parts& parts,
                                   std::size_t records, Moves moves)
    : floating_(floating),
      parts_(parts),
      state_(std::move(start)),
      window_(floating, sides_in_filled_sea(floating, state_.motions, parts, moves), parts.mine().comm, records) {}

std::int64_t SystemSimulation::file_number(std::int64_t window) const {
  return floating_.timeline().tick_of_window(window) - floating_.timeline().first_tick();
}

std::int64_t SystemSimulation::begin(const io::RunDirectory& directory) {
  if (parts_.has(air_part)) window_.sides().air().settle_in(directory);
  std::int64_t window = -floating_.timeline().held_windows();
  if (floating_.scenario().start.file.empty()) {
    window_.begin(state_);  // rotor and bodies begin at t = 0, whatever is held before
    state_.tick = floating_.timeline().first_tick();
  } else {
    window = take_over();
  }
  write_log_lines();
  if (floating_.particles()) {
    const runtime::Span span("sea/start");
    evaluate_particles(floating_, state_);
  }
  start_clocks();
  return window;
}

/// start.file.
std::int64_t SystemSimulation::take_over() {
  const coupling::SavedStart saved = coupling::open_start(parts_.world().comm, floating_, state_);
  const io::CheckpointReader& file = saved.file;
  const std::vector<double> bodies = file.read<double>(coupling::bodies_name);
  const std::vector<double> work = std::exchange(state_.work, {});  // counted anew
  state_.unpack(std::span(bodies).first(state_.packed_size()));
  state_.work = work;
  state_.tick = floating_.timeline().tick_of_window(saved.window);
  restore_library(floating_, file);
  restore_fluids(file, coupling::NamedState{"start.file", floating_.scenario().start.file});
  // What the scheme has learnt goes along where scheme and window are the same; else it begins with the state alone.
  const bool same = file.has("coupling/history") &&
                    form_of(file, floating_.scenario().coupling) == form_of(floating_.scenario().coupling) &&
                    file.number("window_s") == floating_.timeline().window_s();
  if (!same || !window_.restore(file.read<double>("coupling/history"))) window_.begin(state_);
  spdlog::info("from t = {:g} s of {}", saved.t, file.path().string());
  return saved.window;
}

void SystemSimulation::restore(const io::CheckpointReader& file) {
  const std::vector<double> bodies = file.read<double>(coupling::bodies_name);
  if (bodies.size() != state_.packed_size() || file.integer("bodies/works") != std::int64_t(state_.work.size()))
    throw io::InputError(file.path().string() +
                         ": its bodies, joints, loads and their memories are not those of this scene, which cannot "
                         "go on from it");
  state_.unpack(bodies);
  steps_ = file.integer("steps");
  restore_library(floating_, file);
  restore_fluids(file);  // first: a scheme that begins anew asks the air for its load
  const bool learnt = file.has("coupling/history");
  if (learnt && form_of(file, floating_.scenario().coupling) != form_of(floating_.scenario().coupling)) {
    spdlog::warn("the coupling scheme begins anew: its options are not those of {}", file.path().string());
    window_.begin(state_);
  } else if (!window_.restore(learnt ? file.read<double>("coupling/history") : std::vector<double>())) {
    throw io::InputError(file.path().string() + ": its coupling history is that of another coupling.scheme");
  }
  if (floating_.particles()) place_in_particles(floating_, state_);
  write_log_lines();
  start_clocks();
}

void SystemSimulation::restore_fluids(const io::CheckpointReader& file, const std::optional<coupling::NamedState>& named) {
  coupling::on_parts(parts_, [&] {
    window_.sides().air().restore(file);
    restore_particles(floating_, file, named);
  });
}

void SystemSimulation::save(io::CheckpointCopy& copy) {
  std::vector<double> packed(state_.packed_size());
  state_.pack(packed);
  copy.set("steps", steps_);
  copy.write<double>(coupling::bodies_name, packed);
  copy.set("bodies/works", std::int64_t(state_.work.size()));
  copy.write<double>(coupling::step_of_bodies, std::array{floating_.timeline().tick_s()});
  if (const std::vector<double> history = window_.history(); !history.empty()) {
    copy.write<double>("coupling/form", form_of(floating_.scenario().coupling));
    copy.write<double>("coupling/history", history);
  }
  save_library(floating_, copy);
  coupling::write(copy, parts_, air_part, window_.sides().air().saved());
  if (has_resolved_rotor(floating_.scenario())) write_air_settings(copy, floating_.scenario());
  if (!floating_.particle_plan()) return;
  sea::ParticleState particles;
  if (parts_.has(sea_part)) particles = floating_.particles()->save();
  copy.set("sea/time_s", particles.time_s);  // as rank 0 has it, which has the sea
  copy.set("sea/steps", particles.steps);
  const std::array sums{particles.energy.onto_water, particles.energy.from_solids, particles.energy.absorbed};
  copy.write<std::int64_t>("sea/energy", sums);
  copy.write<double>("sea/made_J", std::array{particles.made_J});
  if (!floating_.particle_plan()->sensors.empty()) copy.write<double>("sea/sensors", particles.sensors);
  std::vector<coupling::SavedArray> arrays;  // not by a list, which copies
  arrays.push_back({coupling::particles_name, particles.total, {}});
  arrays.back().pieces.push_back({particles.first, std::move(particles.values)});
  coupling::write(copy, parts_, sea_part, std::move(arrays));
}

Advance SystemSimulation::advance(std::int64_t window, std::int64_t) {
  const auto begin = std::chrono::steady_clock::now();
  const double end_s = floating_.timeline().window_end_s(window + 1);
  const std::int64_t steps = window_.sides().bodies().steps();
  coupling::WindowReport report = window_.advance(state_);
  for (int retry = 1; report.of_a_side && !report.stopped && retry <= coupling::most_retries; ++retry) {
    spdlog::warn("{}; the window to t = {:g} s is made again (retry {} of {}): {}", report.failure, end_s, retry,
                 coupling::most_retries, smaller_steps(floating_, retry));
    report = window_.advance(state_, retry);
  }
  if (aero::BladedLibrary* library = library_of(floating_)) {
    for (const std::string& greeting : library->take_greetings()) spdlog::info("{}", greeting);
    for (const std::string& warning : library->take_warnings()) spdlog::warn("{}", warning);
  }
  write_log_lines();
  if (report.stopped) return {};
  log_window(report, end_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  if (report.log.retries > 0)
    spdlog::warn("window that ends at t = {:g} s: {} retries and {} cuts, {} evaluations, ended by {}", end_s, report.log.retries,
                 report.log.cuts, report.log.evaluations, bound_name(report.log.bound));
  if (!report.ok()) return {.failure = report.failure};
  steps_ += floating_.particle_plan() ? window_.sides().bodies().steps() - steps : floating_.timeline().steps_per_window();
  return {.windows = 1};
}

/// Start-up is not in the windows' times. Collective.
void SystemSimulation::start_clocks() {
  floating_.sources.reset_clocks();
  core_seconds_[3] = runtime::summed(parts_.world().comm, {1e-9 * double(parts_.waited_ns())})[0];
}

void SystemSimulation::write_log_lines() { write_lines(window_.sides().air().log_lines()); }

/// A line of log.txt for a window: how it went, and core-seconds of each side on all ranks; not for single evaluations of a
/// system without fluids, which are too short to be worth a line. Collective.
void SystemSimulation::log_window(const coupling::WindowReport& report, double end_s, double wall_s) {
  const bool resolved = floating_.scenario().resolves_air() || floating_.particle_plan();
  if (!resolved && !window_.iterates()) return;
  const coupling::WindowTasks& tasks = window_.sides().tasks();
  const double bodies = parts_.has(sea_part) ? 1e-9 * double(window_.sides().bodies().own_ns()) : 0.0;
  const std::vector<double> now =
      runtime::summed(parts_.world().comm, {tasks.core_seconds("aero") + tasks.core_seconds("rotor"), tasks.core_seconds("sea"),
                                            bodies, 1e-9 * double(parts_.waited_ns())});
  std::array<double, 4> spent;
  for (std::size_t n = 0; n < now.size(); ++n) spent[n] = now[n] - core_seconds_[n], core_seconds_[n] = now[n];
  const coupling::WindowLog& log = report.log;
  std::string how = fmt::format("{} evaluations, mismatch {:.3g}", log.evaluations, report.mismatch);
  if (window_.iterates())
    how += fmt::format(", residual {:.3g} of {:.3g} at first, {} columns, {} retries, {} cuts, ended by {}", log.residual,
                       log.first_residual, log.columns, log.retries, log.cuts, bound_name(log.bound));
  spdlog::debug("window to t = {:g} s: {}; {:.3g} s; core-s: air {:.3g}, sea {:.3g}, bodies {:.3g}{}", end_s, how, wall_s,
                spent[0], spent[1], spent[2],
                parts_.split() ? fmt::format("; ranks waited {:.3g} s for the other side", spent[3]) : std::string());
}

void SystemSimulation::declare(io::History& history) {
  recorder_.emplace(floating_, history);
  window_.declare(history);
}

bool SystemSimulation::has_rows() const { return parts_.has(sea_part); }

void SystemSimulation::fill_row(std::int64_t window, std::span<double> row) {
  // Loads that are evaluated once more for the row are the output's time.
  const std::vector<coupling::LoadSources::Clock> clocks = floating_.sources.clocks;
  recorder_->fill(row, state_, floating_.timeline().window_end_s(window));
  floating_.sources.clocks = clocks;
  window_.put(row);
}

std::vector<std::unique_ptr<Output>> SystemSimulation::outputs(const io::RunDirectory& directory, double resume_s) {
  window_.sides().air().open_output(directory, resume_s);
  std::vector<std::unique_ptr<Output>> outputs;
  outputs.push_back(std::make_unique<SeaFields>(floating_, output(), directory.fields(), parts_.mine(), resume_s));
  outputs.push_back(std::make_unique<AirFields>(floating_, output(), window_.sides().air()));
  return outputs;
}

void SystemSimulation::summarise(io::Summary& summary, runtime::Ledger& ledger) {
  summary.counts.emplace_back("steps", steps_);
  if (const auto* plan = floating_.particle_plan()) summary.sound_speed_m_s = plan->parameters.eos.c0;
  if (floating_.has_interface()) {
    const coupling::CoupledWindow::Totals& totals = window_.totals();
    summary.counts.emplace_back("coupling_evaluations", totals.evaluations);
    summary.counts.emplace_back("coupling_retries", totals.retries);
    summary.counts.emplace_back("coupling_cuts", totals.cuts);
    summary.counts.emplace_back("rotor_evaluations", totals.rotor_calls);
    summary.counts.emplace_back("step_evaluations", totals.body_steps);
  }
  if (const sea::ParticleSea* sea = floating_.particles()) {
    const sea::ParticleSea::Counts counts = sea->counts();
    summary.counts.emplace_back("particles", std::int64_t(counts.particles));
    summary.counts.emplace_back("particle_evaluations", counts.evaluations);
    summary.counts.emplace_back("particle_sorts", counts.sorts);
    summary.counts.emplace_back("particles_lost", std::int64_t(counts.lost));
    summary.counts.emplace_back("particles_left", std::int64_t(counts.left));
  }
  const coupling::AirSide::Account air = window_.sides().air().account();
  summary.counts.insert(summary.counts.end(), air.counts.begin(), air.counts.end());
  write_log_lines(), write_lines(air.sentences);
  for (const std::string& doubt : air.doubts) spdlog::warn("{}", doubt);
  summary.numerical_trouble.insert(summary.numerical_trouble.end(), air.doubts.begin(), air.doubts.end());
  // Bodies that no particle moves go on within tasks of the sea; all ask for their loads within their own.
  if (parts_.has(sea_part) && !floating_.scenario().bodies.empty()) {
    if (floating_.particles() && !floating_.particles()->moves_solids())
      ledger.move("sea", "bodies/substeps", window_.sides().bodies().own_ns(), window_.sides().bodies().steps());
    const auto& clocks = floating_.sources.clocks;
    for (std::size_t s = 0; s < clocks.size(); ++s)
      ledger.move("bodies", floating_.multibody().loads()[s].name + "/loads", clocks[s].ns, clocks[s].calls);
  }
  if (parts_.split()) describe_sides(summary, ledger);
}

/// Where the core-seconds of each side's ranks went, into the summary and as lines under the table. Collective; split runs.
void SystemSimulation::describe_sides(io::Summary& summary, const runtime::Ledger& ledger) {
  const runtime::RankTrace trace = ledger.sums(parts_.world().rank);
  std::vector<double> mine(8, 0.0);  // by part: ranks, core-seconds in all, busy, waiting for the other side
  double* at = mine.data() + 4 * parts_.part();
  at[0] = 1.0, at[3] = 1e-9 * double(parts_.waited_ns()) * double(trace.threads.size());
  for (const runtime::ThreadTimes& thread : trace.threads)
    at[1] += 1e-9 * double(thread.wall_ns), at[2] += 1e-9 * double(thread.task_ns);
  const std::vector<double> all = runtime::summed(parts_.world().comm, mine);
  for (const auto& [part, name, other] : {std::tuple{air_part, "air", "sea"}, std::tuple{sea_part, "sea", "air"}}) {
    const double *of = all.data() + 4 * part, core_s = of[1];
    spdlog::info(
        "  {} on {} rank{}: {:5.1f} % busy, {:5.1f} % waiting for the {}, {:5.1f} % other waiting and runtime; of {:.4g} core-s",
        name, of[0], of[0] == 1.0 ? "" : "s", 100.0 * of[2] / core_s, 100.0 * of[3] / core_s, other,
        100.0 * (core_s - of[2] - of[3]) / core_s, core_s);
    summary.efficiency.push_back(
        {fmt::format("{} busy", name), of[2] / core_s, fmt::format("useful part of the core-seconds of the {}'s ranks", name)});
    summary.efficiency.push_back(
        {fmt::format("{} waiting", name), of[3] / core_s, fmt::format("part of them spent until the {} was done", other)});
  }
}

}  // namespace spindrift::run
