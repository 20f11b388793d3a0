// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/flow_run.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <optional>

#include "kernels/base/constants.hpp"
#include "runtime/executor/executor.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "runtime/partition/partition.hpp"
#include "src/aero/coarse_start.hpp"
#include "src/aero/flow/choice.hpp"
#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/flow/poisson.hpp"
#include "src/aero/flow/transfer.hpp"
#include "src/aero/flow_grid.hpp"
#include "src/aero/flow_options.hpp"
#include "src/aero/grid/coarsen.hpp"
#include "src/aero/grid/wall_distance.hpp"
#include "src/aero/grid_motion.hpp"
#include "src/aero/resolved_rotor.hpp"
#include "src/aero/wind.hpp"
#include "src/coupling/air_file.hpp"
#include "src/coupling/air_output.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/grid_progress.hpp"
#include "src/coupling/saved_air.hpp"
#include "src/coupling/saved_history.hpp"
#include "src/coupling/timeline.hpp"
#include "src/io/checkpoint.hpp"
#include "src/io/checkpoint_plan.hpp"
#include "src/io/history.hpp"
#include "src/io/machine_failure.hpp"
#include "src/io/progress.hpp"
#include "src/scene/error.hpp"

namespace spindrift::coupling {

namespace {

using aero::FlowSolver;

/// Pseudo-steps of a steady march between two looks at the clock and the disk.
constexpr int steady_chunk = 20;

/// Grid, tiles and solver of a scene on this rank.
struct Air {
  void begin(const std::string& start) {
    const aero::FlowSetting& s = solver->setting();
    if (start == "wind") return solver->start_uniform();
    const double rho = gas::density(s.gas, gas::Primitive<double>{}), U = s.speed;
    solver->start([&](const Eigen::Vector3d& x) {
      if (start == "rest") return gas::Primitive<double>{};
      const double p = rho * U * U / 16.0 * (std::cos(2 * x[0]) + std::cos(2 * x[1])) * (std::cos(2 * x[2]) + 2.0);
      return gas::Primitive<double>{p, U * std::sin(x[0]) * std::cos(x[1]) * std::cos(x[2]),
                                    -U * std::cos(x[0]) * std::sin(x[1]) * std::cos(x[2]), 0.0, p / (rho * s.gas.gas_constant)};
    });
  }

  std::unique_ptr<aero::ResolvedRotor> rotor;  ///< has grid, store and solver itself
  aero::MultiBlockGrid own_grid;
  std::unique_ptr<aero::GridStore> own_store;
  std::unique_ptr<FlowSolver> own_solver;
  std::optional<aero::GridMotion> motion;  ///< of an unsteady flow
  aero::GridStore* store = nullptr;
  FlowSolver* solver = nullptr;

  std::size_t blocks() const { return (rotor ? rotor->grid() : own_grid).blocks.size(); }

  Air(const Scenario& s, const runtime::World& world) {
    const aero::FlowOptions& o = *s.aero.flow;
    if (has_resolved_rotor(s)) {
      rotor = std::make_unique<aero::ResolvedRotor>(resolved_rotor_setup(s), world.size, world.rank, steady_chunk, nullptr,
                                                    grid_progress());
      store = &rotor->store(), solver = &rotor->solver();
      begin(o.start);
      return;
    }
    own_grid = aero::flow_grid(o);
    if (const std::string why = o.coarse_steps > 0 ? aero::why_not_halved(own_grid) : std::string(); !why.empty())
      throw scene::SceneError(
          {{s.source, 0, "aero.flow.coarse_steps", fmt::format("{}", o.coarse_steps),
            fmt::format("needs a grid whose every second node makes a grid; {}, an odd number or too few", why)}});
    if (o.motion) follow(o);
    solve(s, world, steady_chunk);
  }
  /// On the grid of every second node, all of it on this rank.
  Air(const Air& fine, const Scenario& s) {
    Scenario coarse = s;
    aero::FlowOptions& o = *coarse.aero.flow;
    o.drop = o.coarse_drop;
    if (o.preconditioner == "auto") o.preconditioner = aero::FlowOptions().preconditioner;
    own_grid = aero::halved(fine.own_grid);
    solve(coarse, {.comm = MPI_COMM_SELF, .rank = 0, .size = 1}, o.coarse_steps);
  }
  /// Tiles and solver on own_grid; at most `steps` pseudo-steps a run where the flow is steady.
  void solve(const Scenario& s, const runtime::World& world, int steps) {
    const aero::FlowOptions& o = *s.aero.flow;
    const std::vector<std::string> walls = aero::wall_patches(o);
    aero::Tiling tiling = aero::make_tiling(own_grid, walls);
    std::vector<aero::PatchCondition> conditions = aero::patch_conditions(o, tiling);
    std::vector<int> ranks(std::size_t(tiling.size()), 0);
    if (world.size > 1) ranks = runtime::partition_blocks(aero::tile_graph(tiling), {.ranks = world.size}).rank_of_block;
    own_store = std::make_unique<aero::GridStore>(std::move(tiling), std::move(ranks), world.rank);
    store = own_store.get();
    store->build_all(own_grid, motion.has_value());
    std::vector<std::string> no_slip;
    for (const aero::PatchOptions& b : o.boundaries)
      if (aero::sticks(b.condition)) no_slip.push_back(b.patch);
    if (o.wall_distance == "poisson") {
      aero::fill_wall_distance_by_poisson(*store, no_slip, world.comm);
    } else {
      const aero::WallSurface surface = aero::wall_surface(own_grid, no_slip);
      for (const int tile : store->owned()) aero::fill_wall_distance((*store)[tile], surface);
    }
    aero::FlowSetting setting =
        aero::flow_setting(o, s.environment.air_density_kg_m3, flow_wind(s), s.time.window_s, aero::wind_profile(s.wind));
    if (setting.time_order == 0) setting.march.max_steps = steps;
    own_solver = std::make_unique<FlowSolver>(*store, setting, std::move(conditions));
    solver = own_solver.get();
    begin(o.start);
    if (motion) place(0, s.time.window_s);
  }
  /// The grid follows the walls that move: in steady flow at once, else from step to step.
  void follow(const aero::FlowOptions& o) {
    std::vector<std::string> held, sliding;
    for (const aero::PatchOptions& b : o.boundaries) {
      if (std::ranges::find(o.motion->patches, b.patch) != o.motion->patches.end()) continue;
      (b.condition == aero::Condition::symmetry ? sliding : held).push_back(b.patch);
    }
    motion.emplace(own_grid, *o.motion, held, sliding);
    spdlog::info("air: {}", motion->description());
    if (o.time != "steady") return;
    aero::MultiBlockGrid placed = motion->moved_grid(0.0);
    motion.reset();
    own_grid = std::move(placed);
  }
  /// Where the walls are after so many windows.
  void place(std::int64_t number, double window_s) {
    solver->place(motion->poses(double(number - 1) * window_s), motion->poses(double(number) * window_s));
  }
  bool steady() const { return solver->setting().time_order == 0; }
};

void fill_geometry(FlowSolver& solver, MPI_Comm comm) {
  runtime::Graph geometry(comm);
  solver.record_geometry(geometry);
  runtime::Executor(std::move(geometry), {.threads = 1}).run();
}

/// Grid sequencing of grids that are no rotor's: the flow settles on every second node first; what the drop is counted from stays
/// the residual of the undisturbed flow on the fine grid. `march` is the fine one's. Every rank makes the same coarse flow for
/// itself.
void start_on_coarser_grid(const Scenario& s, Air& air, runtime::Executor& march) {
  air.solver->march().look();
  march.run();
  air.solver->clear_rows();
  Air coarse(air, s);
  fill_geometry(*coarse.solver, MPI_COMM_SELF);
  runtime::Graph graph(MPI_COMM_SELF);
  coarse.solver->record(graph);
  runtime::Executor(std::move(graph)).run();
  const aero::March& done = coarse.solver->march();
  aero::begin_with(*coarse.solver, *air.solver);
  spdlog::info("air: {} pseudo-steps on every second node, {} cells: {}", done.steps(), coarse.solver->cells(), done.why());
  air.solver->march().begin_after_look();
}

/// Columns of history.csv and how a row fills them.
struct FlowColumns {
  std::size_t force[3], lift, drag, residual, momentum, model, cfl, krylov, steps;
  const aero::ResolvedRotor* rotor;
  const aero::GridMotion* motion;
  std::size_t pitch = 0, heave[3] = {0, 0, 0};
  std::size_t thrust = 0, torque = 0, power = 0, azimuth = 0, rpm = 0;
  std::vector<std::array<std::size_t, 2>> blades;  ///< thrust and torque

  FlowColumns(io::History& history, const aero::ResolvedRotor* of, const aero::GridMotion* moving) : rotor(of), motion(moving) {
    if (rotor) add_rotor(history);
    if (motion) add_motion(history);
    const char* axes[3] = {"x", "y", "z"};
    for (std::size_t d = 0; d < 3; ++d)
      force[d] = history.add({fmt::format("flow.f{}_N", axes[d]), "N",
                              "Force of the air on the patches with loads, pressure above the undisturbed one."});
    if (!rotor)
      lift = history.add({"flow.lift_coefficient", "-",
                          "Force across the wind in its vertical plane, on dynamic pressure and aero.flow.reference_area_m2."});
    if (!rotor) drag = history.add({"flow.drag_coefficient", "-", "Force along the wind, likewise."});
    residual = history.add({"flow.density_residual", "kg/(m3 s)", "Root mean square over the cells."});
    momentum =
        history.add({"flow.scaled_residual", "-", "Norm of the residual of the mean flow in units of the undisturbed one."});
    model = history.add({"flow.turbulence_residual", "-", "The same of the turbulence model."});
    cfl = history.add({"flow.cfl", "-", "CFL number of the pseudo-step."});
    krylov = history.add({"flow.krylov_steps", "-", "Iterations of the linear solver in the pseudo-step before."});
    steps = history.add({"flow.pseudo_steps", "-", "Pseudo-steps: so far (steady), of the window (unsteady)."});
  }
  void add_rotor(io::History& history) {
    thrust = history.add({"rotor.thrust_N", "N", "Force of the air on the blades along the rotor axis, positive downwind."});
    torque = history.add(
        {"rotor.torque_N_m", "N m", "Moment of the air on the blades about the rotor axis, positive where it drives the rotor."});
    power = history.add({"rotor.power_W", "W", "Torque times rotor speed."});
    azimuth = history.add({"rotor.azimuth_deg", "deg", "Of blade 1 from upright, 0 to 360."});
    rpm = history.add({"rotor.rpm", "rpm", "Rotor speed."});
    for (int b = 1; b <= rotor->grid_blades(); ++b)
      blades.push_back(
          {history.add({fmt::format("rotor.blade_{}.thrust_N", b), "N", "Of one blade of the grid: its force along the axis."}),
           history.add(
               {fmt::format("rotor.blade_{}.torque_N_m", b), "N m", "Of one blade of the grid: its moment about the axis."})});
  }
  void fill_rotor(std::span<double> row, const aero::PseudoRow& p) const {
    const aero::RotorLoad load = rotor->load(p);
    const double turns = rotor->pose().azimuth / (2.0 * pi);
    row[thrust] = load.thrust, row[torque] = load.torque, row[power] = load.power;
    row[azimuth] = 360.0 * (turns - std::floor(turns)), row[rpm] = rotor->pose().speed * 30.0 / pi;
    for (std::size_t b = 0; b < blades.size(); ++b) {
      const aero::RotorLoad blade = rotor->blade_load(int(b) + 1, p);
      row[blades[b][0]] = blade.thrust, row[blades[b][1]] = blade.torque;
    }
  }
  void add_motion(io::History& history) {
    pitch = history.add({"flow.pitch_deg", "deg", "Angle of the walls that move, about their axis."});
    for (std::size_t d = 0; d < 3; ++d) heave[d] = history.add({fmt::format("flow.heave_{}_m", "xyz"[d]), "m", "Their shift."});
  }
  void fill_motion(std::span<double> row, double time) const {
    const aero::TurnAndShift now = motion->at(time);
    row[pitch] = now.turn.dot(motion->axis()) / radians_per_degree;
    for (std::size_t d = 0; d < 3; ++d) row[heave[d]] = now.shift[Eigen::Index(d)];
  }
  void fill(std::span<double> row, double time, const FlowSolver& solver, const aero::PseudoRow& p, const aero::FlowOptions& o,
            const Eigen::Vector3d& wind) const {
    if (motion) fill_motion(row, time);
    const aero::FlowSetting& s = solver.setting();
    const Eigen::Vector3d f(p.force[0], p.force[1], p.force[2]), along = wind.normalized();
    Eigen::Vector3d across = Eigen::Vector3d::UnitZ() - along.z() * along;
    if (across.norm() > 0.0) across.normalize();
    const double unit = 0.5 * gas::density(s.gas, s.stream) * s.speed * s.speed * o.reference_area_m2;
    for (std::size_t d = 0; d < 3; ++d) row[force[d]] = p.force[d];
    if (rotor)
      fill_rotor(row, p);
    else
      row[lift] = f.dot(across) / unit, row[drag] = f.dot(along) / unit;
    row[residual] = p.density_residual, row[momentum] = p.mean_residual, row[model] = p.model_residual;
    row[cfl] = p.cfl, row[krylov] = p.krylov, row[steps] = p.step + 1;
  }
};

/// The checkpoints of a run of the air alone.
class FlowCheckpoints {
 public:
  FlowCheckpoints(const runtime::World& world, const Air& air, const io::RunDirectory& directory, const Scenario& scenario,
                  const io::History& history)
      : series_(world.comm, directory.checkpoints(), scenario.checkpoint.keep, directory.identity()),
        file_(*air.solver, *air.store, world),
        air_(air),
        scenario_(scenario),
        history_(history),
        rank_(world.rank) {}
  void save(std::int64_t tick, std::int64_t window, int restarts) {
    series_.save(tick, [&](io::CheckpointWriter& file) {
      file.set("window", window);
      file.set("restarts", std::int64_t(restarts));
      if (!chosen_.empty()) file.set("preconditioner", chosen_);
      write(file, history_.extent());
      for (const SavedArray& array : file_.arrays()) write(file, array);
      if (!air_.rotor) return;
      write_air_settings(file, scenario_);
      for (const SavedArray& array : rotor_arrays(*air_.rotor, felt_by(*air_.rotor), rank_)) write(file, array);
    });
  }
  /// What preconditioner = "auto" became; of a run before.
  void choose(const std::string& name) { chosen_ = name; }
  std::string chosen_before() {
    const std::optional<io::CheckpointReader> file = series_.newest();
    if (!file) throw io::InputError("--restart: no valid checkpoint in the run directory");
    return file->text("preconditioner");
  }
  std::int64_t resume(int& restarts) {
    const std::optional<io::CheckpointReader> file = series_.newest();
    if (!file) throw io::InputError("--restart: no valid checkpoint in the run directory");
    file_.read(*file);
    restarts = int(file->integer("restarts")) + 1;
    rows_ = extent_in(*file);
    return file->integer("window");
  }
  /// Of history.csv, when the checkpoint that was resumed was written.
  const std::optional<io::History::Extent>& rows() const { return rows_; }

 private:
  std::string chosen_;
  io::CheckpointSeries series_;
  AirFile file_;
  const Air& air_;
  const Scenario& scenario_;
  const io::History& history_;
  std::optional<io::History::Extent> rows_;
  int rank_;
};

/// preconditioner = "auto": by trial, or as the run that goes on had it; scene.toml then names it, so that it runs alike.
void choose_for(Air& air, FlowCheckpoints& checkpoints, const io::RunDirectory& directory, const runtime::World& world,
                bool restart) {
  std::string name, reason = "as before the restart";
  if (restart) {
    name = checkpoints.chosen_before();
  } else {
    const aero::Choice choice = aero::choose_preconditioner(*air.solver, world.comm);
    name = choice.preconditioner, reason = choice.reason;
  }
  air.solver->use(aero::make_preconditioner(name, air.solver->setting().common));
  checkpoints.choose(name);
  spdlog::info("air: preconditioner \"{}\" ({})", name, reason);
  if (world.rank == 0) write_choice(directory, name);
}

}  // namespace

io::Summary run_flow(const Scenario& s, const io::RunDirectory& directory, const runtime::World& world,
                     const RunSettings& settings) {
  const auto begin = std::chrono::steady_clock::now();
  const Timeline timeline(s.time.window_s, s.time.window_s, s.time.end_s);
  runtime::StopRequest stop(s.runtime.wall_limit_s, directory.stop());
  Air air(s, world);
  FlowSolver& solver = *air.solver;
  spdlog::info("air: {} cells in {} tiles of {} blocks, {:.0f} bytes per cell", solver.cells(), air.store->tiling().size(),
               air.blocks(), double(solver.bytes() + air.store->bytes()) / double(std::max(1L, solver.cells())) * world.size);
  if (air.rotor)
    if (const std::string note = aero::far_side_note(*s.aero.grid); !note.empty()) spdlog::warn("air: {}", note);
  fill_geometry(solver, world.comm);
  io::History history;
  FlowCheckpoints checkpoints(world, air, directory, s, history);
  if (s.aero.flow->preconditioner == "auto") choose_for(air, checkpoints, directory, world, settings.restart);
  const int coarse_steps = settings.restart ? 0 : s.aero.flow->coarse_steps;
  if (coarse_steps > 0 && air.rotor) {
    const aero::RotorLoad load = aero::start_from_coarser(resolved_rotor_setup(s), coarse_steps, *air.rotor);
    spdlog::info("air: {} pseudo-steps on a grid of half the resolution: thrust {:.4g} kN, power {:.4g} MW", coarse_steps,
                 1e-3 * load.thrust, 1e-6 * load.power);
  }
  runtime::Graph graph(world.comm);
  solver.record(graph);
  runtime::Executor executor(std::move(graph));
  if (coarse_steps > 0 && !air.rotor) start_on_coarser_grid(s, air, executor);

  io::Summary summary;
  const FlowColumns columns(history, air.rotor.get(), air.motion ? &*air.motion : nullptr);
  std::int64_t number = 0, saved = -1;
  if (settings.restart) {
    number = checkpoints.resume(summary.restarts);
    solver.set_time_step(s.time.window_s, s.time.window_s);
    if (air.rotor && !air.steady()) air.rotor->placed_at(number);
    if (air.motion) air.place(number, s.time.window_s);
  }
  open_history(world.comm, history, directory, settings, timeline.window_end_s(number), checkpoints.rows());
  const std::int64_t first = number;
  std::int64_t last = timeline.windows();
  if (settings.until_s)
    last = std::min<std::int64_t>(last, std::int64_t(std::ceil(*settings.until_s / s.time.window_s * (1.0 - 1e-12))));
  io::CheckpointPlan plan(s.checkpoint.interval_s, s.time.window_s, s.checkpoint.wall_interval_s);
  const auto save = [&] {
    const auto save_begin = io::CheckpointPlan::Clock::now();
    history.flush(), checkpoints.save(saved = number, number, summary.restarts);
    plan.saved(save_begin), stop.keep_margin(2.0 * plan.cost_s());
  };
  if (plan.at_start() && !settings.restart) save();
  const Eigen::Vector3d wind = flow_wind(s);
  io::Progress progress(timeline.window_end_s(number), timeline.window_end_s(last),
                        io::progress_style(world.rank, settings.quiet));
  const auto write_row = [&](const aero::PseudoRow& row, double time) {
    columns.fill(history.row(time), time, solver, row, *s.aero.flow, wind);
    history.write();
  };

  // A steady flow that separates somewhere goes on swinging: its loads along the span are means over the steps of the summary's
  // means.
  std::deque<aero::PseudoRow> last_rows;
  const auto averaged = [&](std::int64_t windows) {
    return std::size_t(std::max(1.0, std::round(s.output.mean_length(timeline.window_end_s(windows)) / s.time.window_s)));
  };
  const std::size_t most_rows = averaged(last);

  double march_seconds = 0.0;
  bool settled = false;
  while (number < last && summary.exit_code == 0 && !settled) {
    const auto march_begin = std::chrono::steady_clock::now();
    const std::int64_t before = number;
    if (air.rotor && !air.steady()) air.rotor->move_to(air.rotor->turned(number + 1));
    if (air.motion) solver.move_to(air.motion->poses(double(number + 1) * s.time.window_s));
    executor.run();
    march_seconds += seconds_since(march_begin);
    const aero::March& march = solver.march();
    if (air.steady()) {
      // The last row of a chunk that goes on is judged, and written, by the next.
      const std::size_t count = solver.rows().size() - (march.spent() ? 1 : 0);
      for (std::size_t n = 0; n < count && number < last; ++n) {
        write_row(solver.rows()[n], timeline.window_end_s(++number));
        last_rows.push_back(solver.rows()[n]);
        if (last_rows.size() > most_rows) last_rows.pop_front();
      }
      settled = march.verdict() == aero::Verdict::converged && !march.spent();
      solver.keep_last_row();
    } else {
      write_row(solver.rows().back(), timeline.window_end_s(++number));
      solver.clear_rows();
    }
    if (march.verdict() == aero::Verdict::failed) {
      summary.exit_code = 3;
      summary.exit_reason =
          fmt::format("aero: {} (pseudo-step {}, CFL {:.3g}, density residual {:.3g} after {:.3g} at first){}", march.why(),
                      march.steps(), march.cfl(), march.density_residual(), march.first_density_residual(), solver.trouble());
      summary.numerical_trouble.push_back(summary.exit_reason);
    }
    progress.update(timeline.window_end_s(number));
    if (std::string why = stop.agreed(world.comm); !why.empty() && number < last && !settled && summary.exit_code == 0)
      summary.exit_code = 5, summary.exit_reason = why;
    if (plan.due(world.comm, before, number)) save();
  }
  history.flush();
  if (saved != number) checkpoints.save(number, number, summary.restarts);
  AirOutput(world.comm, solver, *air.store, directory.fields(), {.walls = s.aero.flow->surfaces})
      .write(number, timeline.window_end_s(number));
  if (air.rotor && number > first) {  // a restart that has nothing left to do leaves what there is
    while (last_rows.size() > averaged(number)) last_rows.pop_front();
    const std::vector<aero::PseudoRow> rows(last_rows.begin(), last_rows.end());
    write_span(world, rows.empty() ? air.rotor->span_loads() : air.rotor->span_loads(rows), directory);
  }

  if (summary.exit_code == 0)
    summary.exit_reason = !air.steady() ? "done"
                          : settled     ? fmt::format("done: {}", solver.march().why())
                                        : "done: the pseudo-steps of the scene are spent";
  summary.start_time_s = timeline.window_end_s(first);
  summary.end_time_s = timeline.window_end_s(number);
  summary.window_s = timeline.window_s();
  summary.counts = {{"windows", number - first}, {"cells", solver.cells()}, {"krylov_steps", solver.march().krylov_total()}};
  summary.wall_seconds = seconds_since(begin);
  summary.parts = {{"air", march_seconds, march_seconds * executor.threads() * world.size, number - first},
                   {"output", summary.wall_seconds - march_seconds, summary.wall_seconds - march_seconds, 0}};
  summary.ranks = world.size;
  summary.threads = executor.threads();
  summary.columns = history.columns();
  return summary;
}

}  // namespace spindrift::coupling
