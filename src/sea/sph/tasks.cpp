// The graph of a step: see tasks.hpp. Read `window`, `steps`, `step`, then what they call.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/tasks.hpp"

#include <algorithm>
#include <atomic>

#include "runtime/graph/sizes.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "src/sea/sph/filters.hpp"
#include "src/sea/sph/step.hpp"

namespace spindrift::sph {

using runtime::Context;
using runtime::Datum;
using runtime::reads;
using runtime::updates;
using runtime::Uses;
using runtime::writes;

namespace {

/// Planes, boxes, cleared sums; in the middle of the step by the predictor.
template <int dim, class Real>
void record_packing(StepRecording<dim, Real>& r, Half half) {
  for (std::size_t b = 0; b < r.bundles.size(); ++b) {
    Uses uses = {reads(r.order), reads(r.plan)};
    for (const int g : r.bundles[b]) {
      const auto n = std::size_t(g);
      uses.push_back(reads(r.state[n])), uses.push_back(writes(r.planes[n])), uses.push_back(writes(r.walls[n]));
      uses.push_back(updates(r.sums[n]));
    }
    r.graph.task(task_name(half == Half::begin ? "pack" : "predict", b), uses,
                 r.if_active([&sea = r.sea, &groups = r.bundles[b], half](const Context&, int n) {
                   for (const int g : groups) pack(sea.store, sea.p, g, half == Half::begin ? 0.0 : 0.5 * sea.plan.dt_of(n));
                 }));
  }
}

/// Contacts of bodies with walls and with each other, listed by group; each pair by the rank that owns the group it belongs to.
template <int dim, class Real>
void record_contacts(StepRecording<dim, Real>& r) {
  if (!r.sea.has_contacts()) return;
  for (std::size_t b = 0; b < r.bundles.size(); ++b) {
    Uses uses = of_groups(r.bundles[b], writes, r.touches);
    for (const int g : r.bundles[b]) {
      uses.push_back(reads(r.planes[std::size_t(g)]));
      r.sea.columns.for_forward(g, [&](const Neighbour<dim>& near) {
        for (const GroupData* data : {&r.planes, &r.walls}) uses.push_back(reads((*data)[std::size_t(near.group)]));
      });
    }
    uses.push_back(reads(r.order)), uses.push_back(reads(r.plan)), uses.push_back(reads(r.loads));
    r.graph.task(task_name("contacts", b), uses,
                 r.if_active([&sea = r.sea, &groups = r.bundles[b], law = contact_law(r.sea.p, dim)] {
                   for (const int g : groups) {
                     std::vector<Touch>& touches = sea.touches[std::size_t(g)];
                     touches.clear();
                     find_contacts(sea.store, sea.columns, sea.solids, sea.free, law, g, touches);
                   }
                 }));
  }
}

/// Empties the sums of a sweep that is not that of the rates (those are emptied by packing).
template <int dim, class Real>
void clear_sums(StepRecording<dim, Real>& r, std::size_t which, const std::string& label) {
  for (std::size_t b = 0; b < r.bundles.size(); ++b) {
    Uses uses = of_groups(r.bundles[b], writes, r.extra[which]);
    uses.push_back(reads(r.order)), uses.push_back(reads(r.plan));
    r.graph.task(task_name(label + "/clear", b), uses, r.if_active([&store = r.sea.store, &groups = r.bundles[b], which] {
      const std::size_t size = std::size_t(store.extra_planes[which]) * cluster_size;
      Real* const sums = store.extra_sums[which].data();
      for (const int g : groups) {
        const Group& group = store.groups[std::size_t(g)];
        std::fill(sums + group.fluid * size, sums + group.end * size, Real(0));
      }
    }));
  }
}

}  // namespace

template <int dim, class Real>
StepTasks<dim, Real>::StepTasks(SeaState<dim, Real>& sea, const Sweeps<dim, Real>& sweeps, const StepDriver& driver,
                                runtime::Graph& graph, int threads, int first_tag)
    : recording_(sea, graph),
      sweeps_(sweeps),
      driver_(driver),
      sorting_(sea.store, sea.columns, sea.subdomain, sea.p.anchor_step()),
      halo_(first_tag),
      bodies_(recording_, driver),
      sensors_(recording_, bool(driver.move_bodies), bodies_.groups()),
      neighbour_lists_(std::size_t(threads)),
      extremes_data_(graph.data(recording_.bundles.size())),
      extremes_(extremes_size * recording_.bundles.size()) {
  sea.touches.resize(std::size_t(sea.columns.groups()));
}

/// Sort where it is due, check the limits, step; until the window is over.
template <int dim, class Real>
void StepTasks<dim, Real>::window() {
  auto& r = recording_;
  SeaState<dim, Real>& sea = r.sea;
  r.graph.loop("sea/checks", {.min = 1, .urgency = 1}, [&] {
    r.graph.task("sea/order", {updates(r.plan)},
                 [&sea] { sea.plan.sort = sea.plan.sort_is_due(sea.p.drift()) && !sea.plan.ended(); });
    sort();
    steps(true);
    if (driver_.steps.steps_per_check > 1)
      r.graph.repeat("sea/substeps", std::uint32_t(driver_.steps.steps_per_check - 1), [&] { steps(false); });
    r.graph.task("sea/clock", {updates(r.plan)},
                 [&sea, &driver = driver_] { sea.plan.finish_steps(driver.steps, sea.p.step, sea.work); });
    r.graph.until("sea/until", {reads(r.plan)}, [&sea] { return !(sea.plan.left > 0.0); });
  });
}

/// The first of the planned steps checks the limits; the others go on.
template <int dim, class Real>
void StepTasks<dim, Real>::steps(bool first) {
  auto& r = recording_;
  SeaState<dim, Real>& sea = r.sea;
  if (first) {
    r.step = [](const Context&) { return 0; };
    // Nothing is planned before the check.
    r.graph.task("sea/plan", {updates(r.plan)}, [&sea] { sea.plan.planned = sea.plan.ended() ? 0 : 1; });
    evaluate(Half::begin);
    limits();
    r.graph.task("sea/steps", {updates(r.plan)}, [&sea, &driver = driver_] {
      sea.plan.choose_steps(driver.steps, sea.p.drift());
      sea.plan.shifted = 0.0;
    });
  } else {
    r.step = [](const Context& c) { return int(c.iteration) + 1; };
    const Datum number = r.graph.datum();
    r.graph.task("sea/substep", {reads(r.plan), writes(number)}, [this](const Context& c) { substep_ = recording_.step(c); });
    r.active = [this] { return substep_ < recording_.sea.plan.planned; };
    r.active_from = {reads(r.plan), reads(number)};
    evaluate(Half::begin);
  }
  step();
  r.active = {}, r.active_from.clear();
}

template <int dim, class Real>
void StepTasks<dim, Real>::step() {
  auto& r = recording_;
  if (r.sea.p.step == StepChoice::verlet) sensors_.record();
  bodies_.record(Half::begin);
  if (r.sea.p.step == StepChoice::symplectic) {
    evaluate(Half::middle);
    sensors_.record();
    bodies_.record(Half::middle);
  }
  correct();
  filters();
}

template <int dim, class Real>
void StepTasks<dim, Real>::evaluate(Half half) {
  auto& r = recording_;
  show_planes(half, "halo");
  stress();
  sweep_pairs("pairs", sweeps_.rates, r.sea.store.sums, sum_planes<dim>, r.sums, bool(sweeps_.strain));
  record_contacts(r);
}

// ---- the parts ----

/// Planes of own groups and of the halo, with what walls take from the water.
template <int dim, class Real>
void StepTasks<dim, Real>::show_planes(Half half, const std::string& label) {
  record_packing(recording_, half);
  halo_.record(recording_, label, sweeps_.boundary ? HaloOf::water : HaloOf::planes);
  set_walls();
}

template <int dim, class Real>
void StepTasks<dim, Real>::sort() {
  auto& r = recording_;
  using S = Sorting<dim, Real>;
  SeaState<dim, Real>& sea = r.sea;
  // Without places: a part is of the work on what this rank holds, not of the tank.
  std::vector<Datum> part;
  for (int n = 0; n < S::parts; ++n) part.push_back(r.graph.datum());
  const auto record = [&r](std::uint32_t node) { runtime::set_on_all(r.graph, node); };
  const auto serial = [&](const std::string& label, auto&& work) {
    record(r.graph.task(label, {updates(r.order), updates(r.plan), updates(part)}, [&sea, &sorting = sorting_, work] {
      if (sea.plan.sort) work(sorting);
    }));
  };
  const auto parallel = [&](const std::string& label, int count, auto&& work) {
    for (int n = 0; n < count; ++n)
      record(r.graph.task(task_name(label, std::size_t(n)), {reads(r.order), updates(part[std::size_t(n)])},
                          [&sea, &sorting = sorting_, work, n] {
                            if (sea.plan.sort) work(sorting, n);
                          }));
  };
  const auto together = [&](const std::string& label, auto&& work) {
    record(r.graph.collective(
        label, {updates(r.order), updates(r.plan), updates(part)},
        [&sorting = sorting_, work](MPI_Comm comm) { work(sorting, comm); }, [&sea] { return sea.plan.sort; }));
  };
  serial("sea/sort/begin", [](S& s) { s.begin(); });
  parallel("sort/classify", S::parts, [](S& s, int n) { s.classify(n); });
  together("sea/sort/migrate", [](S& s, MPI_Comm comm) { s.migrate(comm); });
  parallel("sort/put", S::parts, [](S& s, int n) { s.put(n); });
  serial("sea/sort/lay_out", [](S& s) { s.lay_out(); });
  parallel("sort/halve", S::parts, [](S& s, int n) { s.halve(n); });
  serial("sea/sort/give_back", [](S& s) { s.give_back(); });
  parallel("sort/reorder", sorting_.arrays(), [](S& s, int n) { s.reorder(n); });
  serial("sea/sort/anchors", [](S& s) { s.make_anchors(); });
  parallel("sort/anchor", S::parts, [](S& s, int n) { s.anchor(n); });
  together("sea/sort/show", [&sea](S& s, MPI_Comm comm) {
    s.exchange_halo(comm);
    sea.sorted();
  });
}

/// Extrapolated walls take their density and velocity from the water in the columns beside them, modified ones from that round
/// their ghost nodes, up to two columns away.
template <int dim, class Real>
void StepTasks<dim, Real>::set_walls() {
  auto& r = recording_;
  if (!sweeps_.boundary) return;
  std::vector<std::vector<int>> around(std::size_t(r.sea.columns.groups_and_images()));
  for (int g = 0; g < r.sea.columns.groups(); ++g)
    r.sea.columns.for_forward(g, [&](const Neighbour<dim>& near) {
      around[std::size_t(g)].push_back(near.group), around[std::size_t(near.group)].push_back(g);
    });
  for (std::size_t b = 0; b < r.wall_bundles.size(); ++b) {
    Uses uses = {reads(r.order), reads(r.plan), reads(r.loads)};
    for (const int g : r.wall_bundles[b]) {
      uses.push_back(updates(r.walls[std::size_t(g)])), uses.push_back(updates(r.state[std::size_t(g)]));
      uses.push_back(reads(r.planes[std::size_t(g)]));
      for (const int near : around[std::size_t(g)]) {
        uses.push_back(reads(r.planes[std::size_t(near)]));
        if (r.sea.ghosts.empty()) continue;
        for (const int far : around[std::size_t(near)]) uses.push_back(reads(r.planes[std::size_t(far)]));
      }
    }
    r.graph.task(task_name("walls", b), uses,
                 r.if_active([&sea = r.sea, &sweeps = sweeps_, &groups = r.wall_bundles[b], &lists = neighbour_lists_](
                                 const Context& context, int) {
                   Candidates<dim, Real>& water = lists[std::size_t(context.thread)].water;
                   water.reserve((dim == 2 ? 5 : 25) * sea.store.longest);
                   for (const int g : groups) sweeps.boundary(sea.store, g, water);
                 }));
  }
  halo_.record(r, "walls/halo", HaloOf::solids);
}

/// Sub-particle stress from a sweep of its own.
template <int dim, class Real>
void StepTasks<dim, Real>::stress() {
  auto& r = recording_;
  if (!sweeps_.strain) return;
  clear_sums(r, of_strain, "strain");
  sweep_pairs("strain", sweeps_.strain, r.sea.store.extra_sums[of_strain], r.sea.store.extra_planes[of_strain],
              r.extra[of_strain]);
  for (std::size_t b = 0; b < r.bundles.size(); ++b) {
    Uses uses = of_groups(r.bundles[b], writes, r.stress);
    for (const int g : r.bundles[b])
      uses.push_back(reads(r.extra[of_strain][std::size_t(g)])), uses.push_back(reads(r.planes[std::size_t(g)]));
    uses.push_back(reads(r.order)), uses.push_back(reads(r.plan));
    r.graph.task(task_name("stress", b), uses, r.if_active([&sea = r.sea, &groups = r.bundles[b]] {
      for (const int g : groups) apply_stress(sea.store, sea.store.extra_sums[of_strain], sea.p, g);
    }));
  }
  halo_.record(r, "stress/halo", HaloOf::stress);
}

/// Pairs of each group with itself and its forward neighbours. Sums are updated in the order of recording, colour by colour, and
/// what each row carried to the next is added last: the same bits for any number of threads and ranks, and whatever is bundled.
template <int dim, class Real>
void StepTasks<dim, Real>::sweep_pairs(const std::string& label, const Sweep& sweep, Array<Real>& sums, int planes,
                                       const GroupData& data, bool with_stress) {
  auto& r = recording_;
  const auto to = [&sums, &carried = r.sea.store.carried, stride = std::size_t(r.sea.store.carried_planes()) * cluster_size] {
    return SweepSums<Real>{sums.data(), carried.data(), stride};
  };
  for (std::size_t b = 0; b < r.pair_bundles.size(); ++b) {
    Uses uses = {reads(r.order), reads(r.plan)};
    const auto touch = [&](int g, const GroupData& adds_to) {
      uses.push_back(reads(r.planes[std::size_t(g)])), uses.push_back(reads(r.walls[std::size_t(g)]));
      if (with_stress) uses.push_back(reads(r.stress[std::size_t(g)]));
      if (r.sea.subdomain.owns(g)) uses.push_back(updates(adds_to[std::size_t(g)]));
    };
    for (const int g : r.pair_bundles[b]) {
      touch(g, data);
      r.sea.columns.for_forward(g, [&](const Neighbour<dim>& near) {
        if (r.sea.subdomain.owns(g) || r.sea.subdomain.owns(near.group)) touch(near.group, near.in_next_row ? r.carried : data);
      });
    }
    const auto work = [&sea = r.sea, &groups = r.pair_bundles[b], &lists = neighbour_lists_, &sweep, to](const Context& context,
                                                                                                         int) {
      NeighbourLists<dim, Real>& mine = lists[std::size_t(context.thread)];
      mine.reserve(9 * sea.store.longest);
      for (const int g : groups) sweep(to(), g, mine);
    };
    runtime::set_in_parts(r.graph, r.graph.task(task_name(label, b), uses, r.if_active(work)));
  }
  for (std::size_t b = 0; b < r.bundles.size(); ++b) {
    Uses uses = of_groups(r.bundles[b], updates, data);
    for (const int g : r.bundles[b]) uses.push_back(updates(r.carried[std::size_t(g)]));
    uses.push_back(reads(r.order)), uses.push_back(reads(r.plan));
    r.graph.task(task_name(label + "/join", b), uses, r.if_active([&sea = r.sea, &groups = r.bundles[b], to, planes] {
      for (const int g : groups) join_carried(sea.store, to(), g, std::size_t(planes) * cluster_size);
    }));
  }
}

/// Largest speed and acceleration of all ranks, and what they allow.
template <int dim, class Real>
void StepTasks<dim, Real>::limits() {
  auto& r = recording_;
  SeaState<dim, Real>& sea = r.sea;
  for (std::size_t b = 0; b < r.bundles.size(); ++b) {
    Uses uses = of_groups(r.bundles[b], reads, r.state);
    for (const int g : r.bundles[b]) uses.push_back(reads(r.sums[std::size_t(g)]));
    uses.push_back(reads(r.order)), uses.push_back(reads(r.plan)), uses.push_back(writes(extremes_data_[b]));
    r.graph.task(task_name("extremes", b), uses, r.if_active([&sea, &groups = r.bundles[b], to = &extremes_[extremes_size * b]] {
      Extremes most;
      for (const int g : groups) most.merge(extremes(sea.store, sea.p, g));
      to[0] = most.speed2, to[1] = most.acceleration2, to[2] = sea.plan.shifted;
      to[3] = runtime::StopRequest::asked() ? 1.0 : 0.0;
    }));
  }
  const Datum result = r.graph.datum();
  r.graph.reduce("sea/limits", {reads(extremes_data_), writes(result)}, {runtime::Reduction::Operation::max, extremes_, most_});
  r.graph.task("sea/limits", {reads(result), updates(r.plan)}, [&sea, &most = most_] {
    if (sea.plan.ended()) return;
    sea.plan.check_limits(sea.p, sea.body_limit, most[0], most[1], most[2]);
    sea.plan.stopped = most[3] > 0.0;
  });
}

template <int dim, class Real>
void StepTasks<dim, Real>::correct() {
  auto& r = recording_;
  for (std::size_t b = 0; b < r.bundles.size(); ++b) {
    Uses uses = of_groups(r.bundles[b], updates, r.state);
    for (const int g : r.bundles[b])
      uses.push_back(reads(r.planes[std::size_t(g)])), uses.push_back(reads(r.sums[std::size_t(g)]));
    uses.push_back(reads(r.order)), uses.push_back(reads(r.plan));
    r.graph.task(task_name("correct", b), uses, r.if_active([&sea = r.sea, &groups = r.bundles[b]](const Context&, int n) {
      const bool join = (sea.plan.steps + n) % sea.p.verlet_join_every == 0;
      const double dt = sea.plan.dt_of(n);
      for (const int g : groups) {
        sea.energy.add_from_task(energy_flow(sea.store, sea.p, g, dt));
        if (sea.p.step == StepChoice::verlet) {
          sea.energy.add_from_task(energy_of_solids(sea.store, sea.p, g, 0.5 * dt));
          correct_verlet(sea.store, sea.p, g, dt, join);
        } else {
          correct_symplectic(sea.store, sea.p, g, dt);
        }
        if (!sea.damping.acts()) continue;
        const double end = sea.plan.time + n * sea.plan.dt + dt;
        sea.energy.add_from_task(damp(sea.store, sea.p, sea.damping, end, dt, g));
      }
    }));
  }
}

/// A sweep of its own after the step: planes at n + 1, pair sums, and what each group makes of them (returning how far it moved
/// its particles).
template <int dim, class Real>
void StepTasks<dim, Real>::extra_sweep(std::size_t which, const std::string& label, const Sweep& sweep,
                                       std::function<bool(int step)> due, std::function<double(int group, int step)> apply) {
  auto& r = recording_;
  r.due = std::move(due);
  clear_sums(r, which, label);
  show_planes(Half::begin, label + "/halo");
  sweep_pairs(label, sweep, r.sea.store.extra_sums[which], r.sea.store.extra_planes[which], r.extra[which]);
  for (std::size_t b = 0; b < r.bundles.size(); ++b) {
    Uses uses = of_groups(r.bundles[b], updates, r.state);
    for (const int g : r.bundles[b]) uses.push_back(reads(r.extra[which][std::size_t(g)]));
    uses.push_back(reads(r.order)), uses.push_back(reads(r.plan));
    r.graph.task(task_name(label + "/apply", b), uses,
                 r.if_active([&groups = r.bundles[b], &plan = r.sea.plan, apply](const Context&, int n) {
                   double farthest = 0.0;
                   for (const int g : groups) farthest = std::max(farthest, apply(g, n));
                   // This rank's until the next check of the limits takes the maximum of all; a maximum needs no order.
                   const std::atomic_ref<double> shifted(plan.shifted);
                   for (double before = shifted.load(); before < farthest && !shifted.compare_exchange_weak(before, farthest);) {}
                 }));
  }
  r.due = {};
}

template <int dim, class Real>
void StepTasks<dim, Real>::filters() {
  SeaState<dim, Real>& sea = recording_.sea;
  if (sweeps_.filter)
    extra_sweep(
        0, "filter", sweeps_.filter, [&sea](int n) { return (sea.plan.steps + n + 1) % sea.p.filter_every == 0; },
        [&sea](int g, int) {
          sea.p.filter == FilterChoice::mls ? apply_mls(sea.store, sea.store.extra_sums[0], g)
                                            : apply_shepard(sea.store, sea.store.extra_sums[0], g);
          return 0.0;
        });
  if (sweeps_.shifting)
    extra_sweep(1, "shifting", sweeps_.shifting, {},
                [&sea](int g, int n) { return apply_shifting(sea.store, sea.store.extra_sums[1], sea.p, g, sea.plan.dt_of(n)); });
}

// One dimension and one precision at a time: SPINDRIFT_SPH_DIM and _REAL come from CMakeLists.txt, which compiles this file for
// each.
template class StepTasks<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>;

}  // namespace spindrift::sph
