// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/implicit_system.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/aero/flow/sweep.hpp"

namespace spindrift::aero {

namespace {

Scales scales_of(const FlowSetting& s) {
  const double rho = gas::density(s.gas, s.stream), u = s.speed;
  Scales scales;
  scales.unknown = {rho * u * u, u, u, u, u * u / s.gas.cp()};
  scales.residual = {rho * u, rho * u * u, rho * u * u, rho * u * u, rho * u * u * u};
  return scales;
}

/// Largest change of an unknown, in its unit, by which matrix-free products differ from the state.
constexpr double difference_size = 1e-6;

}  // namespace

ImplicitSystem::ImplicitSystem(const FlowSetting& s, TileArrays& arrays, const FlowResidual& residual)
    : arrays_(arrays),
      residual_(residual),
      gas_(s.gas),
      speed_(s.speed),
      cycle_(s.krylov, s.march.krylov_steps),
      preconditioner_(make_preconditioner(s.preconditioner, s.coarse)) {
  setting_.gas = s.gas;
  setting_.scales = scales_of(s);
  const gas::Reservoir& reservoir = residual.boundary().reservoir;
  setting_.inflow = {reservoir.x, reservoir.y, reservoir.z};
  setting_.viscous = s.viscous;
  if (s.flux == "roe_low_mach") {
    setting_.preconditioned_waves = s.preconditioned && !s.matrix_mach_floor;
    setting_.mach_floor = s.matrix_mach_floor.value_or(1.0);
  }
  setting_.rusanov = s.flux == "rusanov";
  setting_.preconditioned = s.preconditioned;
  setting_.floor_speed = s.speed;
  setting_.physical_rate = s.held_rate;
  for (std::size_t c = 0; c < 3; ++c) setting_.omega[c] = s.frame_omega[Eigen::Index(c)];
  if (residual.model().equations > 0) {
    const double rho = gas::density(s.gas, s.stream),
                 nu = gas::viscosity(s.gas, gas::absolute_temperature(s.gas, s.stream)) / rho;
    // SA: nu tilde of a boundary layer. SST: k, and the omega that goes with both.
    const double eddy = 100.0 * nu, k = 1e-2 * s.speed * s.speed;
    setting_.scales.model_unknown = residual.model().equations == 1 ? std::array{eddy, 1.0} : std::array{k, k / eddy};
    for (std::size_t t = 0; t < 2; ++t)
      setting_.scales.model_residual[t] = model_unit_[t] = rho * s.speed * setting_.scales.model_unknown[t];
  }
  for (FlowTile& tile : arrays.tiles) cycle_.allocate(tile);
  dots.resize(arrays.tiles.size(), std::size_t(cycle_.most_columns() + 1));
  direction_size.resize(arrays.tiles.size(), 1), fraction.resize(arrays.tiles.size(), 1);
  direction_size.result = {0.0}, fraction.result = {1.0};
  preconditioner_->attach(arrays.grid, arrays.tiles);
}

void ImplicitSystem::use(std::unique_ptr<Preconditioner> preconditioner) {
  preconditioner_ = std::move(preconditioner);
  preconditioner_->attach(arrays_.grid, arrays_.tiles);
}

void ImplicitSystem::begin(double mean, double model, bool anew) {
  // The linear solver lowers one norm. What turbulence brings to it is made no larger than the mean flow's part, or errors of the
  // order of the one would be let into the other. With a matrix that is kept its units are kept.
  if (anew && residual_.model().equations > 0) {
    const double times = mean > 0.0 ? std::max(1.0, std::sqrt(model / mean)) : 1.0;
    for (std::size_t t = 0; t < 2; ++t) setting_.scales.model_residual[t] = times * model_unit_[t];
  }
  const double share = model_unit_[0] / setting_.scales.model_residual[0];
  linear_norm_ = std::sqrt(mean + share * share * model);
  cycle_.start(linear_norm_);
}

bool ImplicitSystem::solved(double drop) const { return cycle_.breakdown() || cycle_.residual_norm() <= drop * linear_norm_; }

void ImplicitSystem::build(FlowTile& tile, double cfl, bool anew) {
  sweep_rates(tile, tile.state.data(), setting_);
  if (!anew) return;  // the pseudo-time of matrix-free products follows the state all the same
  const double* eddy =
      tile.eddies ? tile.gradients.data() + eddy_component(tile.turbulence) * tile.gradient_box.component : nullptr;
  sweep_jacobian(tile, tile.state.data(), eddy, cfl, setting_);
  if (tile.turbulence > 0) residual_.model().matrix(tile, tile.state.data(), cfl, setting_);
  const std::ptrdiff_t singular = preconditioner_->refresh(tile);
  tile.limit = {};
  const std::ptrdiff_t row = tile.box.ni, plane = row * tile.box.nj;
  if (singular >= 0)
    tile.limit = {-1.0, {int(singular % row), int(singular % plane / row), int(singular / plane)}, "a singular pivot in"};
}

/// v_0: the scaled residual with its sign turned, of unit length.
void ImplicitSystem::first_vector(FlowTile& tile) const {
  const double norm = cycle_.first_norm(), scale = norm > 0.0 ? -1.0 / norm : 0.0;
  float* v = cycle_.first(tile);
  float* m = v + tile.box.count() * mean_unknowns;
  const Scales& s = setting_.scales;
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; ++i) {
      const double* r = tile.residual.data() + tile.inner.at(k, j, i);
      for (int c = 0; c < mean_unknowns; ++c) *v++ = float(scale * r[c * tile.inner.component] / s.residual[std::size_t(c)]);
      for (int t = 0; t < tile.turbulence; ++t)
        *m++ = float(scale * r[(mean_unknowns + t) * tile.inner.component] / s.model_residual[std::size_t(t)]);
    }
  });
}

void ImplicitSystem::make_vector(FlowTile& tile, int j) const {
  if (j == 0)
    first_vector(tile);
  else
    cycle_.advance(tile, j);
}

double ImplicitSystem::make_direction(FlowTile& tile, int j) {
  preconditioner_->apply({&tile, cycle_.source(tile, j), cycle_.direction(tile, j)});
  return spread_direction(tile, j);
}

/// Puts the direction M^-1 v_j where neighbours read it; returns its largest component in the units of the unknowns, or in
/// that of a cell's own turbulence where this is more: omega at walls is 1e5 times what it is in the flow.
double ImplicitSystem::spread_direction(FlowTile& tile, int j) const {
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
        const double unit = setting_.scales.model_unknown[std::size_t(t)],
                     q = tile.state.data()[tile.cells.at(k, row, i) + (mean_unknowns + t) * tile.cells.component];
        largest = std::max(largest, std::abs(value) * float(unit / std::max(unit, std::abs(q))));
      }
    }
  });
  return double(largest);
}

void ImplicitSystem::perturb(FlowTile& tile) const {
  const double step = difference_size / std::max(direction_size.one(), 1e-30);
  for (int c = 0; c < tile.unknowns(); ++c) {
    const double factor = step * (c < mean_unknowns ? setting_.scales.unknown[std::size_t(c)]
                                                    : setting_.scales.model_unknown[std::size_t(c - mean_unknowns)]);
    for_rows(tile.box, [&](int k, int j) {
      const double* from = tile.state.data() + c * tile.cells.component + tile.cells.at(k, j, 0);
      const float* z = tile.direction.data() + c * tile.gradient_box.component + tile.gradient_box.at(k, j, 0);
      double* to = tile.trial.data() + c * tile.cells.component + tile.cells.at(k, j, 0);
      for (int i = 0; i < tile.box.ni; ++i) to[i] = from[i] + factor * double(z[i]);
    });
  }
}

/// What the pseudo-time brings to the rows of turbulence.
void ImplicitSystem::add_model_pseudo_time(const FlowTile& tile, double cfl, float* model) const {
  for_rows(tile.box, [&](int k, int row) {
    for (int i = 0; i < tile.box.ni; ++i) {
      const auto q = gas::load_primitive<double>(tile.state.data() + tile.cells.at(k, row, i), std::size_t(tile.cells.component));
      const double time = gas::density(gas_, q) * tile.rate.data()[tile.inner.at(k, row, i)] / cfl;
      for (int t = 0; t < tile.turbulence; ++t) {
        const double unit = setting_.scales.model_unknown[std::size_t(t)] / setting_.scales.model_residual[std::size_t(t)];
        const float z =
            tile.direction.data()[(mean_unknowns + t) * tile.gradient_box.component + tile.gradient_box.at(k, row, i)];
        const bool of_k = tile.turbulence == 2 && t == 0;
        const double slowed =
            of_k ? time + growth_damping(tile.residual.data()[tile.inner.at(k, row, i) + mean_unknowns * tile.inner.component],
                                         tile.state.data()[tile.cells.at(k, row, i) + mean_unknowns * tile.cells.component])
                 : time;
        *model++ += float(slowed * unit * double(z));
      }
    }
  });
}

/// w = A z, and its products with all v so far and itself.
void ImplicitSystem::product(FlowTile& tile, int j, double cfl, bool matrix_free, std::span<double> to_sum) {
  float* w = cycle_.product(tile, j);
  if (!matrix_free) {
    const BoxLayout& box = tile.gradient_box;
    linear::multiply(tile.mean(), tile.direction.data(), {box.origin, box.row, box.plane, box.component}, w);
    if (tile.turbulence > 0)
      residual_.model().multiply(tile, tile.direction.data() + mean_unknowns * box.component,
                                 w + tile.box.count() * mean_unknowns);
  } else {
    thread_local AlignedArray<double> scratch;  // one tile's residual of the perturbed state lives no longer than this task
    if (scratch.size() < tile.residual.size()) scratch = AlignedArray<double>(tile.residual.size());
    residual_.evaluate(tile, tile.trial.data(), scratch.data());
    const double inverse = std::max(direction_size.one(), 1e-30) / difference_size;
    float *to = w, *model = w + tile.box.count() * mean_unknowns;
    for_rows(tile.box, [&](int k, int row) {
      for (int i = 0; i < tile.box.ni; ++i) {
        const std::ptrdiff_t at = tile.inner.at(k, row, i);
        const auto difference = [&](int c, double unit) {
          const std::ptrdiff_t place = at + c * tile.inner.component;
          return float((scratch.data()[place] - tile.residual.data()[place]) * inverse / unit);
        };
        for (int c = 0; c < mean_unknowns; ++c) *to++ = difference(c, setting_.scales.residual[std::size_t(c)]);
        for (int t = 0; t < tile.turbulence; ++t)
          *model++ = difference(mean_unknowns + t, setting_.scales.model_residual[std::size_t(t)]);
      }
    });
    add_pseudo_time(tile, tile.state.data(), cfl, setting_, tile.direction.data(), w);
    if (tile.turbulence > 0) add_model_pseudo_time(tile, cfl, w + tile.box.count() * mean_unknowns);
  }
  std::fill(to_sum.begin(), to_sum.end(), 0.0);
  cycle_.dots(tile, j, to_sum.first(std::size_t(j) + 2));
}

void ImplicitSystem::solve_for_update(FlowTile& tile) {
  if (cycle_.precondition_at_end()) preconditioner_->apply({&tile, cycle_.solution(tile), cycle_.solution(tile)});
}

double ImplicitSystem::update_fraction(FlowTile& tile) const {
  const float* x = cycle_.solution(tile);
  constexpr double most = 0.2;        // of the absolute value, in one pseudo-step;
  constexpr double most_speed = 0.5;  // of the cell's speed or the flow's, the larger of both
  double fraction = 1.0;
  if (tile.limit.fraction < 0.0 || preconditioner_->singular()) return -1.0;
  tile.limit = {}, tile.limited = 0;
  const Scales& s = setting_.scales;
  const float* d = x;
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; ++i, d += mean_unknowns) {
      const auto q = gas::load_primitive<double>(tile.state.data() + tile.cells.at(k, j, i), std::size_t(tile.cells.component));
      bool limited = false;
      const auto limit = [&](double change, double bound, const char* what) {
        if (std::abs(change) <= bound) return;
        limited = true;
        const double allowed = std::isfinite(change) ? bound / std::abs(change) : 0.0;  // not a number must not hide
        if (allowed < fraction) fraction = allowed, tile.limit = {allowed, {i, j, k}, what};
      };
      limit(double(d[0]) * s.unknown[0], most * gas::absolute_pressure(gas_, q), "the change of pressure in");
      limit(double(d[4]) * s.unknown[4], most * gas::absolute_temperature(gas_, q), "the change of temperature in");
      limit(std::hypot(double(d[1]), double(d[2]), double(d[3])) * s.unknown[1],
            most_speed * std::max(speed_, std::sqrt(2.0 * gas::kinetic(q))), "the change of velocity in");
      tile.limited += limited;
    }
  });
  if (fraction < tile.worst_limit.fraction) tile.worst_limit = tile.limit;
  return fraction;
}

void ImplicitSystem::apply_update(FlowTile& tile) const {
  std::copy_n(tile.state.data(), tile.state.size(), tile.trial.data());
  tile.clip = {}, tile.clipped = 0;
  const double share = fraction.one();
  if (share < 0.0) return;
  const float* d = cycle_.solution(tile);
  const Scales& s = setting_.scales;
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; ++i) {
      double* at = tile.state.data() + tile.cells.at(k, j, i);
      for (int c = 0; c < mean_unknowns; ++c) at[c * tile.cells.component] += share * s.unknown[std::size_t(c)] * double(*d++);
    }
  });
  if (tile.turbulence == 0) return;
  // An update that would take more than nine tenths of a quantity that must stay above its bound is shortened in that cell.
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; ++i) {
      bool clipped = false;
      for (int t = 0; t < tile.turbulence; ++t) {
        double& q = tile.state.data()[tile.cells.at(k, j, i) + (mean_unknowns + t) * tile.cells.component];
        const double change = share * s.model_unknown[std::size_t(t)] * double(*d++),
                     low = residual_.model().lowest[std::size_t(t)];
        const double most = 0.9 * (q - low);
        if (change < -most) {
          clipped = true;
          if (const double allowed = most / -change; allowed < tile.clip.fraction)
            tile.clip = {allowed, {i, j, k}, "the change of turbulence in"};
        }
        q += std::max(change, -most);
      }
      tile.clipped += clipped;
    }
  });
  if (tile.clip.fraction < tile.worst_clip.fraction) tile.worst_clip = tile.clip;
}

}  // namespace spindrift::aero
