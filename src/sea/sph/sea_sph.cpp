// The step over groups (see sea_sph.hpp) and the choice of schemes, made once per scene.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/sea_sph.hpp"

#include <omp.h>

#include <chrono>
#include <stdexcept>
#include <variant>

#include "kernels/sph/density_diffusion_fourtakas.hpp"
#include "kernels/sph/density_diffusion_molteni.hpp"
#include "kernels/sph/kernel_cubic.hpp"
#include "kernels/sph/kernel_wendland.hpp"
#include "src/sea/sph/step.hpp"
#include "src/sea/sph/sweep_pairs.hpp"

namespace spindrift::sph {
namespace {

/// Adds the wall seconds of its life to a counter.
class Stopwatch {
 public:
  explicit Stopwatch(double& total) : total_(total), start_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() { total_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  double& total_;
  std::chrono::steady_clock::time_point start_;
};

template <int dim, class Real>
using Sweep = std::function<void(int, Meetings<dim, Real>&)>;

template <class Kernel, class Diffusion, int dim, class Real>
Sweep<dim, Real> sweep_of(Store<dim, Real>& store, const Columns<dim>& columns, const Parameters& p, Diffusion diffusion) {
  const Kernel kernel(p.h());
  const auto viscosity = [&](double alpha) { return ViscosityArtificial<Real>{Real(alpha), Real(p.eos.c0), Real(p.h())}; };
  const LawMotion<Kernel, Diffusion, Real> water{kernel, viscosity(p.alpha), diffusion, Real(p.eos.rho0)};
  // Diffusion acts between water and water only: the density of a wall particle is a boundary condition.
  const LawMotion<Kernel, DensityDiffusionNone, Real> solid{kernel, viscosity(p.alpha_solid), {}, Real(p.eos.rho0)};
  const double length = columns.domain().high[dim - 1] - columns.domain().low[dim - 1] + columns.domain().high[0] - columns.domain().low[0];
  const float reach = float(p.reach() + 4e-7 * length);  // boxes are floats from the corner of the domain
  return [&store, &columns, reach, water, solid](int group, Meetings<dim, Real>& meets) {
    sweep_pairs(store, columns, group, reach, meets, water, solid);
  };
}

template <class Kernel, int dim, class Real>
Sweep<dim, Real> choose_diffusion(Store<dim, Real>& store, const Columns<dim>& columns, const Parameters& p) {
  const Real delta = Real(p.delta), c0 = Real(p.eos.c0), h = Real(p.h());
  const Real slope = Real(p.eos.rho0 * p.gravity / (p.eos.c0 * p.eos.c0));
  switch (p.diffusion) {
    case DiffusionChoice::molteni: return sweep_of<Kernel>(store, columns, p, DensityDiffusionMolteni<Real>{delta, c0, h});
    case DiffusionChoice::fourtakas: return sweep_of<Kernel>(store, columns, p, DensityDiffusionFourtakas<Real>{delta, c0, h, slope});
    default: return sweep_of<Kernel>(store, columns, p, DensityDiffusionNone{});
  }
}

template <int dim, class Real>
Sweep<dim, Real> choose_sweep(Store<dim, Real>& store, const Columns<dim>& columns, const Parameters& p) {
  return p.kernel == KernelChoice::cubic ? choose_diffusion<KernelCubic<dim, Real>>(store, columns, p)
                                         : choose_diffusion<KernelWendland<dim, Real>>(store, columns, p);
}

}  // namespace

template <int dim, class Real>
SeaSph<dim, Real>::SeaSph(const Parameters& parameters, const Domain<dim>& domain, std::span<const Seed<dim>> seeds)
    : p_(parameters), particles_(seeds.size()) {
  const double reach = p_.reach() + 2.0 * p_.drift();
  columns_ = Columns<dim>(domain, reach, p_.column_over_reach * reach);
  fill(store_, seeds, columns_, p_.anchor_step());
  sweep_ = choose_sweep(store_, columns_, p_);
  colours_.resize(columns_.colours());
  for (int group = 0; group < columns_.groups(); ++group) colours_[columns_.colour(group)].push_back(group);
  scratch_.resize(omp_get_max_threads());
}

template <int dim, class Real>
void SeaSph<dim, Real>::sort_if_drifted() {
  if (drift_ <= p_.drift()) return;
  const Stopwatch watch(work_.sort_s);
  sort(store_, columns_, p_.anchor_step());
  drift_ = 0.0;
  ++work_.sorts;
}

template <int dim, class Real>
void SeaSph<dim, Real>::pack_all(double half_dt) {
  const Stopwatch watch(work_.pack_s);
#pragma omp parallel for schedule(dynamic, 4)
  for (int group = 0; group < columns_.groups(); ++group) pack(store_, p_, group, half_dt);
}

template <int dim, class Real>
void SeaSph<dim, Real>::sweep_all() {
  const Stopwatch watch(work_.pair_s);
  for (Meetings<dim, Real>& scratch : scratch_) scratch.reserve(store_.clusters() / 4 + 4096);
#pragma omp parallel
  for (const std::vector<int>& colour : colours_) {
#pragma omp for schedule(dynamic, 1)
    for (std::size_t n = 0; n < colour.size(); ++n) sweep_(colour[n], scratch_[omp_get_thread_num()]);
  }
  ++work_.evaluations;
}

template <int dim, class Real>
void SeaSph<dim, Real>::evaluate() {
  sort_if_drifted();
  pack_all(0.0);
  sweep_all();
}

template <int dim, class Real>
double SeaSph<dim, Real>::step(double dt_max) {
  evaluate();
  Extremes most;
  for (int group = 0; group < columns_.groups(); ++group) most.merge(extremes(store_, p_, group));
  const double limit =
      step_limits(p_.cfl, p_.h(), p_.eos.c0, std::sqrt(most.speed2), std::sqrt(most.acceleration2), 0.0).smallest();
  const double dt = std::min(limit, dt_max);
  pack_all(0.5 * dt);
  sweep_all();
  {
    const Stopwatch watch(work_.correct_s);
#pragma omp parallel for schedule(dynamic, 4)
    for (int group = 0; group < columns_.groups(); ++group) correct_symplectic(store_, p_, group, dt);
  }
  // Over the step a particle goes at most (|v| + dt |a|) dt; the half step's acceleration may be larger, hence the factor two.
  drift_ += dt * (std::sqrt(most.speed2) + 2.0 * dt * std::sqrt(most.acceleration2));
  time_ += dt;
  ++work_.steps;
  return dt;
}

template <int dim, class Real>
void SeaSph<dim, Real>::advance(double duration) {
  for (double left = duration; left > 0.0;) {
    const double dt = step(left);
    left = dt < left ? left - dt : 0.0;
  }
}

template class SeaSph<2, float>;
template class SeaSph<2, double>;
template class SeaSph<3, float>;
template class SeaSph<3, double>;

}  // namespace spindrift::sph
