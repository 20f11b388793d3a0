// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/flow_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "kernels/turbulence/model_sa.hpp"
#include "runtime/mpi/exchange.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "src/aero/flow/sweep_gradients.hpp"

namespace spindrift::aero {

namespace {

constexpr int norm_count = 8;

Scales scales_of(const FlowSetting& s) {
  const double rho = gas::density(s.gas, s.stream), u = s.speed;
  Scales scales;
  scales.unknown = {rho * u * u, u, u, u, u * u / s.gas.cp()};
  scales.residual = {rho * u, rho * u * u, rho * u * u, rho * u * u, rho * u * u * u};
  return scales;
}

/// Sum of squares of what round-off leaves in the scaled residuals of a uniform stream: a part in 1e17 of the pressure on all
/// faces, which is 1 / (gamma M^2) in their units.
double noise_of(const FlowTile& tile, const FlowSetting& s) {
  const double c = gas::sound_speed(s.gas, s.stream), unit = 1e-17 * (1.0 + c * c / (s.speed * s.speed));
  double sum = 0.0;
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; ++i) {
      double area = 0.0;
      for (int d = 0; d < tile.directions; ++d)
        area += load_face(*tile.geometry, d, k, j, i).area[0] +
                load_face(*tile.geometry, d, k + (d == 2), j + (d == 1), i + (d == 0)).area[0];
      sum += unit * unit * area * area;
    }
  });
  return sum;
}

/// What turbulence carries in the undisturbed flow, the closure's own values but for what the setting gives.
std::array<double, 2> turbulence_of_wind(const FlowSetting& s, int equations, double nu, std::array<double, 2> usual) {
  if (equations == 1)
    return {s.wind_eddy_viscosity ? nu * turbulence::SaConstants::chi_of(*s.wind_eddy_viscosity) : usual[0], 0.0};
  if (!s.wind_eddy_viscosity && !s.wind_intensity) return usual;
  const double eddy = s.wind_eddy_viscosity ? nu * *s.wind_eddy_viscosity : usual[0] / usual[1];
  const double k = s.wind_intensity ? 3.0 * *s.wind_intensity * *s.wind_intensity * gas::kinetic(s.stream) : usual[0];
  return {k, k / eddy};
}

}  // namespace

std::size_t FlowTile::bytes() const {
  std::size_t sum = state.bytes() + trial.bytes() + source.bytes() + gradients.bytes() + residual.bytes() + before.bytes() +
                    before_that.bytes() + rate.bytes() + mean_matrix.bytes() + turbulence_matrix.bytes() + direction.bytes();
  for (const auto& v : vectors) sum += v.bytes();
  for (const auto& v : directions_kept) sum += v.bytes();
  for (const auto& v : open) sum += v.bytes();
  for (const auto& v : law) sum += v.bytes();
  return sum;
}

FlowSolver::FlowSolver(GridStore& grid, const FlowSetting& setting, std::vector<PatchCondition> conditions)
    : grid_(grid),
      setting_(setting),
      conditions_(std::move(conditions)),
      march_(setting.march),
      cycle_(setting.krylov, setting.march.krylov_steps),
      preconditioner_(make_preconditioner(setting.preconditioner, setting.common)) {
  const Tiling& tiling = grid.tiling();
  if (setting.speed <= 0.0) throw std::invalid_argument("flow: the scale of velocity must be positive");
  convective_.gas = viscous_.gas = boundary_.gas = implicit_.gas = setting.gas;
  const double rho = gas::density(setting.gas, setting.stream);
  if (setting.smooth > 0.0) convective_.smooth = gas::smoothness(setting.gas, rho, setting.speed, 0.0, setting.smooth);
  convective_.reconstruct = reconstruction(setting.limiter);
  convective_.flux = row_flux(setting.flux);
  convective_.law_slope = setting.limiter == "first_order" ? 0.0 : 0.5;
  convective_.upwinding = setting.upwinding;
  convective_.first_order_model = setting.first_order_model;
  viscous_.active = setting.viscous;
  viscous_.thin_layer = setting.thin_layer;
  boundary_.stream = setting.stream;
  boundary_.inviscid = !setting.viscous;
  boundary_.profile = setting.profile;
  boundary_.reservoir = reservoir_of(setting.gas, setting.stream);
  boundary_.dt = setting.dt, boundary_.weights = bdf1;  // until a step begins
  if (setting.preconditioned && !setting.physical_far_field) boundary_.reference_speed = setting.speed;
  implicit_.scales = scales_of(setting);
  implicit_.inflow = {boundary_.reservoir.x, boundary_.reservoir.y, boundary_.reservoir.z};
  implicit_.viscous = setting.viscous;
  if (setting.flux == "roe_low_mach") {
    implicit_.preconditioned_waves = setting.preconditioned && !setting.matrix_mach_floor;
    implicit_.mach_floor = setting.matrix_mach_floor.value_or(1.0);
  }
  implicit_.rusanov = setting.flux == "rusanov";
  implicit_.preconditioned = setting.preconditioned;
  implicit_.floor_speed = setting.speed;
  implicit_.physical_rate = setting.held_rate;
  model_ = &model_sweeps(setting.turbulence);
  if (model_->closures != nullptr && model_->equations == 0 && tiling.planar)
    throw std::invalid_argument("flow: " + setting.turbulence + " resolves eddies: the grid must have three dimensions");
  if (model_->equations > 0) {
    const double nu = gas::viscosity(setting.gas, gas::absolute_temperature(setting.gas, setting.stream)) / rho;
    boundary_.carried = turbulence_of_wind(setting, model_->equations, nu,
                                           model_->far_field(nu, setting.speed, gas::sound_speed(setting.gas, setting.stream)));
    boundary_.wall_carried = model_->wall;
    // SA: nu tilde of a boundary layer. SST: k, and the omega that goes with both.
    const double eddy = 100.0 * nu, k = 1e-2 * setting.speed * setting.speed;
    implicit_.scales.model_unknown = model_->equations == 1 ? std::array{eddy, 1.0} : std::array{k, k / eddy};
    for (std::size_t t = 0; t < 2; ++t)
      implicit_.scales.model_residual[t] = model_unit_[t] = rho * setting.speed * implicit_.scales.model_unknown[t];
  }

  periodic_ = tiling.periodic;
  const bool turning = !setting.frame_omega.isZero();
  if (turning) {
    if (setting.time_order > 0) throw std::invalid_argument("flow: a turning frame is for steady flow; unsteady grids move");
    const Eigen::Vector3d u(setting.stream.u, setting.stream.v, setting.stream.w);
    if (setting.frame_omega.cross(u).norm() > 1e-9 * setting.frame_omega.norm() * setting.speed)
      throw std::invalid_argument("flow: a stream across the axis is not steady in a turning frame");
    if (!setting.profile.uniform())
      throw std::invalid_argument("flow: a wind that goes with height is not steady in a turning frame");
    boundary_.turning = true;
    for (std::size_t c = 0; c < 3; ++c) implicit_.omega[c] = setting.frame_omega[Eigen::Index(c)];
  }

  const int columns = cycle_.most_columns();
  local_.assign(std::size_t(tiling.size()), -1);
  for (const int index : grid.owned()) {
    local_[std::size_t(index)] = int(tiles_.size());
    const Tile& from = tiling.tiles[std::size_t(index)];
    if (from.ni > longest_row)
      throw std::invalid_argument("flow: a tile has rows of " + std::to_string(from.ni) + " cells; the sweeps hold " +
                                  std::to_string(longest_row));
    FlowTile& t = tiles_.emplace_back();
    t.geometry = &grid[index];
    t.index = index;
    if (turning) turn_frame(*t.geometry, setting.frame_omega, setting.frame_centre, tiling.planar);
    t.directions = tiling.planar ? 2 : 3;
    t.turbulence = model_->equations;
    t.eddies = model_->closures != nullptr;
    t.cells = cell_layout(from, state_ghosts, tiling.planar);
    t.gradient_box = cell_layout(from, gradient_ghosts, tiling.planar);
    t.inner = BoxLayout(from.ni, from.nj, from.nk);
    t.box = {from.ni, from.nj, from.nk};
    for (const TileBoundary& where : tiling.boundary(index)) {
      const PatchCondition& c = conditions_.at(std::size_t(where.patch));
      const BoundaryCondition& condition = of(c.condition);
      if (condition.wall_law && model_->equations == 0)
        throw std::invalid_argument("flow: the law of the wall goes with models that transport turbulence");
      if (c.temperature && std::ranges::find(condition.keys, "temperature_K") == condition.keys.end())
        throw std::invalid_argument("flow: only walls resolved to the wall can be held at a temperature");
      if (condition.wall_law) t.wall_law = &model_->wall_law();
      t.boundaries.push_back({where, &condition, c.loads, c.temperature});
    }
    const int unknowns = t.unknowns();
    t.state = AlignedArray<double>(t.cells.size(unknowns));
    t.trial = AlignedArray<double>(t.cells.size(unknowns));
    t.gradients = AlignedArray<double>(t.gradient_box.size(gradient_components(t.turbulence, t.eddies)));
    t.residual = AlignedArray<double>(t.inner.size(unknowns));
    t.rate = AlignedArray<double>(t.inner.size(1));
    if (setting.time_order > 0) t.before = AlignedArray<double>(t.inner.size(unknowns));
    if (setting.time_order > 1) t.before_that = AlignedArray<double>(t.inner.size(unknowns));
    t.mean_matrix = AlignedArray<float>(linear::StencilMatrix<5>::size(t.box, t.directions));
    if (t.turbulence == 1) t.turbulence_matrix = AlignedArray<float>(linear::StencilMatrix<1>::size(t.box, t.directions));
    if (t.turbulence == 2) t.turbulence_matrix = AlignedArray<float>(linear::StencilMatrix<2>::size(t.box, t.directions));
    t.direction = AlignedArray<float>(t.gradient_box.size(unknowns));
    cycle_.allocate(t);
    set_open_faces(t);
  }
  const std::size_t owned = tiles_.size();
  norm_partials_.resize(owned * norm_count);
  load_partials_.resize(owned * std::max<std::size_t>(1, conditions_.size()) * load_components);
  dot_partials_.resize(owned * std::size_t(columns + 1));
  size_partials_.resize(owned);
  fraction_partials_.resize(owned);
  limits_.resize(owned);
  for (const FlowTile& tile : tiles_) noise_.push_back(noise_of(tile, setting));
  norm_sums_.resize(norm_count);
  loads_.resize(std::max<std::size_t>(1, conditions_.size()) * load_components);
  dots_.resize(std::size_t(columns + 1));
  rows_.reserve(1024);
  preconditioner_->attach(grid_, tiles_);
}

void FlowSolver::gather_bands(LoadBands bands) {
  if (!pieces_.empty()) throw std::logic_error("flow: bands of loads come before the march is recorded");
  bands_ = std::move(bands);
  const std::size_t sums =
      std::max<std::size_t>(1, conditions_.size()) * load_components + std::size_t(bands_.count) * band_components;
  load_partials_.resize(tiles_.size() * sums), loads_.resize(sums);
}

void FlowSolver::set_body_force(std::shared_ptr<BodyForce> force) {
  if (!pieces_.empty()) throw std::logic_error("flow: a body force comes before the march is recorded");
  if (grid_.tiling().planar) throw std::invalid_argument("flow: a body force needs a grid of three dimensions");
  body_force_ = std::move(force);
  body_force_->attach(tiles_.size());
  body_partials_.resize(tiles_.size() * body_force_->sums()), body_sums_.resize(body_force_->sums());
}

void FlowSolver::start_uniform() {
  start([this](const Eigen::Vector3d& x) { return stream_at(setting_.stream, setting_.profile, x.z()); });
}

void FlowSolver::start_from(const FlowSolver& other) {
  if (other.tiles_.size() != tiles_.size()) throw std::invalid_argument("flow: another solver's state is on other tiles");
  for (std::size_t n = 0; n < tiles_.size(); ++n) {
    if (tiles_[n].index != other.tiles_[n].index || tiles_[n].state.size() != other.tiles_[n].state.size())
      throw std::invalid_argument("flow: another solver's state is on other tiles");
    std::copy_n(other.tiles_[n].state.data(), tiles_[n].state.size(), tiles_[n].state.data());
  }
  forget();
}

void FlowSolver::forget() { time_steps_ = 0; }

long FlowSolver::cells() const {
  long sum = 0;
  for (const Tile& tile : grid_.tiling().tiles) sum += tile.count();
  return sum;
}

std::size_t FlowSolver::bytes() const {
  std::size_t sum = 0;
  for (const FlowTile& tile : tiles_) sum += tile.bytes();
  return sum;
}

void FlowSolver::set_time_step(double dt, double dt_before) { setting_.dt = boundary_.dt = dt, dt_before_ = dt_before; }

/// The state as it is becomes the past; weights follow from how much past there is.
void FlowSolver::begin_time_step(FlowTile& tile) {
  if (setting_.time_order == 0) return;
  if (setting_.time_order > 1) std::swap(tile.before, tile.before_that);
  const TileGeometry& g = *tile.geometry;
  const std::size_t component = std::size_t(tile.cells.component);
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; ++i) {
      const std::ptrdiff_t from = tile.cells.at(k, j, i), to = tile.inner.at(k, j, i);
      const auto w = gas::conserved(setting_.gas, gas::load_primitive<double>(tile.state.data() + from, component));
      const double v = g.volume_data.data()[g.cell_box.at(k, j, i)];  // a moving grid has not moved yet
      gas::store_conserved(tile.before.data() + to, std::size_t(tile.inner.component), v * w);
      for (int t = 0; t < tile.turbulence; ++t) {
        const int c = mean_unknowns + t;
        tile.before.data()[to + c * tile.inner.component] = v * w.rho * tile.state.data()[from + c * tile.cells.component];
      }
    }
  });
}

// ---- motion

const Tile& FlowSolver::tiling_tile(const FlowTile& tile) const { return grid_.tiling().tiles[std::size_t(tile.index)]; }
const BlockPose& FlowSolver::pose(const std::vector<BlockPose>& poses, const FlowTile& tile) const {
  return poses.size() == 1 ? poses[0] : poses[std::size_t(grid_.tiling().tiles[std::size_t(tile.index)].block)];
}

void FlowSolver::check_poses(const std::vector<BlockPose>& poses) const {
  const Tiling& tiling = grid_.tiling();
  if (setting_.time_order == 0 || (!tiles_.empty() && !tiles_[0].geometry->moving()))
    throw std::invalid_argument("flow: only grids built as moving, in unsteady flow, move");
  if (poses.size() != 1 && poses.size() != tiling.block_cells.size())
    throw std::invalid_argument("flow: " + std::to_string(poses.size()) + " poses for " +
                                std::to_string(tiling.block_cells.size()) + " blocks");
  if (tiling.periodic.empty()) return;
  // Across a periodic link both sides must see the same motion: only along the period, or about and along its axis.
  for (const BlockPose& p : poses) {
    const std::vector<RigidMap> maps = moved_maps(tiling.periodic, p.map);
    for (std::size_t n = 0; n < maps.size(); ++n) {
      const double size = 1.0 + p.map.translation.norm() + periodic_[n].translation.norm();
      if ((maps[n].rotation - periodic_[n].rotation).norm() > 1e-9 ||
          (maps[n].translation - periodic_[n].translation).norm() > 1e-9 * size)
        throw std::invalid_argument("flow: this motion does not keep the periodicity of the grid; a turn must be about its axis");
    }
  }
}

void FlowSolver::move_to(std::vector<BlockPose> poses) {
  check_poses(poses);
  poses_next_ = std::move(poses);
}

namespace {
/// Of a node of a tile in its block: cell t lies between nodes t and t + 1 in both, also where the two count against each other.
Index node_of_block(const IndexMap& to_block, const Index& node) {
  Index at = to_block(node);
  for (int d = 0; d < 3; ++d)
    if (to_block.sign(d) < 0) ++at[std::size_t(to_block.target(d))];
  return at;
}
void set_nodes(TileGeometry& g, const Tile& tile, const BlockPose& pose) {
  if (pose.shape_at) {
    for (int k = 0; k <= tile.nk; ++k)
      for (int j = 0; j <= tile.nj; ++j)
        for (int i = 0; i <= tile.ni; ++i) {
          const std::ptrdiff_t at = g.node_box.at(k, j, i), c = g.node_box.component;
          const double* x = g.reference_node_data.data() + at;
          const Eigen::Vector3d shaped = pose.shape_at(node_of_block(tile.to_block, {i, j, k}), {x[0], x[c], x[2 * c]});
          const Eigen::Vector3d placed = pose.map.rotation * shaped + pose.map.translation;
          for (int d = 0; d < 3; ++d) g.node_data.data()[at + d * c] = placed[d];
        }
    return;
  }
  if (!pose.shape) return move_rigidly(g, pose.map);
  move_nodes(
      g, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return pose.map.rotation * pose.shape(x) + pose.map.translation; });
}
/// From one pose to another: displacement at the origin and turn, those of the middle of the step to second order.
TileGeometry::RigidRate change(const RigidMap& from, const RigidMap& to) {
  const Eigen::AngleAxisd axis(to.rotation * from.rotation.transpose());
  const Eigen::Vector3d turn = axis.axis() * axis.angle();
  return {to.translation - from.translation - turn.cross(0.5 * (to.translation + from.translation)), turn};
}
}  // namespace

namespace {
/// Up to round-off.
bool alike(const std::vector<RigidMap>& a, const std::vector<RigidMap>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t n = 0; n < a.size(); ++n)
    if ((a[n].rotation - b[n].rotation).norm() > 1e-9 ||
        (a[n].translation - b[n].translation).norm() > 1e-9 * (1.0 + a[n].translation.norm()))
      return false;
  return true;
}
}  // namespace

void FlowSolver::place(std::vector<BlockPose> before, std::vector<BlockPose> now) {
  // A motion about the axis of the period leaves the maps as they are but for round-off: those of the first place stay, so that
  // a restart, which places the grid somewhere else, has their bits.
  if (std::vector<RigidMap> maps = moved_maps(grid_.tiling().periodic, now[0].map); !alike(maps, periodic_))
    periodic_ = std::move(maps);
  check_poses(before), check_poses(now);
  const bool planar = grid_.tiling().planar;
  for (FlowTile& tile : tiles_) {
    TileGeometry& g = *tile.geometry;
    set_nodes(g, tiling_tile(tile), pose(before, tile));
    begin_step(g);  // nothing was swept on the way here
    update_metrics(g, planar);
    update_sweeps(g, planar);
    begin_step(g);
    set_nodes(g, tiling_tile(tile), pose(now, tile));
    update_metrics(g, planar);
    update_sweeps(g, planar);
    g.over_step = change(pose(before, tile).map, pose(now, tile).map);
  }
  poses_before_ = std::move(before);
  poses_ = poses_next_ = std::move(now);
  grid_.fill_local_geometry(periodic_);
}

void FlowSolver::move_tile(FlowTile& tile) {
  TileGeometry& g = *tile.geometry;
  const bool planar = grid_.tiling().planar;
  begin_step(g);
  set_nodes(g, tiling_tile(tile), pose(poses_, tile));
  update_metrics(g, planar);
  update_sweeps(g, planar);
  update_speeds(g, weights_, setting_.dt, planar);
  // As face speeds: of this step and the one before it, second order at the new time level.
  const auto old = std::exchange(g.over_step, change(pose(poses_before_, tile).map, pose(poses_, tile).map));
  g.rate.velocity = (weights_.now * g.over_step.velocity - weights_.older * old.velocity) / setting_.dt;
  g.rate.omega = (weights_.now * g.over_step.omega - weights_.older * old.omega) / setting_.dt;
  fill_boundary_geometry(g, grid_.tiling().boundary(tile.index));
}

/// Gradients, and what the turbulence model makes of them.
void FlowSolver::slopes(FlowTile& tile, const double* state) {
  if (!setting_.viscous) return;
  sweep_gradients(tile, state);
  set_wall_law_gradients(tile, state, setting_.gas);
  if (tile.eddies) model_->closures(tile, state, viscous_);
}

/// Residual of a state whose ghosts and gradients are there: fluxes, sources, the physical time derivative.
void FlowSolver::evaluate(FlowTile& tile, double* state, double* residual) {
  sweep_convective(tile, state, residual, convective_);
  add_wall_pressure(tile, state, residual);
  if (setting_.viscous) sweep_viscous(tile, state, residual, viscous_);
  if (tile.turbulence > 0) model_->residual(tile, state, residual, viscous_);
  if (tile.source.size() > 0) {
    const BoxLayout& cells = tile.geometry->cell_box;
    for (int c = 0; c < tile.unknowns(); ++c)
      for_rows(tile.box, [&](int k, int j) {
        const std::ptrdiff_t at = tile.inner.at(k, j, 0) + c * tile.inner.component;
        for (int i = 0; i < tile.box.ni; ++i)
          residual[at + i] -= tile.geometry->volume_data.data()[cells.at(k, j, i)] * tile.source.data()[at + i];
      });
  }
  const TileGeometry& g = *tile.geometry;
  if (boundary_.turning) {  // in axes that turn with the frame, the components of a constant momentum change
    const double x = implicit_.omega[0], y = implicit_.omega[1],
                 z = implicit_.omega[2];  // no binding: clang with OpenMP captures none
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; i += row_lanes) {
        const auto w = gas::conserved(
            setting_.gas, gas::load_primitive<Row>(state + tile.cells.at(k, j, i), std::size_t(tile.cells.component)));
        const Row v = Row::load(g.volume_data.data() + g.cell_box.at(k, j, i)),
                  across[3] = {y * w.mz - z * w.my, z * w.mx - x * w.mz, x * w.my - y * w.mx};
        for (int c = 0; c < 3; ++c) {
          double* to = residual + tile.inner.at(k, j, i) + (c + 1) * tile.inner.component;
          (Row::load(to) + v * across[c]).store(to);
        }
      }
    });
  }
  if (setting_.time_order == 0) return;
  const double now = weights_.now / setting_.dt, old = weights_.old / setting_.dt, older = weights_.older / setting_.dt;
  const std::ptrdiff_t c = tile.inner.component;
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; i += row_lanes) {
      const double* at = state + tile.cells.at(k, j, i);
      const auto w = gas::conserved(setting_.gas, gas::load_primitive<Row>(at, std::size_t(tile.cells.component)));
      const Row v = Row::load(g.volume_data.data() + g.cell_box.at(k, j, i)) * now;
      const std::ptrdiff_t place = tile.inner.at(k, j, i);
      const auto add = [&](int n, const Row& amount) {
        double* to = residual + place + n * c;
        Row sum = Row::load(to) + v * amount + Row(old) * Row::load(tile.before.data() + place + n * c);
        if (older != 0.0) sum += Row(older) * Row::load(tile.before_that.data() + place + n * c);
        sum.store(to);
      };
      add(0, w.rho), add(1, w.mx), add(2, w.my), add(3, w.mz), add(4, w.E);
      for (int t = 0; t < tile.turbulence; ++t)
        add(mean_unknowns + t, w.rho * Row::load(at + (mean_unknowns + t) * tile.cells.component));
    }
  });
}

void FlowSolver::measure(FlowTile& tile, std::span<double> partial, std::span<double> loads) {
  const TileGeometry& g = *tile.geometry;
  std::fill(partial.begin(), partial.end(), 0.0);
  partial[5] = noise_[std::size_t(&tile - tiles_.data())];
  const Scales& s = implicit_.scales;
  for_rows(tile.box, [&](int k, int j) {
    double density = 0.0, mass = 0.0, mean = 0.0, model = 0.0;
    for (int i = 0; i < tile.box.ni; ++i) {
      const double* r = tile.residual.data() + tile.inner.at(k, j, i);
      const double rate = r[0] / g.volume_data.data()[g.cell_box.at(k, j, i)];
      density += rate * rate, mass += r[0] * r[0];
      for (int c = 0; c < mean_unknowns; ++c) {
        const double scaled = r[c * tile.inner.component] / s.residual[std::size_t(c)];
        mean += scaled * scaled;
      }
      for (int t = 0; t < tile.turbulence; ++t) {
        const double scaled = r[(mean_unknowns + t) * tile.inner.component] / model_unit_[std::size_t(t)];
        model += scaled * scaled;
      }
    }
    if (!std::isfinite(density + mean + model)) {
      partial[3] += 1.0;
      limits_[std::size_t(&tile - tiles_.data())] = {0.0, {0, j, k}, "no finite residual in the row of"};
    }
    partial[0] += density, partial[1] += mean, partial[2] += model, partial[4] += mass;
  });
  partial[6] = runtime::StopRequest::asked() ? 1.0 : 0.0;
  if (body_force_ && tile.source.size() > 0)
    for_rows(tile.box, [&](int k, int j) {
      double forced = 0.0;
      for (int i = 0; i < tile.box.ni; ++i) {
        const double* f = tile.source.data() + tile.inner.at(k, j, i);
        for (int c = 0; c < mean_unknowns; ++c) {
          const double scaled =
              f[c * tile.inner.component] * g.volume_data.data()[g.cell_box.at(k, j, i)] / s.residual[std::size_t(c)];
          forced += scaled * scaled;
        }
      }
      partial[7] += forced;
    });
  std::fill(loads.begin(), loads.end(), 0.0);
  add_loads(tile, tile.state.data(), viscous_, bands_, loads);
}

/// One place where the march goes on, back, or ends: after the sums over all cells.
void FlowSolver::judge() {
  norms_ = {.density = norm_sums_[0],
            .mass = norm_sums_[4],
            .mean = norm_sums_[1],
            .model = norm_sums_[2],
            .cells = double(cells()),
            .broken = norm_sums_[3],
            .noise = norm_sums_[5],
            .forced = norm_sums_[7]};
  double force[3] = {0.0, 0.0, 0.0}, moment[3] = {0.0, 0.0, 0.0};
  for (std::size_t p = 0; p < conditions_.size(); ++p)
    if (conditions_[p].loads)
      for (std::size_t c = 0; c < 3; ++c) {
        force[c] += loads_[p * load_components + c] + loads_[p * load_components + 3 + c];
        moment[c] += loads_[p * load_components + 6 + c];
      }
  std::vector<double> bodies;
  if (body_force_) bodies = body_force_->loads();
  const Eigen::Map<const Eigen::Vector3d> on_bodies(bodies.data());
  const double load = body_force_ ? on_bodies.norm() : std::sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
  const double cfl = march_.cfl_of_step();
  Verdict verdict = march_.judge(norms_, load);
  rows_.push_back({.step = int(march_.steps_made()),
                   .krylov = march_.krylov(),
                   .rejections = march_.rejections(),
                   .matrices = matrices_,
                   .cfl = cfl,
                   .density_residual = march_.density_residual(),
                   .mass_residual = march_.mass_residual(),
                   .mean_residual = std::sqrt(norms_.mean),
                   .model_residual = std::sqrt(norms_.model),
                   .balance_drop = march_.balance_drop(),
                   .fraction = march_.fraction(),
                   .matrix_free = matrix_free_,
                   .force = {force[0], force[1], force[2]},
                   .moment = {moment[0], moment[1], moment[2]},
                   .loads = loads_,
                   .bodies = std::move(bodies)});
  if (watcher_) watcher_(rows_.back());
  if (norm_sums_[6] > 0.0 && verdict == Verdict::go_on && stops_anywhere()) march_.stop(), verdict = march_.verdict();
  if (verdict == Verdict::failed) name_trouble();
  solving_ = verdict == Verdict::go_on;
  matrix_free_ = march_.matrix_free();
  if (refreshes()) ++matrices_;
  if (!solving_) return;
  // The linear solver lowers one norm. What turbulence brings to it is made no larger than the mean flow's part, or errors of the
  // order of the one would be let into the other. With a matrix that is kept its units are kept.
  if (refreshes() && model_->equations > 0) {
    const double times = norms_.mean > 0.0 ? std::max(1.0, std::sqrt(norms_.model / norms_.mean)) : 1.0;
    for (std::size_t t = 0; t < 2; ++t) implicit_.scales.model_residual[t] = times * model_unit_[t];
  }
  const double share = model_unit_[0] / implicit_.scales.model_residual[0];
  linear_norm_ = std::sqrt(norms_.mean + share * share * norms_.model);
  cycle_.start(linear_norm_);
}

void FlowSolver::name_trouble() {
  const auto worst =
      std::min_element(limits_.begin(), limits_.end(), [](const Limit& a, const Limit& b) { return a.fraction < b.fraction; });
  if (worst == limits_.end() || worst->fraction >= 1.0) return;
  const Tile& tile = grid_.tiling().tiles[std::size_t(tiles_[std::size_t(worst - limits_.begin())].index)];
  const Index at = tile.to_block(worst->cell);
  trouble_ = std::string("; ") + worst->what + " block " + std::to_string(tile.block) + " cell (" + std::to_string(at[0]) + ", " +
             std::to_string(at[1]) + ", " + std::to_string(at[2]) + ")";
}

std::string FlowSolver::worst_cells(MPI_Comm comm) const {
  struct Worst {
    double balance = -1.0;
    int block = 0, unknown = 0;
    Index cell{};
    double x[3] = {0.0, 0.0, 0.0};
  };
  std::array<Worst, 2> worst;  // of the mean flow, of turbulence
  for (const FlowTile& tile : tiles_)
    for_centres(tile, [&](int k, int j, int i, const Eigen::Vector3d& x) {
      for (int c = 0; c < tile.unknowns(); ++c) {
        const bool model = c >= mean_unknowns;
        const Scales& s = implicit_.scales;
        const double unit = model ? model_unit_[std::size_t(c - mean_unknowns)] : s.residual[std::size_t(c)],
                     r = std::abs(tile.residual.data()[tile.inner.at(k, j, i) + c * tile.inner.component]) / unit;
        if (Worst& w = worst[model]; !(r <= w.balance))
          w = {r, tiling_tile(tile).block, c, tiling_tile(tile).to_block({i, j, k}), {x[0], x[1], x[2]}};
      }
    });
  runtime::Packer mine;
  mine.put(std::span<const Worst>(worst));
  worst = {};
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take())) {
    const std::vector<Worst> other = runtime::Unpacker(bytes).many<Worst>();
    for (std::size_t n = 0; n < 2; ++n)
      if (!(other[n].balance <= worst[n].balance)) worst[n] = other[n];
  }
  static constexpr std::array<const char*, mean_unknowns + 2> names{"mass",   "momentum",   "momentum",          "momentum",
                                                                    "energy", "turbulence", "turbulence's omega"};
  std::string text;
  for (const Worst& w : worst)
    if (w.balance >= 0.0)
      text += fmt::format("{}the balance of {} in block {} cell ({}, {}, {}) at ({:.4g}, {:.4g}, {:.4g}) m",
                          text.empty() ? "worst are " : " and ", names[std::size_t(w.unknown)], w.block, w.cell[0], w.cell[1],
                          w.cell[2], w.x[0], w.x[1], w.x[2]);
  return text;
}

/// With the preconditioner's part of the tile; where that is singular the step is rejected (find_update).
void FlowSolver::build_matrix(FlowTile& tile) {
  if (!solving_) return;
  sweep_rates(tile, tile.state.data(), implicit_);
  if (!refreshes()) return;  // the pseudo-time of matrix-free products follows the state all the same
  const double* eddy =
      tile.eddies ? tile.gradients.data() + eddy_component(tile.turbulence) * tile.gradient_box.component : nullptr;
  sweep_jacobian(tile, tile.state.data(), eddy, march_.cfl(), implicit_);
  if (tile.turbulence > 0) model_->matrix(tile, tile.state.data(), march_.cfl(), implicit_);
  const std::ptrdiff_t singular = preconditioner_->refresh(tile);
  Limit& limit = limits_[std::size_t(&tile - tiles_.data())];
  limit = {};
  const std::ptrdiff_t row = tile.box.ni, plane = row * tile.box.nj;
  if (singular >= 0)
    limit = {-1.0, {int(singular % row), int(singular % plane / row), int(singular / plane)}, "a singular pivot in"};
}

/// v_0: the scaled residual with its sign turned, of unit length.
void FlowSolver::first_vector(FlowTile& tile) {
  const double norm = cycle_.first_norm(), scale = norm > 0.0 ? -1.0 / norm : 0.0;
  float* v = cycle_.first(tile);
  float* m = v + tile.box.count() * mean_unknowns;
  const Scales& s = implicit_.scales;
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; ++i) {
      const double* r = tile.residual.data() + tile.inner.at(k, j, i);
      for (int c = 0; c < mean_unknowns; ++c) *v++ = float(scale * r[c * tile.inner.component] / s.residual[std::size_t(c)]);
      for (int t = 0; t < tile.turbulence; ++t)
        *m++ = float(scale * r[(mean_unknowns + t) * tile.inner.component] / s.model_residual[std::size_t(t)]);
    }
  });
}

void FlowSolver::make_vector(FlowTile& tile, int j) {
  if (!solving_) return;
  if (j == 0)
    first_vector(tile);
  else
    cycle_.advance(tile, j);
}

void FlowSolver::precondition_vector(FlowTile& tile, int j) {
  if (solving_) preconditioner_->apply({&tile, cycle_.source(tile, j), cycle_.direction(tile, j)});
}

/// Puts the direction M^-1 v_j where neighbours look for it; returns its largest component in the units of the unknowns, or in
/// that of a cell's own turbulence where this is more: omega at walls is 1e5 times what it is in the flow.
double FlowSolver::spread_direction(FlowTile& tile, int j) {
  if (!solving_) return 0.0;
  const float* z = cycle_.direction(tile, j);
  const float* m = z + tile.box.count() * mean_unknowns;
  float largest = 0.0f;
  for_rows(tile.box, [&](int k, int row) {
    float* to = tile.direction.data() + tile.gradient_box.at(k, row, 0);
    for (int i = 0; i < tile.box.ni; ++i, ++to) {
      for (int c = 0; c < mean_unknowns; ++c) {
        const float value = *z++;
        to[c * tile.gradient_box.component] = value;
        largest = std::max(largest, std::abs(value));
      }
      for (int t = 0; t < tile.turbulence; ++t) {
        const float value = *m++;
        to[(mean_unknowns + t) * tile.gradient_box.component] = value;
        const double unit = implicit_.scales.model_unknown[std::size_t(t)],
                     q = tile.state.data()[tile.cells.at(k, row, i) + (mean_unknowns + t) * tile.cells.component];
        largest = std::max(largest, std::abs(value) * float(unit / std::max(unit, std::abs(q))));
      }
    }
  });
  return double(largest);
}

namespace {
/// Largest change of an unknown, in its unit, by which matrix-free products differ from the state.
constexpr double difference_size = 1e-6;
}  // namespace

void FlowSolver::perturb(FlowTile& tile) {
  const double step = difference_size / std::max(direction_size_, 1e-30);
  for (int c = 0; c < tile.unknowns(); ++c) {
    const double factor = step * (c < mean_unknowns ? implicit_.scales.unknown[std::size_t(c)]
                                                    : implicit_.scales.model_unknown[std::size_t(c - mean_unknowns)]);
    for_rows(tile.box, [&](int k, int j) {
      const double* from = tile.state.data() + c * tile.cells.component + tile.cells.at(k, j, 0);
      const float* z = tile.direction.data() + c * tile.gradient_box.component + tile.gradient_box.at(k, j, 0);
      double* to = tile.trial.data() + c * tile.cells.component + tile.cells.at(k, j, 0);
      for (int i = 0; i < tile.box.ni; ++i) to[i] = from[i] + factor * double(z[i]);
    });
  }
}

/// w = A z, and its products with all v so far and itself.
void FlowSolver::product(FlowTile& tile, int j, std::span<double> dots) {
  if (!solving_) return;
  float* w = cycle_.product(tile, j);
  if (!matrix_free_) {
    const BoxLayout& box = tile.gradient_box;
    linear::multiply(tile.mean(), tile.direction.data(), {box.origin, box.row, box.plane, box.component}, w);
    if (tile.turbulence > 0)
      model_->multiply(tile, tile.direction.data() + mean_unknowns * box.component, w + tile.box.count() * mean_unknowns);
  } else {
    thread_local AlignedArray<double> scratch;  // one tile's residual of the perturbed state lives no longer than this task
    if (scratch.size() < tile.residual.size()) scratch = AlignedArray<double>(tile.residual.size());
    evaluate(tile, tile.trial.data(), scratch.data());
    const double inverse = std::max(direction_size_, 1e-30) / difference_size;
    float *to = w, *model = w + tile.box.count() * mean_unknowns;
    for_rows(tile.box, [&](int k, int row) {
      for (int i = 0; i < tile.box.ni; ++i) {
        const std::ptrdiff_t at = tile.inner.at(k, row, i);
        const auto difference = [&](int c, double unit) {
          const std::ptrdiff_t place = at + c * tile.inner.component;
          return float((scratch.data()[place] - tile.residual.data()[place]) * inverse / unit);
        };
        for (int c = 0; c < mean_unknowns; ++c) *to++ = difference(c, implicit_.scales.residual[std::size_t(c)]);
        for (int t = 0; t < tile.turbulence; ++t)
          *model++ = difference(mean_unknowns + t, implicit_.scales.model_residual[std::size_t(t)]);
      }
    });
    add_pseudo_time(tile, tile.state.data(), march_.cfl(), implicit_, tile.direction.data(), w);
    if (tile.turbulence > 0) {
      model = w + tile.box.count() * mean_unknowns;
      for_rows(tile.box, [&](int k, int row) {
        for (int i = 0; i < tile.box.ni; ++i) {
          const auto q =
              gas::load_primitive<double>(tile.state.data() + tile.cells.at(k, row, i), std::size_t(tile.cells.component));
          const double time = gas::density(setting_.gas, q) * tile.rate.data()[tile.inner.at(k, row, i)] / march_.cfl();
          for (int t = 0; t < tile.turbulence; ++t) {
            const double unit = implicit_.scales.model_unknown[std::size_t(t)] / implicit_.scales.model_residual[std::size_t(t)];
            const float z =
                tile.direction.data()[(mean_unknowns + t) * tile.gradient_box.component + tile.gradient_box.at(k, row, i)];
            const bool of_k = tile.turbulence == 2 && t == 0;
            const double slowed =
                of_k
                    ? time + growth_damping(tile.residual.data()[tile.inner.at(k, row, i) + mean_unknowns * tile.inner.component],
                                            tile.state.data()[tile.cells.at(k, row, i) + mean_unknowns * tile.cells.component])
                    : time;
            *model++ += float(slowed * unit * double(z));
          }
        }
      });
    }
  }
  std::fill(dots.begin(), dots.end(), 0.0);
  cycle_.dots(tile, j, dots.first(std::size_t(j) + 2));
}

void FlowSolver::combine(FlowTile& tile) {
  if (solving_) cycle_.combine(tile);
}
void FlowSolver::precondition_solution(FlowTile& tile) {
  if (solving_ && cycle_.precondition_at_end()) preconditioner_->apply({&tile, cycle_.solution(tile), cycle_.solution(tile)});
}

/// Of the change of the unknowns: the fraction that no cell finds too large; -1 where a matrix was singular.
double FlowSolver::find_update(FlowTile& tile) {
  if (!solving_) return 1.0;
  const float* x = cycle_.solution(tile);
  constexpr double most = 0.2;        // of the absolute value, in one pseudo-step;
  constexpr double most_speed = 0.5;  // of the cell's speed or the flow's, the larger of both
  double fraction = 1.0;
  Limit& limit_of_tile = limits_[std::size_t(&tile - tiles_.data())];
  if (limit_of_tile.fraction < 0.0 || preconditioner_->singular()) return -1.0;
  limit_of_tile = {};
  const Scales& s = implicit_.scales;
  const float* d = x;
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; ++i, d += mean_unknowns) {
      const auto q = gas::load_primitive<double>(tile.state.data() + tile.cells.at(k, j, i), std::size_t(tile.cells.component));
      const auto limit = [&](double change, double bound, const char* what) {
        if (std::abs(change) <= bound) return;
        const double allowed = std::isfinite(change) ? bound / std::abs(change) : 0.0;  // not a number must not hide
        if (allowed < fraction) fraction = allowed, limit_of_tile = {allowed, {i, j, k}, what};
      };
      limit(double(d[0]) * s.unknown[0], most * gas::absolute_pressure(setting_.gas, q), "the change of pressure in");
      limit(double(d[4]) * s.unknown[4], most * gas::absolute_temperature(setting_.gas, q), "the change of temperature in");
      limit(std::hypot(double(d[1]), double(d[2]), double(d[3])) * s.unknown[1],
            most_speed * std::max(setting_.speed, std::sqrt(2.0 * gas::kinetic(q))), "the change of velocity in");
    }
  });
  return fraction;
}

void FlowSolver::apply_update(FlowTile& tile) {
  const Verdict verdict = march_.verdict();
  if (ends_march(verdict)) {
    if (verdict == Verdict::failed && march_.rejections() > 0) std::swap(tile.state, tile.trial);
    return;
  }
  if (verdict == Verdict::rejected) {
    std::copy_n(tile.trial.data(), tile.trial.size(), tile.state.data());
    return;
  }
  std::copy_n(tile.state.data(), tile.state.size(), tile.trial.data());
  if (fraction_ < 0.0) return;
  const float* d = cycle_.solution(tile);
  const Scales& s = implicit_.scales;
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; ++i) {
      double* at = tile.state.data() + tile.cells.at(k, j, i);
      for (int c = 0; c < mean_unknowns; ++c)
        at[c * tile.cells.component] += fraction_ * s.unknown[std::size_t(c)] * double(*d++);
    }
  });
  if (tile.turbulence == 0) return;
  // An update that would take more than nine tenths of a quantity that must stay above its bound is shortened in that cell.
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; ++i)
      for (int t = 0; t < tile.turbulence; ++t) {
        double& q = tile.state.data()[tile.cells.at(k, j, i) + (mean_unknowns + t) * tile.cells.component];
        const double change = fraction_ * s.model_unknown[std::size_t(t)] * double(*d++), low = model_->lowest[std::size_t(t)];
        q += std::max(change, -0.9 * (q - low));
      }
  });
}

// ---- restart

std::size_t FlowSolver::saved_size(int owned) const {
  const FlowTile& t = tiles_[std::size_t(owned)];
  return std::size_t(t.box.count()) * std::size_t(t.unknowns()) * std::size_t(1 + setting_.time_order);
}

namespace {
template <class Tile, class Body>
void for_saved(Tile& t, int time_order, Body&& body) {
  const auto walk = [&](auto& array, const BoxLayout& layout) {
    for (int c = 0; c < t.unknowns(); ++c)
      for_rows(t.box, [&](int k, int j) {
        for (int i = 0; i < t.box.ni; ++i) body(array.data()[c * layout.component + layout.at(k, j, i)]);
      });
  };
  walk(t.state, t.cells);
  if (time_order > 0) walk(t.before, t.inner);
  if (time_order > 1) walk(t.before_that, t.inner);
}
}  // namespace

void FlowSolver::save(int owned, std::span<double> to) const {
  std::size_t n = 0;
  for_saved(tiles_[std::size_t(owned)], setting_.time_order, [&](const double& value) { to[n++] = value; });
}
void FlowSolver::load(int owned, std::span<const double> from) {
  std::size_t n = 0;
  for_saved(tiles_[std::size_t(owned)], setting_.time_order, [&](double& value) { value = from[n++]; });
}
FlowSolver::SetUpNote FlowSolver::save_set_up() const {
  SetUpNote note;
  if (!keeps_set_up()) return note;
  note.number = preconditioner_->kept_number();
  for (const FlowTile& tile : tiles_) preconditioner_->save_kept(tile, note.tiles.emplace_back(preconditioner_->kept_size(tile)));
  return note;
}
void FlowSolver::load_set_up(const SetUpNote& from) {
  if (!keeps_set_up() || from.tiles.size() != tiles_.size()) return;
  if (from.number > 0 && from.number == preconditioner_->kept_number()) return;  // it stands
  for (std::size_t n = 0; n < tiles_.size(); ++n) preconditioner_->load_kept(tiles_[n], from.tiles[n]);
  preconditioner_->set_kept_number(from.number);
}
std::vector<double> FlowSolver::save_march() const {
  std::vector<double> all = march_.save();
  all.insert(all.end(), {double(time_steps_), dt_before_});
  if (!moves()) return all;
  all.push_back(double(poses_before_.size()));
  const auto add = [&](const RigidMap& map) {
    all.insert(all.end(), map.rotation.data(), map.rotation.data() + 9);
    all.insert(all.end(), map.translation.data(), map.translation.data() + 3);
  };
  for (const RigidMap& map : periodic_) add(map);
  for (const auto* poses : {&poses_before_, &poses_})
    for (const BlockPose& p : *poses) add(p.map);
  return all;
}
void FlowSolver::load_march(std::span<const double> from) {
  march_.load(from);
  from = from.subspan(march_.save().size());
  time_steps_ = std::int64_t(from[0]);
  dt_before_ = from[1];
  if (!moves()) return;
  constexpr std::size_t numbers = 12;
  const std::size_t first = std::size_t(from[2]);
  from = from.subspan(3);
  const auto next = [&from] {
    RigidMap map;
    map.rotation = Eigen::Map<const Eigen::Matrix3d>(from.data());
    map.translation = Eigen::Map<const Eigen::Vector3d>(from.data() + 9);
    from = from.subspan(numbers);
    return map;
  };
  periodic_.resize(grid_.tiling().periodic.size());
  for (RigidMap& map : periodic_) map = next();
  std::vector<BlockPose> all;
  while (!from.empty()) all.push_back({.map = next(), .shape = {}});
  place({all.begin(), all.begin() + std::ptrdiff_t(first)}, {all.begin() + std::ptrdiff_t(first), all.end()});
}

}  // namespace spindrift::aero
