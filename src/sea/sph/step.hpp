// The sweeps of one step that touch each particle of a group once: packing the state for the pair sweep, limits, corrector.
// Called by sea_sph.cpp, group by group (later as tasks); tested in tests/src/sea/sph/motion_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/sph/boundary_dynamic.hpp"
#include "kernels/sph/step_symplectic.hpp"
#include "kernels/sph/step_verlet.hpp"
#include "src/sea/sph/parameters.hpp"
#include "src/sea/sph/store.hpp"

namespace spindrift::sph {

/// Acceleration along an axis and density rate from the sums of the pair sweep.
template <int dim>
struct Rates {
  double mass, gravity, drive;
  explicit Rates(const Parameters& p) : mass(p.mass(dim)), gravity(p.gravity), drive(p.drive) {}
  template <class Real>
  double acceleration(int axis, Real sum) const {
    return mass * double(sum) + (axis == dim - 1 ? -gravity : axis == 0 ? drive : 0.0);
  }
  template <class Real>
  double density(Real sum) const {
    return mass * double(sum);
  }
};

/// Writes the planes that pair sweeps read, the bounding box of each cluster, and clears the sums.
/// half_dt > 0 advances the state at n by the sums at n (predictor); solids keep the place that was given to them.
template <int dim, class Real>
void pack(Store<dim, Real>& store, const Parameters& p, int group, double half_dt) {
  const Rates<dim> rates(p);
  const double dt = 2.0 * half_dt, courant = p.eos.c0 * dt / p.h();
  const bool dynamic_walls = p.boundary != BoundaryChoice::extrapolated;  // others are set after this
  const Group& range = store.groups[group];
  for (std::uint32_t cluster = range.fluid; cluster < range.end; ++cluster) {
    const bool water = cluster < range.solid;
    const std::size_t first = std::size_t(cluster) * cluster_size;
    const std::uint32_t* id = store.id.data() + first;
    Real* planes = store.pack_of(cluster);
    Real* sums = store.sums_of(cluster);
    for (int k = 0; k < dim; ++k) {
      const double* x = store.x[k].data() + first;
      const double* v = store.v[k].data() + first;
      const double anchor = store.anchor[k][cluster];
      const double advance = water ? dt : 0.0;
      Real low = Real(1e30), high = Real(-1e30);
      for (int lane = 0; lane < cluster_size; ++lane) {
        const bool filled = id[lane] != no_particle;
        const double at = StepSymplectic::half(x[lane], v[lane], advance) - anchor;
        const double speed =
            StepSymplectic::velocity_half(v[lane], rates.acceleration(k, sums[k * cluster_size + lane]), advance, courant);
        const Real offset = Real(at);
        planes[k * cluster_size + lane] = filled ? offset : Real(empty_lane_offset_m);
        planes[(dim + k) * cluster_size + lane] = filled ? Real(advance > 0.0 ? speed : v[lane]) : Real(0);
        low = std::min(low, filled ? offset : Real(1e30));
        high = std::max(high, filled ? offset : Real(-1e30));
      }
      const float frame = store.frame(k, cluster);
      store.low[k][cluster] = frame + float(low);
      store.high[k][cluster] = frame + float(high);
    }
    const double* deviation = store.deviation.data() + first;
    for (int lane = 0; lane < cluster_size; ++lane) {
      const double rate = dt > 0.0 ? rates.density(sums[dim * cluster_size + lane]) : 0.0;
      double d = StepSymplectic::half(deviation[lane], rate, dt);
      if (!water) d = dynamic_walls ? boundary_dynamic(d) : deviation[lane];
      const double rho = p.eos.rho0 + d;
      planes[2 * dim * cluster_size + lane] = Real(d);
      planes[(2 * dim + 1) * cluster_size + lane] = Real(p.eos.pressure(d) / (rho * rho));
    }
    std::fill(sums, sums + sum_planes<dim> * cluster_size, Real(0));
  }
}

/// Bounding box of a cluster whose planes came from another rank; as `pack` makes it.
template <int dim, class Real>
void set_box(Store<dim, Real>& store, std::size_t cluster) {
  const Real* planes = store.pack_of(cluster);
  for (int k = 0; k < dim; ++k) {
    Real low = Real(1e30), high = Real(-1e30);
    for (int lane = 0; lane < cluster_size && store.id[cluster * cluster_size + lane] != no_particle; ++lane)
      low = std::min(low, planes[k * cluster_size + lane]), high = std::max(high, planes[k * cluster_size + lane]);
    store.low[k][cluster] = store.frame(k, cluster) + float(low);
    store.high[k][cluster] = store.frame(k, cluster) + float(high);
  }
}

/// Largest squared speed and acceleration of water in a group.
struct Extremes {
  double speed2 = 0.0, acceleration2 = 0.0;
  void merge(Extremes e) { speed2 = std::max(speed2, e.speed2), acceleration2 = std::max(acceleration2, e.acceleration2); }
};
template <int dim, class Real>
Extremes extremes(const Store<dim, Real>& store, const Parameters& p, int group) {
  const Rates<dim> rates(p);
  Extremes result;
  for (std::uint32_t cluster = store.groups[group].fluid; cluster < store.groups[group].solid; ++cluster) {
    const Real* sums = store.sums_of(cluster);
    for (int lane = 0; lane < cluster_size; ++lane) {
      const std::size_t slot = std::size_t(cluster) * cluster_size + lane;
      if (store.id[slot] == no_particle) continue;
      Extremes here;
      for (int k = 0; k < dim; ++k) {
        const double a = rates.acceleration(k, sums[k * cluster_size + lane]);
        here.speed2 += store.v[k][slot] * store.v[k][slot], here.acceleration2 += a * a;
      }
      // A NaN must not hide behind std::max: it becomes infinite, and the step limit zero.
      if (!(here.speed2 + here.acceleration2 < 1e300)) here.speed2 = here.acceleration2 = 1e300;
      result.merge(here);
    }
  }
  return result;
}

/// End of the clusters whose density follows its rate: extrapolated walls take theirs from the water.
inline std::uint32_t end_of_rates(const Group& range, const Parameters& p) {
  return p.boundary == BoundaryChoice::extrapolated ? range.solid : range.end;
}

/// Full step from the sums at n + 1/2.
template <int dim, class Real>
void correct_symplectic(Store<dim, Real>& store, const Parameters& p, int group, double dt) {
  const Rates<dim> rates(p);
  const Group& range = store.groups[group];
  for (std::uint32_t cluster = range.fluid; cluster < end_of_rates(range, p); ++cluster) {
    const bool water = cluster < range.solid;
    const std::size_t first = std::size_t(cluster) * cluster_size;
    const Real* planes = store.pack_of(cluster);
    const Real* sums = store.sums_of(cluster);
    if (water) {
      for (int k = 0; k < dim; ++k) {
        double* x = store.x[k].data() + first;
        double* v = store.v[k].data() + first;
        for (int lane = 0; lane < cluster_size; ++lane) {
          const double v_new = StepSymplectic::velocity(v[lane], rates.acceleration(k, sums[k * cluster_size + lane]), dt);
          x[lane] = StepSymplectic::position(x[lane], v[lane], v_new, dt);
          v[lane] = v_new;
        }
      }
    }
    double* deviation = store.deviation.data() + first;
    for (int lane = 0; lane < cluster_size; ++lane) {
      const double d = StepSymplectic::deviation(deviation[lane], double(planes[2 * dim * cluster_size + lane]),
                                                 rates.density(sums[dim * cluster_size + lane]), dt, p.eos.rho0);
      deviation[lane] = water ? d : boundary_dynamic(d);
    }
  }
}

/// Full step from the sums at n. `join`: the step that ties the odd and even chains together.
template <int dim, class Real>
void correct_verlet(Store<dim, Real>& store, const Parameters& p, int group, double dt, bool join) {
  const Rates<dim> rates(p);
  const Group& range = store.groups[group];
  const auto advance = [&](double& value, double& before, double rate) {
    const double next = join ? StepVerlet::join(value, rate, dt) : StepVerlet::leap(before, rate, dt);
    before = value, value = next;
  };
  for (std::uint32_t cluster = range.fluid; cluster < end_of_rates(range, p); ++cluster) {
    const bool water = cluster < range.solid;
    const Real* sums = store.sums_of(cluster);
    for (int lane = 0; lane < cluster_size; ++lane) {
      const std::size_t slot = std::size_t(cluster) * cluster_size + lane;
      for (int k = 0; k < dim && water; ++k) {
        const double a = rates.acceleration(k, sums[k * cluster_size + lane]);
        store.x[k][slot] = StepVerlet::position(store.x[k][slot], store.v[k][slot], a, dt);
        advance(store.v[k][slot], store.v_before[k][slot], a);
      }
      advance(store.deviation[slot], store.deviation_before[slot], rates.density(sums[dim * cluster_size + lane]));
      if (!water) store.deviation[slot] = boundary_dynamic(store.deviation[slot]);
    }
  }
}

}  // namespace spindrift::sph
