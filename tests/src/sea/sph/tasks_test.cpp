// The step as tasks: the same bits for any number of threads, ranks and any schedule; windows as steps one by one; bodies in the
// loop; groups that change ranks; states saved and restored.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/tasks.hpp"

#include <catch2/catch.hpp>

#include <bit>
#include <cstring>
#include <map>

#include "src/sea/sph/lattice.hpp"
#include "src/sea/sph/load_balance.hpp"
#include "src/sea/sph/sea_sph.hpp"
#include "src/sea/sph/shapes.hpp"
#include "src/sea/sph/tank.hpp"
#include "tests/src/sea/sph/scenes.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

/// Dam break across a tank twice as long as the water, 3-D, some thousand particles; a box floats in it where `body`. `all`: a
/// free box that touches the wall, modified walls, sub-particle stress: every sweep there is.
struct Scene {
  Parameters p;
  std::vector<Seed<3>> seeds;
  Motion box;
  double touching_mass = 0.0;
  Domain<3> domain{{-0.5, -0.5, -0.5}, {3.0, 1.1, 2.0}};

  explicit Scene(bool body = false, StepChoice step = StepChoice::symplectic, bool all = false) {
    const double d = p.spacing = 0.05;
    p.eos = {1000.0, 25.0}, p.h_over_d = 1.3, p.step = step;
    add_water<3>(seeds, {0, 0, 0}, d, {1, 1, 1}, {20, 12, 14}, p.eos, p.gravity, 0.7);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> shift(-0.2 * d, 0.2 * d);
    for (auto& seed : seeds) {
      for (double& x : seed.position) x += shift(random);
      seed.velocity[0] = 1.5;
    }
    add_tank<3>(seeds, {0, 0, 0}, d, {1, 1, 1}, {46, 12, 20}, 1, p.eos, p.gravity, 0.0);
    if (body) {
      box.position = {0.5, all ? 0.6 - 0.12 : 0.3, 0.85};
      for (const auto& point : points_in_box({0.25, 0.2, 0.15}, d))
        seeds.push_back({.position = from_earth<3>(box.point(point)), .owner = 2});
    }
    if (!all) return;
    touching_mass = 6.0;
    p.viscosity = ViscosityChoice::laminar_sps, p.wall = WallChoice::no_slip, p.filter = FilterChoice::shepard,
    p.filter_every = 9;
    for (Seed<3>& seed : seeds)
      if (seed.owner == 1) seed.ghost = mirror_in_box<3>(seed.position, {0.5 * d, 0.5 * d, 0.5 * d}, {45.5 * d, 11.5 * d, 1e9});
  }
};

/// State of all particles of all ranks, by identity.
using Everything = std::map<std::uint32_t, std::array<double, 7>>;
Everything everything(const SeaSph<3, float>& sea, MPI_Comm comm = MPI_COMM_SELF) {
  runtime::Packer mine;
  const auto& store = sea.store();
  for (std::size_t slot = 0; slot < store.slots(); ++slot) {
    if (store.id[slot] == no_particle) continue;
    mine.put_one(store.id[slot]);
    std::array<double, 7> s;
    for (int k = 0; k < 3; ++k) s[k] = store.x[k][slot], s[3 + k] = store.v[k][slot];
    s[6] = store.deviation[slot];
    mine.put_one(s);
  }
  Everything all;
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take()))
    for (runtime::Unpacker from(bytes); !from.done();) {
      const auto id = from.one<std::uint32_t>();
      CHECK(all.emplace(id, from.one<std::array<double, 7>>()).second);  // on one rank only
    }
  return all;
}

/// A word, where a failing comparison of maps would print pages.
bool same(const Everything& a, const Everything& b) { return a == b; }

/// A body that falls, pushed by the water: Euler's step, enough to be chaotic in its bits.
MoveBodies falling(double mass) {
  return [mass](const HalfStep& half, std::span<const Wrench> loads, std::span<Motion> motions) {
    for (std::size_t n = 0; n < motions.size(); ++n) {
      const double dt = 0.5 * half.dt;
      Eigen::Vector3d force = loads[n].force;
      for (const Touch& touch : half.contacts) force += touch.of == 2 ? -touch.wrench.force : touch.wrench.force;
      motions[n].velocity += dt * (force / mass + Eigen::Vector3d(0, 0, -9.81));
      motions[n].position += dt * motions[n].velocity;
      motions[n].omega += dt * 1e-2 * loads[n].moment;
      motions[n].attitude =
          (motions[n].attitude * Eigen::Quaterniond(1.0, 0.5 * dt * motions[n].omega[0], 0.5 * dt * motions[n].omega[1],
                                                    0.5 * dt * motions[n].omega[2]))
              .normalized();
    }
  };
}

constexpr double window = 0.02;

Everything run(const Scene& scene, Resources resources, int windows, StepControl step_control = {}, double* imbalance = nullptr) {
  const MPI_Comm comm = resources.comm;
  SeaSph<3, float> sea(scene.p, scene.domain, scene.seeds, std::move(resources));
  if (scene.box.position.norm() > 0) {
    sea.add_body(2, scene.box, scene.touching_mass);
    sea.set_bodies(falling(6.0));
  }
  sea.set_step_control(step_control);
  for (int n = 0; n < windows; ++n) sea.advance(window);
  CHECK(sea.time() == Approx(windows * window));
  CHECK(sea.state().work.sorts > 0);
  CHECK(sea.store().lost.empty());
  if (imbalance) *imbalance = sph::imbalance(sea.state(), runtime::Communicator(comm));
  return everything(sea, comm);
}

std::vector<int> striped(const SeaSph<3, float>& sea, int ranks) {
  std::vector<int> rank_of_group(std::size_t(sea.state().columns.groups()), 0);
  for (std::size_t g = 0; g < rank_of_group.size(); ++g) rank_of_group[g] = int(g % std::size_t(ranks));
  return rank_of_group;
}

}  // namespace

TEST_CASE("a window as one graph has the bits of its steps one by one", "[sph][tasks][fast]") {
  const StepChoice step = GENERATE(StepChoice::symplectic, StepChoice::verlet);
  Scene scene(false, step);
  scene.p.filter = FilterChoice::mls, scene.p.filter_every = 7, scene.p.shifting = 2.0;
  SeaSph<3, float> window_by_window(scene.p, scene.domain, scene.seeds, {.threads = 2});
  SeaSph<3, float> step_by_step(scene.p, scene.domain, scene.seeds, {.threads = 1});
  window_by_window.advance(0.01);
  for (double left = 0.01; left > 0.0;) {
    const double dt = step_by_step.step(left);
    left = dt < left ? left - dt : 0.0;
  }
  CHECK(window_by_window.state().work.steps == step_by_step.state().work.steps);
  CHECK(window_by_window.state().work.evaluations == step_by_step.state().work.evaluations);
  CHECK(window_by_window.time() == step_by_step.time());
  CHECK(same(everything(window_by_window), everything(step_by_step)));
}

TEST_CASE("threads and schedules leave every bit, with a body in the loop", "[sph][tasks][fast]") {
  const Scene scene(true, StepChoice::symplectic, GENERATE(false, true));
  const StepControl step_control = GENERATE(StepControl{}, StepControl{.steps_per_check = 5});
  const Everything expected = run(scene, {.threads = 1}, 2, step_control);
  CHECK(same(run(scene, {.threads = 2}, 2, step_control), expected));
  if (scene.touching_mass == 0.0) CHECK(same(run(scene, {.threads = 3}, 2, step_control), expected));
  for (std::uint64_t seed = 1; seed <= (scene.touching_mass == 0.0 ? 3u : 1u); ++seed)
    CHECK(same(run(scene, {.threads = int(1 + seed % 3), .random_schedule = seed}, 2, step_control), expected));
}

TEST_CASE("steps checked some at a time have the bits of the same steps checked one by one", "[sph][tasks][fast]") {
  Scene scene(true, GENERATE(StepChoice::symplectic, StepChoice::verlet));
  scene.p.filter = FilterChoice::mls, scene.p.filter_every = 3, scene.p.shifting = 2.0, scene.p.verlet_join_every = 3;
  const auto run_with = [&](StepControl step_control) {
    SeaSph<3, float> sea(scene.p, scene.domain, scene.seeds, {.threads = 1});
    sea.add_body(2, scene.box);
    sea.set_bodies(falling(6.0));
    sea.add_sensor({.owner = 2,
                    .low = {-1, -1, -1},
                    .high = {3, 3, 3},
                    .points = {{0, 0, -0.2}},
                    .counted = std::vector<char>(sea.state().solids.back().local.size(), 1),
                    .mean_over = 1.0});
    sea.set_step_control(std::move(step_control));
    sea.advance(window);
    CHECK(sea.state().work.steps == 6);
    CHECK(sea.time() == Approx(7e-4));
    const PatchReading reading = sea.state().records[0].mean();
    return std::tuple(everything(sea), sea.state().work.sorts, reading.pressure);
  };
  int one_by_one = 0, some_at_a_time = 0;
  const auto each = run_with({.choose = [&](double, int) {
    ++one_by_one;
    return StepControl::Choice{one_by_one == 6 ? 2e-4 : 1e-4, one_by_one == 6};
  }});
  const auto some =
      run_with({.steps_per_check = 4, .choose = [&](double, int most) {
                  CHECK(most == 4);
                  return ++some_at_a_time == 1 ? StepControl::Choice{1e-4, false, 4} : StepControl::Choice{1e-4, true, 2, 2e-4};
                }});
  CHECK(one_by_one == 6);
  CHECK(some_at_a_time == 2);
  CHECK(std::get<1>(each) == std::get<1>(some));
  CHECK(std::get<2>(each) == std::get<2>(some));
  CHECK(std::get<2>(each) != 0.0);
  CHECK(same(std::get<0>(each), std::get<0>(some)));
}

TEST_CASE("what goes wrong between two checks of the limits ends the window at the next", "[sph][tasks][fast]") {
  const Scene scene(true);
  SeaSph<3, float> sea(scene.p, scene.domain, scene.seeds, {.threads = 1});
  sea.add_body(2, scene.box);
  long halves = 0;
  sea.set_bodies([&](const HalfStep&, std::span<const Wrench>, std::span<Motion>) {
    if (++halves == 2 * 6 - 1) sea.state().store.v[0][0] = 200.0 * scene.p.eos.c0;  // in the sixth step, the second of its four
  });
  sea.set_step_control({.steps_per_check = 4});
  try {
    sea.advance(0.05);
    FAIL("no failure");
  } catch (const NumericalFailure& failure) { CHECK(failure.step == 8); }
  CHECK(halves == 2 * 8);
}

TEST_CASE("fixed steps are made in full and refused beyond their limit", "[sph][tasks][fast]") {
  const Scene scene;
  SeaSph<3, float> sea(scene.p, scene.domain, scene.seeds, {.threads = 1});
  sea.set_step_control({.dt = 2e-4, .steps_per_check = 8});
  sea.advance(0.004);
  CHECK(sea.state().work.steps == 20);
  CHECK(sea.time() == Approx(0.004).epsilon(1e-12));
  sea.set_step_control({.dt = 2e-3, .steps_per_check = 8});
  CHECK_THROWS_WITH(sea.advance(0.004), Catch::Contains("fixed step") && Catch::Contains("beyond the limit"));
}

TEST_CASE("a body in the loop gets the loads that the facade gives", "[sph][tasks][fast]") {
  const Scene scene(true);
  std::vector<Wrench> seen;
  SeaSph<3, float> sea(scene.p, scene.domain, scene.seeds, {.threads = 2}),
      other(scene.p, scene.domain, scene.seeds, {.threads = 1});
  sea.add_body(2, scene.box), other.add_body(2, scene.box);
  sea.set_bodies([&](const HalfStep& half, std::span<const Wrench> loads, std::span<Motion> motions) {
    seen.push_back(loads[0]);
    motions[0].velocity = {0, 0, -1}, motions[0].position = scene.box.position - Eigen::Vector3d(0, 0, half.to);
  });
  sea.advance(0.005);
  Motion motion = scene.box;
  std::size_t at = 0;
  for (double left = 0.005; left > 0.0; ++at) {
    const double t = other.time(), dt = other.begin_step(left);
    const auto compare = [&](double to) {
      const Wrench w = other.load_on(2, motion.position);
      REQUIRE(at < seen.size());
      CHECK(w.force == seen[at].force);
      CHECK(w.moment == seen[at].moment);
      motion.velocity = {0, 0, -1}, motion.position = scene.box.position - Eigen::Vector3d(0, 0, to);
      place_body(other.state(), 2, motion);
    };
    compare(t + 0.5 * dt);
    other.half_step(), ++at;
    compare(t + dt);
    other.end_step();
    left = dt < left ? left - dt : 0.0;
  }
  CHECK(at == seen.size());
  CHECK(same(everything(sea), everything(other)));
}

TEST_CASE("a body that outruns its window's groups stops the run", "[sph][tasks][fast]") {
  const Scene scene(true);
  SeaSph<3, float> sea(scene.p, scene.domain, scene.seeds, {.threads = 1});
  sea.add_body(2, scene.box);
  sea.set_bodies([](const HalfStep& half, std::span<const Wrench>, std::span<Motion> motions) {
    motions[0].velocity = {100, 0, 0}, motions[0].position[0] += 50 * half.dt;
  });
  CHECK_THROWS_WITH(sea.advance(0.02), Catch::Contains("a column of cells and a half"));
}

TEST_CASE("a window repeated from its snapshot has the same bits; a snapshot takes at most 100 bytes per particle",
          "[sph][tasks][fast]") {
  const StepChoice step = GENERATE(StepChoice::symplectic, StepChoice::verlet);
  const Scene scene(true, step);
  SeaSph<3, float> sea(scene.p, scene.domain, scene.seeds, {.threads = 2});
  sea.add_body(2, scene.box);
  sea.set_bodies(falling(6.0));
  sea.advance(0.015);
  const Saved<3> snapshot = sea.save();
  CHECK(double(snapshot.bytes()) / double(scene.seeds.size()) < (step == StepChoice::symplectic ? 75.0 : 110.0));
  sea.advance(0.03);
  const Everything once = everything(sea);
  const double time = sea.time();
  std::ranges::fill(sea.state().store.carried, 1.0F);  // as a window that failed may leave it
  sea.restore(snapshot);
  CHECK(sea.time() == snapshot.plan[0]);
  sea.advance(0.03);
  CHECK(sea.time() == time);
  CHECK(same(everything(sea), once));
}

TEST_CASE("a saved state that lacks a group or was made with another step is refused", "[sph][tasks][fast]") {
  const Scene scene;
  SeaSph<3, float> sea(scene.p, scene.domain, scene.seeds, {.threads = 1});
  Saved<3> twice = sea.save(), lacking = twice, other = twice;
  const std::vector<Saved<3>> pieces{twice, twice};
  CHECK_THROWS_WITH(sea.restore(pieces), Catch::Contains("given twice"));
  lacking.groups.resize(lacking.groups.size() - 3);
  CHECK_THROWS_WITH(sea.restore(lacking), Catch::Contains("lacks group"));
  other.values.pop_back();
  CHECK_THROWS_WITH(sea.restore(other), Catch::Contains("does not hold"));
}

namespace {

/// Every way of dealing groups to ranks gives the bits of one rank.
void same_bits_on_ranks() {
  const MPI_Comm world = MPI_COMM_WORLD;
  const int ranks = runtime::ranks_in(world);
  const int kind = GENERATE(0, 1, 2);
  const Scene scene(kind > 0, StepChoice::symplectic, kind == 2);
  const StepControl step_control = kind == 1 ? StepControl{} : StepControl{.steps_per_check = kind == 2 ? 3 : 6};
  const Everything expected = run(scene, {.threads = 1}, 3, step_control);
  const SeaSph<3, float> probe(scene.p, scene.domain, scene.seeds, {.threads = 1});
  CHECK(same(run(scene, {.comm = world, .threads = 1}, 3, step_control), expected));
  CHECK(same(
      run(scene, {.comm = world, .threads = 2, .random_schedule = std::uint64_t(7 + runtime::rank_in(world))}, 3, step_control),
      expected));
  CHECK(same(run(scene, {.comm = world, .threads = 1, .rank_of_group = striped(probe, ranks)}, 3, step_control), expected));
  const std::vector<int> last(std::size_t(probe.state().columns.groups()), ranks - 1);  // others have no particle
  CHECK(same(run(scene, {.comm = world, .threads = 1, .repartition_above = 1e9, .rank_of_group = last}, 3, step_control),
             expected));
  double imbalance = 0.0;  // all on one rank at the start, dealt out after the first window
  CHECK(same(run(scene, {.comm = world, .threads = 1, .rank_of_group = last}, 3, step_control, &imbalance), expected));
  CHECK(imbalance < 0.8 * ranks);
}

/// A state saved on all ranks goes on the same on one, and one saved on one rank goes on the same on all.
void restart_on_other_ranks() {
  const MPI_Comm world = MPI_COMM_WORLD;
  const Scene scene(true);
  const auto make = [&](MPI_Comm comm, int threads) {
    auto sea =
        std::make_unique<SeaSph<3, float>>(scene.p, scene.domain, scene.seeds, Resources{.comm = comm, .threads = threads});
    sea->add_body(2, scene.box);
    sea->set_bodies(falling(6.0));
    return sea;
  };
  const auto gathered = [&](const Saved<3>& mine) {
    runtime::Packer packer;
    mine.put(packer);
    std::vector<Saved<3>> pieces;
    for (const runtime::Bytes& bytes : runtime::exchange_all(world, packer.take())) {
      runtime::Unpacker from(bytes);
      pieces.push_back(Saved<3>::take(from));
    }
    return pieces;
  };
  const auto sea = make(world, 1), alone = make(MPI_COMM_SELF, 2), again = make(world, 2);
  sea->advance(0.03);
  const auto pieces = gathered(sea->save());
  alone->restore(pieces);
  sea->advance(0.02), alone->advance(0.02);
  const Everything expected = everything(*sea, world);
  CHECK(same(everything(*alone), expected));
  again->restore(pieces);
  again->advance(0.02);
  CHECK(same(everything(*again, world), expected));
}

void lost_particles_are_known_to_all() {
  Scene scene;
  scene.seeds[0].velocity = {0, -120.0, 0};
  scene.p.lost_at_most = 5;
  SeaSph<3, float> sea(scene.p, scene.domain, scene.seeds, {.comm = MPI_COMM_WORLD, .threads = 1});
  sea.advance(0.02);
  REQUIRE(sea.store().lost.size() == 1);
  CHECK(sea.store().lost[0].id == 0);
  CHECK(everything(sea, MPI_COMM_WORLD).size() == scene.seeds.size() - 1);
  scene.p.lost_at_most = 0;
  SeaSph<3, float> strict(scene.p, scene.domain, scene.seeds, {.comm = MPI_COMM_WORLD, .threads = 1});
  CHECK_THROWS_WITH(strict.advance(0.02), Catch::Contains("left the tank"));
}

/// A tank whose parts ranks visit by themselves has on each rank what a list has that all visit.
void parts_fill_ranks_as_a_list() {
  TankPlan plan;
  plan.x = {0.0, 4.0}, plan.y = {0.0, 2.0}, plan.depth = 0.5, plan.top = 0.8, plan.jitter = 0.1;
  plan.periodic = {false, GENERATE(false, true)};
  plan.bodies = {{"ball", {Sphere{Eigen::Vector3d::Zero(), 0.25}}, {.position = {1.0, 1.0, 0.0}}}};
  Parameters p;
  p.spacing = 0.05, p.h_over_d = 1.3, p.eos = {1000.0, 25.0};
  const TankParticles<3> tank = lay_out<3>(plan, p);
  const std::vector<Seed<3>> list = tank.seeds.all();
  const MPI_Comm world = MPI_COMM_WORLD;
  const SeaSph<3, float> by_parts(p, tank.domain, tank.seeds, {.comm = world, .threads = 1}),
      by_list(p, tank.domain, list, {.comm = world, .threads = 1});
  CHECK(by_parts.state().subdomain.rank_of_group == by_list.state().subdomain.rank_of_group);
  CHECK(by_parts.store().owners == by_list.store().owners);
  CHECK(by_parts.store().id == by_list.store().id);
  CHECK(same(everything(by_parts, world), everything(by_list, world)));
  CHECK(everything(by_parts, world).size() == list.size());
}

}  // namespace

TEST_CASE("two ranks fill their columns from parts as from a list", "[sph][tasks][mpi2]") { parts_fill_ranks_as_a_list(); }
TEST_CASE("four ranks fill their columns from parts as from a list", "[sph][tasks][mpi4]") { parts_fill_ranks_as_a_list(); }
TEST_CASE("two ranks give the bits of one, however groups are dealt out", "[sph][tasks][mpi2]") { same_bits_on_ranks(); }
TEST_CASE("four ranks give the bits of one, however groups are dealt out", "[sph][tasks][mpi4]") { same_bits_on_ranks(); }
TEST_CASE("a state saved on two ranks goes on the same on one and on two", "[sph][tasks][mpi2]") { restart_on_other_ranks(); }
TEST_CASE("a state saved on four ranks goes on the same on one and on four", "[sph][tasks][mpi4]") { restart_on_other_ranks(); }
TEST_CASE("lost particles are counted, located and limited on all ranks", "[sph][tasks][mpi2]") {
  lost_particles_are_known_to_all();
}
