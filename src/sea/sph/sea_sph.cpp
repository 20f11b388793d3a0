// The step over groups: see sea_sph.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/sea_sph.hpp"

#include <omp.h>

#include <chrono>
#include <string>

#include "kernels/base/failure.hpp"
#include "src/sea/sph/filters.hpp"
#include "src/sea/sph/schemes.hpp"
#include "src/sea/sph/step.hpp"

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

template <int dim>
std::string place_of(const std::array<double, dim>& x) {
  std::string text = "(";
  for (int k = 0; k < dim; ++k) text += (k > 0 ? ", " : "") + std::to_string(x[k]);
  return text + ") m";
}

}  // namespace

template <int dim, class Real>
SeaSph<dim, Real>::SeaSph(const Parameters& parameters, const Domain<dim>& domain, std::span<const Seed<dim>> seeds)
    : p_(parameters), body_limit_(std::numeric_limits<double>::infinity()), particles_(seeds.size()) {
  const double reach = p_.reach() + 2.0 * p_.drift();
  columns_ = Columns<dim>(domain, reach, p_.column_over_reach * reach);
  fill(store_, seeds, columns_, p_.anchor_step());
  if (p_.step == StepChoice::verlet) store_.v_before = store_.v, store_.deviation_before = store_.deviation;
  const Schemes<dim, Real> schemes(store_, columns_, p_);
  ghosts_ = Ghosts<dim>(seeds);
  boundary_ = schemes.boundary(ghosts_);
  rates_ = schemes.rates(), strain_ = schemes.strain(), filter_ = schemes.filter(), shifting_ = schemes.shifting();
  colours_.resize(columns_.colours());
  for (int group = 0; group < columns_.groups(); ++group) colours_[columns_.colour(group)].push_back(group);
  scratch_.resize(omp_get_max_threads());
}

template <int dim, class Real>
template <class Body>
void SeaSph<dim, Real>::for_groups(double& seconds, Body&& body) {
  const Stopwatch watch(seconds);
#pragma omp parallel for schedule(dynamic, 4)
  for (int group = 0; group < columns_.groups(); ++group) body(group);
}

template <int dim, class Real>
void SeaSph<dim, Real>::sort_if_drifted() {
  if (std::max(drift_, solid_drift_) <= p_.drift()) return;
  const Stopwatch watch(work_.sort_s);
  sort(store_, columns_, p_.anchor_step());
  drift_ = solid_drift_ = 0.0;
  ++work_.sorts;
  if (store_.lost.size() > p_.lost_at_most) {
    const LostParticle<dim>& last = store_.lost.back();
    throw NumericalFailure("sea: " + std::to_string(store_.lost.size()) + " particles left the domain (allowed " +
                               std::to_string(p_.lost_at_most) + "), the last one, " + std::to_string(last.id) + ", at " +
                               place_of<dim>(last.position) + "; widen the domain or check the walls",
                           "sea", work_.steps, time_, double(p_.lost_at_most));
  }
}

template <int dim, class Real>
void SeaSph<dim, Real>::prepare(double half_dt) {
  for_groups(work_.pack_s, [&](int group) { pack(store_, p_, group, half_dt); });
  if (boundary_) {
    reserve_scratch();
    for_groups(work_.pair_s, [&](int group) { boundary_(store_, group, scratch_[omp_get_thread_num()].water); });
  }
}

template <int dim, class Real>
void SeaSph<dim, Real>::reserve_scratch() {
  std::size_t longest = 0;
  for (const Group& group : store_.groups) longest = std::max<std::size_t>(longest, group.end - group.fluid);
  constexpr std::size_t columns_met = dim == 2 ? 5 : 25;  // by a ghost node; a pair sweep meets five
  for (Meetings<dim, Real>& scratch : scratch_) scratch.reserve((boundary_ ? columns_met : 9) * longest);
}

template <int dim, class Real>
void SeaSph<dim, Real>::evaluate_packed() {
  if (strain_) {
    constexpr int planes = SymmetricTensor<double, dim>::components;
    extra_sums_.assign(store_.slots() * planes, Real(0));
    store_.stress.resize(store_.slots() * planes);
    run(strain_, extra_sums_);
    for_groups(work_.correct_s, [&](int group) { apply_stress(store_, extra_sums_, p_, group); });
  }
  run(rates_, store_.sums);
  if (p_.contact && !free_.empty()) {
    const Contact law = contact_law(p_, dim);
    std::vector<std::vector<Touch>> touches(columns_.groups());
    for_groups(work_.correct_s, [&](int group) { find_contacts(store_, columns_, free_, law, group, touches[group]); });
    contacts_ = merge_contacts(touches);
  }
  ++work_.evaluations;
}

template <int dim, class Real>
void SeaSph<dim, Real>::run(const Sweep& sweep, Array<Real>& sums) {
  const Stopwatch watch(work_.pair_s);
  reserve_scratch();
#pragma omp parallel num_threads(int(scratch_.size()))
  for (const std::vector<int>& colour : colours_) {
#pragma omp for schedule(dynamic, 1)
    for (std::size_t n = 0; n < colour.size(); ++n) sweep(sums.data(), colour[n], scratch_[omp_get_thread_num()]);
  }
}

template <int dim, class Real>
void SeaSph<dim, Real>::evaluate() {
  sort_if_drifted();
  prepare(0.0);
  evaluate_packed();
}

template <int dim, class Real>
double SeaSph<dim, Real>::begin_step(double dt_max) {
  evaluate();
  Extremes most;
  for (int group = 0; group < columns_.groups(); ++group) most.merge(extremes(store_, p_, group));
  const double speed = std::sqrt(most.speed2), acceleration = std::sqrt(most.acceleration2);
  limits_ = step_limits(p_.cfl, p_.h(), p_.eos.c0, speed, acceleration, p_.laminar() ? std::max(p_.nu, p_.nu_solid) : 0.0);
  limits_.body = body_limit_;
  const double limit = limits_.smallest();
  constexpr double smallest_share = 1e-4;  // of the step of water at rest: speeds of 1e4 c0 are no flow
  if (!(limit > smallest_share * p_.cfl * p_.h() / p_.eos.c0))
    throw NumericalFailure("sea: the step fell to " + std::to_string(limit) + " s (largest speed " + std::to_string(speed) +
                               " m/s, acceleration " + std::to_string(acceleration) +
                               " m/s2); try a smaller sea.cfl or more viscosity",
                           "sea", work_.steps, time_, limit);
  dt_ = std::min(limit, dt_max);
  // Over the step a particle goes at most (|v| + dt |a|) dt; the half step's acceleration may be larger, hence the factor two.
  drift_ += dt_ * (speed + 2.0 * dt_ * acceleration);
  return dt_;
}

template <int dim, class Real>
void SeaSph<dim, Real>::half_step() {
  if (p_.step == StepChoice::verlet) return;
  prepare(0.5 * dt_);
  evaluate_packed();
}

template <int dim, class Real>
void SeaSph<dim, Real>::end_step() {
  const bool join = work_.steps % p_.verlet_join_every == 0;
  for_groups(work_.correct_s, [&](int group) {
    if (p_.step == StepChoice::verlet)
      correct_verlet(store_, p_, group, dt_, join);
    else
      correct_symplectic(store_, p_, group, dt_);
  });
  time_ += dt_;
  ++work_.steps;
  filter_if_due();
}

template <int dim, class Real>
void SeaSph<dim, Real>::filter_if_due() {
  const auto gather = [&](const Sweep& sweep, int planes) {
    sort_if_drifted();
    prepare(0.0);
    extra_sums_.assign(store_.slots() * planes, Real(0));
    run(sweep, extra_sums_);
  };
  if (filter_ && work_.steps % p_.filter_every == 0) {
    gather(filter_, p_.filter == FilterChoice::mls ? FilterMls<dim>::planes : FilterShepard::planes);
    for_groups(work_.correct_s, [&](int group) {
      p_.filter == FilterChoice::mls ? apply_mls(store_, extra_sums_, group) : apply_shepard(store_, extra_sums_, group);
    });
  }
  if (shifting_) {
    gather(shifting_, Shifting<dim>::planes);
    std::vector<double> longest(columns_.groups());
    for_groups(work_.correct_s, [&](int group) { longest[group] = apply_shifting(store_, extra_sums_, p_, group, dt_); });
    drift_ += *std::max_element(longest.begin(), longest.end());
  }
}

template <int dim, class Real>
void SeaSph<dim, Real>::add_body(std::uint16_t owner, const Motion& motion, double mass) {
  solids_.push_back(solid_from(store_, owner, motion));
  built_.push_back(motion);
  if (mass <= 0.0) return;
  const Solid& solid = solids_.back();
  free_.push_back(box_of<dim>(solid, motion));
  const double relative_weight = mass / (double(solid.local.size()) * p_.mass(dim));
  // Half of what is stable for a body pressed from one side: it is wet all round, and turns.
  body_limit_ = std::min(body_limit_, 0.5 * step_limit_body(relative_weight, solid.layers(p_.spacing), p_.spacing, p_.eos.c0));
}

template <int dim, class Real>
Wrench SeaSph<dim, Real>::contact_on(std::uint16_t owner, const Eigen::Vector3d& about, int of) const {
  Wrench total{.point = about};
  for (const Touch& touch : contacts_) {
    if (touch.on != owner && touch.of != owner) continue;
    if (of >= 0 && int(touch.on == owner ? touch.of : touch.on) != of) continue;
    Wrench wrench = touch.wrench.about(about);
    if (touch.of == owner) wrench.force = -wrench.force, wrench.moment = -wrench.moment;
    total += wrench;
  }
  return total;
}

template <int dim, class Real>
void SeaSph<dim, Real>::place_body(std::uint16_t owner, const Motion& motion) {
  for (std::size_t n = 0; n < solids_.size(); ++n) {
    if (solids_[n].owner != owner) continue;
    solid_drift_ += place(store_, columns_.domain(), solids_[n], motion);
    for (BodyBox<dim>& box : free_)
      if (box.owner == owner) box = box_of<dim>(solids_[n], motion);
    if (!ghosts_.empty()) ghosts_.turn(solids_[n], motion.attitude * built_[n].attitude.conjugate());
  }
}

template <int dim, class Real>
double SeaSph<dim, Real>::step(double dt_max) {
  const double dt = begin_step(dt_max);
  half_step();
  end_step();
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
