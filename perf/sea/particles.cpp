// Speed and memory of the sea of particles on a dam break that DualSPHysics can run too: tank 1.6 x 0.67 x 0.4 m, water 0.4 x
// 0.67 x 0.3 m, post 0.12 x 0.12 x 0.45 m, spacing 6 mm, h/d 1.732, Wendland, c0 34 m/s, alpha 0.1, symplectic, CFL 0.2, dynamic
// walls, water displaced by up to a quarter spacing at random. Counted as particle evaluations (all particles, two per step)
// over wall time, everything included.
// Run by perf/run; what was tried is in docs/developer/notes/sea.md.
// SPDX-License-Identifier: Apache-2.0
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "kernels/sph/kernel_wendland.hpp"
#include "perf/harness.hpp"
#include "src/sea/sph/lattice.hpp"
#include "src/sea/sph/sea_sph.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

Parameters parameters(double spacing) {
  Parameters p;
  p.spacing = spacing, p.eos = {1000.0, 34.0};
  return p;
}

/// The dam break at any spacing; at 6 mm 371,850 particles of water and 87,070 of walls.
std::vector<Seed<3>> dam_break(const Parameters& p) {
  const double d = p.spacing;
  const auto count = [d](double length) { return int(std::lround(length / d)); };
  std::vector<Seed<3>> seeds;
  const std::array<int, 3> inside{count(1.6), count(0.67), count(0.4) + 1};
  add_water<3>(seeds, {0, 0, 0}, d, {1, 1, 1}, {count(0.4) + 1, inside[1], count(0.3) + 1}, p.eos, p.gravity, 0.3);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> displacement(-0.25 * d, 0.25 * d);
  for (Seed<3>& seed : seeds)
    for (double& x : seed.position) x += displacement(random);
  add_tank<3>(seeds, {0, 0, 0}, d, {1, 1, 1}, inside, 1, p.eos, p.gravity, 0.0);
  const int side = count(0.12);
  for_lattice<3>({0, 0, 1}, {side + 1, side + 1, count(0.45) + 1}, [&](const std::array<int, 3>& at) {
    if (at[0] == 0 || at[0] == side || at[1] == 0 || at[1] == side)
      seeds.push_back({.position = lattice_point<3>({0.9, 0.24, 0.0}, d, at), .owner = 1});
  });
  return seeds;
}

const Domain<3> domain{{-0.5, -0.5, -0.1}, {2.1, 1.2, 2.0}};

template <class Real>
std::unique_ptr<SeaSph<3, Real>> make_sea(const Parameters& p, const std::vector<Seed<3>>& seeds, int threads,
                                          const Domain<3>& box = domain) {
  return std::make_unique<SeaSph<3, Real>>(p, box, seeds, Resources{.threads = threads});
}

/// Particle evaluations per second of processor time, mean of five parts of steps that last about `seconds_wanted` together.
template <class Real>
double evaluations_per_second(const Parameters& p, const std::vector<Seed<3>>& seeds, double seconds_wanted = 4.0,
                              const Domain<3>& box = domain) {
  const auto sea = make_sea<Real>(p, seeds, 1, box);
  for (int n = 0; n < 2; ++n) sea->step(1.0);
  const double one = perf::seconds([&] { sea->step(1.0); });
  const int steps = std::max(2, int(seconds_wanted / one));
  constexpr int parts = 5;
  const int count = std::max(1, steps / parts);
  double rate = 0.0;
  for (int part = 0; part < parts; ++part) {
    const auto steps_of_part = [&] {
      for (int n = 0; n < count; ++n) sea->step(1.0);
    };
    rate += 2.0 * double(seeds.size()) * count / perf::seconds(steps_of_part, perf::processor_seconds) / parts;
  }
  return rate;
}

/// Water that fills a box with periodic sides, disordered: the same partners for all at any size.
std::vector<Seed<3>> periodic_water(const Parameters& p, const std::array<int, 3>& cells, Domain<3>& box) {
  const double d = p.spacing;
  std::vector<Seed<3>> seeds;
  add_water<3>(seeds, {0.5 * d, 0.5 * d, 0.5 * d}, d, {0, 0, 0}, cells, p.eos, 0.0, 0.0);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> displacement(-0.25 * d, 0.25 * d);
  for (Seed<3>& seed : seeds)
    for (double& x : seed.position) x += displacement(random);
  box = {{0, 0, -10 * d}, {d * cells[0], d * cells[1], d * (cells[2] + 20)}, {true, true, false}};
  return seeds;
}

/// The paper's tank: 500 x 150 m, 20.6 m deep, at a spacing of 0.625 m 5 M particles, walls of one layer included.
std::vector<Seed<3>> paper_tank(const Parameters& p, Domain<3>& box) {
  const double d = p.spacing;
  const std::array<int, 3> water{int(std::lround(500.0 / d)), int(std::lround(150.0 / d)), int(std::lround(20.6 / d))};
  const std::array<int, 3> tank{water[0], water[1], int(std::lround(30.0 / d))};
  std::vector<Seed<3>> seeds;
  add_water<3>(seeds, {0, 0, 0}, d, {0, 0, 0}, water, p.eos, p.gravity, water[2] * d);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> displacement(-0.1 * d, 0.1 * d);
  for (Seed<3>& seed : seeds)
    for (double& x : seed.position) x += displacement(random);
  add_tank<3>(seeds, {0, 0, 0}, d, {0, 0, 0}, tank, 1, p.eos, p.gravity, 0.0);
  box = {{-5.0, -5.0, -5.0}, {505.0, 155.0, 60.0}};
  return seeds;
}

/// Counts partners instead of moving them.
struct LawCount {
  static constexpr int sum_planes = 1;
  KernelWendland<3, float> kernel;
  template <class Real>
  SPINDRIFT_INLINE void operator()(const PairState<Real, 3>& i, const PairState<Real, 3>& j, Vec<Real, 1>& to_i,
                                   Vec<Real, 1>& to_j) const {
    const Real one = min(Real(-1e30f) * make_pair(kernel, i.x - j.x, i.v - j.v).slope, Real(1.0f));
    to_i[0] += one, to_j[0] += one;
  }
};

/// Mean number of partners of a particle, pairs of solids left out as in the sweep.
double mean_neighbours(const Parameters& p, const std::vector<Seed<3>>& seeds) {
  SeaSph<3, float> sea(p, domain, seeds);
  sea.evaluate();
  std::vector<float> sums(sea.store().slots(), 0.0f);
  NeighbourLists<3, float> meets;
  meets.reserve(sea.store().clusters());
  const LawCount law{KernelWendland<3, float>(p.h())};
  for (int g = 0; g < sea.state().columns.groups(); ++g)
    sweep_pairs(sea.store(), {sums.data(), sums.data(), cluster_size}, sea.state().columns, g, float(1.001 * p.reach()), meets,
                law, law);
  double total = 0.0;
  for (std::size_t slot = 0; slot < sea.store().slots(); ++slot)
    if (sea.store().id[slot] != no_particle) total += sums[slot];
  const auto water = std::count_if(seeds.begin(), seeds.end(), [](const Seed<3>& seed) { return seed.owner == 0; });
  return (total - double(water)) / double(seeds.size());  // water met itself once
}

}  // namespace

int main(int argc, char** argv) {
  perf::Group group("sea", argc, argv);
  const int threads = omp_get_max_threads();
  const Parameters p = parameters(0.006);
  const std::vector<Seed<3>> seeds = dam_break(p);

  const double one = evaluations_per_second<float>(p, seeds);
  group.at_least("particle_evaluations", one * 1e-6, "M/s", 5.0, perf::Ceiling::fma_float,
                 "dam break, 458,920 particles, one core");
  const double neighbours = mean_neighbours(p, seeds);
  group.figure("neighbours", neighbours, "-");
  group.figure("pairs", one * neighbours * 0.5e-9, "G/s", "each pair once");
  {
    Parameters diffusing = p;
    diffusing.diffusion = DiffusionChoice::fourtakas;
    const auto plain = make_sea<float>(p, seeds, 1), with = make_sea<float>(diffusing, seeds, 1);
    const double dt = 0.5 * plain->step_limit();
    for (SeaSph<3, float>* sea : {plain.get(), with.get()}) sea->set_step_control({.dt = dt, .steps_per_check = 2});
    group.at_most("fourtakas_extra",
                  perf::paired_ratio([&] { with->advance(2.0 * dt); }, [&] { plain->advance(2.0 * dt); }).median - 1.0, "-", 0.15,
                  perf::Ceiling::none, "windows of 2 steps in turns");
  }
  group.figure("double", evaluations_per_second<double>(p, seeds) * 1e-6, "M/s", "pairs in double");
  {
    const auto sea = make_sea<float>(p, seeds, 1);
    group.at_most("memory", double(sea->store().bytes()) / double(seeds.size()), "B/particle", 150.0);
    group.at_most("snapshot", double(sea->save().bytes()) / double(seeds.size()), "B/particle", 100.0, perf::Ceiling::none,
                  "only where a scheme repeats windows");
  }
  if (threads >= 2) {
    // Windows of the same number of steps, in turn on one and on two threads; what others do on the machine only ever adds.
    const auto one_thread = make_sea<float>(p, seeds, 1), two_threads = make_sea<float>(p, seeds, 2);
    const double dt = 0.5 * one_thread->step_limit(), duration = 4.0 * dt;
    double best_one = 1e300, best_two = 1e300;
    for (SeaSph<3, float>* sea : {one_thread.get(), two_threads.get()})
      sea->set_step_control({.dt = dt, .steps_per_check = 4}), sea->advance(duration);
    for (int n = 0; n < 7; ++n) {
      best_one = std::min(best_one, perf::seconds([&] { one_thread->advance(duration); }));
      best_two = std::min(best_two, perf::seconds([&] { two_threads->advance(duration); }));
    }
    group.at_least("two_threads", best_one / best_two, "-", 1.9, perf::Ceiling::none, "windows of 4 steps, best of 7 each");
    const auto task_s = [](const SeaSph<3, float>& sea) {
      double tasks = 0.0;
      for (int t = 0; t < sea.window_executor()->threads(); ++t) tasks += 1e-9 * double(sea.window_executor()->times(t).task_ns);
      return tasks;
    };
    const auto idle_share = [](const SeaSph<3, float>& sea) {
      double idle = 0.0, wall = 0.0;
      for (int t = 0; t < sea.window_executor()->threads(); ++t)
        idle += double(sea.window_executor()->times(t).idle_ns), wall += double(sea.window_executor()->times(t).wall_ns);
      return idle / wall;
    };
    group.figure("two_threads_task_time", task_s(*two_threads) / task_s(*one_thread), "-",
                 "seconds inside tasks, two threads over one");
    group.figure("two_threads_idle", idle_share(*two_threads), "-", "share of both threads' time");
  }

  double slowest = 1e30, fastest = 0.0;
  for (double spacing : {0.010, 0.006, 0.0028}) {
    const Parameters size = parameters(spacing);
    const std::vector<Seed<3>> particles = dam_break(size);
    const double partners = mean_neighbours(size, particles);
    const double rate = evaluations_per_second<float>(size, particles, 3.0) * partners;
    slowest = std::min(slowest, rate), fastest = std::max(fastest, rate);
    group.point("sea_size", "dam break, one core", double(particles.size()), "particles", rate * 0.5e-9, "pairs [G/s]");
  }
  group.at_most("size_dependence_per_pair", fastest / slowest - 1.0, "-", 0.10, perf::Ceiling::none,
                "dam break, 0.1 to 4.2 M particles");
  slowest = 1e30, fastest = 0.0;
  for (const std::array<int, 3>& cells : {std::array{60, 60, 30}, std::array{120, 120, 35}, std::array{380, 376, 35}}) {
    Domain<3> box;
    Parameters size = parameters(0.006);
    size.gravity = 0.0;
    const std::vector<Seed<3>> particles = periodic_water(size, cells, box);
    const double rate = evaluations_per_second<float>(size, particles, 3.0, box);
    slowest = std::min(slowest, rate), fastest = std::max(fastest, rate);
    group.point("sea_size_periodic", "water only, one core", double(particles.size()), "particles", rate * 1e-6,
                "evaluations [M/s]");
  }
  group.at_most("size_dependence_per_particle", fastest / slowest - 1.0, "-", 0.10, perf::Ceiling::none,
                "water only, periodic sides: the same partners at 0.11, 0.5 and 5.0 M particles");
  {
    Domain<3> box;
    Parameters paper = parameters(0.625);
    paper.eos = {1025.0, 800.0}, paper.alpha_solid = 0.0;
    const std::vector<Seed<3>> tank = paper_tank(paper, box);
    const auto sea = make_sea<float>(paper, tank, std::min(threads, 2), box);
    constexpr double dt = 2e-4;
    sea->set_step_control({.dt = dt, .steps_per_check = 2});
    sea->advance(2 * dt);
    double best = 1e300;
    for (int n = 0; n < 2; ++n) best = std::min(best, perf::seconds([&] { sea->advance(2 * dt); }) / 2);
    group.figure("paper_sea_particles", double(tank.size()) * 1e-6, "M");
    group.at_most("paper_sea", best / dt / 3600.0, "h per simulated s", 1.5, perf::Ceiling::fma_float,
                  "d 0.625 m, step 2e-4 s, h/d 1.732, from measured steps on two threads; the paper's 21.3 on eight cores");
  }
}
