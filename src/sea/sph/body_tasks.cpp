// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/body_tasks.hpp"

#include <algorithm>

namespace spindrift::sph {

using runtime::Context;
using runtime::Datum;
using runtime::reads;
using runtime::updates;
using runtime::writes;

template <int dim, class Real>
BodyTasks<dim, Real>::BodyTasks(StepRecording<dim, Real>& recording, const StepDriver& driver)
    : recording_(recording), driver_(driver), path_(recording.sea.plan.solid_path) {
  SeaState<dim, Real>& sea = recording.sea;
  const Subdomain& subdomain = sea.subdomain;
  if (!driver_.move_bodies) return;
  // Bodies load the groups they are in and two rings round these: path_limit sees to it that none goes farther.
  std::vector<std::uint8_t> region(std::size_t(sea.columns.groups_and_images()), 0);
  for (const Solid& solid : sea.solids)
    for (const Eigen::Vector3d& local : solid.local) {
      const auto x = from_earth<dim>(solid.motion.point(local));
      if (sea.columns.domain().contains(x)) region[std::size_t(sea.columns.group(x))] = 1;
    }
  for (std::uint8_t ring = 1; ring <= 2; ++ring)
    for (int g = 0; g < sea.columns.groups(); ++g)
      sea.columns.for_forward(g, [&](const Neighbour<dim>& near) {
        std::uint8_t &a = region[std::size_t(g)], &b = region[std::size_t(near.group)];
        if (a == ring && b == 0) b = std::uint8_t(ring + 1);
        if (b == ring && a == 0) a = std::uint8_t(ring + 1);
      });
  for (const int g : subdomain.own)
    if (region[std::size_t(g)] > 0) groups_.push_back(g);
  if (sea.has_contacts())
    for (int on = 1; on < sea.store.owners; ++on)
      for (int of = on + 1; of < sea.store.owners; ++of)
        if (std::any_of(sea.free.begin(), sea.free.end(), [&](const auto& box) { return box.owner == on || box.owner == of; }))
          touching_.emplace_back(on, of);
  partial_data_ = recording.graph.data(groups_.size());
  total_.resize(6 * (sea.solids.size() + touching_.size()));
  partial_.resize(total_.size() * groups_.size());
}

template <int dim, class Real>
void BodyTasks<dim, Real>::record(Half half) {
  if (!driver_.move_bodies) return;
  auto& r = recording_;
  SeaState<dim, Real>& sea = r.sea;
  const std::string when = half == Half::begin ? "begin" : "middle";
  // Of a symplectic step in its middle; of Verlet's by the mean of the velocities before and after it (tasks.cpp has the second).
  const double counted = half == Half::middle ? 1.0 : sea.p.step == StepChoice::verlet ? 0.5 : 0.0;
  for (std::size_t n = 0; n < groups_.size(); ++n) {
    const int g = groups_[n];
    r.graph.task(task_name("load/" + when, std::size_t(g)),
                 {reads(r.order), reads(r.plan), reads(r.loads), reads(r.state[std::size_t(g)]), reads(r.planes[std::size_t(g)]),
                  reads(r.sums[std::size_t(g)]), reads(r.touches[std::size_t(g)]), writes(partial_data_[n])},
                 r.if_active([this, &sea, g, n, counted](const Context&, int step) {
                   gather(g, &partial_[n * total_.size()]);
                   if (counted > 0.0)
                     sea.energy.add_from_task(energy_of_solids(sea.store, sea.p, g, counted * sea.plan.dt_of(step)));
                 }));
  }
  const Datum sum = r.graph.datum();
  r.sum("sea/loads/" + when, partial_data_, sum, partial_, total_);
  r.graph.task("bodies/substeps/" + when, {reads(sum), reads(r.plan), updates(r.loads)},
               r.if_active([this, half](const Context&, int step) { move(half, step); }));
  for (const int g : groups_)
    r.graph.task(task_name("place/" + when, std::size_t(g)),
                 {reads(r.order), reads(r.plan), reads(r.loads), updates(r.state[std::size_t(g)])}, r.if_active([&sea, g] {
                   for (const Solid& solid : sea.solids) place(sea.store, sea.columns.domain(), solid, g);
                 }));
}

/// Loads of one group on each body, and of each pair of owners that touch in it.
template <int dim, class Real>
void BodyTasks<dim, Real>::gather(int group, double* loads) const {
  const SeaState<dim, Real>& sea = recording_.sea;
  const std::size_t solids = sea.solids.size();
  for (std::size_t s = 0; s < solids; ++s) {
    const Solid& solid = sea.solids[s];
    const Wrench w = load(sea.store, solid.owner, sea.p.mass(dim), solid.motion.position, group);
    double* to = loads + 6 * s;
    for (int k = 0; k < 3; ++k) to[k] = w.force[k], to[3 + k] = w.moment[k];
  }
  std::fill(loads + 6 * solids, loads + total_.size(), 0.0);
  if (touching_.empty()) return;
  for (const Touch& touch : sea.touches[std::size_t(group)]) {
    const auto at = std::find(touching_.begin(), touching_.end(), std::pair<int, int>(touch.on, touch.of)) - touching_.begin();
    double* to = loads + 6 * (solids + std::size_t(at));
    for (int k = 0; k < 3; ++k) to[k] += touch.wrench.force[k], to[3 + k] += touch.wrench.moment[k];
  }
}

/// Asks the driver where the bodies are at the middle of the step, or at its end.
template <int dim, class Real>
void BodyTasks<dim, Real>::move(Half half, int step) {
  SeaState<dim, Real>& sea = recording_.sea;
  wrenches_.clear(), motions_.clear(), contacts_.clear();
  for (std::size_t t = 0; t < touching_.size(); ++t) {
    const double* from = &total_[6 * (sea.solids.size() + t)];
    Touch touch{std::uint16_t(touching_[t].first), std::uint16_t(touching_[t].second), {}};
    for (int k = 0; k < 3; ++k) touch.wrench.force[k] = from[k], touch.wrench.moment[k] = from[3 + k];
    if (touch.wrench.force != Eigen::Vector3d::Zero()) contacts_.push_back(touch);
  }
  for (std::size_t s = 0; s < sea.solids.size(); ++s) {
    const double* from = &total_[6 * s];
    Wrench w{.point = sea.solids[s].motion.position};
    for (int k = 0; k < 3; ++k) w.force[k] = from[k], w.moment[k] = from[3 + k];
    wrenches_.push_back(w), motions_.push_back(sea.solids[s].motion);
  }
  const Plan& plan = sea.plan;
  double begin = plan.time;
  for (int done = 0; done < step; ++done) begin += plan.dt;  // as the clock will add them up
  const bool last = half == Half::middle || sea.p.step == StepChoice::verlet;
  const double dt = plan.dt_of(step);
  driver_.move_bodies({half == Half::begin ? 0 : 1, begin, begin + (last ? dt : 0.5 * dt), dt, contacts_}, wrenches_, motions_);
  for (std::size_t s = 0; s < sea.solids.size(); ++s) sea.set_motion(sea.solids[s], motions_[s]);
  const double farthest = path_limit();
  if (plan.solid_path > farthest)
    sea.plan.failure =
        NumericalFailure("sea: bodies went " + in_words(plan.solid_path - path_) + " m in a window or two, the limit is " +
                             in_words(farthest - path_) + " m (a column of cells and a half); shorten time.window_s",
                         "sea", plan.steps, plan.time, farthest - path_);
}

template <int dim, class Real>
double BodyTasks<dim, Real>::path_limit() const {
  double edge = recording_.sea.columns.edge(0);
  for (int k = 1; k < dim - 1; ++k) edge = std::min(edge, recording_.sea.columns.edge(k));
  return path_ + 1.5 * edge;
}

template <int dim, class Real>
bool BodyTasks<dim, Real>::outdated() const {
  return driver_.move_bodies && recording_.sea.plan.solid_path > path_ + 0.5 * (path_limit() - path_);
}

template class BodyTasks<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>;

}  // namespace spindrift::sph
