// Energy that goes into and out of the water, step by step: from solids, into what viscosity, diffusion and walls take, into
// damping zones. Each particle's part is rounded to a quantum, a power of two, so that sums are exact: the same for any order,
// number of threads and ranks. With the energy of the water itself (particle_sea.cpp) they make its balance:
//   change of kinetic, potential and compression energy = from_solids - dissipated - absorbed - what particles that are no more
//   in the tank took along + what time steps, shifting and density filters make.
// Called by tasks.cpp before each group's step, and for solids by body_tasks.cpp while they are where they were loaded; tested in
// tests/src/sea/sph/energy_flow_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "src/sea/sph/damping.hpp"
#include "src/sea/sph/energy_sums.hpp"
#include "src/sea/sph/parameters.hpp"
#include "src/sea/sph/step.hpp"
#include "src/sea/sph/store.hpp"

namespace spindrift::sph {

/// [J]: about 1e-11 of a particle's mass times the sound's speed squared. 2^63 of them are 1e8 such energies.
inline double energy_quantum(const Parameters& p, int dim) {
  return std::exp2(std::round(std::log2(p.mass(dim) * p.eos.c0 * p.eos.c0)) - 36.0);
}

/// Rounds to quanta; adding the results is exact while the sum stays below 2^52 of them.
struct ToQuanta {
  explicit ToQuanta(double quantum) : quantum(quantum), large(1.5 * std::exp2(52.0) * quantum) {}
  double quantum, large;
  double operator()(double energy) const { return (energy + large) - large; }
  std::int64_t count(double sum) const { return std::int64_t(sum / quantum); }
};

/// What the step of dt [s] that is about to be made does to the water of a group, from the sums that it will use; solids apart.
template <int dim, class Real>
EnergyFlow energy_flow(const Store<dim, Real>& store, const Parameters& p, int group, double dt) {
  const Rates<dim> rates(p);
  const double mass = p.mass(dim);
  const ToQuanta quanta(energy_quantum(p, dim));
  const double ahead = p.step == StepChoice::symplectic ? 0.5 * dt : 0.0;  // kinetic energy changes by the mean velocity
  double onto_water[cluster_size] = {}, from_solids[cluster_size] = {};
  const Group& range = store.groups[group];
  for (std::uint32_t cluster = range.fluid; cluster < range.solid; ++cluster) {
    const std::size_t first = std::size_t(cluster) * cluster_size;
    const std::uint32_t* id = store.id.data() + first;
    const Real* by_density = store.pack_of(cluster) + (2 * dim + 1) * cluster_size;  // p/rho^2
    const Real* sums = store.sums_of(cluster);
    double power[cluster_size] = {}, driven[cluster_size] = {};
    for (int k = 0; k < dim; ++k) {
      const double* v = store.v[k].data() + first;
      const double drive = k == 0 ? p.drive : 0.0;
      for (int lane = 0; lane < cluster_size; ++lane) {
        const double velocity = v[lane] + ahead * rates.acceleration(k, sums[k * cluster_size + lane]);
        power[lane] += velocity * (mass * double(sums[k * cluster_size + lane]));
        driven[lane] += drive * velocity;
      }
    }
    for (int lane = 0; lane < cluster_size; ++lane) {
      const double work = power[lane] + driven[lane] + double(by_density[lane]) * rates.density(sums[dim * cluster_size + lane]);
      const double filled = id[lane] != no_particle ? mass * dt : 0.0;
      onto_water[lane] += quanta(filled * work);
      from_solids[lane] += quanta(filled * driven[lane]);
    }
  }
  double onto = 0.0, from = 0.0;
  for (int lane = 0; lane < cluster_size; ++lane) onto += onto_water[lane], from += from_solids[lane];
  return {quanta.count(onto), quanta.count(from), 0};
}

/// What the solids of a group do to the water in `dt` of a step [s], by the sums as they are and the velocities that the solids
/// have now: those of the middle of the step for symplectic steps.
template <int dim, class Real>
EnergyFlow energy_of_solids(const Store<dim, Real>& store, const Parameters& p, int group, double dt) {
  const double mass = p.mass(dim);
  const ToQuanta quanta(energy_quantum(p, dim));
  double from_solids[cluster_size] = {};
  const Group& range = store.groups[group];
  for (std::uint32_t cluster = range.solid; cluster < range.end; ++cluster) {
    const std::size_t first = std::size_t(cluster) * cluster_size;
    const std::uint32_t* id = store.id.data() + first;
    const Real* sums = store.sums_of(cluster);
    double power[cluster_size] = {}, largest = 0.0;
    for (int k = 0; k < dim; ++k)
      for (int lane = 0; lane < cluster_size; ++lane) {
        const double velocity = store.v[k][first + lane];
        power[lane] += velocity * (mass * double(sums[k * cluster_size + lane]));
        largest = std::max(largest, std::abs(velocity));
      }
    if (largest == 0.0) continue;  // walls that stand
    const double own_mass = mass * store.weight_of(cluster);
    for (int lane = 0; lane < cluster_size; ++lane)
      from_solids[lane] -= quanta(id[lane] != no_particle ? own_mass * dt * power[lane] : 0.0);
  }
  double from = 0.0;
  for (int lane = 0; lane < cluster_size; ++lane) from += from_solids[lane];
  return {0, quanta.count(from), 0};
}

/// Damps the water of a group over a step of dt that ends at t [s], and says what that takes; below zero where waves are made.
template <int dim, class Real>
EnergyFlow damp(Store<dim, Real>& store, const Parameters& p, const Damping& damping, double t, double dt, int group) {
  const ToQuanta quanta(energy_quantum(p, dim));
  double absorbed = 0.0;
  const Group& range = store.groups[group];
  damp(store, damping, t, dt, std::size_t(range.fluid), std::size_t(range.solid),
       [&](double speed2) { absorbed += quanta(0.5 * p.mass(dim) * speed2); });
  return {0, 0, quanta.count(absorbed)};
}

}  // namespace spindrift::sph
