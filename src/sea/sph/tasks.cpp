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

constexpr std::size_t clusters_per_pass = 256;  // of a bundle for sweeps that touch each particle once: 50 us
constexpr std::size_t clusters_per_pairs = 24;  // of a bundle for pair sweeps: 100 us; a column in 3-D has more by itself
constexpr std::size_t groups_per_bundle = 64;   // of empty columns, which may fill: no bundle spans the scene

/// Consecutive groups with about `wanted` clusters.
template <int dim, class Real>
void bundle(const Store<dim, Real>& store, const std::vector<int>& groups, std::size_t wanted,
            std::vector<std::vector<int>>& into) {
  std::size_t clusters = wanted;
  for (const int g : groups) {
    if (clusters >= wanted || into.back().size() >= groups_per_bundle) into.emplace_back(), clusters = 0;
    into.back().push_back(g);
    clusters += store.groups[std::size_t(g)].end - store.groups[std::size_t(g)].fluid;
  }
}

}  // namespace

template <int dim, class Real>
struct StepTasks<dim, Real>::Shared {
  Shared(SeaState<dim, Real>& sea) : sorting(sea.store, sea.columns, sea.subdomain, sea.p.anchor_step()) {}
  Sorting<dim, Real> sorting;
  std::vector<NeighbourLists<dim, Real>> neighbour_lists;  // one per thread
  std::vector<double> extremes;  // partials by bundle: speed, acceleration (squares), way by shifting, a request to stop
  double extreme[4] = {};
  std::vector<double> partial_loads, loads;        // by body group and body: force, moment
  std::vector<double> partial_readings, readings;  // by group near a sensor: sums of all patches (sensors.hpp)
  struct Message {
    std::vector<Real> out, in;
    bool active = false;
  };
  std::vector<std::unique_ptr<Message>> messages;
  std::vector<Wrench> wrenches;
  std::vector<Touch> contacts;
  std::vector<Motion> motions;
};

template <int dim, class Real>
StepTasks<dim, Real>::StepTasks(SeaState<dim, Real>& sea, const Sweeps<dim, Real>& sweeps, const StepDriver& driver,
                                runtime::Graph& graph, int threads, int first_tag)
    : sea_(sea),
      sweeps_(sweeps),
      driver_(driver),
      graph_(graph),
      next_tag_(first_tag),
      path_(sea.plan.solid_path),
      shared_(std::make_shared<Shared>(sea)) {
  const Subdomain& subdomain = sea.subdomain;
  sea.touches.resize(std::size_t(sea.columns.groups()));
  shared_->neighbour_lists.resize(std::size_t(threads));
  bundle(sea.store, subdomain.own, clusters_per_pass, bundles_);
  std::vector<std::vector<int>> colours(std::size_t(sea.columns.colours()));
  for (int g = 0; g < sea.columns.groups(); ++g) {
    bool swept = subdomain.owns(g);  // a group of another rank is swept for its pairs with mine
    sea.columns.for_forward(g, [&](const Neighbour<dim>& near) { swept = swept || subdomain.owns(near.group); });
    if (swept) colours[std::size_t(sea.columns.colour(g))].push_back(g);
  }
  for (const std::vector<int>& colour : colours) bundle(sea.store, colour, clusters_per_pairs, pair_bundles_);

  order_ = graph.datum(), plan_ = graph.datum(), loads_ = graph.datum();
  // Places follow the own groups, so that a thread keeps its region; groups of the halo have none.
  for (Data* data : {&state_, &planes_, &walls_, &sums_, &stress_, &touches_, &extra_[0], &extra_[1], &extra_[2]}) {
    data->resize(std::size_t(sea.columns.groups()));
    for (std::size_t n = 0; n < subdomain.own.size(); ++n)
      (*data)[std::size_t(subdomain.own[n])] = graph.datum(float(n) / float(subdomain.own.size()));
    for (const Subdomain::Border& border : subdomain.borders)
      for (const int g : border.seen) (*data)[std::size_t(g)] = graph.datum();
  }
  for (const int g : subdomain.own) {
    const Group& group = sea.store.groups[std::size_t(g)];
    const std::size_t of_plane = (group.end - group.fluid) * cluster_size * sizeof(Real);
    for (const Data* data : {&planes_, &walls_}) runtime::set_bytes(graph, (*data)[std::size_t(g)], pack_planes<dim> * of_plane);
    runtime::set_bytes(graph, stress_[std::size_t(g)], sea.store.stress_planes * of_plane);
  }
  extremes_ = graph.data(bundles_.size());
  shared_->extremes.resize(4 * bundles_.size());
  find_bodies();
  find_sensors();
}

template <int dim, class Real>
void StepTasks<dim, Real>::find_bodies() {
  SeaState<dim, Real>& sea = sea_;
  const Subdomain& subdomain = sea.subdomain;
  if (!driver_.move_bodies) return;
  // Bodies load the groups they are in and two rings round these: path_limit sees to it that none goes farther.
  std::vector<std::uint8_t> region(std::size_t(sea.columns.groups()), 0);
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
    if (region[std::size_t(g)] > 0) body_groups_.push_back(g);
  if (sea.has_contacts())
    for (int on = 1; on < sea.store.owners; ++on)
      for (int of = on + 1; of < sea.store.owners; ++of)
        if (std::any_of(sea.free.begin(), sea.free.end(), [&](const auto& box) { return box.owner == on || box.owner == of; }))
          touching_.emplace_back(on, of);
  partial_loads_ = graph_.data(body_groups_.size());
  shared_->loads.resize(6 * (sea.solids.size() + touching_.size()));
  shared_->partial_loads.resize(shared_->loads.size() * body_groups_.size());
}

/// The own groups that sensors have to do with: those near, of a body all that it may come into.
template <int dim, class Real>
void StepTasks<dim, Real>::find_sensors() {
  const SeaState<dim, Real>& sea = sea_;
  std::size_t sums = 0;
  for (const Patch& patch : sea.patches) {
    sums += sums_of(patch);
    if (body_of(patch, sea.solids) && driver_.move_bodies)
      sensor_groups_.insert(sensor_groups_.end(), body_groups_.begin(), body_groups_.end());
    else
      for (const int g : groups_near(patch, sea.solids, sea.columns, sea.p.reach() + 2.0 * sea.p.drift()))
        if (sea.subdomain.owns(g)) sensor_groups_.push_back(g);
  }
  std::sort(sensor_groups_.begin(), sensor_groups_.end());
  sensor_groups_.erase(std::unique(sensor_groups_.begin(), sensor_groups_.end()), sensor_groups_.end());
  partial_readings_ = graph_.data(sensor_groups_.size());
  records_ = graph_.datum();
  shared_->readings.resize(sums);
  shared_->partial_readings.resize(sums * sensor_groups_.size());
}

/// Sort where it is due, look at the limits, step; until the window is over.
template <int dim, class Real>
void StepTasks<dim, Real>::window() {
  SeaState<dim, Real>& sea = sea_;
  graph_.loop("sea/looks", {.min = 1, .urgency = 1}, [&] {
    graph_.task("sea/order", {updates(plan_)},
                [&sea] { sea.plan.sort = sea.plan.sort_is_due(sea.p.drift()) && !sea.plan.ended(); });
    sort();
    steps(true);
    if (driver_.steps.steps_per_check > 1)
      graph_.repeat("sea/substeps", std::uint32_t(driver_.steps.steps_per_check - 1), [&] { steps(false); });
    graph_.task("sea/clock", {updates(plan_)},
                [&sea, &driver = driver_] { sea.plan.finish_steps(driver.steps, sea.p.step, sea.work); });
    graph_.until("sea/until", {reads(plan_)}, [&sea] { return !(sea.plan.left > 0.0); });
  });
}

/// The first of the planned steps looks at the limits; the others go on.
template <int dim, class Real>
void StepTasks<dim, Real>::steps(bool first) {
  SeaState<dim, Real>& sea = sea_;
  if (first) {
    step_ = [](const Context&) { return 0; };
    // Nothing is planned before the look.
    graph_.task("sea/plan", {updates(plan_)}, [&sea] { sea.plan.planned = sea.plan.ended() ? 0 : 1; });
    evaluate(Half::begin);
    limits();
    graph_.task("sea/steps", {updates(plan_)}, [&sea, &driver = driver_] {
      sea.plan.choose_steps(driver.steps);
      sea.plan.shifted = 0.0;
    });
  } else {
    step_ = [](const Context& c) { return int(c.iteration) + 1; };
    graph_.task("sea/substep", {reads(plan_)}, [] {});  // a rank may have no group, a loop must have a task
    evaluate(Half::begin);
  }
  step();
}

template <int dim, class Real>
void StepTasks<dim, Real>::step() {
  if (sea_.p.step == StepChoice::verlet) sensors();
  bodies(Half::begin);
  if (sea_.p.step == StepChoice::symplectic) {
    evaluate(Half::middle);
    sensors();
    bodies(Half::middle);
  }
  correct();
  filters();
}

template <int dim, class Real>
void StepTasks<dim, Real>::evaluate(Half half) {
  pack(half);
  show("halo", false);
  set_walls();
  stress();
  sweep_pairs(
      "pairs", sweeps_.rates, [&store = sea_.store] { return store.sums.data(); }, sums_, bool(sweeps_.strain));
  contacts();
}

// ---- the parts ----

/// Tasks of steps that are not to be made, and of filters that are not due, do nothing.
template <int dim, class Real>
template <class Do>
std::function<void(const Context&)> StepTasks<dim, Real>::if_active(Do&& work) const {
  return [&plan = sea_.plan, step = step_, due = due_, work = std::forward<Do>(work)](const Context& context) {
    const int n = step(context);
    if (n >= plan.planned || plan.ended() || (due && !due(n))) return;
    if constexpr (std::is_invocable_v<Do, const Context&, int>)
      work(context, n);
    else
      work();
  };
}

template <int dim, class Real>
Uses StepTasks<dim, Real>::of_groups(const std::vector<int>& groups, runtime::Use (*how)(Datum), const Data& data) const {
  Uses uses;
  for (const int g : groups) uses.push_back(how(data[std::size_t(g)]));
  return uses;
}

template <int dim, class Real>
void StepTasks<dim, Real>::sort() {
  using S = Sorting<dim, Real>;
  const auto shared = shared_;
  SeaState<dim, Real>& sea = sea_;
  const auto part = graph_.data(std::size_t(S::parts));
  const auto serial = [&](const std::string& label, auto&& work) {
    graph_.task(label, {updates(order_), updates(plan_), updates(part)}, [&sea, shared, work] {
      if (sea.plan.sort) work(shared->sorting);
    });
  };
  const auto parallel = [&](const std::string& label, int count, auto&& work) {
    for (int n = 0; n < count; ++n)
      graph_.task(name(label, std::size_t(n)), {reads(order_), updates(part[std::size_t(n)])}, [&sea, shared, work, n] {
        if (sea.plan.sort) work(shared->sorting, n);
      });
  };
  const auto together = [&](const std::string& label, auto&& work) {
    graph_.collective(
        label, {updates(order_), updates(plan_), updates(part)}, [shared, work](MPI_Comm comm) { work(shared->sorting, comm); },
        [&sea] { return sea.plan.sort; });
  };
  serial("sea/sort/begin", [](S& s) { s.begin(); });
  parallel("sort/classify", S::parts, [](S& s, int n) { s.classify(n); });
  together("sea/sort/migrate", [](S& s, MPI_Comm comm) { s.migrate(comm); });
  parallel("sort/halve", S::parts, [](S& s, int n) { s.halve(n); });
  serial("sea/sort/lay_out", [](S& s) { s.lay_out(); });
  parallel("sort/reorder", shared->sorting.arrays(), [](S& s, int n) { s.reorder(n); });
  serial("sea/sort/anchors", [](S& s) { s.make_anchors(); });
  parallel("sort/anchor", S::parts, [](S& s, int n) { s.anchor(n); });
  together("sea/sort/show", [&sea](S& s, MPI_Comm comm) {
    s.show(comm);
    sea.sorted();
  });
}

/// Planes, boxes, cleared sums; in the middle of the step by the predictor.
template <int dim, class Real>
void StepTasks<dim, Real>::pack(Half half) {
  for (std::size_t b = 0; b < bundles_.size(); ++b) {
    Uses uses = {reads(order_), reads(plan_)};
    for (const int g : bundles_[b]) {
      const auto n = std::size_t(g);
      uses.push_back(reads(state_[n])), uses.push_back(writes(planes_[n])), uses.push_back(writes(walls_[n]));
      uses.push_back(updates(sums_[n]));
    }
    graph_.task(name(half == Half::begin ? "pack" : "predict", b), uses, if_active([&sea = sea_, &groups = bundles_[b], half] {
                  for (const int g : groups)
                    spindrift::sph::pack(sea.store, sea.p, g, half == Half::begin ? 0.0 : 0.5 * sea.plan.dt);
                }));
  }
}

/// Extrapolated walls take their density and velocity from the water in the columns beside them, modified ones from that round
/// their ghost nodes, up to two columns away.
template <int dim, class Real>
void StepTasks<dim, Real>::set_walls() {
  if (!sweeps_.boundary) return;
  const auto shared = shared_;
  std::vector<std::vector<int>> around(std::size_t(sea_.columns.groups()));
  for (int g = 0; g < sea_.columns.groups(); ++g)
    sea_.columns.for_forward(g, [&](const Neighbour<dim>& near) {
      around[std::size_t(g)].push_back(near.group), around[std::size_t(near.group)].push_back(g);
    });
  for (std::size_t b = 0; b < bundles_.size(); ++b) {
    Uses uses = {reads(order_), reads(plan_), reads(loads_)};
    for (const int g : bundles_[b]) {
      uses.push_back(updates(walls_[std::size_t(g)])), uses.push_back(updates(state_[std::size_t(g)]));
      uses.push_back(reads(planes_[std::size_t(g)]));
      for (const int near : around[std::size_t(g)]) {
        uses.push_back(reads(planes_[std::size_t(near)]));
        if (sea_.ghosts.empty()) continue;
        for (const int far : around[std::size_t(near)]) uses.push_back(reads(planes_[std::size_t(far)]));
      }
    }
    graph_.task(name("walls", b), uses,
                if_active([&sea = sea_, &sweeps = sweeps_, &groups = bundles_[b], shared](const Context& context, int) {
                  Candidates<dim, Real>& water = shared->neighbour_lists[std::size_t(context.thread)].water;
                  water.reserve((dim == 2 ? 5 : 25) * sea.store.longest);
                  for (const int g : groups) sweeps.boundary(sea.store, g, water);
                }));
  }
  show("walls/halo", false);
}

/// Sub-particle stress from a sweep of its own.
template <int dim, class Real>
void StepTasks<dim, Real>::stress() {
  if (!sweeps_.strain) return;
  clear(of_strain, "strain");
  sweep_pairs(
      "strain", sweeps_.strain, [&store = sea_.store] { return store.extra_sums[of_strain].data(); }, extra_[of_strain]);
  for (std::size_t b = 0; b < bundles_.size(); ++b) {
    Uses uses = of_groups(bundles_[b], writes, stress_);
    for (const int g : bundles_[b])
      uses.push_back(reads(extra_[of_strain][std::size_t(g)])), uses.push_back(reads(planes_[std::size_t(g)]));
    uses.push_back(reads(order_)), uses.push_back(reads(plan_));
    graph_.task(name("stress", b), uses, if_active([&sea = sea_, &groups = bundles_[b]] {
                  for (const int g : groups) apply_stress(sea.store, sea.store.extra_sums[of_strain], sea.p, g);
                }));
  }
  show("stress/halo", true);
}

/// Planes of groups at borders (or their stress) go to the ranks beside, as one message each.
template <int dim, class Real>
void StepTasks<dim, Real>::show(const std::string& what, bool stress) {
  using Message = typename Shared::Message;
  Store<dim, Real>& store = sea_.store;
  const std::size_t size = std::size_t(stress ? store.stress_planes : pack_planes<dim>) * cluster_size;
  const auto values = [&store, size, stress](std::uint32_t cluster) {
    return (stress ? store.stress.data() : store.pack.data()) + cluster * size;
  };
  const auto sizes = [&store, size](const std::vector<int>& groups) {
    std::size_t clusters = 0;
    for (const int g : groups) clusters += store.groups[std::size_t(g)].end - store.groups[std::size_t(g)].fluid;
    return clusters * size;
  };
  for (const Subdomain::Border& border : sea_.subdomain.borders) {
    const auto rank = std::size_t(border.rank);
    Message& message = *shared_->messages.emplace_back(std::make_unique<Message>());
    const Datum out = graph_.datum(), in = graph_.datum();
    Uses gather = of_groups(border.shown, reads, stress ? stress_ : planes_);
    for (const int g : border.shown) gather.push_back(reads(walls_[std::size_t(g)]));
    gather.push_back(reads(order_)), gather.push_back(reads(plan_)), gather.push_back(writes(out)), gather.push_back(writes(in));
    const auto fill = if_active([&store, &message, &border, sizes, values] {
      message.out.resize(sizes(border.shown)), message.in.resize(sizes(border.seen));
      Real* to = message.out.data();
      for (const int g : border.shown) {
        const Group& group = store.groups[std::size_t(g)];
        to = std::copy(values(group.fluid), values(group.end), to);
      }
    });
    graph_.task(name(what + "/gather", rank), gather, [&message, fill](const Context& context) {
      message.out.clear(), message.in.clear();  // nothing to say in steps that are not made
      fill(context);
    });
    const int tag = next_tag_;
    graph_.send(name(what + "/send", rank), {reads(out)},
                {border.rank, tag, [&message] { return std::as_writable_bytes(std::span(message.out)); }});
    graph_.receive(name(what + "/receive", rank), {updates(in)},
                   {border.rank, tag, [&message] { return std::as_writable_bytes(std::span(message.in)); }});
    Uses scatter = {reads(order_), reads(plan_), reads(in)};
    for (const int g : border.seen)
      for (const Data* data : {&planes_, &walls_, &sums_, &stress_, &extra_[0], &extra_[1], &extra_[2]})
        scatter.push_back(writes((*data)[std::size_t(g)]));
    graph_.task(name(what + "/scatter", rank), scatter, if_active([&store, &message, &border, size, stress, values] {
                  const Real* from = message.in.data();
                  for (const int g : border.seen) {
                    const Group& group = store.groups[std::size_t(g)];
                    for (std::size_t cluster = group.fluid; cluster < group.end; ++cluster, from += size) {
                      std::copy(from, from + size, values(std::uint32_t(cluster)));
                      if (stress) continue;
                      set_box(store, cluster);
                      std::fill_n(store.sums_of(cluster), sum_planes<dim> * cluster_size, Real(0));
                    }
                    if (stress) continue;
                    // Sums of the halo are of no use to anybody; they must only stay finite.
                    for (std::size_t n = 0; n < store.extra_sums.size(); ++n) {
                      const std::size_t extra = std::size_t(store.extra_planes[n]) * cluster_size;
                      std::fill_n(store.extra_sums[n].data() + group.fluid * extra, (group.end - group.fluid) * extra, Real(0));
                    }
                  }
                }));
  }
  ++next_tag_;
}

/// Pairs of each group with itself and its forward neighbours. Sums are updated in the order of recording, colour by colour: the
/// same bits for any number of threads and ranks, and whatever is bundled.
template <int dim, class Real>
void StepTasks<dim, Real>::sweep_pairs(const std::string& label, const Sweep& sweep, std::function<Real*()> sums,
                                       const Data& data, bool with_stress) {
  const auto shared = shared_;
  for (std::size_t b = 0; b < pair_bundles_.size(); ++b) {
    Uses uses = {reads(order_), reads(plan_)};
    const auto touch = [&](int g) {
      uses.push_back(reads(planes_[std::size_t(g)])), uses.push_back(reads(walls_[std::size_t(g)]));
      uses.push_back(updates(data[std::size_t(g)]));
      if (with_stress) uses.push_back(reads(stress_[std::size_t(g)]));
    };
    for (const int g : pair_bundles_[b]) {
      touch(g);
      sea_.columns.for_forward(g, [&](const Neighbour<dim>& near) {
        if (sea_.subdomain.owns(g) || sea_.subdomain.owns(near.group)) touch(near.group);
      });
    }
    graph_.task(name(label, b), uses,
                if_active([&sea = sea_, &groups = pair_bundles_[b], shared, &sweep, sums](const Context& context, int) {
                  NeighbourLists<dim, Real>& neighbour_lists = shared->neighbour_lists[std::size_t(context.thread)];
                  neighbour_lists.reserve(9 * sea.store.longest);
                  for (const int g : groups) sweep(sums(), g, neighbour_lists);
                }));
  }
}

/// Contacts of bodies with walls and with each other, listed by group; each pair by the rank that owns the group it belongs to.
template <int dim, class Real>
void StepTasks<dim, Real>::contacts() {
  if (!sea_.has_contacts()) return;
  for (std::size_t b = 0; b < bundles_.size(); ++b) {
    Uses uses = of_groups(bundles_[b], writes, touches_);
    for (const int g : bundles_[b]) {
      uses.push_back(reads(planes_[std::size_t(g)]));
      sea_.columns.for_forward(g, [&](const Neighbour<dim>& near) { uses.push_back(reads(planes_[std::size_t(near.group)])); });
    }
    uses.push_back(reads(order_)), uses.push_back(reads(plan_)), uses.push_back(reads(loads_));
    graph_.task(name("contacts", b), uses, if_active([&sea = sea_, &groups = bundles_[b], law = contact_law(sea_.p, dim)] {
                  for (const int g : groups) {
                    std::vector<Touch>& touches = sea.touches[std::size_t(g)];
                    touches.clear();
                    find_contacts(sea.store, sea.columns, sea.solids, sea.free, law, g, touches);
                  }
                }));
  }
}

/// Largest speed and acceleration of all ranks, and what they allow.
template <int dim, class Real>
void StepTasks<dim, Real>::limits() {
  const auto shared = shared_;
  SeaState<dim, Real>& sea = sea_;
  for (std::size_t b = 0; b < bundles_.size(); ++b) {
    Uses uses = of_groups(bundles_[b], reads, state_);
    for (const int g : bundles_[b]) uses.push_back(reads(sums_[std::size_t(g)]));
    uses.push_back(reads(order_)), uses.push_back(reads(plan_)), uses.push_back(writes(extremes_[b]));
    graph_.task(name("extremes", b), uses, if_active([&sea, &groups = bundles_[b], shared, b] {
                  Extremes most;
                  for (const int g : groups) most.merge(extremes(sea.store, sea.p, g));
                  double* to = &shared->extremes[4 * b];
                  to[0] = most.speed2, to[1] = most.acceleration2, to[2] = sea.plan.shifted;
                  to[3] = runtime::StopRequest::asked() ? 1.0 : 0.0;
                }));
  }
  const Datum result = graph_.datum();
  graph_.reduce("sea/limits", {reads(extremes_), writes(result)},
                {runtime::Reduction::Operation::max, shared->extremes, shared->extreme});
  graph_.task("sea/limits", {reads(result), updates(plan_)}, [&sea, shared] {
    if (sea.plan.ended()) return;
    sea.plan.check_limits(sea.p, sea.body_limit, shared->extreme[0], shared->extreme[1], shared->extreme[2]);
    sea.plan.stopped = shared->extreme[3] > 0.0;
  });
}

/// Loads of each body group by group, summed in the order of the groups; one task moves the bodies; their particles follow.
template <int dim, class Real>
void StepTasks<dim, Real>::bodies(Half half) {
  if (!driver_.move_bodies) return;
  const auto shared = shared_;
  SeaState<dim, Real>& sea = sea_;
  const std::size_t solids = sea.solids.size();
  const std::string when = half == Half::begin ? "begin" : "middle";
  for (std::size_t n = 0; n < body_groups_.size(); ++n) {
    const int g = body_groups_[n];
    graph_.task(name("load/" + when, std::size_t(g)),
                {reads(order_), reads(plan_), reads(loads_), reads(planes_[std::size_t(g)]), reads(sums_[std::size_t(g)]),
                 reads(touches_[std::size_t(g)]), writes(partial_loads_[n])},
                if_active([&sea, shared, &touching = touching_, g, n, solids] {
                  double* const mine = &shared->partial_loads[n * shared->loads.size()];
                  for (std::size_t s = 0; s < solids; ++s) {
                    const Solid& solid = sea.solids[s];
                    const Wrench w = load(sea.store, solid.owner, sea.p.mass(dim), solid.motion.position, g);
                    double* to = mine + 6 * s;
                    for (int k = 0; k < 3; ++k) to[k] = w.force[k], to[3 + k] = w.moment[k];
                  }
                  std::fill(mine + 6 * solids, mine + shared->loads.size(), 0.0);
                  if (touching.empty()) return;
                  for (const Touch& touch : sea.touches[std::size_t(g)]) {
                    const auto at =
                        std::find(touching.begin(), touching.end(), std::pair<int, int>(touch.on, touch.of)) - touching.begin();
                    double* to = mine + 6 * (solids + std::size_t(at));
                    for (int k = 0; k < 3; ++k) to[k] += touch.wrench.force[k], to[3 + k] += touch.wrench.moment[k];
                  }
                }));
  }
  const Datum sum = graph_.datum();
  graph_.reduce("sea/loads/" + when, {reads(partial_loads_), writes(sum)},
                {runtime::Reduction::Operation::sum, shared->partial_loads, shared->loads});
  graph_.task(
      "sea/bodies/" + when, {reads(sum), reads(plan_), updates(loads_)},
      if_active([&sea, &driver = driver_, shared, half, &touching = touching_, farthest = path_limit()](const Context&, int n) {
        shared->wrenches.clear(), shared->motions.clear(), shared->contacts.clear();
        for (std::size_t t = 0; t < touching.size(); ++t) {
          const double* from = &shared->loads[6 * (sea.solids.size() + t)];
          Touch touch{std::uint16_t(touching[t].first), std::uint16_t(touching[t].second), {}};
          for (int k = 0; k < 3; ++k) touch.wrench.force[k] = from[k], touch.wrench.moment[k] = from[3 + k];
          if (touch.wrench.force != Eigen::Vector3d::Zero()) shared->contacts.push_back(touch);
        }
        for (std::size_t s = 0; s < sea.solids.size(); ++s) {
          const double* from = &shared->loads[6 * s];
          Wrench w{.point = sea.solids[s].motion.position};
          for (int k = 0; k < 3; ++k) w.force[k] = from[k], w.moment[k] = from[3 + k];
          shared->wrenches.push_back(w), shared->motions.push_back(sea.solids[s].motion);
        }
        const Plan& plan = sea.plan;
        double begin = plan.time;
        for (int done = 0; done < n; ++done) begin += plan.dt;  // as the clock will add them up
        const bool last = half == Half::middle || sea.p.step == StepChoice::verlet;
        driver.move_bodies(
            {half == Half::begin ? 0 : 1, begin, begin + (last ? plan.dt : 0.5 * plan.dt), plan.dt, shared->contacts},
            shared->wrenches, shared->motions);
        for (std::size_t s = 0; s < sea.solids.size(); ++s) sea.set_motion(sea.solids[s], shared->motions[s]);
        if (plan.solid_path > farthest)
          sea.plan.failure =
              NumericalFailure("sea: bodies went " + in_words(plan.solid_path) + " m in one window, the limit is " +
                                   in_words(farthest) + " m (a column of cells and a half); shorten time.window_s",
                               "sea", plan.steps, plan.time, farthest);
      }));
  for (const int g : body_groups_)
    graph_.task(name("place/" + when, std::size_t(g)),
                {reads(order_), reads(plan_), reads(loads_), updates(state_[std::size_t(g)])}, if_active([&sea, g] {
                  for (const Solid& solid : sea.solids) place(sea.store, sea.columns.domain(), solid, g);
                }));
}

/// What the groups add to the sensors' patches, summed in the order of the groups, and noted for the length of the step.
template <int dim, class Real>
void StepTasks<dim, Real>::sensors() {
  if (sea_.patches.empty()) return;
  const auto shared = shared_;
  SeaState<dim, Real>& sea = sea_;
  for (std::size_t n = 0; n < sensor_groups_.size(); ++n) {
    const auto g = std::size_t(sensor_groups_[n]);
    graph_.task(name("sensors", g),
                {reads(order_), reads(plan_), reads(loads_), reads(planes_[g]), reads(sums_[g]), writes(partial_readings_[n])},
                if_active([&sea, shared, g, n] {
                  std::span<double> mine = std::span(shared->partial_readings).subspan(n * shared->readings.size());
                  for (const Patch& patch : sea.patches) {
                    read_patch(sea.store, sea.p, sea.columns.domain(), patch, sea.solids, int(g), mine.first(sums_of(patch)));
                    mine = mine.subspan(sums_of(patch));
                  }
                }));
  }
  const Datum sum = graph_.datum();
  graph_.reduce("sea/sensors", {reads(partial_readings_), writes(sum)},
                {runtime::Reduction::Operation::sum, shared->partial_readings, shared->readings});
  graph_.task("sea/sensors/note", {reads(sum), reads(plan_), updates(records_)}, if_active([&sea, shared] {
                std::span<const double> sums = shared->readings;
                for (std::size_t n = 0; n < sea.patches.size(); ++n) {
                  const std::size_t size = sums_of(sea.patches[n]);
                  sea.records[n].add(sea.plan.dt, reading_of(sea.patches[n], sums.first(size)));
                  sums = sums.subspan(size);
                }
              }));
}

template <int dim, class Real>
void StepTasks<dim, Real>::correct() {
  for (std::size_t b = 0; b < bundles_.size(); ++b) {
    Uses uses = of_groups(bundles_[b], updates, state_);
    for (const int g : bundles_[b]) uses.push_back(reads(planes_[std::size_t(g)])), uses.push_back(reads(sums_[std::size_t(g)]));
    uses.push_back(reads(order_)), uses.push_back(reads(plan_));
    graph_.task(name("correct", b), uses, if_active([&sea = sea_, &groups = bundles_[b]](const Context&, int n) {
                  const bool join = (sea.plan.steps + n) % sea.p.verlet_join_every == 0;
                  for (const int g : groups) {
                    sea.energy.add_from_task(energy_flow(sea.store, sea.p, g, sea.plan.dt));
                    if (sea.p.step == StepChoice::verlet)
                      correct_verlet(sea.store, sea.p, g, sea.plan.dt, join);
                    else
                      correct_symplectic(sea.store, sea.p, g, sea.plan.dt);
                    if (!sea.damping.acts()) continue;
                    sea.energy.add_from_task(damped_energy(sea.store, sea.p, sea.damping, sea.plan.dt, g));
                    const Group& group = sea.store.groups[std::size_t(g)];
                    damp(sea.store, sea.damping, sea.plan.dt, group.fluid, group.solid);
                  }
                }));
  }
}

/// A sweep of its own after the step: planes at n + 1, pair sums, and what each group makes of them (returning how far it moved
/// its particles).
template <int dim, class Real>
void StepTasks<dim, Real>::extra_sweep(std::size_t which, const std::string& label, const Sweep& sweep,
                                       std::function<bool(int step)> due, std::function<double(int group)> apply) {
  due_ = std::move(due);
  clear(which, label);
  pack(Half::begin);
  show(label + "/halo", false);
  set_walls();
  sweep_pairs(
      label, sweep, [&store = sea_.store, which] { return store.extra_sums[which].data(); }, extra_[which]);
  for (std::size_t b = 0; b < bundles_.size(); ++b) {
    Uses uses = of_groups(bundles_[b], updates, state_);
    for (const int g : bundles_[b]) uses.push_back(reads(extra_[which][std::size_t(g)]));
    uses.push_back(reads(order_)), uses.push_back(reads(plan_));
    graph_.task(name(label + "/apply", b), uses, if_active([&groups = bundles_[b], &plan = sea_.plan, apply] {
                  double farthest = 0.0;
                  for (const int g : groups) farthest = std::max(farthest, apply(g));
                  // This rank's until the next check of the limits takes the maximum of all; a maximum needs no order.
                  const std::atomic_ref<double> shifted(plan.shifted);
                  for (double before = shifted.load(); before < farthest && !shifted.compare_exchange_weak(before, farthest);) {}
                }));
  }
  due_ = {};
}

/// Empties the sums of a sweep that is not that of the rates (those are emptied by packing).
template <int dim, class Real>
void StepTasks<dim, Real>::clear(std::size_t which, const std::string& label) {
  for (std::size_t b = 0; b < bundles_.size(); ++b) {
    Uses uses = of_groups(bundles_[b], writes, extra_[which]);
    uses.push_back(reads(order_)), uses.push_back(reads(plan_));
    graph_.task(name(label + "/clear", b), uses, if_active([&store = sea_.store, &groups = bundles_[b], which] {
                  const std::size_t size = std::size_t(store.extra_planes[which]) * cluster_size;
                  Real* const sums = store.extra_sums[which].data();
                  for (const int g : groups) {
                    const Group& group = store.groups[std::size_t(g)];
                    std::fill(sums + group.fluid * size, sums + group.end * size, Real(0));
                  }
                }));
  }
}

template <int dim, class Real>
void StepTasks<dim, Real>::filters() {
  SeaState<dim, Real>& sea = sea_;
  if (sweeps_.filter)
    extra_sweep(
        0, "filter", sweeps_.filter, [&sea](int n) { return (sea.plan.steps + n + 1) % sea.p.filter_every == 0; },
        [&sea](int g) {
          sea.p.filter == FilterChoice::mls ? apply_mls(sea.store, sea.store.extra_sums[0], g)
                                            : apply_shepard(sea.store, sea.store.extra_sums[0], g);
          return 0.0;
        });
  if (sweeps_.shifting)
    extra_sweep(1, "shifting", sweeps_.shifting, {},
                [&sea](int g) { return apply_shifting(sea.store, sea.store.extra_sums[1], sea.p, g, sea.plan.dt); });
}

template <int dim, class Real>
double StepTasks<dim, Real>::path_limit() const {
  double edge = sea_.columns.edge(0);
  for (int k = 1; k < dim - 1; ++k) edge = std::min(edge, sea_.columns.edge(k));
  return path_ + 1.5 * edge;
}

template <int dim, class Real>
bool StepTasks<dim, Real>::outdated() const {
  return driver_.move_bodies && sea_.plan.solid_path > path_ + 0.5 * (path_limit() - path_);
}

// One dimension and one precision at a time: SPINDRIFT_SPH_DIM and _REAL come from CMakeLists.txt, which compiles this file for
// each.
template class StepTasks<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>;

}  // namespace spindrift::sph
