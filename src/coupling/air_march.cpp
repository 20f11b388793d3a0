// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/air_march.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "kernels/base/failure.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "runtime/trace/clock.hpp"
#include "runtime/trace/ledger.hpp"
#include "src/aero/flow/choice.hpp"
#include "src/coupling/columns.hpp"
#include "src/coupling/first_cells.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/retries.hpp"

namespace spindrift::coupling {

namespace {

/// What preconditioner = "auto" may become, by number in checkpoints.
constexpr std::array<const char*, 2> choices{"block_ilu", "coarse"};
constexpr const char* choice_name = "air/preconditioner";

SavedArray choice_array(const std::string& preconditioner, int rank) {
  SavedArray array{choice_name, 1, {}};
  if (rank == 0) array.pieces.push_back({0, {double(std::ranges::find(choices, preconditioner) - choices.begin())}});
  return array;
}

/// Nothing where the file has none.
std::optional<std::string> choice_in(const io::CheckpointReader& file) {
  if (!file.has(choice_name)) return {};
  return choices.at(std::size_t(file.read<double>(choice_name).at(0)));
}

/// Throws NumericalFailure where the step to `t` failed or too many steps have not converged, runtime::StopAsked where it was
/// given up; a first step that was spent goes to `log_lines`, once.
void require_good_step(const aero::FlowSolver& solver, const FloatingSystem& floating, double t,
                       std::vector<std::string>& log_lines, bool& told_spent) {
  const aero::FlowOptions& flow = *floating.scenario().aero.flow;
  const aero::MarchState& march = solver.march();
  if (march.verdict == aero::Verdict::stopped) throw runtime::StopAsked();
  if (march.verdict == aero::Verdict::failed)
    throw NumericalFailure(fmt::format("t = {:g} s: aero: {} (pseudo-step {}, CFL {:.3g}){}; try aero.flow.cfl_max below {:g}", t,
                                       march.why, march.steps, march.cfl, solver.judgement().trouble(), flow.cfl_max),
                           "aero/rotor", long(solver.time_steps()), t);
  const long windows = floating.timeline().windows(), unconverged = march.unconverged;
  if (march.spent && unconverged == 1 && !std::exchange(told_spent, true))
    log_lines.push_back(
        fmt::format("warning: air: the step to t = {:g} s spent its {} pseudo-steps; the flux balance is at {:.2g} of "
                    "that at its start, {:.2g} is asked for",
                    t, march.steps - 1, march.balance_drop(), flow.drop));
  if (double(unconverged) > flow.unconverged_share * double(std::max(windows, march.ended)))
    throw LastingFailure(  // from smaller CFL numbers the same pseudo-steps come less far
        fmt::format("t = {:g} s: aero: {} of {} steps spent their {} pseudo-steps without the drop of {:.2g}, more than "
                    "aero.flow.unconverged_share = {:g} of the run's; the last ended at {:.2g}; try more "
                    "aero.flow.max_pseudo_steps or a shorter window",
                    t, unconverged, march.ended, flow.max_pseudo_steps, flow.drop, flow.unconverged_share, march.balance_drop()),
        "aero/rotor", long(solver.time_steps()), t);
}

}  // namespace

double step_of(const Scenario& s) {
  return is_strong(s.coupling.scheme) ? s.time.window_s / s.coupling.samples : s.time.window_s;
}

MarchingAir::MarchingAir(const FloatingSystem& floating, const aero::RotorState& now, const runtime::World& world)
    : floating_(floating),
      world_(world),
      state_(now),
      preconditioner_(scenario().aero.flow->preconditioner),
      wind_(changing_wind(scenario())) {}

void MarchingAir::prepare(double t, double dt, const aero::RotorState& at_end) {
  t_ = t, state_ = at_end;
  if (dt == 0.0) return;
  solver_->set_time_step(dt);
  solver_->set_wind(wind_.until(t));
  move();
  solver_->judgement().rows.all.clear();
}

void MarchingAir::tell_wind() {
  if (wind_.has_plane()) log_lines_.push_back("air: " + wind_.description());
}

Tasks MarchingAir::record(runtime::Graph& graph) {
  solver_->record(graph);
  return Tasks::many;
}

aero::RotorLoad MarchingAir::load_at_end() {
  require_good_step(*solver_, floating_, t_, log_lines_, told_spent_);
  loads_.computed = computed();
  return update_load_on_bodies();
}

void MarchingAir::make_timed() {
  const std::int64_t begin_ns = runtime::Clock::now_ns();
  make();
  made_s_ = std::max(made_s_, runtime::Clock::seconds_since(begin_ns));
}

std::optional<aero::TileMove> MarchingAir::better_ranks(const Measured& measured) {
  // What knows ranks would make results follow the clock.
  if (world_.size == 1 || solver_->knows_ranks() || scenario().aero.flow->wall_distance == "poisson") return {};
  return aero::better_ranks(solver_->grid(), aero::seconds_of_tiles(solver_->grid(), measured.executors),
                            {.move_s = made_s_,
                             .ahead = double(measured.left) / double(std::max<std::int64_t>(1, measured.windows)),
                             .threads = measured.executors.empty() ? 1 : measured.executors.front()->threads()},
                            world_.comm);
}

void MarchingAir::move_tiles(const aero::TileMove& move) {
  const runtime::Span span("aero/balance");
  const runtime::StopRequest::Later to_the_end;  // between two solvers there is no state to save
  const std::int64_t begin_ns = runtime::Clock::now_ns();
  const aero::GridStore& grid = solver_->grid();
  const std::vector<int> owned(grid.owned().begin(), grid.owned().end());
  const std::vector<int> before(grid.rank_of_tile().begin(), grid.rank_of_tile().end());
  rank_of_tile_ = move.rank_of_tile;
  make_anew([&](aero::FlowSnapshot mine) { return aero::send_tiles(std::move(mine), owned, rank_of_tile_, world_.comm); });
  if (output_) output_->follow(*solver_);
  const double took_s = runtime::Clock::seconds_since(begin_ns);
  made_s_ = std::max(made_s_, took_s);
  std::size_t moved = 0;
  for (std::size_t t = 0; t < before.size(); ++t) moved += std::size_t(before[t] != rank_of_tile_[t]);
  log_lines_.push_back(fmt::format(
      "t = {:g} s: air: {} of {} tiles go to other ranks, by the time that each took: the most loaded rank has {:.3g} "
      "of the mean, it had {:.3g}; {:.2g} s",
      t_, moved, before.size(), move.after, move.before, took_s));
}

aero::RotorLoad MarchingAir::update_load_on_bodies() {
  return loads_.on_bodies = on_bodies(loads_.computed.rotor).times(floating_.rotor_source().ramp_of_air(t_));
}

void MarchingAir::ease(int retry) {
  if (solver_) solver_->judgement().march.ease(share_of_cfl(retry));
}

void MarchingAir::choose() {
  const aero::Choice choice = aero::choose_preconditioner(*solver_, world_.comm);
  preconditioner_ = choice.preconditioner;
  solver_->use(aero::make_preconditioner(preconditioner_, solver_->setting().coarse));
  log_lines_.push_back(fmt::format("air: preconditioner \"{}\" ({})", preconditioner_, choice.reason));
}

void MarchingAir::settle(const SteadyMarch& march, int retry) {
  const runtime::Phase settling("settling");
  std::optional<SettlingFile> file;
  if (const double interval_s = scenario().checkpoint.wall_interval_s; directory_ && interval_s > 0.0)
    file.emplace(*directory_, world_, interval_s);
  coupling::settle(march, scenario().start.air_steps, retry, std::move(file), world_, log_lines_);
}

std::vector<SavedArray> MarchingAir::saved() const {
  std::vector<SavedArray> arrays = AirFile(*solver_, world_).arrays();
  for (SavedArray& array : computed_arrays()) arrays.push_back(std::move(array));
  arrays.push_back(rotor_load_array({loads_.on_bodies, step_of(scenario())}, world_.rank));
  if (scenario().aero.flow->preconditioner == "auto") arrays.push_back(choice_array(preconditioner_, world_.rank));
  return arrays;
}

void MarchingAir::restore(const io::CheckpointReader& file) {
  const runtime::Span span("aero/start");
  if (const std::optional<std::string> named = choice_in(file); automatic() && named) {
    preconditioner_ = *named;
    log_lines_.push_back(fmt::format("air: preconditioner \"{}\" (as before the restart)", *named));
  }
  make_timed();
  AirFile(*solver_, world_).read(file);
  if (automatic()) choose();  // the run that left it had named one
  loads_ = {computed_loads_in(file, int(loads_.computed.blades.size())), rotor_load_in(file).load};
}

std::vector<io::Column> MarchingAir::columns() const {
  std::vector<io::Column> columns;
  for (const auto& c : march_columns()) columns.push_back({fmt::format("air.{}", c.name), c.unit, c.meaning});
  for (const auto& c : mass_columns()) columns.push_back({fmt::format("air.{}", c.name), c.unit, c.meaning});
  if (has_time_tolerance())
    for (const auto& c : time_error_columns()) columns.push_back({fmt::format("air.{}", c.name), c.unit, c.meaning});
  for (std::size_t b = 1; b <= loads_.computed.blades.size(); ++b)
    for (const auto& c : blade_columns()) columns.push_back({fmt::format("rotor.blade_{}.{}", b, c.name), c.unit, c.meaning});
  return columns;
}

std::vector<double> MarchingAir::values() const {
  std::vector<double> values;
  for (const auto& c : march_columns()) values.push_back(c.value(solver_->march()));
  for (const auto& c : mass_columns()) values.push_back(c.value(solver_->judgement().mass()));
  if (has_time_tolerance())
    for (const auto& c : time_error_columns()) values.push_back(c.value(solver_->time_error().value_or(0.0)));
  for (const aero::RotorLoad& blade : loads_.computed.blades)
    for (const auto& c : blade_columns()) values.push_back(c.value(blade));
  return values;
}

void MarchingAir::open_output(const io::RunDirectory& directory, double resume_s) {
  directory_ = &directory;
  const aero::FlowOptions& flow = *scenario().aero.flow;
  if (flow.preconditioner == "auto" && world_.rank == 0) write_choice(directory, preconditioner_);
  output_ = std::make_unique<AirOutput>(
      world_.comm, *solver_, directory.fields(),
      AirOutput::Choice{.walls = flow.surfaces, .moves = !scenario().has_actuator(), .resume_s = resume_s});
}

/// A window stays one step here: bodies and wind are told at its ends. Said once, and counted.
void MarchingAir::judge_time_error() {
  const double error = solver_->time_error().value_or(0.0);
  if (!has_time_tolerance() || error <= *scenario().aero.flow->time_tolerance || ++above_tolerance_ > 1) return;
  log_lines_.push_back(
      fmt::format("warning: air: the step to t = {:g} s has an error in time of {:.2g}, {:.2g} is asked for "
                  "(aero.flow.time_tolerance); try a shorter time.window_s; such windows are counted",
                  t_, error, *scenario().aero.flow->time_tolerance));
}

void MarchingAir::end_window() {
  has_made_windows_ = true;
  judge_time_error();
  const aero::PseudoStep& last = solver_->march().last;
  const bool first = limits_.shortened() + limits_.clipped() == 0;
  limits_.count(last.limited, last.clipped);
  if (last.limited + last.clipped == 0.0) return;
  const aero::LimitPlaces places = solver_->limited_cells(aero::Updates::last, world_.comm);
  worst_limits_.keep_worse(places, fmt::format("t = {:g} s", t_));
  if (!first) return;
  const std::string most = places.text();
  log_lines_.push_back(fmt::format(
      "warning: air: the last update of the window to t = {:g} s went beyond the bounds of {}{}; such windows are counted", t_,
      aero::limited_update(last.limited, last.clipped, solver_->cells()), most.empty() ? "" : "; most was " + most));
}

AirSide::Account MarchingAir::account() const {
  Account account{{{"shortened_windows", limits_.shortened()}, {"clipped_windows", limits_.clipped()}}, {}, {}};
  if (has_time_tolerance()) account.counts.emplace_back("windows_above_time_tolerance", above_tolerance_);
  for (const std::string& doubt : doubts_of_walls(*solver_, scenario(), world_)) account.doubts.push_back("air: " + doubt);
  const std::string text =
      limits_.text(fmt::format("the last pseudo-steps of {} windows", limits_.counted()), solver_->cells(), worst_limits_);
  if (!text.empty()) account.sentences.push_back("air: " + text);
  return account;
}

std::string MarchingAir::failure_at_end() const {
  const std::string walls = unresolved_walls(*solver_, scenario(), world_);
  return walls.empty() ? walls : "air: " + walls;
}

void MarchingAir::write_span() {
  if (has_made_windows_) coupling::write_span(world_, span_loads(), *directory_);
}

}  // namespace spindrift::coupling
