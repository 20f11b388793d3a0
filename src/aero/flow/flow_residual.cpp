// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/flow_residual.hpp"

#include <stdexcept>
#include <utility>

#include "kernels/turbulence/model_sa.hpp"
#include "src/aero/flow/sweep.hpp"
#include "src/aero/flow/sweep_gradients.hpp"

namespace spindrift::aero {

namespace {

/// What turbulence carries in the undisturbed flow, the closure's own values but for what the setting gives.
std::array<double, 2> turbulence_of_wind(const FlowSetting& s, int equations, double nu, std::array<double, 2> usual) {
  if (equations == 1)
    return {s.wind_eddy_viscosity ? nu * turbulence::SaConstants::chi_of(*s.wind_eddy_viscosity) : usual[0], 0.0};
  if (!s.wind_eddy_viscosity && !s.wind_intensity) return usual;
  const double eddy = s.wind_eddy_viscosity ? nu * *s.wind_eddy_viscosity : usual[0] / usual[1];
  const double k = s.wind_intensity ? 3.0 * *s.wind_intensity * *s.wind_intensity * gas::kinetic(s.stream) : usual[0];
  return {k, k / eddy};
}

void require_steady_in_frame(const FlowSetting& s) {
  if (s.time_order > 0) throw std::invalid_argument("flow: a turning frame is for steady flow; unsteady grids move");
  const Eigen::Vector3d u(s.stream.u, s.stream.v, s.stream.w);
  if (s.frame_omega.cross(u).norm() > 1e-9 * s.frame_omega.norm() * s.speed)
    throw std::invalid_argument("flow: a stream across the axis is not steady in a turning frame");
  if (!s.profile.uniform()) throw std::invalid_argument("flow: a wind that goes with height is not steady in a turning frame");
}

}  // namespace

FlowResidual::FlowResidual(const FlowSetting& s, const ModelSweeps& model, const PhysicalTime& time)
    : gas_(s.gas), model_(model), time_(time) {
  if (s.speed <= 0.0) throw std::invalid_argument("flow: the scale of velocity must be positive");
  convective_.gas = viscous_.gas = boundary_.gas = s.gas;
  const double rho = gas::density(s.gas, s.stream);
  use_limiter(s.limiter);
  convective_.flux = row_flux(s.flux);
  convective_.upwinding = s.upwinding;
  convective_.first_order_model = s.first_order_model;
  viscous_.active = s.viscous;
  viscous_.thin_layer = s.thin_layer;
  boundary_.stream = s.stream;
  boundary_.inviscid = !s.viscous;
  boundary_.profile = s.profile;
  boundary_.reservoir = reservoir_of(s.gas, s.stream);
  boundary_.dt = s.dt, boundary_.weights = bdf1;  // until a step begins
  if (s.preconditioned && !s.physical_far_field) boundary_.reference_speed = s.speed;
  if (model.equations > 0) {
    const double nu = gas::viscosity(s.gas, gas::absolute_temperature(s.gas, s.stream)) / rho;
    boundary_.carried =
        turbulence_of_wind(s, model.equations, nu, model.far_field(nu, s.speed, gas::sound_speed(s.gas, s.stream)));
    boundary_.wall_carried = model.wall;
  }
  if (s.frame_omega.isZero()) return;
  require_steady_in_frame(s);
  boundary_.turning = true;
  for (std::size_t c = 0; c < 3; ++c) omega_[c] = s.frame_omega[Eigen::Index(c)];
}

void FlowResidual::use_limiter(std::string_view limiter) {
  convective_.reconstruct = reconstructions(limiter);
  convective_.law_slope = limiter == "first_order" ? 0.0 : 0.5;
}

void FlowResidual::begin_step() { boundary_.weights = time_.weights; }

void FlowResidual::keep_past(FlowTile& tile) const {
  if (!time_.unsteady()) return;
  if (!tile.geometry->moving()) {
    PhysicalTime step = time_;
    step.begin_step();
    store_driving(tile, step);
  }
  for (int n = time_.levels - 1; n > 0; --n) std::swap(tile.past[std::size_t(n)], tile.past[std::size_t(n - 1)]);
  const TileGeometry& g = *tile.geometry;
  const std::size_t component = std::size_t(tile.cells.component);
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; ++i) {
      const std::ptrdiff_t from = tile.cells.at(k, j, i), to = tile.inner.at(k, j, i);
      const auto w = gas::conserved(gas_, gas::load_primitive<double>(tile.state.data() + from, component));
      const double v = g.volume_data.data()[g.cell_box.at(k, j, i)];  // a moving grid has not moved yet
      gas::store_conserved(tile.past[0].data() + to, std::size_t(tile.inner.component), v * w);
      for (int t = 0; t < tile.turbulence; ++t) {
        const int c = mean_unknowns + t;
        tile.past[0].data()[to + c * tile.inner.component] = v * w.rho * tile.state.data()[from + c * tile.cells.component];
      }
    }
  });
}

/// What makes the undisturbed wind change acts on all air alike: its acceleration by the weights of the step, and what the rate
/// of change of its kinetic energy has beyond the power of that acceleration. A uniform wind stays uniform to round-off. Forces
/// on the inflow plane come in addition.
void FlowResidual::store_driving(FlowTile& tile, const PhysicalTime& step) const {
  if (boundary_.wind.steady()) return;
  const TimeWeights& w = step.weights;
  const double shares[4] = {w.now / step.dt, w.old / step.dt, w.older / step.dt, w.oldest / step.dt};
  const TileGeometry& g = *tile.geometry;
  const std::ptrdiff_t c = tile.inner.component;
  if (tile.driving.size() == 0) tile.driving = AlignedArray<double>(tile.inner.size(4));
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; ++i) {
      const double* centre = g.centre_data.data() + g.cell_box.at(k, j, i);
      const Eigen::Vector3d x(centre[0], centre[g.cell_box.component], centre[2 * g.cell_box.component]);
      const Eigen::Vector3d now = boundary_.wind.velocity(x, 0.0);
      Eigen::Vector3d acceleration = shares[0] * now;
      double power = 0.5 * shares[0] * now.squaredNorm();
      for (std::size_t n = 1; n < 4; ++n)
        if (shares[n] != 0.0) {
          const Eigen::Vector3d u = boundary_.wind.velocity(x, step.ago[n - 1]);
          acceleration += shares[n] * u, power += 0.5 * shares[n] * u.squaredNorm();
        }
      power -= now.dot(acceleration);
      if (boundary_.wind.plane)
        acceleration += boundary_.wind.plane->acceleration(x, extent_along(g, boundary_.wind.plane->normal, k, j, i));
      double* to = tile.driving.data() + tile.inner.at(k, j, i);
      for (int n = 0; n < 3; ++n) to[n * c] = acceleration[n];
      to[3 * c] = power;
    }
  });
}

void FlowResidual::add_driving(const FlowTile& tile, const double* state, double* residual) const {
  const TileGeometry& g = *tile.geometry;
  const std::ptrdiff_t c = tile.inner.component;
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; i += row_lanes) {
      const auto w =
          gas::conserved(gas_, gas::load_primitive<Row>(state + tile.cells.at(k, j, i), std::size_t(tile.cells.component)));
      const Row v = Row::load(g.volume_data.data() + g.cell_box.at(k, j, i));
      const double* by = tile.driving.data() + tile.inner.at(k, j, i);
      const Row x = Row::load(by), y = Row::load(by + c), z = Row::load(by + 2 * c);
      const Row rates[4] = {w.rho * x, w.rho * y, w.rho * z, w.mx * x + w.my * y + w.mz * z + w.rho * Row::load(by + 3 * c)};
      for (int n = 0; n < 4; ++n) {
        double* to = residual + tile.inner.at(k, j, i) + (n + 1) * c;
        (Row::load(to) - v * rates[n]).store(to);
      }
    }
  });
}

void FlowResidual::gradients(FlowTile& tile, const double* state) const {
  if (!has_friction()) return;
  sweep_gradients(tile, state);
  set_wall_law_gradients(tile, state, gas_);
  if (tile.eddies) model_.closures(tile, state, viscous_);
}

void FlowResidual::fill_gradient_ghosts(FlowTile& tile, const double* state) const {
  fill_boundary_gradients(tile, state, gas_, model_.wall_spread);
}

Eigen::Vector3d FlowResidual::undisturbed(const Eigen::Vector3d& place, double ago) const {
  if (!boundary_.wind.steady()) return boundary_.wind.velocity(place, ago);
  const gas::Primitive<double> stream = stream_at(boundary_.stream, boundary_.profile, place.z());
  return {stream.u, stream.v, stream.w};
}

std::vector<WallPoint> FlowResidual::wall_points(const FlowTile& tile) const {
  std::vector<WallPoint> points;
  gather_wall(tile, tile.state.data(), viscous_, boundary_, points);
  return points;
}

void FlowResidual::evaluate(FlowTile& tile, double* state, double* residual) const {
  sweep_convective(tile, state, residual, convective_);
  add_wall_pressure(tile, state, residual);
  if (has_friction()) sweep_viscous(tile, state, residual, viscous_);
  if (tile.turbulence > 0) model_.residual(tile, state, residual, viscous_);
  if (tile.source.size() > 0) {
    const BoxLayout& cells = tile.geometry->cell_box;
    for (int c = 0; c < tile.unknowns(); ++c)
      for_rows(tile.box, [&](int k, int j) {
        const std::ptrdiff_t at = tile.inner.at(k, j, 0) + c * tile.inner.component;
        for (int i = 0; i < tile.box.ni; ++i)
          residual[at + i] -= tile.geometry->volume_data.data()[cells.at(k, j, i)] * tile.source.data()[at + i];
      });
  }
  if (!boundary_.wind.steady() && tile.driving.size() > 0) add_driving(tile, state, residual);  // none where flow settles
  if (boundary_.turning) add_turning(tile, state, residual);
  if (time_.unsteady()) add_time_derivative(tile, state, residual);
}

/// In axes that turn with the frame, the components of a constant momentum change.
void FlowResidual::add_turning(const FlowTile& tile, const double* state, double* residual) const {
  const TileGeometry& g = *tile.geometry;
  const double x = omega_[0], y = omega_[1], z = omega_[2];  // no binding: clang with OpenMP captures none
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; i += row_lanes) {
      const auto w =
          gas::conserved(gas_, gas::load_primitive<Row>(state + tile.cells.at(k, j, i), std::size_t(tile.cells.component)));
      const Row v = Row::load(g.volume_data.data() + g.cell_box.at(k, j, i)),
                across[3] = {y * w.mz - z * w.my, z * w.mx - x * w.mz, x * w.my - y * w.mx};
      for (int c = 0; c < 3; ++c) {
        double* to = residual + tile.inner.at(k, j, i) + (c + 1) * tile.inner.component;
        (Row::load(to) + v * across[c]).store(to);
      }
    }
  });
}

void FlowResidual::add_time_derivative(const FlowTile& tile, const double* state, double* residual) const {
  const TileGeometry& g = *tile.geometry;
  const double now = time_.weights.now / time_.dt, old = time_.weights.old / time_.dt, older = time_.weights.older / time_.dt,
               oldest = time_.weights.oldest / time_.dt;
  const std::ptrdiff_t c = tile.inner.component;
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; i += row_lanes) {
      const double* at = state + tile.cells.at(k, j, i);
      const auto w = gas::conserved(gas_, gas::load_primitive<Row>(at, std::size_t(tile.cells.component)));
      const Row v = Row::load(g.volume_data.data() + g.cell_box.at(k, j, i)) * now;
      const std::ptrdiff_t place = tile.inner.at(k, j, i);
      const auto add = [&](int n, const Row& amount) {
        double* to = residual + place + n * c;
        Row sum = Row::load(to) + v * amount + Row(old) * Row::load(tile.past[0].data() + place + n * c);
        if (older != 0.0) sum += Row(older) * Row::load(tile.past[1].data() + place + n * c);
        if (oldest != 0.0) sum += Row(oldest) * Row::load(tile.past[2].data() + place + n * c);
        sum.store(to);
      };
      add(0, w.rho), add(1, w.mx), add(2, w.my), add(3, w.mz), add(4, w.E);
      for (int t = 0; t < tile.turbulence; ++t)
        add(mean_unknowns + t, w.rho * Row::load(at + (mean_unknowns + t) * tile.cells.component));
    }
  });
}

}  // namespace spindrift::aero
