// SPDX-License-Identifier: Apache-2.0
#include "src/sea/particle_sea.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "kernels/base/binned_sum.hpp"
#include "kernels/sph/time_step.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "src/sea/particle_solids.hpp"
#include "src/sea/sph/bounds.hpp"
#include "src/sea/sph/by_identity.hpp"
#include "src/sea/sph/damping.hpp"
#include "src/sea/sph/gauges.hpp"
#include "src/sea/sph/lattice.hpp"
#include "src/sea/sph/sea_sph.hpp"
#include "src/sea/sph/tank_count.hpp"
#include "src/sea/wave_field.hpp"

namespace spindrift::sea {

using sph::Store;

namespace {

/// The plan's tank with the bodies where they start.
sph::TankPlan tank_with_bodies(const ParticlePlan& plan, std::span<const Motion> start) {
  sph::TankPlan tank = plan.tank;
  for (std::size_t b = 0; b < plan.bodies.size(); ++b)
    if (!plan.bodies[b].shapes.empty()) tank.bodies.push_back({plan.bodies[b].name, plan.bodies[b].shapes, start[b]});
  return tank;
}

/// Largest step of a floating body in explicit coupling, as SeaSph::add_body bounds it.
template <int dim>
double body_step_limit(const ParticleBody& body, const sph::TankCount::Body& of, const sph::Parameters& p, double share) {
  sph::Solid solid;
  for (const Eigen::Vector3d& x : of.points)
    solid.local.push_back(x), solid.low = solid.low.cwiseMin(x), solid.high = solid.high.cwiseMax(x);
  if (of.particles == double(of.points.size())) return sph::body_step_limit(solid, body.mass / share, p, dim);
  const double coarse = std::pow(of.cell, 1.0 / dim), relative_weight = body.mass / share / (of.particles * p.mass(dim));
  return 0.5 * sph::step_limit_body(relative_weight, solid.layers(coarse, dim) * coarse / p.spacing, p.spacing, p.eos.c0);
}

/// What a sensor of the scene reads.
template <int dim, class Real>
sph::Patch patch_of(const ParticlePlan& plan, const SensorOptions& sensor, const sph::SeaState<dim, Real>& sea,
                    const ParticleSolids<dim, Real>& solids) {
  const sph::Cut cut = plan.cut();
  const double d = plan.options.spacing_m;
  const auto solid = [&](std::uint16_t owner) -> const sph::Solid& {
    return *std::ranges::find(sea.solids, owner, &sph::Solid::owner);
  };
  sph::Patch patch;
  if (!sensor.body.empty()) {
    const auto named = std::ranges::find(plan.bodies, sensor.body, &ParticleBody::name);
    const Eigen::Vector3d& origin = named->described.position;
    patch = sph::patch_of_body(solid(solids.owner(std::size_t(named - plan.bodies.begin()))), named->shapes,
                               sensor.low_m - origin, sensor.high_m - origin, sea.p, cut);
  } else {
    const sph::TankPlan::Block box = sph::particles_of_rectangle(sensor.low_m, sensor.high_m, sea.p.reach());
    patch = {.owner = sph::wall_owner, .low = box.low, .high = box.high};
    patch.points = sph::points_of_rectangle(sensor.low_m, sensor.high_m, 0.5 * d, cut);
    if (plan.paddle && sensor.low_m[0] == plan.tank.x[0] && sensor.high_m[0] == plan.tank.x[0] &&
        sensor.high_m[2] > plan.paddle->paddle().hinge)
      sph::put_on_paddle(patch, solid(solids.owner_of_paddle()), plan.paddle->at_rest().position, cut);
  }
  patch.mean_over = sensor.mean_over_s;
  return patch;
}

sph::Damping damping_of(const ParticlePlan& plan) {
  sph::Damping damping;
  for (const DampingZoneOptions& z : plan.damping_zones)
    damping.zones.push_back({z.from_m, z.to_m, z.rate_1_s, z.axis == "y" ? 1 : 0, z.towards == "waves"});
  damping.waves = waves::grouped(plan.waves, plan.tank.depth);
  return damping;
}

template <int dim, class Real>
class Sea final : public ParticleSea {
 public:
  Sea(const ParticlePlan& plan, std::span<const Motion> start, sph::Parameters parameters, const sph::TankParticles<dim>& tank,
      const runtime::World& world)
      : share_(plan.share()),
        width_(dim == 2 ? plan.options.width_m : 1.0),
        settle_damping_(plan.settle_damping),
        comm_(world.comm),
        ranks_(world.size),
        sea_(parameters, tank.domain, tank.seeds, {.comm = world.comm}),
        particles_(tank.seeds.size()),
        solids_(sea_, plan, start, tank, plan.paddle) {
    sea_.state().damping = damping_of(plan);
    steps_.steps.steps_per_check = plan.options.limits_every;
    steps_.steps.choose = [this](double limit, int most) {
      const WindowDriver::Steps steps = driver_->choose(limit, most);
      return sph::StepControl::Choice{steps.dt, steps.last, steps.count, steps.last_dt};
    };
    const auto mine = sph::identities_of(particles_, world.rank, world.size);
    owner_.reserve(mine.last - mine.first);
    runtime::give_up_together(world.comm, [&] {
      tank.seeds.for_each(
          [&](std::size_t id, const sph::Seed<dim>& seed) {
            if (id >= mine.first && id < mine.last) owner_.push_back(seed.owner);
          },
          [&](const sph::SeedPart<dim>& part) { return part.first < mine.last && part.last > mine.first; });
    });
    for (const SensorOptions& sensor : plan.sensors) sea_.add_sensor(patch_of(plan, sensor, sea_.state(), solids_));
  }

  void place(double t, std::span<const Motion> bodies) override { solids_.place(t, bodies); }
  void evaluate(double t, std::span<const Motion> bodies) override {
    place(t, bodies);
    if (ranks_ > 1) sea_.repartition();
    sea_.sort();
    (void)sea_.step_limit();
    read_sensors(sea_.state(), comm_);
    solids_.take_loads();
  }

  void balance() override {
    if (ranks_ > 1 && sea_.repartition()) moved_ = true;
  }
  void record(runtime::Graph& graph, WindowDriver& driver, int first_tag) override {
    driver_ = &driver;
    if (moves_solids())
      steps_.move_bodies = [this](const sph::HalfStep& half, std::span<const Wrench> loads, std::span<Motion> motions) {
        solids_.move(*driver_, half, loads, motions);
      };
    tasks_.push_back(sea_.tasks(steps_, graph, omp_get_max_threads(), first_tag));
    tasks_.back()->window();
    moved_ = false;
  }
  bool moves_solids() const override { return !sea_.state().solids.empty(); }
  bool outdated() const override {
    return moved_ || std::any_of(tasks_.begin(), tasks_.end(), [](const auto& tasks) { return tasks->outdated(); });
  }
  void forget_tasks() override { tasks_.clear(); }
  void open(double t, std::span<const Motion> bodies, bool settling) override {
    sph::Damping& damping = sea_.state().damping;
    damping.everywhere = settling ? settle_damping_ : 0.0, damping.ahead = t - sea_.time(), t_ = t;
    place(t, bodies);
    sph::Plan& plan = sea_.state().plan;
    plan.left = 1.0;                               // until the driver calls a step the last
    plan.drift = 2.0 * sea_.parameters().drift();  // sorts first: what follows depends on the state alone
    plan.failure.reset(), plan.stopped = false;
    if (!balance_) balance_ = Balance{measured(), sea_.time(), made_before_J_};
    between_windows_ = false;
  }
  void close() override {
    if (sea_.state().plan.stopped) throw runtime::StopAsked();
    const std::optional<NumericalFailure>& failure = sea_.state().plan.failure;
    if (!failure) return solids_.require_inside(t_), require_bounded(), require_energy();
    // Who drives the window knows the scene's time, the sea its own.
    const std::string what = failure->what(), told = what.starts_with("t = ") ? "" : "t = " + in_words(t_) + " s: ";
    throw NumericalFailure(told + what, failure->place, failure->step, told.empty() ? failure->time_s : t_, failure->limit);
  }
  void take_snapshot(int slot) override {
    snapshots_[std::size_t(slot)] = {sea_.save(), solids_.state(), sea_.state().records, balance_};
  }
  void return_to(int slot) override {
    const Saved& n = snapshots_[std::size_t(slot)];
    sea_.restore(n.sea);
    solids_.set(n.solids), sea_.state().records = n.records, balance_ = n.balance, between_windows_ = true;
  }
  std::span<const Wrench> loads() const override { return solids_.state().loads; }
  std::span<const Wrench> contacts() const override { return solids_.state().contacts; }

  std::vector<double> surface(std::span<const std::array<double, 2>> places) const override {
    std::vector<std::array<double, dim - 1>> horizontal;
    for (const auto& place : places) {
      if constexpr (dim == 2)
        horizontal.push_back({place[0]});
      else
        horizontal.push_back(place);
    }
    const auto& domain = sea_.state().columns.domain();
    return sph::surface_heights<dim>(sea_.store(), sea_.parameters(), domain,
                                     std::span<const std::array<double, dim - 1>>(horizontal),
                                     std::numeric_limits<double>::quiet_NaN(), comm_);
  }
  Reading probe(const Eigen::Vector3d& at) const override {
    const auto reading =
        sph::probe<dim>(sea_.store(), sea_.parameters(), sea_.state().columns.domain(), sph::from_earth<dim>(at), comm_);
    return {reading.pressure, sph::to_earth<dim>(reading.velocity)};
  }
  sph::PatchReading sensor(std::size_t n) const override {
    sph::PatchReading reading = sea_.state().records[n].mean();
    reading.force *= width_;
    return reading;
  }
  sph::Wavemaker::Stroke paddle(double t) const override { return solids_.paddle(t); }

  Extent extent() const override { return balance_ && between_windows_ ? balance_->extent : measured(); }

  ParticleSample sample(const std::optional<Eigen::Vector3d>& low, const std::optional<Eigen::Vector3d>& high,
                        bool solids) const override {
    const sph::EosTait& eos = sea_.parameters().eos;
    using Vector = std::array<double, dim>;
    ParticleSample sample;
    sph::visit_by_identity(
        sea_, particles_, comm_,
        [&](std::uint16_t owner, const Vector& x) {
          if (owner != sph::water_owner && !solids) return false;
          const Eigen::Vector3d at = sph::to_earth<dim>(x);
          return (!low || (at.array() >= low->array()).all()) && (!high || (at.array() <= high->array()).all());
        },
        [&](std::size_t count) {
          sample.id.reserve(count), sample.position.reserve(3 * count), sample.velocity.reserve(3 * count);
          for (std::vector<double>* one : {&sample.pressure, &sample.density, &sample.owner}) one->reserve(count);
        },
        [&](std::uint32_t id, std::uint16_t owner, std::span<const double> values) {
          Vector x, v;
          for (int k = 0; k < dim; ++k) x[k] = values[k], v[k] = values[dim + k];
          const double deviation = values[2 * dim];
          const Eigen::Vector3d at = sph::to_earth<dim>(x), speed = sph::to_earth<dim>(v);
          sample.id.push_back(std::int64_t(id));
          for (int k = 0; k < 3; ++k) sample.position.push_back(at[k]), sample.velocity.push_back(speed[k]);
          sample.pressure.push_back(eos.pressure(deviation));
          sample.density.push_back(eos.rho0 + deviation);
          sample.owner.push_back(owner);
        });
    return sample;
  }

  ParticleState save() const override {
    ParticleState state = layout_without_values();
    state.values = sph::by_identity(sea_, particles_, comm_).values;
    for (const sph::PatchRecord& record : sea_.state().records) record.pack(state.sensors);
    state.energy = sea_.state().energy;
    state.made_J = balance_ ? balance_->made : made_before_J_;
    if (ranks_ > 1) {
      runtime::Packer mine;
      mine.put_one(std::exchange(state.energy, {}));
      for (const runtime::Bytes& bytes : runtime::exchange_all(comm_, mine.take()))
        state.energy = sum(state.energy, runtime::Unpacker(bytes).template one<sph::EnergyFlow>());
    }
    return state;
  }
  ParticleState layout() const override {
    ParticleState state = layout_without_values();
    const auto mine = sph::identities_of(particles_, runtime::rank_in(comm_), ranks_);
    state.values.resize((mine.last - mine.first) * sph::values_per_particle<dim>(sea_.parameters()));
    return state;
  }
  void restore(const ParticleState& state) override {
    sph::set_by_identity<dim, Real>(sea_, sph::identities_of(particles_, runtime::rank_in(comm_), ranks_), state.values, owner_,
                                    state.time_s, long(state.steps));
    sea_.state().energy = runtime::rank_in(comm_) == 0 ? state.energy : sph::EnergyFlow{};
    balance_.reset(), made_before_J_ = state.made_J;
    // A sea with other sensors than the state's begins their means anew.
    std::vector<std::span<const double>> records;
    for (std::span<const double> rest = state.sensors; !rest.empty();) {
      const std::size_t size = sph::PatchRecord::numbers * std::size_t(rest[0]);
      if (rest.size() < 1 + size) break;
      records.push_back(rest.subspan(1, size)), rest = rest.subspan(1 + size);
    }
    if (records.size() != sea_.state().records.size()) return;
    for (std::size_t n = 0; n < records.size(); ++n) sea_.state().records[n].unpack(records[n]);
  }

  Counts counts() const override {
    const auto gone = sea_.state().gone();
    const sph::Work& work = sea_.state().work;
    return {particles_, gone.lost, gone.over_edge + gone.through_open_sides, work.evaluations, work.sorts};
  }

 private:
  ParticleState layout_without_values() const {
    const std::size_t size = sph::values_per_particle<dim>(sea_.parameters());
    const auto mine = sph::identities_of(particles_, runtime::rank_in(comm_), ranks_);
    return {.first = std::int64_t(mine.first * size),
            .total = std::int64_t(particles_ * size),
            .values = {},
            .sensors = {},
            .energy = {},
            .time_s = sea_.time(),
            .steps = sea_.state().work.steps};
  }
  /// Of all ranks. The energy has the same bits wherever particles lie in memory, which depends on when they were last sorted.
  Extent measured() const {
    struct Part {
      double x_max = -1e300, z_max = -1e300;
      std::int64_t particles = 0;
      BinnedSum speed2, height, compression;
      sph::EnergyFlow flow;
      void add(const Part& part) {
        x_max = std::max(x_max, part.x_max), z_max = std::max(z_max, part.z_max), particles += part.particles;
        speed2.add(part.speed2), height.add(part.height), compression.add(part.compression);
        flow = sum(flow, part.flow);
      }
    };
    const Store<dim, Real>& store = sea_.store();
    Part all;
#pragma omp parallel
    {
      const std::size_t clusters = store.clusters(), thread = std::size_t(omp_get_thread_num()),
                        threads = std::size_t(omp_get_num_threads());
      Part mine;
      sph::for_water_particles(store, clusters * thread / threads, clusters * (thread + 1) / threads, [&](std::size_t slot) {
        mine.x_max = std::max(mine.x_max, store.x[0][slot]), mine.z_max = std::max(mine.z_max, store.x[dim - 1][slot]);
        double speed2 = 0.0;
        for (int k = 0; k < dim; ++k) speed2 += store.v[k][slot] * store.v[k][slot];
        mine.speed2.add(speed2), mine.height.add(store.x[dim - 1][slot]);
        mine.compression.add(sea_.parameters().eos.compression_energy(store.deviation[slot])), ++mine.particles;
      });
#pragma omp critical
      all.add(mine);
    }
    all.flow = sea_.state().energy;
    if (ranks_ > 1) {
      runtime::Packer mine;
      mine.put_one(std::exchange(all, {}));
      for (const runtime::Bytes& bytes : runtime::exchange_all(comm_, mine.take()))
        all.add(runtime::Unpacker(bytes).template one<Part>());
    }
    const sph::Parameters& p = sea_.parameters();
    const double half = 0.5 * p.spacing, mass = p.mass(dim) * share_, quantum = sph::energy_quantum(p, dim) * share_;
    return {.x_max = all.x_max + half,
            .z_max = all.z_max + half,
            .mass = mass * double(all.particles),
            .kinetic_energy = 0.5 * mass * all.speed2.value(),
            .potential_energy = mass * p.gravity * all.height.value(),
            .compression_energy = mass * all.compression.value(),
            .work_of_solids = quantum * double(all.flow.from_solids),
            .dissipated = quantum * double(all.flow.from_solids - all.flow.onto_water),
            .absorbed = quantum * double(all.flow.absorbed),
            .left = mass * left_energy()};
  }

  /// Kinetic and potential energy of all particles that are no more in the tank, of a particle's mass [J/kg].
  double left_energy() const {
    BinnedSum sum;  // a restart lists them in another order
    for (const sph::LostParticle<dim>& particle : sea_.store().lost) {
      double energy = sea_.parameters().gravity * particle.position[dim - 1];
      for (int k = 0; k < dim; ++k) energy += 0.5 * particle.velocity[k] * particle.velocity[k];
      if (std::isfinite(energy)) sum.add(energy);
    }
    return sum.value();
  }

  /// The last step's end, which no step has checked.
  void require_bounded() const {
    const std::optional<sph::Beyond> beyond = sph::beyond_bounds(sea_.store(), sea_.parameters(), comm_);
    if (!beyond) return;
    throw NumericalFailure("t = " + in_words(t_) + " s: " + beyond->describe(dim), "sea", long(sea_.state().work.steps), t_,
                           beyond->limit);
  }

  /// Steps that are too long make energy, which dissipation takes again: neither bounds nor the speed of the water tell it.
  void require_energy() {
    constexpr double memory = 100.0, most = 1.5;  // of the time sound takes through h; of what the water moves with
    const Extent now = measured(), before = balance_->extent;
    const sph::Parameters& p = sea_.parameters();
    const double worked = now.work_of_solids - before.work_of_solids, absorbed = now.absorbed - before.absorbed;
    const auto kept = [](const Extent& e) { return e.kinetic_energy + e.potential_energy + e.compression_energy + e.dissipated; };
    double made = balance_->made * std::exp(-(sea_.time() - balance_->time_s) * p.eos.c0 / (memory * p.h()));
    if (now.mass == before.mass) made += kept(now) - kept(before) - worked + absorbed;  // water that leaves takes its own along
    const double little =
        1e-4 * now.mass * p.gravity * p.spacing;  // of water at rest: what lifts it by a ten-thousandth of a row
    const double moves = std::max(
        {before.kinetic_energy, now.kinetic_energy, std::abs(worked), std::abs(absorbed), 0.1 * now.compression_energy, little});
    const double at_start = balance_->made;  // which no shorter steps of this window undo
    balance_ = Balance{now, sea_.time(), made}, between_windows_ = true;
    if (made <= 2.0 * most * moves && at_start <= most * moves) return;
    throw NumericalFailure("t = " + in_words(t_) + " s: sea: its steps have made " + in_words(std::max(made, at_start)) +
                               " J out of nothing within " + in_words(memory * p.h() / p.eos.c0) + " s, the limit is " +
                               in_words(most * moves) +
                               " J, one and a half times what the water moves with; take a smaller sea.particles.cfl",
                           "sea", long(sea_.state().work.steps), t_, most * moves);
  }

  /// Of the water's energy between windows.
  struct Balance {
    Extent extent;
    double time_s;      ///< of the sea's clock
    double made = 0.0;  ///< of late, out of nothing [J]
  };
  double share_, width_, settle_damping_;
  MPI_Comm comm_;
  int ranks_;
  sph::SeaSph<dim, Real> sea_;
  std::size_t particles_;
  std::vector<std::uint16_t> owner_;  ///< of this rank's run of identities
  ParticleSolids<dim, Real> solids_;
  double t_ = 0.0;  ///< at the window's start
  std::optional<Balance> balance_;
  double made_before_J_ = 0.0;  ///< of the state that a restart begins with
  bool between_windows_ = true;
  // Windows as tasks.
  struct Saved {
    sph::Saved<dim> sea;
    SolidsState solids;
    std::vector<sph::PatchRecord> records;
    std::optional<Balance> balance;
  };
  WindowDriver* driver_ = nullptr;
  sph::StepDriver steps_;  ///< asks driver_
  std::vector<std::unique_ptr<sph::StepTasks<dim, Real>>> tasks_;
  bool moved_ = false;  ///< groups went to other ranks
  std::array<Saved, 2> snapshots_;
};

template <int dim, class Real>
std::unique_ptr<ParticleSea> make_sea(const ParticlePlan& plan, std::span<const Motion> start, const runtime::World& world) {
  sph::Parameters parameters = plan.parameters;
  sph::TankParticles<dim> tank;
  runtime::give_up_together(world.comm, [&] { tank = sph::lay_out<dim>(tank_with_bodies(plan, start), parameters); });
  // One in ten thousand may slip through walls (an impact presses some), one in a hundred splash over the edge.
  parameters.lost_at_most = std::size_t(plan.options.lost_at_most.value_or(std::max(10, int(1e-4 * double(tank.water)))));
  if (plan.tank.over_edge_open)
    parameters.left_at_most = std::numeric_limits<std::size_t>::max();
  else
    parameters.left_at_most = std::max<std::size_t>(100, tank.water / 100);
  return std::make_unique<Sea<dim, Real>>(plan, start, parameters, tank, world);
}

/// Evaluations per core-second (processor time, so that other programs do not count) and bytes per particle of a small sea of
/// the same schemes; returns its particles of walls to one of water.
template <int dim, class Real>
double measure(const sph::Parameters& scene, ParticleCensus& census) {
  sph::Parameters p = scene;
  const int n = dim == 2 ? 100 : 24;
  std::vector<sph::Seed<dim>> seeds;
  std::array<double, dim> origin{};
  std::array<int, dim> low{}, high;
  high.fill(n);
  sph::add_water<dim>(seeds, origin, p.spacing, low, high, p.eos, p.gravity, (n - 0.5) * p.spacing);
  sph::add_tank<dim>(seeds, origin, p.spacing, low, high, 3, p.eos, p.gravity, (n - 0.5) * p.spacing);
  sph::Domain<dim> domain;
  domain.low.fill(-10.0 * p.spacing), domain.high.fill((n + 20) * p.spacing);
  sph::SeaSph<dim, Real> sea(p, domain, seeds, {.threads = 1});
  sea.step(1e300);
  const std::clock_t begin = std::clock();
  const int steps = 8;
  const long before = sea.state().work.evaluations;
  for (int s = 0; s < steps; ++s) sea.step(1e300);
  const double seconds = std::max(1e-6, double(std::clock() - begin) / CLOCKS_PER_SEC);
  census.evaluations_per_second = double(seeds.size()) * double(sea.state().work.evaluations - before) / seconds;
  census.bytes = double(sea.store().bytes()) / double(seeds.size());
  return double(seeds.size()) / std::pow(n, dim) - 1.0;
}

/// What zones that lead to waves add to a step: seconds for one particle, times the share of the water that is in them.
template <int dim>
double measure_leading(const ParticlePlan& plan) {
  const sph::Damping damping = damping_of(plan);
  const sph::TankPlan& tank = plan.tank;
  constexpr int across = 48;
  std::vector<std::array<double, dim>> led;
  for (int n = 0; n < across * across; ++n) {
    std::array<double, 2> at;
    for (int axis = 0; axis < 2; ++axis) {
      const auto& sides = axis == 0 ? tank.x : tank.y;
      at[axis] = sides[0] + ((axis == 0 ? n % across : n / across) + 0.5) / across * (sides[1] - sides[0]);
    }
    const bool inside = std::any_of(damping.zones.begin(), damping.zones.end(),
                                    [&](const sph::DampingZone& zone) { return zone.rates_at(at[zone.axis]).to_waves > 0.0; });
    if (!inside) continue;
    if constexpr (dim == 3)
      led.push_back({at[0], at[1], -0.5 * tank.depth});
    else
      led.push_back({at[0], -0.5 * tank.depth});
  }
  const std::clock_t begin = std::clock(), at_most = CLOCKS_PER_SEC / 20;
  std::size_t calls = 0;
  double motion = 0.0;
  while (calls < led.size() && std::clock() - begin < at_most)
    for (std::size_t last = std::min(calls + 16, led.size()); calls < last; ++calls)  // the clock takes as long as a few
      motion += sph::wave_velocity<dim>(damping, led[calls], 0.0)[0];
  asm volatile("" : : "x"(motion));  // so that it is reckoned
  if (calls == 0) return 0.0;
  const double share = double(led.size()) / (across * across);
  return share * double(std::clock() - begin) / CLOCKS_PER_SEC / double(calls);
}

/// Places of the lattice that are laid out in about a second; near bodies each takes longer.
constexpr double laid_out_at_most = 1e6;

/// Of particles by kind; points: some of each body's, which stand for `cell` each.
template <int dim>
ParticleCensus counted_or_laid_out(const ParticlePlan& plan, std::span<const Motion> start, sph::Parameters& p,
                                   std::vector<sph::TankCount::Body>& bodies) {
  const sph::TankPlan with_bodies = tank_with_bodies(plan, start);
  ParticleCensus census;
  census.counted = sph::lattice_places<dim>(with_bodies, p) > laid_out_at_most;
  if (census.counted) {
    sph::TankCount count = sph::count_tank<dim>(with_bodies, p);
    p.mass_factor = count.mass_factor;
    census.water = std::size_t(count.water), census.walls = std::size_t(count.walls);
    bodies = std::move(count.bodies);
    return census;
  }
  const auto tank = sph::lay_out<dim>(with_bodies, p);
  census.water = tank.water, census.walls = tank.seeds.size() - tank.water;
  for (const sph::Points& points : tank.body_points) {
    census.walls -= points.size();
    bodies.push_back({double(points.size()), points, std::pow(p.spacing, dim) * tank.cell_volume});
  }
  return census;
}

template <int dim, class Real>
ParticleCensus census_of(const ParticlePlan& plan, std::span<const Motion> start) {
  sph::Parameters p = plan.parameters;
  std::vector<sph::TankCount::Body> bodies;
  ParticleCensus census = counted_or_laid_out<dim>(plan, start, p, bodies);
  census.values_each = sph::values_per_particle<dim>(plan.parameters);
  const double walls_to_water = measure<dim, Real>(plan.parameters, census);
  census.leading_s = measure_leading<dim>(plan);
  census.step_s = sph::step_limits(p.cfl, p.h(), p.eos.c0, 0.0, p.gravity, 0.0).smallest(), census.step_set_by = "sound";
  std::size_t shaped = 0;
  for (std::size_t b = 0; b < plan.bodies.size(); ++b) {
    const ParticleBody& body = plan.bodies[b];
    if (body.shapes.empty()) continue;
    const sph::TankCount::Body& of = bodies[shaped++];
    census.bodies += std::size_t(std::llround(of.particles));
    const double share = plan.share(), edge = std::pow(of.cell, 1.0 / dim);
    census.floats.push_back({body.name, double(of.points.size()) * of.cell * share,
                             sph::wetted_volume(of.points, start[b], of.cell, edge) * share,
                             sph::rise_to_float(of.points, start[b], of.cell, edge, body.mass / (p.eos.rho0 * share))});
    const double limit = body_step_limit<dim>(body, of, p, share);
    if (limit < census.step_s) census.step_s = limit, census.step_set_by = "body " + body.name;
  }
  census.bytes *= double(census.particles());
  // Walls that no water meets cost next to nothing: as many are busy as beside the water of the small sea.
  const double busy =
      double(census.water + census.bodies) + std::min(double(census.walls), walls_to_water * double(census.water));
  if (busy > 0.0) census.evaluations_per_second *= double(census.particles()) / busy;
  return census;
}

}  // namespace

void ParticleSea::add_loads(std::span<const Motion> bodies, std::span<Wrench> wrenches) const {
  // Held over a step, in which centres of mass move: force and moment about the centre stay.
  for (std::size_t b = 0; b < bodies.size(); ++b) wrenches[b].force += loads()[b].force, wrenches[b].moment += loads()[b].moment;
}

void ParticleSea::add_contacts(std::span<const Motion> bodies, std::span<Wrench> wrenches) const {
  for (std::size_t b = 0; b < bodies.size(); ++b)
    wrenches[b].force += contacts()[b].force, wrenches[b].moment += contacts()[b].moment;
}

std::unique_ptr<ParticleSea> ParticleSea::make(const ParticlePlan& plan, std::span<const Motion> start,
                                               const runtime::World& world) {
  const bool single = plan.options.precision == "single";
  if (plan.options.planar()) return single ? make_sea<2, float>(plan, start, world) : make_sea<2, double>(plan, start, world);
  return single ? make_sea<3, float>(plan, start, world) : make_sea<3, double>(plan, start, world);
}

ParticleCensus particle_census(const ParticlePlan& plan, std::span<const Motion> start) {
  const bool single = plan.options.precision == "single";
  if (plan.options.planar()) return single ? census_of<2, float>(plan, start) : census_of<2, double>(plan, start);
  return single ? census_of<3, float>(plan, start) : census_of<3, double>(plan, start);
}

}  // namespace spindrift::sea
