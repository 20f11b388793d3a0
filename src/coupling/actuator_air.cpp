// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/actuator_air.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "kernels/base/failure.hpp"
#include "runtime/executor/executor.hpp"
#include "runtime/trace/ledger.hpp"
#include "src/aero/actuator.hpp"
#include "src/aero/flow_grid.hpp"
#include "src/aero/flow_tiles.hpp"
#include "src/aero/grid/checks.hpp"
#include "src/aero/turbine.hpp"
#include "src/coupling/air_file.hpp"
#include "src/coupling/air_march.hpp"
#include "src/coupling/air_output.hpp"
#include "src/coupling/columns.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/retries.hpp"
#include "src/coupling/saved_air.hpp"

namespace spindrift::coupling {

namespace {

/// Least share of a point's kernel that must be inside the grid.
constexpr double least_kernel = 0.8;

double step_of(const Scenario& s) {
  return is_strong(s.coupling.scheme) ? s.time.window_s / s.coupling.samples : s.time.window_s;
}

class ActuatorAir final : public AirSide {
 public:
  ActuatorAir(const FloatingSystem& floating, const aero::RotorState& now, const runtime::World& world)
      : floating_(floating),
        world_(world),
        flow_(*floating.scenario().aero.flow),
        wind_(changing_wind(floating.scenario())),
        turbine_(aero::read_turbine(floating.scenario().rotor.turbine)),
        state_(now),
        told_blades_(floating.scenario().aero.model == "actuator_line" ? turbine_.blades : 0),
        computed_{{}, std::vector<aero::RotorLoad>(std::size_t(told_blades_))} {
    const aero::MultiBlockGrid grid = aero::flow_grid(flow_);
    for (const aero::Block& block : grid.blocks) cells_ += double(block.ni) * block.nj * block.nk;
    aero::Tiling tiling = aero::make_tiling(grid, aero::wall_patches(flow_));
    aero::require_ranks(std::size_t(tiling.size()), world.size);
    conditions_ = aero::patch_conditions(flow_, tiling);
    store_ = aero::flow_tiles(grid, std::move(tiling), flow_, world);
  }

  void settle_in(const io::RunDirectory& directory) override { directory_ = &directory; }

  aero::RotorLoad begin(double t, const aero::RotorState& now) override {
    const runtime::Span span("aero/start");
    t_ = t, state_ = now;
    if (solver_) {  // restored
      actuator_->place(motion(now));
      return load_;
    }
    const int steps = floating_.scenario().start.air_steps;
    const aero::TileStates settled = steps > 0 ? settled_air(steps) : aero::TileStates();
    make();
    if (flow_.preconditioner == "auto") choose_preconditioner(*solver_, flow_, world_.comm, log_lines_);
    solver_->restart().load_tiles(settled);  // the past stays empty: the first step is of first order
    return load_ = ramped(computed_.rotor, floating_, t_);
  }

  void prepare(double t, double dt, const aero::RotorState& at_end) override {
    t_ = t, state_ = at_end;
    if (dt == 0.0) return;
    solver_->set_time_step(dt);
    solver_->set_wind(wind_until(wind_, t));
    actuator_->place(motion(at_end));
    solver_->judgement().rows.all.clear();
  }

  Tasks record(runtime::Graph& graph) override {
    solver_->record(graph);
    return Tasks::many;
  }
  void forget_tasks() override { solver_->forget_graphs(); }

  aero::RotorLoad load_at_end() override {
    if (solver_->march().verdict != aero::Verdict::stopped) require_inside();  // first: what cuts the blades spoils the march
    require_good_step(*solver_, floating_, t_, log_lines_);
    const aero::PseudoRow& row = solver_->rows().back();
    computed_.rotor = actuator_->load(row);
    for (int b = 1; b <= told_blades_; ++b) computed_.blades[std::size_t(b - 1)] = actuator_->blade_load(b, row);
    return load_ = ramped(computed_.rotor, floating_, t_);
  }
  void ease(int retry) override {
    if (solver_) solver_->judgement().march.ease(share_of_cfl(retry));
  }
  const aero::RotorLoad* written() const override { return &load_; }

  void take_snapshot(Snapshot slot) override {
    snapshots_[slot] = Saved{.air = solver_->restart().snapshot(), .load = load_, .computed = computed_};
  }
  void return_to(Snapshot slot) override {
    const Saved& saved = *snapshots_[slot];
    solver_->restart().restore(saved.air);
    load_ = saved.load, computed_ = saved.computed;
  }

  std::vector<SavedArray> saved() const override {
    std::vector<SavedArray> arrays = file_->arrays();
    arrays.push_back(computed_loads_array(computed_, world_.rank));
    arrays.push_back(rotor_load_array({load_, step_of(floating_.scenario())}, world_.rank));
    if (automatic()) arrays.push_back(choice_array(flow_.preconditioner, world_.rank));
    return arrays;
  }
  void restore(const io::CheckpointReader& file) override {
    const runtime::Span span("aero/start");
    if (const std::optional<std::string> named = choice_in(file); automatic() && named) flow_.preconditioner = *named;
    make();
    file_->read(file);
    computed_ = computed_loads_in(file, told_blades_);
    load_ = rotor_load_in(file).load;
  }

  std::vector<io::Column> columns() const override {
    std::vector<io::Column> columns;
    for (const auto& c : march_columns()) columns.push_back({fmt::format("air.{}", c.name), c.unit, c.meaning});
    for (const auto& c : mass_columns()) columns.push_back({fmt::format("air.{}", c.name), c.unit, c.meaning});
    for (int b = 1; b <= told_blades_; ++b)
      for (const auto& c : blade_columns()) columns.push_back({fmt::format("rotor.blade_{}.{}", b, c.name), c.unit, c.meaning});
    return columns;
  }
  std::vector<double> values() const override {
    std::vector<double> values;
    for (const auto& c : march_columns()) values.push_back(c.value(solver_->march()));
    for (const auto& c : mass_columns()) values.push_back(c.value(solver_->judgement().mass()));
    for (const aero::RotorLoad& blade : computed_.blades)
      for (const auto& c : blade_columns()) values.push_back(c.value(blade));
    return values;
  }

  void open_output(const io::RunDirectory& directory, double resume_s) override {
    directory_ = &directory;
    if (automatic() && world_.rank == 0) write_choice(directory, flow_.preconditioner);
    output_ = std::make_unique<AirOutput>(world_.comm, *solver_, *store_, directory.fields(),
                                          AirOutput::Choice{.walls = flow_.surfaces, .moves = false, .resume_s = resume_s});
  }
  Writing copy_fields(std::int64_t number, double t) override { return output_->copy(number, t); }
  void write_span() override { coupling::write_span(world_, actuator_->span_loads(), *directory_); }
  std::vector<std::string> log_lines() override { return std::exchange(log_lines_, {}); }

 private:
  std::optional<SettlingFile> settling_file() const {
    const double interval_s = floating_.scenario().checkpoint.wall_interval_s;
    if (!directory_ || interval_s <= 0.0) return {};
    return SettlingFile(*directory_, world_, interval_s);
  }

  struct Saved {
    aero::FlowSnapshot air;
    aero::RotorLoad load;
    ComputedLoads computed;
  };

  /// Whether the scene leaves the preconditioner to a trial.
  bool automatic() const { return floating_.scenario().aero.flow->preconditioner == "auto"; }

  aero::DiscMotion motion(const aero::RotorState& s) const {
    return {.hub_velocity = s.hub_velocity,
            .omega = s.omega,
            .axis = s.axis,
            .up = s.up,
            .azimuth = s.azimuth,
            .blade_pitch = floating_.scenario().rotor.blade_pitch,
            .hub = s.hub};
  }

  std::unique_ptr<aero::FlowSolver> solver_of(const aero::FlowOptions& flow, double dt) const {
    const Scenario& s = floating_.scenario();
    auto solver = std::make_unique<aero::FlowSolver>(
        *store_, aero::flow_setting(flow, s.environment.air_density_kg_m3, flow_wind(s), dt, aero::wind_profile(s.wind)),
        conditions_);
    solver->start_uniform();
    runtime::Graph geometry(world_.comm);
    solver->record_geometry(geometry);
    runtime::Executor(std::move(geometry), {.threads = 1}).run();
    return solver;
  }
  std::shared_ptr<aero::Actuator> actuator_of(const aero::AeroOptions& aero, const aero::DiscMotion& rotor) const {
    return aero::make_actuator(aero, turbine_, floating_.scenario().environment.air_density_kg_m3, *store_, rotor, world_.comm);
  }

  /// The rotor where the run begins, in the wind as it comes.
  void make() {
    solver_ = solver_of(flow_, step_of(floating_.scenario()));
    actuator_ = actuator_of(floating_.scenario().aero, motion(state_));
    solver_->set_body_force(actuator_);
    file_.emplace(*solver_, *store_, world_);
    log_lines_.push_back(fmt::format("air: {} cells in {} tiles, {:.0f} MB; {}", solver_->cells(), store_->tiling().size(),
                                     1e-6 * double(solver_->bytes() + store_->bytes()) * world_.size, actuator_->description()));
  }

  /// Tried again where it fails.
  aero::TileStates settled_air(int steps) {
    for (int retry = 0;; ++retry) try {
        return settled_air(steps, retry);
      } catch (const NumericalFailure& failure) {
        if (retry == most_retries) throw;
        spdlog::warn("{}; retry {} of {} from a CFL number {:g} as large", failure.what(), retry + 1, most_retries,
                     share_of_cfl(retry + 1));
      }
  }

  /// Steady flow of the blades' mean over the disc, hub held where it starts: lines go on from it. Each of them is told as its
  /// share of the disc until the first step has been made.
  aero::TileStates settled_air(int steps, int retry) {
    const Scenario& s = floating_.scenario();
    aero::FlowOptions steady = flow_;
    steady.time = "steady", steady.drop = 0.0, steady.load_change = 0.0;
    steady.preconditioner = "coarse";  // steady flow in a wide box: block ILU alone takes ten times as many steps
    steady.max_pseudo_steps = settling_piece(cells_, steps);
    const std::unique_ptr<aero::FlowSolver> solver = solver_of(steady, 0.0);
    aero::AeroOptions mean = s.aero;
    mean.model = "actuator_disc";
    aero::DiscMotion held = motion(state_);
    held.hub_velocity.setZero(), held.omega = state_.speed * state_.axis;
    const std::shared_ptr<aero::Actuator> disc = actuator_of(mean, held);
    solver->set_body_force(disc);
    solver->judgement().march.ease(share_of_cfl(retry));
    spdlog::info("air settles for {} pseudo-steps behind the held rotor's disc: {} cells", steps, solver->cells());
    runtime::Graph graph(world_.comm);
    solver->record(graph);
    runtime::Executor march(std::move(graph), {.watchdog_s = s.runtime.watchdog_s});
    const AirFile state(*solver, *store_, world_);
    settle({.solver = *solver,
            .state = state,
            .file = settling_file(),
            .first_try = retry == 0,
            .run = [&] { march.run(); },
            .thrust = [&](const aero::PseudoRow& row) { return disc->load(row).thrust; }},
           steps, log_lines_);
    computed_.rotor = disc->load(solver->rows().back());
    for (aero::RotorLoad& blade : computed_.blades) blade = share_of(computed_.rotor, turbine_.blades);
    return solver->restart().save_tiles();
  }
  static aero::RotorLoad share_of(aero::RotorLoad load, int blades) {
    load.thrust /= blades, load.torque /= blades, load.power /= blades, load.force /= blades, load.moment /= blades;
    return load;
  }

  /// Throws NumericalFailure where blades have left the grid.
  void require_inside() const {
    const double least = actuator_->least_weight();
    if (least >= least_kernel) return;
    throw NumericalFailure(
        fmt::format("t = {:g} s: aero: blades have left the grid of the air, hub at ({:.4g}, {:.4g}, {:.4g}) m: {:.2g} of a "
                    "section's kernel is inside, {:g} at least is asked for; give a larger [aero.flow.generate]",
                    t_, state_.hub.x(), state_.hub.y(), state_.hub.z(), least, least_kernel),
        "aero/rotor", long(solver_->time_steps()), t_, least_kernel);
  }

  const FloatingSystem& floating_;
  const runtime::World world_;
  aero::FlowOptions flow_;  ///< with the preconditioner that "auto" became
  const aero::Wind wind_;   ///< where it changes in time
  const aero::Turbine turbine_;
  aero::RotorState state_;  ///< of the last prepare()
  int told_blades_;
  double cells_ = 0.0;
  ComputedLoads computed_;  ///< after the last step, as it is
  aero::RotorLoad load_;    ///< the last load_at_end(), ramped
  std::vector<aero::PatchCondition> conditions_;
  std::unique_ptr<aero::GridStore> store_;
  std::unique_ptr<aero::FlowSolver> solver_;  ///< made by begin() or restore()
  std::shared_ptr<aero::Actuator> actuator_;
  std::optional<AirFile> file_;
  double t_ = 0.0;
  std::array<std::optional<Saved>, 2> snapshots_;
  std::vector<std::string> log_lines_;
  const io::RunDirectory* directory_ = nullptr;
  std::unique_ptr<AirOutput> output_;
};

}  // namespace

std::unique_ptr<AirSide> make_actuator_air(const FloatingSystem& floating, const aero::RotorState& now,
                                           const runtime::World& world) {
  return std::make_unique<ActuatorAir>(floating, now, world);
}

}  // namespace spindrift::coupling
