// SPDX-License-Identifier: Apache-2.0
#include "src/aero/resolved_rotor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/base/constants.hpp"
#include "kernels/base/failure.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "src/aero/grid/checks.hpp"
#include "src/aero/grid/wall_distance.hpp"
#include "src/aero/tile_balance.hpp"

namespace spindrift::aero {

namespace {

RigidMap map_of(const RotorPose& pose) { return {pose.attitude().toRotationMatrix(), pose.hub.position}; }

/// A grid without nodes where the rotor is, in earth coordinates.
MultiBlockGrid carried(MultiBlockGrid grid, const RigidMap& map) {
  for (Connection& c : grid.connections)
    if (c.periodic) c.periodic = moved_maps(std::span(&*c.periodic, 1), map)[0];
  return grid;
}

/// What a rotor still needs once its solver is made.
std::shared_ptr<const MadeRotorGrid> rest_of(const MadeRotorGrid& made) {
  auto rest = std::make_shared<MadeRotorGrid>();
  rest->turbine = made.turbine, rest->spec = made.spec, rest->grid = made.grid, rest->stations = made.stations;
  rest->moments = made.moments;
  return rest;
}

/// Layers of cells of the rotor's grid that tiles of this rank have, from the hub on.
std::vector<char> layers_of_tiles(const GridStore& store, const MadeRotorGrid& made) {
  std::vector<char> wanted(std::size_t(made.maker->layers()), 0);
  for (const int t : store.owned()) {
    const Box box = block_box(store.tiling(), t);
    const int of_sector = store.tiling().tiles[std::size_t(t)].block % BladePitching::blocks_of_sector;
    const int begin = of_sector == 1 ? made.span_cells() : 0;  // the plug, from the tip on
    std::fill(wanted.begin() + begin + box.low[2], wanted.begin() + begin + box.high[2], 1);
  }
  return wanted;
}

}  // namespace

RotorPose hub_pose(const RotorOptions& rotor) {
  RotorPose pose;
  const Eigen::Vector3d axis = rotor.axis.normalized();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ() - axis.z() * axis;
  if (up.norm() < 1e-6) up = Eigen::Vector3d::UnitX() - axis.x() * axis;  // as RotorLoads does
  up.normalize();
  Eigen::Matrix3d frame;
  frame << axis, up.cross(axis), up;
  pose.hub.position = rotor.hub_m;
  pose.hub.attitude = Eigen::Quaterniond(frame).normalized();
  pose.azimuth = rotor.azimuth, pose.speed = rotor.speed;
  return pose;
}

ResolvedRotor::ResolvedRotor(const ResolvedRotorSetup& setup, int ranks, int rank, int chunk,
                             std::shared_ptr<const MadeRotorGrid> made, const GridProgress& told, std::vector<int> rank_of_tile)
    : setup_(setup), made_(made ? std::move(made) : made_rotor_grid(setup, MPI_COMM_SELF, told)), start_(hub_pose(setup.rotor)) {
  const RotorOptions& rotor = setup.rotor;

  // Seen from the rotor a steady flow stands still: nodes rest in the earth where the rotor is at the start, and only their frame
  // turns.
  now_ = before_ = {start_};
  const MultiBlockGrid placed = steady() ? carried(made_->grid, map_of(start_)) : made_->grid;
  if (told) told("tiles", 0.0);
  Tiling tiling = rotor_tiling(setup.flow, placed, made_->edges);
  const FlowOptions flow = with_default_patches(setup.flow, placed);
  std::vector<PatchCondition> conditions = patch_conditions(flow, tiling);
  if (!setup.ranks_may_idle) require_ranks(std::size_t(tiling.size()), ranks);
  if (rank_of_tile.empty()) rank_of_tile = ranks_by_cells(tiling, ranks);
  store_ = std::make_unique<GridStore>(std::move(tiling), std::move(rank_of_tile), rank);
  make_nodes();
  fill_wall_distances(told);
  if (steady()) store_->carry(map_of(start_));
  made_ = rest_of(*made_);
  FlowSetting setting = flow_setting(flow, setup.air_density, setup.wind, setup.dt, setup.profile);
  const Turbine& turbine = made_->turbine;
  const double tip = turbine.planform.span.back() * std::cos(turbine.precone);
  setting.speed = std::hypot(setup.wind.norm(), rotor.speed * tip);
  if (steady()) {
    if (chunk > 0) setting.march.max_steps = chunk;
    setting.frame_omega = rotor.speed * (start_.hub.attitude * Eigen::Vector3d::UnitX());
    setting.frame_centre = rotor.hub_m;
  }
  solver_ = std::make_unique<FlowSolver>(*store_, setting, std::move(conditions));
  solver_->gather_bands(rows_of_faces());
  solver_->judgement().bands_of_every_row = steady();
  if (!steady()) place({turned(-2)}, {turned(-1)}, {turned(0)});
}

std::unique_ptr<ResolvedRotor> ResolvedRotor::on(const runtime::World& world, const ResolvedRotorSetup& setup, int chunk,
                                                 std::shared_ptr<const MadeRotorGrid> made, const GridProgress& told,
                                                 std::vector<int> rank_of_tile) {
  std::unique_ptr<ResolvedRotor> rotor;
  runtime::give_up_together(world.comm, [&] {
    rotor = std::make_unique<ResolvedRotor>(setup, world.size, world.rank, chunk, std::move(made), told, std::move(rank_of_tile));
  });
  return rotor;
}

/// Of the tiles of this rank, in the rotor's frame, and how they follow the pitch of blades: layers of the grid, made again.
void ResolvedRotor::make_nodes() {
  pitching_ = std::make_unique<BladePitching>(made_->grid, made_->radii, made_->turbine, made_->spec);
  const std::vector<char> wanted = layers_of_tiles(*store_, *made_);
  std::vector<char> rows(wanted.size() + 1, 0);  // of rings, by k: those of own tiles
  for (const int t : store_->owned()) {
    const Box box = block_box(store_->tiling(), t);
    if (store_->tiling().tiles[std::size_t(t)].block % BladePitching::blocks_of_sector == 0)
      std::fill(rows.begin() + box.low[2], rows.begin() + box.high[2] + 1, 1);
  }
  store_->begin_parts();
  const int layers = int(wanted.size()), some = made_->layers_at_once();
  for (int first = 0; first < layers; ++first) {
    if (!wanted[std::size_t(first)]) continue;
    runtime::StopRequest::give_up_if_asked();
    int last = first;
    while (last < layers && last < first + some && wanted[std::size_t(last)]) ++last;
    GridLayers part = made_->maker->make(first, last);
    pitching_->add_rows(part, [&](int k) { return rows[std::size_t(k)] != 0; });
    store_->take(part);
    first = last - 1;
  }
  store_->end_parts(!steady());
}

/// In the rotor's frame, so that they are the same wherever it is.
void ResolvedRotor::fill_wall_distances(const GridProgress& told) {
  if (take_wall_distance(*store_, *made_->distances)) return;
  fill_wall_distance(*store_, wall_surface(made_->walls, made_->grid.connections),
                     told ? [&](double share) { told("wall distances", share); } : std::function<void(double)>());
  keep_wall_distance(*store_, *made_->distances);
}

// ---- motion

RotorPose ResolvedRotor::turned(double windows) const {
  RotorPose pose = start_;
  pose.azimuth += start_.speed * setup_.dt * windows;
  return pose;
}

std::vector<BlockPose> ResolvedRotor::block_poses(const RotorPlace& place) const {
  const RigidMap map = map_of(place.pose);
  if (!place.pitches_blades()) return {BlockPose{.map = map, .shape = {}}};
  std::vector<BlockPose> poses(made_->grid.blocks.size(), BlockPose{.map = map, .shape = {}});
  for (int b = 0; b < int(poses.size()); ++b)
    if (pitching_->moves(b))
      poses[std::size_t(b)].shape_at = [this, b, pitch = place.pitches.at(std::size_t(b / BladePitching::blocks_of_sector))](
                                           const Index& n, const Eigen::Vector3d& as_made) {
        return pitching_->node(b, n[2], n[1], n[0], pitch, as_made);
      };
  return poses;
}

void ResolvedRotor::move_to(const RotorPlace& end) {
  solver_->motion().move_to(block_poses(end));
  long_before_ = std::exchange(before_, std::exchange(now_, end));
}

void ResolvedRotor::place(const RotorPlace& long_before, const RotorPlace& before, const RotorPlace& now) {
  solver_->motion().place(block_poses(before), block_poses(now), block_poses(long_before));
  long_before_ = long_before, before_ = before, now_ = now;
}

void ResolvedRotor::placed_at(double windows) {
  long_before_.pose = turned(windows - 2.0), before_.pose = turned(windows - 1.0), now_.pose = turned(windows);
}

// ---- loads

RotorLoad ResolvedRotor::about_hub(const Eigen::Vector3d& force, const Eigen::Vector3d& moment, bool all) const {
  const Eigen::Vector3d axis = pose().hub.attitude * Eigen::Vector3d::UnitX();
  RotorLoad load;
  load.force = force, load.moment = moment - pose().hub.position.cross(force);
  if (all && !made_->spec.whole) {  // blades alike at equal angles: what lies across the axis cancels
    load.force = made_->turbine.blades * axis.dot(load.force) * axis;
    load.moment = made_->turbine.blades * axis.dot(load.moment) * axis;
  }
  load.thrust = axis.dot(load.force), load.torque = axis.dot(load.moment), load.power = load.torque * pose().speed;
  return load;
}

RotorLoad ResolvedRotor::load(const PseudoRow& row) const {
  return of_blades([&](int blade) { return blade_load(blade, row); });
}

RotorLoad ResolvedRotor::blade_load(int blade) const {
  return blade_load(solver_->judgement().patch(store_->tiling().patch(fmt::format("blade_{}", blade))));
}

RotorLoad ResolvedRotor::blade_load(int blade, const PseudoRow& row) const {
  return blade_load(patch_loads(row.loads, store_->tiling().patch(fmt::format("blade_{}", blade))));
}

RotorLoad ResolvedRotor::blade_load(const PatchLoads& p) const {
  const auto vector = [](const std::array<double, 3>& v) { return Eigen::Vector3d(v[0], v[1], v[2]); };
  return about_hub(vector(p.pressure_force) + vector(p.viscous_force), vector(p.moment), false);
}

RotorLoad ResolvedRotor::load() const {
  return of_blades([&](int blade) { return blade_load(blade); });
}

RotorLoad ResolvedRotor::of_blades(const std::function<RotorLoad(int blade)>& load) const {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  for (int b = 1; b <= made_->blades(); ++b) {
    const RotorLoad blade = load(b);
    force += blade.force, moment += blade.moment;
  }
  return about_hub(force, moment + pose().hub.position.cross(force), true);
}

LoadBands ResolvedRotor::rows_of_faces() const {
  int count = 0;
  std::vector<int> first_of_block(made_->grid.blocks.size(), -1);  // station of k = 0
  for (const auto& blade : made_->stations)
    for (const BladeStation& s : blade) {
      if (first_of_block[std::size_t(s.block)] < 0) first_of_block[std::size_t(s.block)] = count - s.k;
      ++count;
    }
  return {count, [&tiling = store_->tiling(), first_of_block](const FlowTile& tile, int k, int j, int i) {
            const Tile& from = tiling.tiles[std::size_t(tile.index)];
            const int first = first_of_block[std::size_t(from.block)];
            return first < 0 ? -1 : first + from.to_block({i, j, k})[2];
          }};
}

std::vector<SpanLoad> ResolvedRotor::span_loads(std::span<const double> sums) const {
  int count = 0;
  for (const auto& blade : made_->stations) count += int(blade.size());
  std::vector<SpanLoad> loads;
  const Eigen::Matrix3d to_rotor = pose().attitude().toRotationMatrix().transpose();
  for (std::size_t blade = 0; blade < made_->stations.size(); ++blade)
    for (const BladeStation& s : made_->stations[blade]) {
      const BandLoads band = band_loads(sums, count, int(loads.size()));
      const Eigen::Vector3d pressure = to_rotor * Eigen::Map<const Eigen::Vector3d>(band.pressure_force.data()),
                            friction = to_rotor * Eigen::Map<const Eigen::Vector3d>(band.viscous_force.data());
      loads.push_back({int(blade) + 1, s.radius, s.length, s.chord, load_at(s, pressure + friction), load_at(s, friction)});
    }
  return loads;
}

std::vector<SpanLoad> ResolvedRotor::span_loads(std::span<const PseudoRow> rows) const {
  std::vector<double> mean(solver_->judgement().bands.result.size(), 0.0);
  for (const PseudoRow& row : rows) {
    const std::span<const double> bands = std::span(row.loads).last(mean.size());
    for (std::size_t n = 0; n < mean.size(); ++n) mean[n] += bands[n] / double(rows.size());
  }
  return span_loads(std::span<const double>(mean));
}

// ---- windows

void ResolvedRotor::prepare(MPI_Comm comm, runtime::ExecutorOptions options) {
  solver_->fill_geometry(comm);
  runtime::Graph graph(comm);
  solver_->record(graph);
  march_ = std::make_unique<runtime::Executor>(std::move(graph), options);
}

RotorLoad ResolvedRotor::advance(const RotorPlace& end) {
  move_to(end);
  solver_->judgement().rows.all.clear();
  march_->run();
  const MarchState& march = solver_->march();
  if (march.verdict == Verdict::failed)
    throw NumericalFailure(
        fmt::format("aero: {} (pseudo-step {}, CFL {:.3g}){}", march.why, march.steps, march.cfl, solver_->judgement().trouble()),
        "aero/rotor", long(solver_->time_steps()), double(solver_->time_steps()) * setup_.dt);
  return load();
}

ResolvedRotor::Snapshot ResolvedRotor::snapshot() const {
  return {.air = solver_->restart().snapshot(), .long_before = long_before_, .before = before_, .now = now_};
}

void ResolvedRotor::restore(const Snapshot& s) {
  solver_->restart().restore(s.air);
  long_before_ = s.long_before, before_ = s.before, now_ = s.now;
  if (s.long_before.pitches_blades() || s.before.pitches_blades() || s.now.pitches_blades())
    place(s.long_before, s.before, s.now);
}

}  // namespace spindrift::aero
