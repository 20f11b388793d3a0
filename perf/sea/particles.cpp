// Speed and memory of the sea of particles on a dam break that DualSPHysics can run too: tank 1.6 x 0.67 x 0.4 m, water 0.4 x
// 0.67 x 0.3 m, post 0.12 x 0.12 x 0.45 m, spacing 6 mm, h/d 1.732, Wendland, c0 34 m/s, alpha 0.1, symplectic, CFL 0.2, dynamic
// walls, water displaced by up to a quarter spacing at random. Counted as particle evaluations (all particles, two per step)
// over wall time, everything included.
// Run by perf/run; what was tried is in docs/developer/sea.md.
// SPDX-License-Identifier: Apache-2.0
#include <omp.h>

#include <algorithm>
#include <cmath>
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

/// Particle evaluations per second over steps that last about `seconds_wanted`.
template <class Real>
double evaluations_per_second(const Parameters& p, const std::vector<Seed<3>>& seeds, double seconds_wanted = 4.0) {
  SeaSph<3, Real> sea(p, domain, seeds);
  for (int n = 0; n < 2; ++n) sea.step(1.0);
  const double one = perf::seconds([&] { sea.step(1.0); });
  const int steps = std::max(2, int(seconds_wanted / one));
  const double time = perf::seconds([&] {
    for (int n = 0; n < steps; ++n) sea.step(1.0);
  });
  return 2.0 * double(seeds.size()) * steps / time;
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
  Meetings<3, float> meets;
  meets.reserve(sea.store().clusters());
  const LawCount law{KernelWendland<3, float>(p.h())};
  for (int g = 0; g < sea.columns().groups(); ++g)
    sweep_pairs(sea.store(), sums.data(), sea.columns(), g, float(1.001 * p.reach()), meets, law, law);
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

  omp_set_num_threads(1);
  const double one = evaluations_per_second<float>(p, seeds);
  group.at_least("particle_evaluations", one * 1e-6, "M/s", 5.0, perf::Ceiling::fma_float,
                 "dam break, 458,920 particles, one core");
  const double neighbours = mean_neighbours(p, seeds);
  group.figure("neighbours", neighbours, "-");
  group.figure("pairs", one * neighbours * 0.5e-9, "G/s", "each pair once");
  Parameters diffusing = p;
  diffusing.diffusion = DiffusionChoice::fourtakas;
  group.at_most("fourtakas_extra", one / evaluations_per_second<float>(diffusing, seeds) - 1.0, "-", 0.15);
  group.figure("double", evaluations_per_second<double>(p, seeds) * 1e-6, "M/s", "pairs in double");
  if (threads >= 2) {
    omp_set_num_threads(2);
    group.at_least("two_threads", evaluations_per_second<float>(p, seeds) / one, "-", 1.9);
    omp_set_num_threads(1);
  }
  {
    SeaSph<3, float> sea(p, domain, seeds);
    group.at_most("memory", double(sea.store().bytes()) / double(seeds.size()), "B/particle", 150.0);
  }

  double slowest = 1e30, fastest = 0.0;
  for (double spacing : {0.010, 0.006, 0.0028}) {
    const Parameters size = parameters(spacing);
    const std::vector<Seed<3>> particles = dam_break(size);
    const double rate = evaluations_per_second<float>(size, particles, 3.0) * mean_neighbours(size, particles);
    slowest = std::min(slowest, rate), fastest = std::max(fastest, rate);
    group.point("sea_size", "float, one core", double(particles.size()), "particles", rate * 0.5e-9, "pairs [G/s]");
  }
  group.at_most("size_dependence", fastest / slowest - 1.0, "-", 0.10, perf::Ceiling::none, "per pair, 0.1 to 4.2 M particles");
}
