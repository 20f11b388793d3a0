// SPDX-License-Identifier: Apache-2.0
#include "src/run/flow_case.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "kernels/turbulence/model_k_omega.hpp"
#include "runtime/trace/ledger.hpp"
#include "src/aero/flow/transfer.hpp"
#include "src/aero/flow_grid.hpp"
#include "src/aero/flow_options.hpp"
#include "src/aero/flow_tiles.hpp"
#include "src/aero/grid/checks.hpp"
#include "src/aero/grid/coarsen.hpp"
#include "src/aero/turbine.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/grid_progress.hpp"
#include "src/scene/error.hpp"

namespace spindrift::run {

namespace {

/// Drop of the flux balance that a coarser grid's flow must reach to be worth beginning with. Those that settle reach 5e-3 within
/// 100 pseudo-steps; those that ran away end at .3 and more, and some of the finer marches never recover from them.
constexpr double unsettled = 0.1;

/// A march of first order, where that of the scene's order came to nothing, is taken so far: a drop of the flux balance, or
/// steps. A section at Mach 1.4 comes to that drop in 120; from what it had after 100, .26, the march of the scene's order failed
/// again.
constexpr double first_order_drop = 1e-2;
constexpr int first_order_steps = 300;

/// Extent along the wind of the walls that the air sticks to [m]; 0 where there are none.
double length_of_walls(const aero::MultiBlockGrid& grid, const aero::FlowOptions& o, const Eigen::Vector3d& along_wind) {
  double low = 0.0, high = 0.0;
  bool any = false;
  for (const aero::Boundary& b : grid.boundaries) {
    if (std::ranges::none_of(o.boundaries,
                             [&](const aero::PatchOptions& p) { return p.patch == b.patch && sticks(p.condition); }))
      continue;
    const aero::Block& block = grid.blocks[std::size_t(b.where.block)];
    const auto d = std::size_t(direction_of(b.where.side));
    const auto [u, v] = aero::along(b.where.side);
    aero::Index at{};
    at[d] = at_end(b.where.side) ? block.cells()[d] : 0;
    for (at[std::size_t(v)] = b.where.low[1]; at[std::size_t(v)] <= b.where.high[1]; ++at[std::size_t(v)])
      for (at[std::size_t(u)] = b.where.low[0]; at[std::size_t(u)] <= b.where.high[0]; ++at[std::size_t(u)]) {
        const double x = block.nodes[block.node(at[2], at[1], at[0])].dot(along_wind);
        low = any ? std::min(low, x) : x, high = any ? std::max(high, x) : x, any = true;
      }
  }
  return high - low;
}

/// The stream's turbulence where it is held up to the body: k [m2/s2], omega [1/s].
struct HeldTurbulence {
  double k, omega;
};

/// Wilcox's model of 1988 lets layers depend on the omega at their edge (Menter 1992, AIAA J. 30, 1657), and between a far side
/// and a body that of the stream decays to a fraction of U/L: an aerofoil's drag came out seven times too large. So where the
/// scene gives no intensity the stream has omega = 10 U/L with the length L of the walls, the most that NASA's Turbulence
/// Modeling Resource recommends, and keeps it (Spalart & Rumsey 2007, AIAA J. 45, 2544).
std::optional<HeldTurbulence> hold_turbulence(aero::FlowSetting& s, double length) {
  if (s.turbulence != turbulence::KOmega1988::name || !(length > 0.0)) return std::nullopt;
  const double nu = gas::viscosity(s.gas, gas::absolute_temperature(s.gas, s.stream)) / gas::density(s.gas, s.stream);
  if (!s.wind_eddy_viscosity) s.wind_eddy_viscosity = 0.009;  // as other closures of two equations
  if (!s.wind_intensity) s.wind_intensity = std::sqrt(10.0 * s.speed / length * *s.wind_eddy_viscosity * nu / 1.5) / s.speed;
  const double k = 1.5 * *s.wind_intensity * *s.wind_intensity * s.speed * s.speed;
  return HeldTurbulence{k, k / (*s.wind_eddy_viscosity * nu)};
}

/// Grids of half the cells along each direction, the coarsest last.
std::vector<aero::MultiBlockGrid> coarser_than(const aero::MultiBlockGrid& grid, const aero::FlowOptions& o) {
  std::vector<aero::MultiBlockGrid> grids;
  if (o.time != "steady" || o.coarse_steps.value_or(aero::usual_coarse_steps) == 0) return grids;
  for (const aero::MultiBlockGrid* last = &grid; int(grids.size()) < o.coarse_levels && aero::why_not_halved(*last).empty();
       last = &grids.back())
    grids.push_back(aero::halved(*last));
  return grids;
}

/// Puts back what k and omega of the stream lose.
void hold(aero::FlowSolver& solver, const HeldTurbulence& stream) {
  using Model = turbulence::KOmega1988;
  const double rho = gas::density(solver.setting().gas, solver.setting().stream);
  aero::set_source(solver.tiles(), [&](const Eigen::Vector3d&, auto& values) {
    values[aero::mean_unknowns] = rho * Model::beta_star * stream.k * stream.omega;
    values[aero::mean_unknowns + 1] = rho * Model::wall_beta * stream.omega * stream.omega;
  });
}

/// Marches once; `march` was recorded of the solver.
void evaluate_start(aero::FlowSolver& solver, runtime::Executor& march) {
  solver.judgement().march.judge_only();
  march.run();
  solver.judgement().rows.all.clear();
}

}  // namespace

FlowCase::FlowCase(const coupling::Scenario& s, const runtime::World& world, int chunk) {
  const runtime::Span span("aero/start");
  const aero::FlowOptions& o = *s.aero.flow;
  wind_ = coupling::changing_wind(s);
  if (has_resolved_rotor(s)) {
    const aero::ResolvedRotorSetup setup = resolved_rotor_setup(s);
    rotor_ = aero::ResolvedRotor::on(world, setup, chunk, made_rotor_grid(setup, world.comm, coupling::grid_progress()),
                                     coupling::grid_progress());
    store_ = &rotor_->store(), solver_ = &rotor_->solver();
    place_wind(world.comm);
    begin(o.start);
    return;
  }
  own_grid_ = aero::flow_grid(o);
  aero::Tiling tiling = aero::flow_tiling(o, own_grid_);
  aero::require_ranks(std::size_t(tiling.size()), world.size);
  if (o.motion) follow_walls(o);
  coarser_grids_ = coarser_than(own_grid_, o);
  solve(std::move(tiling), s, world, chunk);
}

FlowCase::FlowCase(aero::MultiBlockGrid grid, const coupling::Scenario& s, const runtime::World& world, int steps) {
  coupling::Scenario coarse = s;
  aero::FlowOptions& o = *coarse.aero.flow;
  o.drop = o.coarse_drop;
  if (o.preconditioner == "auto") o.preconditioner = aero::FlowOptions().preconditioner;
  own_grid_ = std::move(grid);
  solve(aero::flow_tiling(o, own_grid_), coarse, world, steps);
}

/// Solver on own_grid_, cut into these tiles; at most `steps` pseudo-steps a run where the flow is steady.
void FlowCase::solve(aero::Tiling tiling, const coupling::Scenario& s, const runtime::World& world, int steps) {
  const aero::FlowOptions& o = *s.aero.flow;
  std::vector<aero::PatchCondition> conditions = aero::patch_conditions(o, tiling);
  own_store_ = aero::flow_tiles(own_grid_, std::move(tiling), o, world, motion_.has_value());
  store_ = own_store_.get();
  aero::FlowSetting setting =
      aero::flow_setting(o, s.environment.air_density_kg_m3, coupling::flow_wind(s), s.time.window_s, aero::wind_profile(s.wind));
  if (setting.time_order == 0) setting.march.max_steps = steps;
  const Eigen::Vector3d wind(setting.stream.u, setting.stream.v, setting.stream.w);
  const auto held = s.has_actuator() ? std::nullopt : hold_turbulence(setting, length_of_walls(own_grid_, o, wind.normalized()));
  if (s.has_actuator()) aero::require_rotor_inside(own_grid_, s.rotor, "rotor.hub_m");
  if (!motion_) own_grid_ = {};
  own_solver_ = std::make_unique<aero::FlowSolver>(*store_, setting, std::move(conditions));
  solver_ = own_solver_.get();
  if (held) hold(*solver_, *held);
  if (s.has_actuator()) make_actuator(s, world);
  place_wind(world.comm);
  begin(o.start);
  if (motion_) place(0, s.time.window_s);
}

/// The rotor's blades as forces in the air.
void FlowCase::make_actuator(const coupling::Scenario& s, const runtime::World& world) {
  const aero::Turbine turbine = aero::read_turbine(s.rotor.turbine);
  const aero::RotorPose pose = aero::hub_pose(s.rotor);
  const Eigen::Matrix3d frame = pose.hub.attitude.toRotationMatrix();
  const Eigen::Vector3d axis = frame.col(0);
  rotor_at_start_ = {.hub_velocity = Eigen::Vector3d::Zero(),
                     .omega = s.rotor.speed * axis,
                     .axis = axis,
                     .up = frame.col(2),
                     .azimuth = s.rotor.azimuth,
                     .blade_pitch = s.rotor.blade_pitch,
                     .hub = s.rotor.hub_m};
  actuator_ = aero::make_actuator(s.aero, turbine, s.environment.air_density_kg_m3, *store_, rotor_at_start_, world.comm);
  solver_->set_body_force(actuator_);
  spdlog::info("air: {}", actuator_->description());
}

void FlowCase::place_wind(MPI_Comm comm) {
  wind_.place(*store_, comm);
  if (wind_.has_plane()) spdlog::info("air: {}", wind_.description());
}

/// The flow that aero.flow.start names: the wind, air at rest, or a Taylor-Green vortex.
void FlowCase::begin(const std::string& start) {
  const aero::FlowSetting& s = solver_->setting();
  if (start == "wind") {
    solver_->start_uniform();
    return wind_.begin(*solver_);
  }
  const double rho = gas::density(s.gas, gas::Primitive<double>{}), U = s.speed;
  solver_->start([&](const Eigen::Vector3d& x) {
    if (start == "rest") return gas::Primitive<double>{};
    const double p = rho * U * U / 16.0 * (std::cos(2 * x[0]) + std::cos(2 * x[1])) * (std::cos(2 * x[2]) + 2.0);
    return gas::Primitive<double>{p, U * std::sin(x[0]) * std::cos(x[1]) * std::cos(x[2]),
                                  -U * std::cos(x[0]) * std::sin(x[1]) * std::cos(x[2]), 0.0, p / (rho * s.gas.gas_constant)};
  });
}

/// The grid follows the walls that move: in steady flow at once, else from step to step.
void FlowCase::follow_walls(const aero::FlowOptions& o) {
  std::vector<std::string> held, sliding;
  for (const aero::PatchOptions& b : o.boundaries) {
    if (std::ranges::find(o.motion->patches, b.patch) != o.motion->patches.end()) continue;
    (of(b.condition).surface == aero::Surface::mirror ? sliding : held).push_back(b.patch);
  }
  motion_.emplace(own_grid_, *o.motion, held, sliding);
  spdlog::info("air: {}", motion_->description());
  if (o.time != "steady") return;
  aero::MultiBlockGrid placed = motion_->moved_grid(0.0);
  motion_.reset();
  own_grid_ = std::move(placed);
}

void FlowCase::place(std::int64_t window, double window_s) {
  const auto poses = [&](double at) { return motion_->poses(at * window_s); };
  // Steps are windows or parts of them by a power of two: their ends are exact.
  const auto length = [&](std::size_t n) {
    return steps_divide_windows() && solver_->time_steps() > 0 ? solver_->step_before(n) / window_s : 1.0;
  };
  const double now = double(window), before = now - length(0);
  solver_->motion().place(poses(before), poses(now), poses(before - length(1)));
}

void FlowCase::move(double end, double window_s) {
  solver_->set_wind(wind_.until(end * window_s));
  if (rotor_ && !steady()) rotor_->move_to({rotor_->turned(end)});
  if (motion_) solver_->motion().move_to(motion_->poses(end * window_s));
  if (actuator_) place_actuator(steady() ? 0.0 : end * window_s);
}

void FlowCase::place_actuator(double time) {
  aero::DiscMotion rotor = rotor_at_start_;
  rotor.azimuth += time * rotor.omega.dot(rotor.axis);
  actuator_->place(rotor);
}

void FlowCase::return_to(const aero::FlowSnapshot& to, std::int64_t window, double window_s) {
  solver_->restart().restore(to);
  if (rotor_ && !steady()) rotor_->placed_at(double(window));
  if (motion_) place(window, window_s);
  solver_->judgement().rows.all.clear();
}

void FlowCase::start_on_coarser_grids(const coupling::Scenario& s, runtime::Executor& march, const runtime::World& world) {
  const aero::FlowOptions& o = *s.aero.flow;
  std::vector<aero::MultiBlockGrid> grids = std::move(coarser_grids_);
  const bool from_rest = o.start == "rest";
  if (grids.empty() && !from_rest) return;
  if (from_rest) solver_->start_uniform();
  evaluate_start(*solver_, march);
  if (from_rest) begin(o.start);
  std::unique_ptr<FlowCase> coarser;
  while (!grids.empty()) {
    std::unique_ptr<FlowCase> next(
        new FlowCase(std::move(grids.back()), s, world, o.coarse_steps.value_or(aero::usual_coarse_steps)));
    grids.pop_back();
    next->solver().fill_geometry(world.comm);
    aero::FlowSolver& solver = next->solver();
    runtime::Graph graph(world.comm);
    solver.record(graph);
    runtime::Executor executor(std::move(graph));
    if (coarser || from_rest) {
      if (from_rest) solver.start_uniform();
      evaluate_start(solver, executor);
      if (coarser)
        aero::begin_with(coarser->solver(), solver, {}, world.comm);
      else
        next->begin(o.start);
      solver.judgement().march.begin_after_judging(from_rest);
    }
    executor.run();
    const aero::MarchState& done = solver.march();
    if (done.verdict == aero::Verdict::stopped) break;  // the fine march stops at its first step
    if (done.verdict == aero::Verdict::failed) {
      spdlog::warn("air: on a coarser grid of {} cells the march failed ({}); the next begins without it", solver.cells(),
                   done.why);
      coarser.reset();
      continue;
    }
    if (done.spent && done.balance_drop() > std::max(unsettled, o.coarse_drop)) {
      spdlog::info(
          "air: on a coarser grid of {} cells the flux balance is at {:.2g} after {} pseudo-steps; the next begins without it",
          solver.cells(), done.balance_drop(), done.steps - 1);
      coarser.reset();
      continue;
    }
    spdlog::info("air: {} pseudo-steps on a coarser grid of {} cells, flux balance down to {:.2g}: {}", done.steps - 1,
                 solver.cells(), done.balance_drop(), done.why);
    coarser = std::move(next);
  }
  if (coarser) aero::begin_with(coarser->solver(), *solver_, {}, world.comm), start_ = Start::coarser_grids;
  solver_->judgement().march.begin_after_judging(from_rest);
}

void FlowCase::take(Start start) {
  start_ = start;
  coarser_grids_.clear();
  solver_->use_limiter(start == Start::first_order ? "first_order" : solver_->setting().limiter);
  if (start == Start::physical_pseudo_time) solver_->use_physical_pseudo_time();
}

bool FlowCase::first_order_is_over() const {
  if (start_ != Start::first_order) return false;
  const aero::MarchState& march = solver_->march();
  const bool ended = march.verdict == aero::Verdict::converged && !march.spent;
  return ended || march.balance_drop() <= first_order_drop || march.steps > first_order_steps;
}

void FlowCase::raise_order() {
  take(Start::after_first_order);
  solver_->judgement().march.begin_again();
  solver_->judgement().rows.all.clear();
}

std::string FlowCase::begin_again(const coupling::Scenario& s) {
  const aero::FlowOptions& o = *s.aero.flow;
  if (rotor_ || !steady()) return {};
  const std::string start = fmt::format("aero.flow.start = \"{}\" on the grid itself", o.start);
  std::string what;
  if (start_ == Start::coarser_grids) {
    take(Start::own_grid);
    what = fmt::format("from {}, without coarser grids", start);
  } else if (start_ == Start::own_grid && o.limiter != "first_order") {
    take(Start::first_order);
    solver_->judgement().march.keep_start();
    what = fmt::format("from {}, of first order until its balance has come to {:g} or for {} pseudo-steps", start,
                       first_order_drop, first_order_steps);
  } else if (start_ != Start::physical_pseudo_time && o.low_mach) {
    take(Start::physical_pseudo_time);
    what = fmt::format("from {}, with the pseudo-time of low_mach = false", start);
  } else {
    return {};
  }
  begin(o.start);
  solver_->judgement().march.begin_again();
  solver_->judgement().rows.all.clear();
  return what;
}

}  // namespace spindrift::run
