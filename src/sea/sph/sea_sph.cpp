// The facade over the tasks: see sea_sph.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/sea_sph.hpp"

#include <omp.h>

#include <string>

#include "runtime/partition/partition.hpp"

namespace spindrift::sph {

namespace {

/// Ghost nodes may see no farther than two columns: so far reach the uses of tasks and the halos of ranks. Widens columns for
/// those that lie far in.
template <int dim>
Parameters with_room_for_ghosts(Parameters p, const SeedStream<dim>& seeds) {
  double farthest = 0.0;
  seeds.for_each([&](std::size_t, const Seed<dim>& seed) {
    for (int k = 0; k < dim - 1; ++k) farthest = std::max(farthest, std::abs(seed.ghost[k]));
  });
  const double least = p.reach() + 2.0 * p.drift();
  p.column_over_reach = std::max(p.column_over_reach, 0.5 * (farthest + least) / least);
  return p;
}

}  // namespace

template <int dim, class Real>
SeaSph<dim, Real>::SeaSph(const Parameters& parameters, const Domain<dim>& domain, const SeedStream<dim>& seeds,
                          Resources resources)
    : resources_(std::move(resources)),
      comm_(resources_.comm),
      s_(with_room_for_ghosts(parameters, seeds), domain),
      particles_(seeds.size()) {
  if (resources_.threads <= 0) resources_.threads = omp_get_max_threads();
  std::vector<int> rank_of_group = resources_.rank_of_group;
  if (rank_of_group.empty()) {
    std::vector<GroupCount> counts(std::size_t(s_.columns.groups()));
    for (int g = 0; g < s_.columns.groups(); ++g) counts[std::size_t(g)] = {g, 0, 0};
    seeds.for_each([&](std::size_t, const Seed<dim>& seed) {
      if (!domain.contains(seed.position)) return;
      GroupCount& count = counts[std::size_t(s_.columns.group(seed.position))];
      ++(seed.owner == 0 ? count.water : count.solid);
    });
    for (GroupCount& c : counts)
      c.water = (c.water + cluster_size - 1) / cluster_size, c.solid = (c.solid + cluster_size - 1) / cluster_size;
    rank_of_group =
        comm_.size() == 1
            ? std::vector<int>(counts.size(), 0)
            : runtime::partition_blocks(block_graph(s_.columns, counts), {.ranks = comm_.size()}, comm_.get()).rank_of_block;
  }
  s_.ghosts = Ghosts<dim>(seeds);
  set_territory(std::move(rank_of_group));
  sweeps_ = sweeps_over(s_);
  fill(s_.store, seeds, s_.columns, s_.subdomain, comm_.get(), s_.p.anchor_step());
  if (s_.p.step == StepChoice::verlet) s_.store.v_before = s_.store.v, s_.store.deviation_before = s_.store.deviation;
}

template <int dim, class Real>
void SeaSph<dim, Real>::set_territory(std::vector<int> rank_of_group) {
  if (rank_of_group.size() != std::size_t(s_.columns.groups()))
    throw std::invalid_argument("sea: ranks are given for " + std::to_string(rank_of_group.size()) + " groups of " +
                                std::to_string(s_.columns.groups()));
  forget_programs();
  s_.subdomain = subdomain_of(s_.columns, std::move(rank_of_group), comm_.rank(), s_.ghosts.empty() ? 1 : 2);
}

template <int dim, class Real>
void SeaSph<dim, Real>::forget_programs() {
  for (auto* program : {&sort_, &begin_, &half_, &end_, &window_}) program->reset();
}

/// Records where that has not been done, runs, and throws what the numerics found wrong.
template <int dim, class Real>
template <class Record>
void SeaSph<dim, Real>::run(std::unique_ptr<Program>& program, Record&& record) {
  if (!program) {
    runtime::Graph graph(comm_.get());
    auto tasks = std::make_unique<StepTasks<dim, Real>>(s_, sweeps_, driver_, graph, resources_.threads);
    record(*tasks);
    const bool is_window = &program == &window_;
    program.reset(
        new Program{std::move(tasks), runtime::Executor(std::move(graph), {.threads = resources_.threads,
                                                                           .records = is_window ? resources_.records : 0,
                                                                           .random_schedule = resources_.random_schedule})});
  }
  program->executor.run();
  if (s_.plan.failure) throw NumericalFailure(*s_.plan.failure);
}

template <int dim, class Real>
void SeaSph<dim, Real>::sort() {
  s_.plan.sort = true;
  run(sort_, [](StepTasks<dim, Real>& tasks) { tasks.sort(); });
}

template <int dim, class Real>
void SeaSph<dim, Real>::sort_if_due() {
  if (s_.plan.sort_is_due(s_.p.drift())) sort();
}

template <int dim, class Real>
void SeaSph<dim, Real>::evaluate() {
  sort_if_due();
  s_.plan.planned = 1;
  run(begin_, [](StepTasks<dim, Real>& tasks) {
    tasks.evaluate(Half::begin);
    tasks.limits();
  });
  gather_contacts();
}

template <int dim, class Real>
double SeaSph<dim, Real>::step_limit() {
  evaluate();
  return s_.plan.limit;
}

template <int dim, class Real>
void SeaSph<dim, Real>::start_step(double dt) {
  s_.plan.start_steps(dt, 1);
  s_.plan.shifted = 0.0;
}

template <int dim, class Real>
double SeaSph<dim, Real>::begin_step(double dt_max) {
  start_step(std::min(step_limit(), dt_max));
  return s_.plan.dt;
}

template <int dim, class Real>
void SeaSph<dim, Real>::half_step() {
  if (s_.p.step == StepChoice::verlet) return;
  run(half_, [](StepTasks<dim, Real>& tasks) { tasks.evaluate(Half::middle); });
  gather_contacts();
}

template <int dim, class Real>
void SeaSph<dim, Real>::end_step() {
  run(end_, [](StepTasks<dim, Real>& tasks) {
    tasks.correct();
    tasks.filters();
  });
  s_.plan.left = s_.plan.dt;
  s_.plan.finish_steps(driver_.steps, s_.p.step, s_.work);
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
  run(window_, [](StepTasks<dim, Real>& tasks) { tasks.window(); });
  if (window_->tasks->outdated()) window_ = nullptr;
  if (comm_.size() > 1) repartition();
}

template <int dim, class Real>
void SeaSph<dim, Real>::set_step_control(StepControl step_control) {
  if (step_control.steps_per_check < 1 || step_control.dt < 0.0)
    throw std::invalid_argument("sea: a step_control needs steps_per_check >= 1 and dt >= 0");
  driver_.steps = std::move(step_control);
  window_ = nullptr;
}

template <int dim, class Real>
void SeaSph<dim, Real>::set_bodies(MoveBodies move) {
  driver_.move_bodies = std::move(move);
  window_ = nullptr;
}

template <int dim, class Real>
void SeaSph<dim, Real>::add_body(std::uint16_t owner, const Motion& motion, double mass) {
  s_.solids.push_back(solid_from(s_.store, owner, motion, comm_.get()));
  forget_programs();
  if (mass <= 0.0) return;
  const Solid& solid = s_.solids.back();
  s_.free.push_back(box_of<dim>(solid, motion));
  s_.body_limit = std::min(s_.body_limit, body_step_limit(solid, mass, s_.p, dim));
}

/// One list of contacts from those of all groups, in the order of groups.
template <int dim, class Real>
void SeaSph<dim, Real>::gather_contacts() {
  if (!s_.has_contacts()) return;
  struct Part {
    int group;
    std::uint16_t on, of;
    std::array<double, 6> load;
  };
  runtime::Packer mine;
  for (const int g : s_.subdomain.own)
    for (const Touch& touch : s_.touches[std::size_t(g)]) {
      const Eigen::Vector3d &f = touch.wrench.force, &m = touch.wrench.moment;
      mine.put_one(Part{g, touch.on, touch.of, {f[0], f[1], f[2], m[0], m[1], m[2]}});
    }
  std::vector<Part> parts;
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm_.get(), mine.take()))
    for (runtime::Unpacker from(bytes); !from.done();) parts.push_back(from.one<Part>());
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.group < b.group; });
  contacts_.clear();
  for (const Part& part : parts) {
    auto known =
        std::find_if(contacts_.begin(), contacts_.end(), [&](const Touch& t) { return t.on == part.on && t.of == part.of; });
    if (known == contacts_.end()) known = contacts_.insert(known, Touch{part.on, part.of, {}});
    for (int k = 0; k < 3; ++k)
      known->wrench.force[k] += part.load[std::size_t(k)], known->wrench.moment[k] += part.load[std::size_t(3 + k)];
  }
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
  for (Solid& solid : s_.solids) {
    if (solid.owner != owner) continue;
    s_.set_motion(solid, motion);
    for (const int g : s_.subdomain.own) place(s_.store, s_.columns.domain(), solid, g);
  }
}

template <int dim, class Real>
Wrench SeaSph<dim, Real>::load_on(std::uint16_t owner, const Eigen::Vector3d& about) const {
  struct Part {
    int group;
    std::array<double, 6> load;
  };
  runtime::Packer mine;
  for (const int g : s_.subdomain.own) {
    const Wrench w = load(s_.store, owner, s_.p.mass(dim), about, g);
    if (w.force != Eigen::Vector3d::Zero() || w.moment != Eigen::Vector3d::Zero())
      mine.put_one(Part{g, {w.force[0], w.force[1], w.force[2], w.moment[0], w.moment[1], w.moment[2]}});
  }
  std::vector<Part> parts;
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm_.get(), mine.take()))
    for (runtime::Unpacker from(bytes); !from.done();) parts.push_back(from.one<Part>());
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.group < b.group; });
  Wrench total{.point = about};
  for (const Part& part : parts)
    for (int k = 0; k < 3; ++k) total.force[k] += part.load[std::size_t(k)], total.moment[k] += part.load[std::size_t(3 + k)];
  return total;
}

template <int dim, class Real>
void SeaSph<dim, Real>::add_sensor(Patch patch) {
  s_.records.emplace_back(patch.mean_over);
  s_.patches.push_back(std::move(patch));
  forget_programs();
}

template <int dim, class Real>
void SeaSph<dim, Real>::read_sensors() {
  for (std::size_t n = 0; n < s_.patches.size(); ++n) {
    if (!s_.records[n].empty()) continue;
    const Patch& patch = s_.patches[n];
    runtime::Packer mine;
    std::vector<double> part(sums_of(patch)), sums(part.size(), 0.0);
    for (const int g : groups_near(patch, s_.solids, s_.columns, s_.p.reach() + 2.0 * s_.p.drift())) {
      if (!s_.subdomain.owns(g)) continue;
      read_patch(s_.store, s_.p, s_.columns.domain(), patch, s_.solids, g, std::span<double>(part));
      mine.put_one(g), mine.put(std::span<const double>(part));
    }
    std::vector<std::pair<int, std::vector<double>>> parts;
    for (const runtime::Bytes& bytes : runtime::exchange_all(comm_.get(), mine.take()))
      for (runtime::Unpacker from(bytes); !from.done();) {
        const int g = from.one<int>();
        parts.emplace_back(g, from.many<double>());
      }
    std::sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [g, values] : parts)
      for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += values[k];
    s_.records[n].add(0.0, reading_of(patch, sums));
  }
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
std::vector<GroupCount> SeaSph<dim, Real>::counts() const {
  runtime::Packer mine;
  for (const int g : s_.subdomain.own) {
    const Group& group = s_.store.groups[std::size_t(g)];
    mine.put_one(GroupCount{g, int(group.solid - group.fluid), int(group.end - group.solid)});
  }
  std::vector<GroupCount> all;
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm_.get(), mine.take()))
    for (runtime::Unpacker from(bytes); !from.done();) all.push_back(from.one<GroupCount>());
  return all;
}

template <int dim, class Real>
double SeaSph<dim, Real>::imbalance() const {
  return runtime::partition_quality(block_graph(s_.columns, counts()), s_.subdomain.rank_of_group, comm_.size()).imbalance[0];
}

template <int dim, class Real>
bool SeaSph<dim, Real>::repartition() {
  const runtime::BlockGraph graph = block_graph(s_.columns, counts());
  const auto now = runtime::partition_quality(graph, s_.subdomain.rank_of_group, comm_.size());
  if (now.imbalance[0] <= resources_.repartition_above) return false;
  const runtime::Partition better = runtime::partition_blocks(graph, {.ranks = comm_.size()}, comm_.get());
  if (better.quality.imbalance[0] > 0.9 * now.imbalance[0]) return false;  // not worth the move
  return repartition(better.rank_of_block);
}

template <int dim, class Real>
bool SeaSph<dim, Real>::repartition(std::vector<int> rank_of_group) {
  if (rank_of_group == s_.subdomain.rank_of_group) return false;
  std::vector<runtime::Bytes> parcels;
  for (int r = 0; r < comm_.size(); ++r) {
    std::vector<int> theirs;
    for (const int g : s_.subdomain.own)
      if (rank_of_group.at(std::size_t(g)) == r) theirs.push_back(g);
    runtime::Packer packer;
    save_groups(s_, theirs).put(packer);
    parcels.push_back(packer.take());
  }
  std::vector<Saved<dim>> pieces;
  for (const runtime::Bytes& bytes : runtime::exchange(comm_.get(), parcels)) {
    runtime::Unpacker from(bytes);
    pieces.push_back(Saved<dim>::take(from));
  }
  set_territory(std::move(rank_of_group));
  const EnergyFlow mine = s_.energy;  // sums over ranks do not know whose groups they came from
  restore(pieces);
  s_.energy = mine;
  return true;
}

// One dimension and one precision at a time: SPINDRIFT_SPH_DIM and _REAL come from CMakeLists.txt, which compiles this file for
// each.
template class SeaSph<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>;

}  // namespace spindrift::sph
