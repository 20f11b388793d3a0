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
#include "runtime/mpi/exchange.hpp"
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
    if (const std::string why = o.coarse_steps.value_or(0) > 0 ? aero::why_not_halved(own_grid) : std::string(); !why.empty())
      throw scene::SceneError(
          {{s.source, 0, "aero.flow.coarse_steps", fmt::format("{}", *o.coarse_steps),
            fmt::format("needs a grid whose every second node makes a grid; {}, an odd number or too few", why)}});
    if (o.motion) follow(o);
    solve(s, world, steady_chunk);
  }
  /// On a coarser grid, for at most so many pseudo-steps.
  Air(aero::MultiBlockGrid grid, const Scenario& s, const runtime::World& world, int steps) {
    Scenario coarse = s;
    aero::FlowOptions& o = *coarse.aero.flow;
    o.drop = o.coarse_drop;
    if (o.preconditioner == "auto") o.preconditioner = aero::FlowOptions().preconditioner;
    own_grid = std::move(grid);
    solve(coarse, world, steps);
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

/// Marches once; `march` was recorded of the solver.
void look_at_start(FlowSolver& solver, runtime::Executor& march) {
  solver.march().look();
  march.run();
  solver.clear_rows();
}

/// Pseudo-steps on each coarser grid where the scene does not say.
constexpr int usual_coarse_steps = 100;

/// Grid sequencing of grids that are no rotor's: the flow settles on coarser grids first, the coarsest before the others, their
/// tiles spread over the ranks like the fine one's. What a drop is counted from stays the residual of the undisturbed flow on
/// each grid. `march` is the fine one's. A coarser grid whose march fails is passed over.
void start_on_coarser_grids(const Scenario& s, Air& air, runtime::Executor& march, const runtime::World& world) {
  const aero::FlowOptions& o = *s.aero.flow;
  std::vector<aero::MultiBlockGrid> grids;
  for (const aero::MultiBlockGrid* last = &air.own_grid;
       int(grids.size()) < o.coarse_levels && aero::why_not_halved(*last).empty(); last = &grids.back())
    grids.push_back(aero::halved(*last));
  if (grids.empty()) return;
  look_at_start(*air.solver, march);
  std::unique_ptr<Air> coarser;
  while (!grids.empty()) {
    auto next = std::make_unique<Air>(std::move(grids.back()), s, world, o.coarse_steps.value_or(usual_coarse_steps));
    grids.pop_back();
    FlowSolver& solver = *next->solver;
    fill_geometry(solver, world.comm);
    runtime::Graph graph(world.comm);
    solver.record(graph);
    runtime::Executor executor(std::move(graph));
    if (coarser) {
      look_at_start(solver, executor);
      aero::begin_with(*coarser->solver, solver, {}, world.comm);
      solver.march().begin_after_look();
    }
    executor.run();
    const aero::March& done = solver.march();
    if (done.verdict() == aero::Verdict::failed) {
      spdlog::warn("air: on a coarser grid of {} cells the march failed ({}); the next begins without it", solver.cells(),
                   done.why());
      coarser.reset();
      continue;
    }
    spdlog::info("air: {} pseudo-steps on a coarser grid of {} cells, flux balance down to {:.2g}: {}", done.steps() - 1,
                 solver.cells(), done.balance_drop(), done.why());
    coarser = std::move(next);
  }
  if (coarser) aero::begin_with(*coarser->solver, *air.solver, {}, world.comm);
  air.solver->march().begin_after_look();
}

/// Says where first cells stand in another part of the layer than their wall is made for: nine tenths of the walls' area by y+ of
/// their centres. Resolved walls want about 1, the law of the wall the logarithmic layer.
void tell_first_cells(const FlowSolver& solver, const runtime::World& world) {
  struct Face {
    double area, y_plus;
  };
  std::array<std::vector<Face>, 2> walls;  // resolved, by the law of the wall
  for (const aero::FlowTile& tile : solver.tiles())
    for (const aero::WallPoint& p : solver.wall_points(tile)) {
      const aero::Condition c = solver.conditions()[std::size_t(p.patch)].condition;
      if (aero::sticks(c)) walls[c == aero::Condition::wall_law].push_back({p.area, p.y_plus});
    }
  constexpr std::array<double, 2> least{0.0, 15.0}, most{5.0, 1000.0};
  constexpr double share = 0.9;
  for (std::size_t kind = 0; kind < 2; ++kind) {
    runtime::Packer mine;
    mine.put(std::span<const Face>(walls[kind]));
    std::vector<Face> all;
    for (const runtime::Bytes& bytes : runtime::exchange_all(world.comm, mine.take()))
      for (const Face& face : runtime::Unpacker(bytes).many<Face>()) all.push_back(face);
    if (all.empty()) continue;
    std::ranges::sort(all, {}, &Face::y_plus);
    double area = 0.0, off = 0.0;
    for (const Face& f : all) area += f.area, off += f.y_plus < least[kind] || f.y_plus > most[kind] ? f.area : 0.0;
    if (off <= (1.0 - share) * area) continue;
    spdlog::warn(
        "air: y+ of first cells is {:.3g} in the middle, {:.3g} at most; {} walls want {:g} to {:g}, which {:.0f} % of their "
        "area does not have: friction is not to be trusted",
        all[all.size() / 2].y_plus, all.back().y_plus, kind == 0 ? "resolved" : "wall-function", least[kind], most[kind],
        100.0 * off / area);
  }
}

/// Columns of history.csv and how a row fills them.
struct FlowColumns {
  std::size_t force[3], lift, drag, residual, momentum, model, cfl, krylov, steps, limited, unconverged = 0;
  const aero::ResolvedRotor* rotor;
  const aero::GridMotion* motion;
  std::size_t pitch = 0, heave[3] = {0, 0, 0};
  std::size_t thrust = 0, torque = 0, power = 0, azimuth = 0, rpm = 0;
  std::vector<std::array<std::size_t, 2>> blades;  ///< thrust and torque

  bool steady = true;

  FlowColumns(io::History& history, const aero::ResolvedRotor* of, const aero::GridMotion* moving, bool is_steady)
      : rotor(of), motion(moving), steady(is_steady) {
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
    limited = history.add({"flow.limited_cells", "-", "Cells whose last update was too large: it was shortened."});
    if (!steady)
      unconverged =
          history.add({"flow.unconverged_windows", "-", "Windows so far that spent their pseudo-steps without the drop."});
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
    row[cfl] = p.cfl, row[krylov] = p.krylov, row[steps] = p.step + 1, row[limited] = double(p.limited);
    if (!steady) row[unconverged] = double(solver.march().unconverged());
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
  const runtime::StopRequest stop(s.runtime.wall_limit_s);
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
  const bool begins = air.steady() && !settings.restart;
  if (const int coarse_steps = s.aero.flow->coarse_steps.value_or(0); begins && coarse_steps > 0 && air.rotor) {
    const aero::RotorLoad load = aero::start_from_coarser(resolved_rotor_setup(s), coarse_steps, *air.rotor, world);
    spdlog::info("air: {} pseudo-steps on a grid of half the resolution: thrust {:.4g} kN, power {:.4g} MW", coarse_steps,
                 1e-3 * load.thrust, 1e-6 * load.power);
  }
  runtime::Graph graph(world.comm);
  solver.record(graph);
  runtime::Executor executor(std::move(graph));
  if (begins && !air.rotor && s.aero.flow->coarse_steps.value_or(usual_coarse_steps) > 0)
    start_on_coarser_grids(s, air, executor, world);

  io::Summary summary;
  const FlowColumns columns(history, air.rotor.get(), air.motion ? &*air.motion : nullptr, air.steady());
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
    plan.saved(save_begin);
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
      const long unconverged = march.unconverged();
      if (march.spent() && unconverged == 1)
        spdlog::warn(
            "air: the window to t = {:.6g} s spent its {} pseudo-steps; the flux balance has fallen by {:.2g} of {:.2g} "
            "asked for; {}",
            timeline.window_end_s(number), march.steps() - 1, march.balance_drop(), s.aero.flow->drop, solver.worst_cell());
      if (const double most = s.aero.flow->unconverged_share * double(timeline.windows()); double(unconverged) > most) {
        summary.exit_code = 3;
        summary.exit_reason = fmt::format(
            "aero: {} of {} windows spent their {} pseudo-steps without the drop of {:.2g} (aero.flow.max_pseudo_steps, .drop), "
            "at "
            "most {:g} may (aero.flow.unconverged_share); the last, to t = {:.6g} s, ended at {:.2g}; {}",
            unconverged, march.ended(), solver.setting().march.max_steps, s.aero.flow->drop, std::floor(most),
            timeline.window_end_s(number), march.balance_drop(), solver.worst_cell());
        summary.numerical_trouble.push_back(summary.exit_reason);
      }
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
  if (air.steady() && summary.exit_code == 0 && !settled && number == timeline.windows() && s.aero.flow->drop > 0.0) {
    const aero::March& march = solver.march();
    summary.exit_code = 3;
    summary.exit_reason = fmt::format(
        "aero: not converged in the {} pseudo-steps of the scene: the flux balance has fallen by {:.2g}, the density residual by "
        "{:.2g}, of {:.2g} asked for (aero.flow.drop; 0 takes all steps whatever they reach); {}; --restart with a larger "
        "time.end_s goes on",
        march.steps() - 1, march.balance_drop(), march.density_residual() / std::max(march.first_density_residual(), 1e-300),
        s.aero.flow->drop, solver.worst_cell());
    summary.numerical_trouble.push_back(summary.exit_reason);
  }
  history.flush();
  if (saved != number) checkpoints.save(number, number, summary.restarts);
  AirOutput(world.comm, solver, *air.store, directory.fields(), {.walls = s.aero.flow->surfaces})
      .write(number, timeline.window_end_s(number));
  if (solver.setting().viscous && solver.setting().turbulence != "none") tell_first_cells(solver, world);
  if (air.rotor && number > first) {  // a restart that has nothing left to do leaves what there is
    while (last_rows.size() > averaged(number)) last_rows.pop_front();
    const std::vector<aero::PseudoRow> rows(last_rows.begin(), last_rows.end());
    write_span(world, rows.empty() ? air.rotor->span_loads() : air.rotor->span_loads(rows), directory);
  }

  if (summary.exit_code == 0)
    summary.exit_reason =
        !air.steady() ? "done"
        : settled     ? fmt::format("done: {}; flux balance down to {:.2g}, density residual to {:.2g}", solver.march().why(),
                                    solver.march().balance_drop(),
                                    solver.march().density_residual() / std::max(solver.march().first_density_residual(), 1e-300))
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
