// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/flow_run.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iterator>

#include "kernels/base/constants.hpp"
#include "runtime/executor/executor.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "runtime/partition/partition.hpp"
#include "src/aero/flow/choice.hpp"
#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/flow/poisson.hpp"
#include "src/aero/flow_grid.hpp"
#include "src/aero/flow_options.hpp"
#include "src/aero/grid/wall_distance.hpp"
#include "src/aero/resolved_rotor.hpp"
#include "src/coupling/air_file.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/timeline.hpp"
#include "src/io/atomic_file.hpp"
#include "src/io/checkpoint.hpp"
#include "src/io/fields.hpp"
#include "src/io/history.hpp"
#include "src/io/machine_failure.hpp"
#include "src/io/progress.hpp"

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
  aero::GridStore* store = nullptr;
  FlowSolver* solver = nullptr;

  std::size_t blocks() const { return (rotor ? rotor->grid() : own_grid).blocks.size(); }

  Air(const Scenario& s, const runtime::World& world) {
    const aero::FlowOptions& o = *s.aero.flow;
    if (has_resolved_rotor(s)) {
      rotor = std::make_unique<aero::ResolvedRotor>(resolved_rotor_setup(s), world.size, world.rank, steady_chunk);
      store = &rotor->store(), solver = &rotor->solver();
      begin(o.start);
      return;
    }
    aero::MultiBlockGrid& grid = own_grid;
    grid = aero::flow_grid(o);
    const std::vector<std::string> walls = aero::wall_patches(o);
    aero::Tiling tiling = aero::make_tiling(grid, walls);
    std::vector<aero::PatchCondition> conditions = aero::patch_conditions(o, tiling);
    std::vector<int> ranks(std::size_t(tiling.size()), 0);
    if (world.size > 1) ranks = runtime::partition_blocks(aero::tile_graph(tiling), {.ranks = world.size}).rank_of_block;
    own_store = std::make_unique<aero::GridStore>(std::move(tiling), std::move(ranks), world.rank);
    store = own_store.get();
    store->build_all(grid);
    std::vector<std::string> no_slip;
    for (const aero::PatchOptions& b : o.boundaries)
      if (aero::sticks(b.condition)) no_slip.push_back(b.patch);
    if (o.wall_distance == "poisson") {
      aero::fill_wall_distance_by_poisson(*store, no_slip, world.comm);
    } else {
      const aero::WallSurface surface = aero::wall_surface(grid, no_slip);
      for (const int tile : store->owned()) aero::fill_wall_distance((*store)[tile], surface);
    }
    aero::FlowSetting setting = aero::flow_setting(o, s.environment.air_density_kg_m3, flow_wind(s), s.time.window_s);
    if (setting.time_order == 0) setting.march.max_steps = steady_chunk;
    own_solver = std::make_unique<FlowSolver>(*store, setting, std::move(conditions));
    solver = own_solver.get();
    begin(o.start);
  }
  bool steady() const { return solver->setting().time_order == 0; }
};

/// Columns of history.csv and how a row fills them.
struct FlowColumns {
  std::size_t force[3], lift, drag, residual, momentum, model, cfl, krylov, steps;
  const aero::ResolvedRotor* rotor;
  std::size_t thrust = 0, torque = 0, power = 0, azimuth = 0, rpm = 0;
  std::vector<std::array<std::size_t, 2>> blades;  ///< thrust and torque, of unsteady scenes

  FlowColumns(io::History& history, const aero::ResolvedRotor* of) : rotor(of) {
    if (rotor) add_rotor(history);
    const char* axes[3] = {"x", "y", "z"};
    for (std::size_t d = 0; d < 3; ++d)
      force[d] = history.add({fmt::format("flow.f{}_N", axes[d]), "N", "Force of the air on the patches with loads, pressure above the undisturbed one."});
    if (!rotor) lift = history.add({"flow.lift_coefficient", "-", "Force across the wind in its vertical plane, on dynamic pressure and aero.flow.reference_area_m2."});
    if (!rotor) drag = history.add({"flow.drag_coefficient", "-", "Force along the wind, likewise."});
    residual = history.add({"flow.density_residual", "kg/(m3 s)", "Root mean square over the cells."});
    momentum = history.add({"flow.scaled_residual", "-", "Norm of the residual of the mean flow in units of the undisturbed one."});
    model = history.add({"flow.turbulence_residual", "-", "The same of the turbulence model."});
    cfl = history.add({"flow.cfl", "-", "CFL number of the pseudo-step."});
    krylov = history.add({"flow.krylov_steps", "-", "Iterations of the linear solver in the pseudo-step before."});
    steps = history.add({"flow.pseudo_steps", "-", "Pseudo-steps: so far (steady), of the window (unsteady)."});
  }
  void add_rotor(io::History& history) {
    thrust = history.add({"rotor.thrust_N", "N", "Force of the air on the blades along the rotor axis, positive downwind."});
    torque = history.add({"rotor.torque_N_m", "N m", "Moment of the air on the blades about the rotor axis, positive where it drives the rotor."});
    power = history.add({"rotor.power_W", "W", "Torque times rotor speed."});
    azimuth = history.add({"rotor.azimuth_deg", "deg", "Of blade 1 from upright, 0 to 360."});
    rpm = history.add({"rotor.rpm", "rpm", "Rotor speed."});
    for (int b = 1; b <= rotor->grid_blades() && !rotor->steady(); ++b)
      blades.push_back({history.add({fmt::format("rotor.blade_{}.thrust_N", b), "N", "Share of one blade."}),
                        history.add({fmt::format("rotor.blade_{}.torque_N_m", b), "N m", "Share of one blade."})});
  }
  void fill_rotor(std::span<double> row, const aero::PseudoRow& p) const {
    const aero::RotorLoad load = rotor->load(p);
    const double turns = rotor->pose().azimuth / (2.0 * pi);
    row[thrust] = load.thrust, row[torque] = load.torque, row[power] = load.power;
    row[azimuth] = 360.0 * (turns - std::floor(turns)), row[rpm] = rotor->pose().speed * 30.0 / pi;
    for (std::size_t b = 0; b < blades.size(); ++b) {
      const aero::RotorLoad blade = rotor->blade_load(int(b) + 1);
      row[blades[b][0]] = blade.thrust, row[blades[b][1]] = blade.torque;
    }
  }
  void fill(std::span<double> row, const FlowSolver& solver, const aero::PseudoRow& p, const aero::FlowOptions& o, const Eigen::Vector3d& wind) const {
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
  FlowCheckpoints(MPI_Comm comm, const Air& air, const io::RunDirectory& directory, int keep)
      : series_(comm, directory.checkpoints(), keep), air_(*air.solver, *air.store) {}
  void save(std::int64_t tick, std::int64_t window, int restarts) {
    series_.save(tick, [&](io::CheckpointWriter& file) {
      file.set("window", window);
      file.set("restarts", std::int64_t(restarts));
      if (!chosen_.empty()) file.set("preconditioner", chosen_);
      air_.write(file);
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
    air_.read(*file);
    restarts = int(file->integer("restarts")) + 1;
    return file->integer("window");
  }

 private:
  std::string chosen_;
  io::CheckpointSeries series_;
  AirFile air_;
};

/// preconditioner = "auto": by trial, or as the run that goes on had it; scene.toml then names it, so that it runs alike.
void choose_for(Air& air, FlowCheckpoints& checkpoints, const io::RunDirectory& directory, const runtime::World& world, bool restart) {
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
  if (world.rank == 0) {
    const std::string automatic = "preconditioner = \"auto\"";
    std::ifstream in(directory.scene());
    std::string text(std::istreambuf_iterator<char>(in), {});
    if (const std::size_t at = text.find(automatic); at != std::string::npos)
      io::write_atomically(directory.scene(), text.replace(at, automatic.size(), fmt::format("preconditioner = \"{}\"", name)));
  }
}

/// Pressure, velocity, temperature and eddy variables at cell centres for ParaView.
void write_fields(MPI_Comm comm, const Air& air, const io::RunDirectory& directory, std::int64_t tick, double time_s) {
  const aero::Tiling& tiling = air.store->tiling();
  std::vector<io::GridBlock> blocks;
  for (const aero::Tile& tile : tiling.tiles)
    blocks.push_back({fmt::format("tile_{}", blocks.size()), tile.ni, tile.nj, tile.nk});
  std::vector<io::Field> fields{{"pressure", "Pa"}, {"velocity", "m/s", 3}, {"temperature", "K"}};
  const int carried = air.solver->tiles().empty() ? 0 : air.solver->tiles()[0].turbulence;
  for (int t = 0; t < carried; ++t) fields.push_back({fmt::format("turbulence_{}", t + 1), carried == 1 ? "m2/s" : t == 0 ? "m2/s2" : "1/s"});
  io::GridFields file(comm, directory.fields(), "air", std::move(blocks), std::move(fields), false);
  const gas::IdealGas& gas = air.solver->setting().gas;
  std::vector<std::vector<double>> kept;
  std::vector<io::GridFields::Values> values;
  kept.reserve(air.solver->tiles().size() * std::size_t(4 + carried));
  for (const aero::FlowTile& t : air.solver->tiles()) {
    const auto component = [&](int c, double offset) -> std::vector<double>& {
      auto& out = kept.emplace_back();
      aero::for_rows(t.box, [&](int k, int j) {
        for (int i = 0; i < t.box.ni; ++i) out.push_back(offset + t.state.data()[c * t.cells.component + t.cells.at(k, j, i)]);
      });
      return out;
    };
    auto& points = kept.emplace_back();
    const BoxLayout& nodes = t.geometry->node_box;
    for (int k = 0; k <= t.box.nk; ++k)
      for (int j = 0; j <= t.box.nj; ++j)
        for (int i = 0; i <= t.box.ni; ++i)
          for (int c = 0; c < 3; ++c) points.push_back(t.geometry->node_data.data()[c * nodes.component + nodes.at(k, j, i)]);
    io::GridFields::Values v{t.index, points, {}};
    v.fields.push_back(component(0, gas.pressure_reference));
    auto& velocity = kept.emplace_back();
    aero::for_rows(t.box, [&](int k, int j) {
      for (int i = 0; i < t.box.ni; ++i)
        for (int c = 1; c < 4; ++c) velocity.push_back(t.state.data()[c * t.cells.component + t.cells.at(k, j, i)]);
    });
    v.fields.push_back(velocity);
    v.fields.push_back(component(4, gas.temperature_reference));
    for (int c = 0; c < carried; ++c) v.fields.push_back(component(aero::mean_unknowns + c, 0.0));
    values.push_back(std::move(v));
  }
  file.write(tick, time_s, values);
}

/// Walls as surfaces: a block for each window of a tile on a wall.
void write_walls(MPI_Comm comm, const Air& air, const io::RunDirectory& directory, std::int64_t tick, double time_s) {
  const aero::Tiling& tiling = air.store->tiling();
  const FlowSolver& solver = *air.solver;
  const auto on_wall = [&](const aero::TileBoundary& b) {
    return aero::is_closed(solver.conditions()[std::size_t(b.patch)].condition);
  };
  std::vector<io::GridBlock> blocks;
  std::vector<int> first_block;  // by tile
  for (int tile = 0; tile < tiling.size(); ++tile) {
    first_block.push_back(int(blocks.size()));
    for (const aero::TileBoundary& b : tiling.boundary(tile))
      if (on_wall(b))
        blocks.push_back({fmt::format("{}_{}", tiling.patches[std::size_t(b.patch)], blocks.size()), b.high[0] - b.low[0], b.high[1] - b.low[1], 0});
  }
  if (blocks.empty()) return;
  io::GridFields file(comm, directory.fields(), "walls", std::move(blocks),
                      {{"pressure", "Pa"}, {"pressure_coefficient", "-"}, {"friction_coefficient", "-", 3}, {"y_plus", "-"}}, false);
  const aero::FlowSetting& s = solver.setting();
  const double q = 0.5 * gas::density(s.gas, s.stream) * s.speed * s.speed;
  std::vector<std::array<std::vector<double>, 5>> kept;
  std::vector<int> numbers;
  for (const aero::FlowTile& t : solver.tiles()) {
    const std::vector<aero::WallPoint> points = solver.wall_points(t);
    std::size_t at = 0;
    int block = first_block[std::size_t(t.index)];
    for (const aero::FlowBoundary& b : t.boundaries) {
      if (!on_wall(b.where)) continue;
      auto& [corners, pressure, cp, cf, y_plus] = kept.emplace_back();
      numbers.push_back(block++);
      const int d = aero::direction_of(b.where.side), extent[3] = {t.box.ni, t.box.nj, t.box.nk};
      const auto [along_a, along_b] = aero::along(b.where.side);
      const BoxLayout& nodes = t.geometry->node_box;
      int n[3];
      n[d] = aero::at_end(b.where.side) ? extent[d] : 0;
      for (n[along_b] = b.where.low[1]; n[along_b] <= b.where.high[1]; ++n[along_b])
        for (n[along_a] = b.where.low[0]; n[along_a] <= b.where.high[0]; ++n[along_a])
          for (int c = 0; c < 3; ++c) corners.push_back(t.geometry->node_data.data()[c * nodes.component + nodes.at(n[2], n[1], n[0])]);
      const int faces = (b.where.high[0] - b.where.low[0]) * (b.where.high[1] - b.where.low[1]);
      for (int m = 0; m < faces; ++m) {
        const aero::WallPoint& p = points.at(at++);
        pressure.push_back(s.gas.pressure_reference + p.pressure), cp.push_back(p.pressure / q), y_plus.push_back(p.y_plus);
        for (const double stress : p.traction) cf.push_back(stress / q);
      }
    }
  }
  std::vector<io::GridFields::Values> values;
  for (std::size_t m = 0; m < kept.size(); ++m) {
    const auto& [corners, pressure, cp, cf, y_plus] = kept[m];
    values.push_back({numbers[m], corners, {pressure, cp, cf, y_plus}});
  }
  file.write(tick, time_s, values);
}

/// Loads along the blades as they are at the end: spanwise.csv.
void write_span(const runtime::World& world, aero::ResolvedRotor& rotor, const io::RunDirectory& directory) {
  const std::vector<aero::SpanLoad> loads = rotor.span_loads(world.comm);
  if (world.rank != 0) return;
  std::string text = "blade,radius_m,length_m,chord_m,normal_N_m,tangential_N_m,friction_normal_N_m,friction_tangential_N_m\n";
  for (const aero::SpanLoad& s : loads)
    text += fmt::format("{},{:.6g},{:.6g},{:.6g},{:.17g},{:.17g},{:.17g},{:.17g}\n", s.blade, s.radius, s.length, s.chord, s.load.normal,
                        s.load.tangential, s.friction.normal, s.friction.tangential);
  io::write_atomically(directory.path() / "spanwise.csv", text);
}

}  // namespace

io::Summary run_flow(const Scenario& s, const io::RunDirectory& directory, const runtime::World& world, const RunSettings& settings) {
  const auto begin = std::chrono::steady_clock::now();
  const Timeline timeline(s.time.window_s, s.time.window_s, s.time.end_s);
  const runtime::StopRequest stop(s.runtime.wall_limit_s);
  Air air(s, world);
  FlowSolver& solver = *air.solver;
  spdlog::info("air: {} cells in {} tiles of {} blocks, {:.0f} bytes per cell", solver.cells(), air.store->tiling().size(),
               air.blocks(), double(solver.bytes() + air.store->bytes()) / double(std::max(1L, solver.cells())) * world.size);
  {
    runtime::Graph geometry(world.comm);
    solver.record_geometry(geometry);
    runtime::Executor(std::move(geometry), {.threads = 1}).run();
  }
  FlowCheckpoints checkpoints(world.comm, air, directory, s.checkpoint.keep);
  if (s.aero.flow->preconditioner == "auto") choose_for(air, checkpoints, directory, world, settings.restart);
  runtime::Graph graph(world.comm);
  solver.record(graph);
  runtime::Executor executor(std::move(graph));

  io::Summary summary;
  io::History history;
  const FlowColumns columns(history, air.rotor.get());
  std::int64_t number = 0, saved = -1;
  if (settings.restart) {
    number = checkpoints.resume(summary.restarts);
    solver.set_time_step(s.time.window_s, s.time.window_s);
    if (air.rotor && !air.steady()) air.rotor->placed_at(number);
  }
  if (world.rank == 0 && settings.restart)
    history.resume(directory.history(), timeline.window_end_s(number));
  else if (world.rank == 0)
    history.open(directory.history());
  const std::int64_t first = number;
  std::int64_t last = timeline.windows();
  if (settings.until_s) last = std::min<std::int64_t>(last, std::int64_t(std::ceil(*settings.until_s / s.time.window_s * (1.0 - 1e-12))));
  const std::int64_t save_every =
      s.checkpoint.interval_s > 0.0 ? std::max<std::int64_t>(1, std::llround(s.checkpoint.interval_s / s.time.window_s)) : 0;
  const Eigen::Vector3d wind = flow_wind(s);
  io::Progress progress(timeline.window_end_s(number), timeline.window_end_s(last), io::progress_style(world.rank, settings.quiet));
  const auto write_row = [&](const aero::PseudoRow& row, double time) {
    columns.fill(history.row(time), solver, row, *s.aero.flow, wind);
    history.write();
  };

  double march_seconds = 0.0;
  bool settled = false;
  while (number < last && summary.exit_code == 0 && !settled) {
    const auto march_begin = std::chrono::steady_clock::now();
    if (air.rotor && !air.steady()) air.rotor->move_to(air.rotor->turned(number + 1));
    executor.run();
    march_seconds += seconds_since(march_begin);
    const aero::March& march = solver.march();
    if (air.steady()) {
      // The last row of a chunk that goes on is judged, and written, by the next.
      const std::size_t count = solver.rows().size() - (march.spent() ? 1 : 0);
      for (std::size_t n = 0; n < count && number < last; ++n) write_row(solver.rows()[n], timeline.window_end_s(++number));
      settled = march.verdict() == aero::Verdict::converged && !march.spent();
      solver.keep_last_row();
    } else {
      write_row(solver.rows().back(), timeline.window_end_s(++number));
      solver.clear_rows();
    }
    if (march.verdict() == aero::Verdict::failed) {
      summary.exit_code = 3;
      summary.exit_reason = fmt::format("aero: {} (pseudo-step {}, CFL {:.3g}, density residual {:.3g} after {:.3g} at first){}", march.why(),
                                        march.steps(), march.cfl(), march.density_residual(), march.first_density_residual(), solver.trouble());
      summary.numerical_trouble.push_back(summary.exit_reason);
    }
    progress.update(timeline.window_end_s(number));
    if (std::string why = stop.agreed(world.comm); !why.empty() && number < last && !settled && summary.exit_code == 0)
      summary.exit_code = 5, summary.exit_reason = why;
    if (save_every > 0 && number / save_every != saved / save_every) history.flush(), checkpoints.save(saved = number, number, summary.restarts);
  }
  history.flush();
  if (saved != number) checkpoints.save(number, number, summary.restarts);
  write_fields(world.comm, air, directory, number, timeline.window_end_s(number));
  if (air.rotor) write_span(world, *air.rotor, directory);
  if (s.aero.flow->surfaces) write_walls(world.comm, air, directory, number, timeline.window_end_s(number));

  if (summary.exit_code == 0)
    summary.exit_reason = !air.steady() ? "done" : settled ? fmt::format("done: {}", solver.march().why()) : "done: the pseudo-steps of the scene are spent";
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
