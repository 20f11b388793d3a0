// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/actuator_air.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "kernels/base/failure.hpp"
#include "runtime/executor/executor.hpp"
#include "runtime/trace/ledger.hpp"
#include "src/aero/actuator.hpp"
#include "src/aero/flow/coarse_correction.hpp"
#include "src/aero/flow_grid.hpp"
#include "src/aero/flow_tiles.hpp"
#include "src/aero/grid/checks.hpp"
#include "src/aero/turbine.hpp"
#include "src/coupling/air_march.hpp"
#include "src/coupling/flow_scene.hpp"

namespace spindrift::coupling {

namespace {

/// Least share of a point's kernel that must be inside the grid.
constexpr double least_kernel = 0.8;

aero::RotorLoad share_of(aero::RotorLoad load, int blades) {
  load.thrust /= blades, load.torque /= blades, load.power /= blades, load.force /= blades, load.moment /= blades;
  return load;
}

class ActuatorAir final : public MarchingAir {
 public:
  ActuatorAir(const FloatingSystem& floating, const aero::RotorState& now, const runtime::World& world)
      : MarchingAir(floating, now, world), turbine_(aero::read_turbine(scenario().rotor.turbine)) {
    loads_.computed.blades.resize(scenario().aero.model == "actuator_line" ? std::size_t(turbine_.blades) : 0);
    make_store();
  }

  aero::RotorLoad begin(double t, const aero::RotorState& now) override {
    const runtime::Span span("aero/start");
    prepare(t, 0.0, now);
    if (solver_) {  // restored
      move();
      return loads_.on_bodies;
    }
    const aero::TileStates steady =
        scenario().start.air_steps > 0 ? settled([this](int retry) { return settled_air(retry); }) : aero::TileStates();
    make_timed();
    tell_size();
    if (automatic()) choose();
    solver_->restart().load_tiles(steady);  // the past stays empty: the first step is of first order
    return update_load_on_bodies();
  }

  aero::RotorLoad load_at_end() override {
    if (solver_->march().verdict != aero::Verdict::stopped) require_inside();  // first: what cuts the blades spoils the march
    return MarchingAir::load_at_end();
  }

  void take_snapshot(Snapshot slot) override { snapshots_[slot] = Saved{solver_->restart().snapshot(), loads_}; }
  void return_to(Snapshot slot) override {
    solver_->restart().restore(snapshots_[slot]->air);
    loads_ = snapshots_[slot]->loads;
  }
  void restore(const io::CheckpointReader& file) override {
    MarchingAir::restore(file);
    tell_size();
  }

 private:
  struct Saved {
    aero::FlowSnapshot air;
    Loads loads;
  };

  /// Grid and tiles.
  void make_store() {
    const aero::FlowOptions& flow = *scenario().aero.flow;
    const aero::MultiBlockGrid grid = aero::flow_grid(flow);
    cells_ = 0.0;
    for (const aero::Block& block : grid.blocks) cells_ += double(block.ni) * block.nj * block.nk;
    aero::Tiling tiling = aero::flow_tiling(flow, grid);
    aero::require_ranks(std::size_t(tiling.size()), world_.size);
    conditions_ = aero::patch_conditions(flow, tiling);
    store_ = aero::flow_tiles(grid, std::move(tiling), flow, world_, false, rank_of_tile_);
  }
  /// The rotor where it is, in the wind as it comes.
  void make() override {
    aero::FlowOptions flow = *scenario().aero.flow;
    flow.preconditioner = preconditioner_;
    own_solver_ = solver_of(flow, step_of(scenario()));
    solver_ = own_solver_.get();
    actuator_ = actuator_of(scenario().aero, motion());
    solver_->set_body_force(actuator_);
    place_wind();
  }
  void tell_size() {
    log_lines_.push_back(fmt::format("air: {} cells in {} tiles, {:.0f} MB; {}", solver_->cells(), store_->tiling().size(),
                                     1e-6 * double(solver_->bytes() + store_->bytes()) * world_.size, actuator_->description()));
    tell_wind();
  }
  void make_anew(const Send& send) override {
    snapshots_ = {};
    aero::FlowSnapshot state = solver_->restart().snapshot();
    solver_ = nullptr, actuator_.reset(), own_solver_.reset(), store_.reset();
    state = send(std::move(state));
    make_store();
    make();
    solver_->restart().restore(state);
  }
  void move() override { actuator_->place(motion()); }
  ComputedLoads computed() const override {
    const aero::PseudoRow& row = solver_->rows().back();
    ComputedLoads loads{actuator_->load(row), {}};
    for (int b = 1; b <= int(loads_.computed.blades.size()); ++b) loads.blades.push_back(actuator_->blade_load(b, row));
    // Of the rotor's own turning: the actuator's also has that of what carries it.
    loads.rotor.power = loads.rotor.torque * state_.speed;
    for (aero::RotorLoad& blade : loads.blades) blade.power = blade.torque * state_.speed;
    return loads;
  }
  std::vector<SavedArray> computed_arrays() const override { return {computed_loads_array(loads_.computed, world_.rank)}; }
  std::vector<aero::SpanLoad> span_loads() const override { return actuator_->span_loads(); }

  aero::DiscMotion motion() const {
    return {.hub_velocity = state_.hub_velocity,
            .omega = state_.omega,
            .axis = state_.axis,
            .up = state_.up,
            .azimuth = state_.azimuth,
            .blade_pitch = state_.pitches.empty() ? scenario().rotor.blade_pitch : state_.pitches.front(),
            .hub = state_.hub,
            .pitches = state_.pitches};
  }

  std::unique_ptr<aero::FlowSolver> solver_of(const aero::FlowOptions& flow, double dt) const {
    const Scenario& s = scenario();
    auto solver = std::make_unique<aero::FlowSolver>(
        *store_, aero::flow_setting(flow, s.environment.air_density_kg_m3, flow_wind(s), dt, aero::wind_profile(s.wind)),
        conditions_);
    solver->start_uniform();
    wind().begin(*solver);
    solver->fill_geometry(world_.comm);
    return solver;
  }
  std::shared_ptr<aero::Actuator> actuator_of(const aero::AeroOptions& aero, const aero::DiscMotion& rotor) const {
    return aero::make_actuator(aero, turbine_, scenario().environment.air_density_kg_m3, *store_, rotor, world_.comm);
  }

  /// Steady flow of the blades' mean over the disc, hub held where it starts: lines go on from it. Each of them is told as its
  /// share of the disc until the first step has been made.
  aero::TileStates settled_air(int retry) {
    const Scenario& s = scenario();
    const int steps = s.start.air_steps;
    aero::FlowOptions steady = *s.aero.flow;
    steady.time = "steady", steady.drop = 0.0, steady.load_change = 0.0;
    // In a wide box steady flow takes ten times as many steps with block ILU alone. Where the scene has that its bits are those
    // of any number of ranks, and those of multigrid, which solves many groups, are not.
    std::optional<int> side = steady.group_cells;
    if (steady.preconditioner != "coarse")
      side = aero::side_of_groups(store_->tiling(), steady.group_cells, steady.direct_groups);
    if (side) steady.preconditioner = "coarse", steady.group_cells = *side;
    steady.max_pseudo_steps = settling_piece(cells_, steps);
    const std::unique_ptr<aero::FlowSolver> solver = solver_of(steady, 0.0);
    solver->set_wind(wind().at_start());
    aero::AeroOptions mean = s.aero;
    mean.model = "actuator_disc";
    aero::DiscMotion held = motion();
    held.hub_velocity.setZero(), held.omega = state_.speed * state_.axis;
    const std::shared_ptr<aero::Actuator> disc = actuator_of(mean, held);
    solver->set_body_force(disc);
    spdlog::info("air settles for {} pseudo-steps behind the held rotor's disc: {} cells", steps, solver->cells());
    runtime::Graph graph(world_.comm);
    solver->record(graph);
    runtime::Executor march(std::move(graph), {.watchdog_s = s.runtime.watchdog_s});
    settle({.solver = *solver,
            .run = [&] { march.run(); },
            .thrust = [&](const aero::PseudoRow& row) { return disc->load(row).thrust; }},
           retry);
    loads_.computed.rotor = disc->load(solver->rows().back());
    for (aero::RotorLoad& blade : loads_.computed.blades) blade = share_of(loads_.computed.rotor, turbine_.blades);
    return solver->restart().save_tiles();
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

  const aero::Turbine turbine_;
  double cells_ = 0.0;
  std::vector<aero::PatchCondition> conditions_;
  std::unique_ptr<aero::GridStore> store_;
  std::unique_ptr<aero::FlowSolver> own_solver_;  ///< solver_
  std::shared_ptr<aero::Actuator> actuator_;
  std::array<std::optional<Saved>, 2> snapshots_;
};

}  // namespace

std::unique_ptr<AirSide> make_actuator_air(const FloatingSystem& floating, const aero::RotorState& now,
                                           const runtime::World& world) {
  return std::make_unique<ActuatorAir>(floating, now, world);
}

}  // namespace spindrift::coupling
