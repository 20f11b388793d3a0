// The facade over the tasks: see sea_sph.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/sea_sph.hpp"

#include <algorithm>
#include <string>

#include "runtime/mpi/stop_request.hpp"
#include "src/sea/sph/load_balance.hpp"

namespace spindrift::sph {

namespace {

/// Ghost nodes may see no farther than two columns: so far reach the uses of tasks and the halos of ranks. Widens columns for
/// those that lie far in.
template <int dim>
Parameters with_room_for_ghosts(Parameters p, const SeedStream<dim>& seeds, MPI_Comm comm) {
  double farthest = 0.0;
  runtime::give_up_together(comm, [&] {
    seeds.for_each(
        [&](std::size_t, const Seed<dim>& seed) {
          for (int k = 0; k < dim - 1; ++k) farthest = std::max(farthest, std::abs(seed.ghost[k]));
        },
        [](const SeedPart<dim>& part) { return part.has_ghosts; });
  });
  const double least = p.reach() + 2.0 * p.drift();
  p.column_over_reach = std::max(p.column_over_reach, 0.5 * (farthest + least) / least);
  return p;
}

}  // namespace

template <int dim, class Real>
SeaSph<dim, Real>::SeaSph(const Parameters& parameters, const Domain<dim>& domain, const SeedStream<dim>& seeds,
                          const Resources& resources)
    : comm_(resources.comm),
      repartition_above_(resources.repartition_above),
      s_(with_room_for_ghosts(parameters, seeds, comm_.get()), domain),
      recorded_(s_, sweeps_, comm_, resources) {
  runtime::give_up_together(comm_.get(), [&] { s_.ghosts = Ghosts<dim>(seeds); });
  set_ranks(resources.rank_of_group.empty() ? first_ranks(s_.columns, seeds, comm_) : resources.rank_of_group);
  sweeps_ = sweeps_over(s_);
  fill(s_.store, seeds, s_.columns, s_.subdomain, comm_.get(), s_.p.anchor_step());
  if (s_.p.step == StepChoice::verlet) s_.store.v_before = s_.store.v, s_.store.deviation_before = s_.store.deviation;
}

template <int dim, class Real>
void SeaSph<dim, Real>::set_ranks(std::vector<int> rank_of_group) {
  if (rank_of_group.size() != std::size_t(s_.columns.groups()))
    throw std::invalid_argument("sea: ranks are given for " + std::to_string(rank_of_group.size()) + " groups of " +
                                std::to_string(s_.columns.groups()));
  recorded_.forget();
  s_.subdomain = subdomain_of(s_.columns, std::move(rank_of_group), comm_.rank(), s_.ghosts.empty() ? 1 : 2);
}

template <int dim, class Real>
void SeaSph<dim, Real>::sort() {
  s_.plan.sort = true;
  recorded_.sort();
}

template <int dim, class Real>
void SeaSph<dim, Real>::evaluate() {
  if (s_.plan.sort_is_due(s_.p.drift())) sort();
  s_.plan.planned = 1;
  recorded_.begin();
  contacts_ = all_contacts(s_, comm_.get());
}

template <int dim, class Real>
double SeaSph<dim, Real>::step_limit() {
  evaluate();
  return s_.plan.limit;
}

template <int dim, class Real>
double SeaSph<dim, Real>::begin_step(double dt_max) {
  s_.plan.start_steps(std::min(step_limit(), dt_max), 1);
  s_.plan.shifted = 0.0;
  if (s_.p.step == StepChoice::verlet) count_work_of_solids(0.5);
  return s_.plan.dt;
}

template <int dim, class Real>
void SeaSph<dim, Real>::half_step() {
  if (s_.p.step == StepChoice::verlet) return;
  recorded_.middle();
  contacts_ = all_contacts(s_, comm_.get());
  count_work_of_solids(1.0);
}

/// As the tasks of bodies do in windows, for a share of the step.
template <int dim, class Real>
void SeaSph<dim, Real>::count_work_of_solids(double share) {
  for (const int g : s_.subdomain.own) s_.energy = sum(s_.energy, energy_of_solids(s_.store, s_.p, g, share * s_.plan.dt));
}

template <int dim, class Real>
void SeaSph<dim, Real>::end_step() {
  recorded_.end();
  s_.plan.left = s_.plan.dt;
  s_.plan.finish_steps(recorded_.driver().steps, s_.p.step, s_.work);
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
  if (!(duration > 0.0)) return;
  s_.plan.left = duration;
  recorded_.window();
  if (comm_.size() > 1) repartition();
}

template <int dim, class Real>
void SeaSph<dim, Real>::set_step_control(StepControl control) {
  if (control.steps_per_check < 1 || control.dt < 0.0)
    throw std::invalid_argument("sea: a step_control needs steps_per_check >= 1 and dt >= 0");
  recorded_.drive({std::move(control), recorded_.driver().move_bodies});
}

template <int dim, class Real>
void SeaSph<dim, Real>::set_bodies(MoveBodies move) {
  recorded_.drive({recorded_.driver().steps, std::move(move)});
}

template <int dim, class Real>
void SeaSph<dim, Real>::add_body(std::uint16_t owner, const Motion& motion, double mass) {
  sph::add_body(s_, owner, motion, mass, comm_.get());
  recorded_.forget();
}

template <int dim, class Real>
void SeaSph<dim, Real>::add_sensor(Patch patch) {
  if (const Solid* const solid = body_of(patch, s_.solids); solid && patch.counted.size() != solid->local.size())
    throw std::invalid_argument("sph: a sensor on solid " + std::to_string(patch.owner) +
                                " must say of each particle whether it counts");
  s_.records.emplace_back(patch.mean_over);
  s_.patches.push_back(std::move(patch));
  recorded_.forget();
}

template <int dim, class Real>
Saved<dim> SeaSph<dim, Real>::save() const {
  return save_groups(s_, s_.subdomain.own);
}

template <int dim, class Real>
void SeaSph<dim, Real>::restore(std::span<const Saved<dim>> pieces) {
  restore_groups(s_, pieces);
  exchange_halo_structure(s_.store, s_.columns, s_.subdomain, comm_.get());
}

template <int dim, class Real>
bool SeaSph<dim, Real>::repartition() {
  const std::optional<std::vector<int>> better = better_ranks(s_, repartition_above_, comm_);
  return better && repartition(*better);
}

template <int dim, class Real>
bool SeaSph<dim, Real>::repartition(std::vector<int> rank_of_group) {
  if (rank_of_group == s_.subdomain.rank_of_group) return false;
  const std::vector<Saved<dim>> pieces = send_groups(s_, rank_of_group, comm_);
  set_ranks(std::move(rank_of_group));
  const EnergyFlow mine = s_.energy;  // sums over ranks do not know whose groups they came from
  restore(pieces);
  s_.energy = mine;
  return true;
}

// One dimension and one precision at a time: SPINDRIFT_SPH_DIM and _REAL come from CMakeLists.txt, which compiles this file for
// each.
template class SeaSph<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>;

}  // namespace spindrift::sph
