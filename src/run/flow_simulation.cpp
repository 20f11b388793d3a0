// SPDX-License-Identifier: Apache-2.0
#include "src/run/flow_simulation.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/trace/ledger.hpp"
#include "src/aero/coarse_start.hpp"
#include "src/aero/flow/choice.hpp"
#include "src/coupling/air_output.hpp"
#include "src/coupling/first_cells.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/retries.hpp"
#include "src/coupling/saved_air.hpp"

namespace spindrift::run {

namespace {

constexpr const char* settled_name = "flow/settled";

/// Fields, walls and loads along the blades at the end of the run.
class FinalFlow final : public Output {
 public:
  explicit FinalFlow(std::function<void(std::int64_t)> write) : write_(std::move(write)) {}
  std::string_view label() const override { return "output/air"; }
  bool due(const Windows&) const override { return false; }
  void take(const Windows&) override {}
  void finish(std::int64_t window) override { write_(window); }

 private:
  std::function<void(std::int64_t)> write_;
};

}  // namespace

FlowSimulation::FlowSimulation(const coupling::Scenario& scenario, const io::RunDirectory& directory, const runtime::World& world,
                               std::size_t records, int chunk)
    : scenario_(scenario),
      directory_(directory),
      world_(world),
      records_(records),
      timeline_(scenario.time.window_s, scenario.time.window_s, scenario.time.end_s),
      air_(scenario, world, chunk),
      file_(air_.solver(), world) {
  spdlog::info("air: {} cells in {} tiles of {} blocks, {:.0f} bytes per cell", air_.solver().cells(),
               air_.store().tiling().size(), air_.blocks(),
               double(air_.solver().bytes() + air_.store().bytes()) / double(std::max(1L, air_.solver().cells())) * world.size);
  if (air_.rotor())
    if (const std::string note = aero::far_side_note(*scenario.aero.grid); !note.empty()) spdlog::warn("air: {}", note);
  if (const aero::FlowSetting& s = air_.solver().setting(); s.time_tolerance) steps_.emplace(*s.time_tolerance, s.time_order);
  air_.solver().fill_geometry(world.comm);
}

/// preconditioner = "auto" became this one; scene.toml then names it, so that it runs alike.
void FlowSimulation::use(const std::string& preconditioner, const std::string& reason) {
  chosen_ = preconditioner;
  air_.solver().use(aero::make_preconditioner(preconditioner, air_.solver().setting().coarse));
  spdlog::info("air: preconditioner \"{}\" ({})", preconditioner, reason);
  if (world_.rank == 0) coupling::write_choice(directory_, preconditioner);
}

void FlowSimulation::record() {
  runtime::Graph graph(world_.comm);
  output_.record(graph);
  air_.solver().record(graph);
  march_.emplace(std::move(graph), runtime::ExecutorOptions{.records = records_, .watchdog_s = scenario_.runtime.watchdog_s});
}

std::int64_t FlowSimulation::begin(const io::RunDirectory&) {
  const runtime::Span span("aero/start");
  const aero::FlowOptions& options = *scenario_.aero.flow;
  if (options.preconditioner == "auto") {
    const aero::Choice choice = aero::choose_preconditioner(air_.solver(), world_.comm);
    use(choice.preconditioner, choice.reason);
  }
  const bool steady = air_.steady();
  if (const int coarse_steps = options.coarse_steps.value_or(0); steady && coarse_steps > 0 && air_.rotor()) {
    const aero::RotorLoad load = aero::start_from_coarser(resolved_rotor_setup(scenario_), coarse_steps, *air_.rotor(), world_);
    spdlog::info("air: {} pseudo-steps on a grid of half the resolution: thrust {:.4g} kN, power {:.4g} MW", coarse_steps,
                 1e-3 * load.thrust, 1e-6 * load.power);
  }
  record();
  if (steady && !air_.rotor()) air_.start_on_coarser_grids(scenario_, *march_, world_);
  return 0;
}

void FlowSimulation::restore(const io::CheckpointReader& file) {
  const runtime::Span span("aero/start");
  if (scenario_.aero.flow->preconditioner == "auto") use(file.text("preconditioner"), "as before the restart");
  record();
  air_.take(FlowCase::Start(file.integer("way")));
  file_.read(file);
  const std::int64_t window = file.integer("window");
  if (steps_)
    steps_->set_count(int(file.integer("time_steps")));
  else
    air_.solver().set_time_step(timeline_.window_s(), timeline_.window_s());
  if (air_.rotor() && !air_.steady()) air_.rotor()->placed_at(double(window));
  if (air_.motion()) air_.place(window, timeline_.window_s());
  if (!file.has(settled_name)) return;
  const std::vector<std::byte> bytes = file.read<std::byte>(settled_name);
  settled_.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

/// What is said and written of the flow needs its residual and its slopes at walls.
void FlowSimulation::nothing_left() {
  if (!air_.steady()) return air_.solver().fill_gradients(world_.comm);
  air_.solver().judgement().march.judge_only();
  march_->run();
}

void FlowSimulation::save(io::CheckpointCopy& copy) {
  if (!chosen_.empty()) copy.set("preconditioner", chosen_);
  copy.set("way", std::int64_t(air_.start()));
  if (steps_) copy.set("time_steps", std::int64_t(steps_->count()));
  if (!settled_.empty()) copy.write<std::byte>(settled_name, std::as_bytes(std::span(settled_)));
  write(copy, file_.arrays());
  if (!air_.rotor()) return;
  write_air_settings(copy, scenario_);
  write(copy, rotor_arrays(*air_.rotor(), coupling::computed_loads(*air_.rotor()), world_.rank));
}

Advance FlowSimulation::advance(std::int64_t window, std::int64_t last) {
  aero::FlowSolver& solver = air_.solver();
  const aero::MarchState& march = solver.march();
  if (air_.first_order_is_over()) {
    spdlog::info(
        "air: after {} pseudo-steps of first order the flux balance is at {:.2g}: the march goes on from there with "
        "aero.flow.limiter = \"{}\"",
        march.steps - 1, march.balance_drop(), solver.setting().limiter);
    air_.raise_order();
  } else if (air_.steady() && march.spent && solver.judgement().march.stands_still())
    begin_again(fmt::format("the flux balance is at {:.2g} and was not halved in the last {} pseudo-steps, CFL {:.2g}",
                            march.balance_drop(), march.still_for, march.cfl));
  aero::FlowSnapshot before = air_.snapshot();
  rows_.clear(), rows_from_ = window;
  // A matrix that serves several steps is made anew where a chunk begins: only whole ones are alike in every run.
  const bool whole = solver.judgement().march.options().refresh_every > 1;
  const std::int64_t left = (whole ? timeline_.windows() : last) - window;
  if (air_.steady()) solver.judgement().march.limit(int(std::min<std::int64_t>(left, FlowCase::steady_chunk)));
  for (int retry = 0;; ++retry) {
    solver.judgement().march.ease(coupling::share_of_cfl(retry));
    const bool made = made_window(window);
    const bool given_up = march.verdict == aero::Verdict::stopped && !air_.steady();
    if (made && holds_tolerance(window + 1)) break;
    if (made) {
      air_.return_to(before, window, timeline_.window_s());
      retry = -1;
      continue;
    }
    const std::string failure =
        fmt::format("t = {:g} s: aero: {} (pseudo-step {}, CFL {:.3g}, density residual {:.3g} after {:.3g} at first){}",
                    timeline_.window_end_s(window), march.why, march.steps, march.cfl, march.now.density, march.first.density,
                    solver.judgement().trouble());
    air_.return_to(before, window, timeline_.window_s());
    if (given_up) return {};
    if (retry == coupling::most_retries && begin_again(failure)) {
      before = air_.snapshot();
      retry = -1;
      continue;
    }
    if (retry == coupling::most_retries)
      return {.failure = fmt::format("{}; {} retries, the last from a CFL number {:g} as large", failure, retry,
                                     coupling::share_of_cfl(retry))};
    spdlog::warn("{}; made again from there (retry {} of {}) from a CFL number {:g} as large", failure, retry + 1,
                 coupling::most_retries, coupling::share_of_cfl(retry + 1));
  }
  Advance advance;
  if (!air_.steady()) count_limits(solver.rows());
  if (air_.steady()) {
    // The last row of a chunk that goes on is judged, and written, by the next; a march of first order always goes on.
    const bool of_first_order = air_.start() == FlowCase::Start::first_order;
    const std::size_t judged = solver.rows().size() - (march.spent || of_first_order ? 1 : 0);
    // One that has begun again has a row more, of where it began.
    rows_.assign(solver.rows().begin(), solver.rows().begin() + std::ptrdiff_t(std::min(std::int64_t(judged), left)));
    count_limits(rows_);
    last_rows_.insert(last_rows_.end(), rows_.begin(), rows_.end());
    while (last_rows_.size() > averaged(last)) last_rows_.pop_front();
    if (march.verdict == aero::Verdict::converged && !march.spent && !of_first_order)
      advance.settled = fmt::format("{}; flux balance at {:.2g}, density residual at {:.2g} of the start", march.why,
                                    march.balance_drop(), march.density_drop());
    if (!advance.settled.empty())
      if (const std::string walls = unresolved_walls(solver, scenario_, world_); !walls.empty())
        advance.failure = fmt::format("aero: {}, but {}", std::exchange(advance.settled, {}), walls);
    solver.judgement().rows.keep_last();
  } else {
    rows_ = {solver.rows().back()};
    if (steps_) {
      rows_[0].step = pseudo_steps_ - 1;
      steps_->end_window(window_.error);
    }
    solver.judgement().rows.all.clear();
    advance.failure = unconverged_windows(window + 1);
  }
  settled_ = advance.settled;
  advance.windows = std::int64_t(rows_.size());
  windows_ += advance.windows;
  return advance;
}

/// The steps of a window, or a chunk of a steady march; false where one came to nothing.
bool FlowSimulation::made_window(std::int64_t window) {
  const aero::MarchState& march = air_.solver().march();
  const double window_s = timeline_.window_s();
  window_ = {.error = 0.0, .count = steps_ ? steps_->count() : 1}, pseudo_steps_ = 0;
  for (int n = 1; n <= window_.count; ++n) {
    air_.move(double(window) + double(n) / window_.count, window_s);
    if (steps_) air_.solver().set_time_step(window_s / window_.count);
    march_->run();
    if (march.verdict == aero::Verdict::failed || (march.verdict == aero::Verdict::stopped && !air_.steady())) return false;
    pseudo_steps_ += march.steps;
    window_.error = std::max(window_.error, air_.solver().time_error().value_or(0.0));
  }
  return true;
}

/// Whether what comes to the end of `window` stands; else it is to be made again with more steps.
bool FlowSimulation::holds_tolerance(std::int64_t window) {
  if (!steps_) return true;
  if (steps_->refine(window_.error)) return false;
  if (steps_->too_large(window_.error) && ++above_tolerance_ == 1)
    spdlog::warn(
        "air: the window to t = {:.6g} s has an error in time of {:.2g} in {} steps, {:.2g} is asked for "
        "(aero.flow.time_tolerance); such windows are counted",
        timeline_.window_end_s(window), window_.error, window_.count, *air_.solver().setting().time_tolerance);
  return true;
}

void FlowSimulation::count_limits(std::span<const aero::PseudoRow> rows) {
  for (const aero::PseudoRow& row : rows) limits_.count(row.limited, row.clipped);
}

/// Of a steady march that comes to nothing, for this reason; false where there is no other way to begin it.
bool FlowSimulation::begin_again(const std::string& why) {
  const std::string how = air_.begin_again(scenario_);
  if (!how.empty()) spdlog::warn("air: {}: the march begins again {}", why, how);
  return !how.empty();
}

/// Of the unsteady march at the end of `window`: warns of the first window that spent its pseudo-steps; what is wrong where more
/// did than aero.flow.unconverged_share allows, else empty.
std::string FlowSimulation::unconverged_windows(std::int64_t window) const {
  const aero::FlowSolver& solver = air_.solver();
  const aero::MarchState& march = solver.march();
  const aero::FlowOptions& o = *scenario_.aero.flow;
  const double t = timeline_.window_end_s(window);
  if (march.spent && march.unconverged == 1)
    spdlog::warn(
        "air: the window to t = {:.6g} s spent its {} pseudo-steps; the flux balance is at {:.2g} of that at its start, {:.2g} "
        "is asked for; {}",
        t, march.steps - 1, march.balance_drop(), o.drop, solver.worst_cells(world_.comm));
  const std::string failure = too_many_unconverged();
  return failure.empty() ? failure
                         : fmt::format("{}; the last, to t = {:.6g} s, ended at {:.2g}; {}", failure, t, march.balance_drop(),
                                       solver.worst_cells(world_.comm));
}

/// Of the windows of an unsteady march so far, those before a restart too; empty where they are no more than may be.
std::string FlowSimulation::too_many_unconverged() const {
  const aero::MarchState& march = air_.solver().march();
  const aero::FlowOptions& o = *scenario_.aero.flow;
  const double most = o.unconverged_share * double(timeline_.windows());
  if (double(march.unconverged) <= most) return {};
  return fmt::format(
      "aero: {} of {} windows spent their {} pseudo-steps without the drop of {:.2g} (aero.flow.max_pseudo_steps, .drop), at "
      "most {:g} may (aero.flow.unconverged_share)",
      march.unconverged, march.ended, air_.solver().setting().march.max_steps, o.drop, std::floor(most));
}

namespace {

/// Of a march that is not asked to end by its loads, but whose loads stand still; empty of others.
std::string settled_loads(const aero::MarchState& march, const aero::MarchOptions& asked) {
  constexpr double still = 1e-3, far_down = 0.1;
  if (!(march.load_swing > 0.0 && march.load_swing <= still)) return {};  // a flow round nothing has no loads
  std::string said = fmt::format("; the loads have settled all the same: they changed by {:.2g} % over the last {} pseudo-steps",
                                 100.0 * march.load_swing, asked.load_window);
  const double reached = asked.by_balance ? march.balance_drop() : march.density_drop();
  if (reached > 0.0 && reached < far_down) {
    const double unit = std::pow(10.0, std::floor(std::log10(reached)));
    said += fmt::format(", and aero.flow.drop = {:.0e} would have taken it", unit * std::ceil(reached / unit));
  }
  return said;
}

}  // namespace

std::string FlowSimulation::failure_at_end() const {
  const aero::FlowOptions& o = *scenario_.aero.flow;
  if (!air_.steady())
    if (std::string failure = too_many_unconverged(); !failure.empty()) return failure;
  if (!air_.steady() || o.drop <= 0.0) {
    if (air_.start() == FlowCase::Start::first_order)
      return "aero: the pseudo-steps of the scene are spent while the march was of first order, which is no answer; --restart "
             "with a larger time.end_s goes on";
    const std::string walls = unresolved_walls(air_.solver(), scenario_, world_);
    return walls.empty() ? walls : "aero: " + walls;
  }
  const aero::MarchState& march = air_.solver().march();
  const aero::MarchOptions& asked = air_.solver().setting().march;
  const std::string loads =
      asked.load_change <= 0.0
          ? settled_loads(march, asked)
          : fmt::format(", the loads {} over the last {} pseudo-steps, {:.2g} is asked for (aero.flow.load_change)",
                        march.load_swing < 1.0 ? fmt::format("changed by {:.2g} of themselves", march.load_swing)
                                               : "did not come to rest",
                        asked.load_window, asked.load_change);
  return fmt::format(
      "aero: not converged in the {} pseudo-steps of the scene: the flux balance is at {:.2g} of that at the start, the density "
      "residual at {:.2g}, {:.2g} is asked for (aero.flow.drop; 0 takes all steps whatever they reach){}; {}; --restart with a "
      "larger time.end_s goes on",
      march.steps_made(), march.balance_drop(), march.density_drop(), o.drop, loads, air_.solver().worst_cells(world_.comm));
}

std::string FlowSimulation::done() const { return air_.steady() ? "done: the pseudo-steps of the scene are spent" : "done"; }

void FlowSimulation::declare(io::History& history) {
  columns_.emplace(history, air_.rotor(), air_.actuator(), air_.motion(), air_.solver().setting());
}

void FlowSimulation::fill_row(std::int64_t window, std::span<double> row) {
  columns_->fill(row, timeline_.window_end_s(window), air_.solver().setting(), rows_.at(std::size_t(window - rows_from_ - 1)),
                 *scenario_.aero.flow, flow_wind(scenario_), air_.solver().march().unconverged, window_);
}

std::vector<std::unique_ptr<Output>> FlowSimulation::outputs(const io::RunDirectory&, double) {
  std::vector<std::unique_ptr<Output>> outputs;
  outputs.push_back(std::make_unique<FinalFlow>([this](std::int64_t window) { write_at_end(window); }));
  return outputs;
}

/// Rows over which the summary's means go, in a run of so many windows: a steady flow that separates somewhere goes on swinging,
/// and its loads along the span are means over them.
std::size_t FlowSimulation::averaged(std::int64_t windows) const {
  const double length = scenario_.output.mean_length(timeline_.window_end_s(windows));
  return std::size_t(std::max(1.0, std::round(length / timeline_.window_s())));
}

void FlowSimulation::write_at_end(std::int64_t window) {
  const auto fields = std::make_shared<coupling::AirOutput>(world_.comm, air_.solver(), directory_.fields(),
                                                            coupling::AirOutput::Choice{.walls = scenario_.aero.flow->surfaces});
  output_.hand_on([fields, write = fields->copy(window, timeline_.window_end_s(window))] { write(); });
  for (const std::string& doubt : doubts_of_walls(air_.solver(), scenario_, world_)) {
    doubts_.push_back(fmt::format("air: {}", doubt));
    spdlog::warn(doubts_.back());
  }
  if (limits_.shortened() + limits_.clipped() > 0)
    spdlog::info("air: {}", limits_.text(fmt::format("{} pseudo-steps", limits_.counted()), air_.solver().cells(),
                                         air_.solver().limited_cells(aero::Updates::all, world_.comm)));
  if (air_.actuator() && windows_ > 0) coupling::write_span(world_, air_.actuator()->span_loads(), directory_);
  if (!air_.rotor() || windows_ == 0) return;  // a restart that has nothing left to do leaves what there is
  while (last_rows_.size() > averaged(window)) last_rows_.pop_front();
  const std::vector<aero::PseudoRow> rows(last_rows_.begin(), last_rows_.end());
  coupling::write_span(world_, rows.empty() ? air_.rotor()->span_loads() : air_.rotor()->span_loads(rows), directory_);
}

void FlowSimulation::summarise(io::Summary& summary, runtime::Ledger&) {
  summary.counts.emplace_back("cells", air_.solver().cells());
  summary.numerical_trouble.insert(summary.numerical_trouble.end(), doubts_.begin(), doubts_.end());
  summary.counts.emplace_back("krylov_steps", air_.solver().march().krylov_total);
  if (steps_) {
    summary.counts.emplace_back("time_steps", air_.solver().time_steps());
    summary.counts.emplace_back("windows_above_time_tolerance", above_tolerance_);
  }
  summary.counts.emplace_back("shortened_pseudo_steps", limits_.shortened());
  summary.counts.emplace_back("clipped_pseudo_steps", limits_.clipped());
}

}  // namespace spindrift::run
