// Decaying isotropic turbulence behind a grid, Comte-Bellot & Corrsin 1971, J. Fluid Mech. 48, 273: spectra of their table 3 (M
// = 5.08 cm, U0 = 10 m/s) at t U0 / M = 42, 98 and 171. A box of 9 x 2 pi cm starts from random modes with the first spectrum;
// the energy that 32^3 cells hold (wave numbers up to pi over their width) must fall as that of the experiment's same wave
// numbers, with a closure for what they do not hold. SPDX-License-Identifier: Apache-2.0
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <random>

#include "kernels/base/constants.hpp"
#include "tests/replica.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

constexpr double box_side = 0.18 * pi;  // m

struct Spectrum {
  double k, at_42, at_98, at_171;  // 1/cm; cm3/s2
};
constexpr Spectrum measured[]{{.15, 0, 0, 49.7},      {.2, 129, 106, 92},   {.25, 230, 196, 120},  {.3, 322, 195, 125},
                              {.4, 435, 202, 98},     {.5, 457, 168, 81.5}, {.7, 380, 127, 60.2},  {1, 270, 79.2, 39.4},
                              {1.5, 168, 47.8, 24.1}, {2, 120, 34.6, 16.5}, {2.5, 89, 28.6, 12.5}, {3, 70.3, 23.1, 9.12},
                              {4, 47, 14.3, 5.62},    {6, 24.7, 5.95, 1.69}};

/// Straight between the points in logarithms [m3/s2] of k [1/m]; below the first of them as k^2.
double spectrum(double k, double Spectrum::*when) {
  const double kc = 0.01 * k;
  const Spectrum *a = nullptr, *b = nullptr;
  for (const Spectrum& p : measured) {
    if (p.*when == 0.0) continue;
    if (p.k <= kc) a = &p;
    if (p.k > kc && b == nullptr) b = &p;
  }
  if (a == nullptr) return 1e-6 * (b->*when) * std::pow(kc / b->k, 2);
  if (b == nullptr) return 0.0;
  const double share = std::log(kc / a->k) / std::log(b->k / a->k);
  return 1e-6 * std::exp((1.0 - share) * std::log(a->*when) + share * std::log(b->*when));
}
/// Energy per mass of the wave numbers that n cells a side hold [m2/s2].
double held(int n, double Spectrum::*when) {
  const double low = pi / box_side, high = pi * n / box_side;  // half the box's own wave number: where its shell 1 begins
  double sum = 0.0;
  constexpr int steps = 4000;
  for (int m = 0; m < steps; ++m) sum += spectrum(low + (m + 0.5) * (high - low) / steps, when) * (high - low) / steps;
  return sum;
}

/// Velocities of random solenoidal modes with that energy in each shell of wave numbers, at cell centres [m/s].
std::vector<std::array<double, 3>> modes(int n) {
  std::mt19937_64 random(7 + spindrift::testing::replica().seed);
  std::normal_distribution<double> normal;
  const int top = n / 2 - 1;
  using C = std::complex<double>;
  struct Mode {
    int k[3];
    C a[3];
  };
  std::vector<Mode> all;
  std::vector<double> energy(std::size_t(top) + 2);
  for (int x = 0; x <= top; ++x)
    for (int y = -top; y <= top; ++y)
      for (int z = -top; z <= top; ++z) {
        if (x == 0 && (y < 0 || (y == 0 && z <= 0))) continue;  // the other half is conjugate
        const double size = std::sqrt(double(x * x + y * y + z * z));
        const int shell = int(size + 0.5);
        if (shell > top) continue;
        Mode m{{x, y, z}, {}};
        C along = 0.0;
        for (int d = 0; d < 3; ++d) m.a[d] = C(normal(random), normal(random)), along += m.a[d] * double(m.k[d]) / size;
        for (int d = 0; d < 3; ++d) m.a[d] -= along * double(m.k[d]) / size;
        for (int d = 0; d < 3; ++d)
          energy[std::size_t(shell)] += std::norm(m.a[d]);  // of 2 Re(a e^ikx): mean square 2 |a|^2, half of it
        all.push_back(m);
      }
  const double unit = 2.0 * pi / box_side;
  for (Mode& m : all) {
    const double size = std::sqrt(double(m.k[0] * m.k[0] + m.k[1] * m.k[1] + m.k[2] * m.k[2]));
    const int shell = int(size + 0.5);
    const double factor = std::sqrt(spectrum(shell * unit, &Spectrum::at_42) * unit / energy[std::size_t(shell)]);
    for (C& a : m.a) a *= factor;
  }
  // Sums over x, then y, then z: n^4 operations, not n^6.
  const auto phase = [&](int k, int cell) { return std::polar(1.0, 2.0 * pi * k * (cell + 0.5) / n); };
  const int wide = 2 * top + 1;
  std::vector<std::array<C, 3>> by_x(std::size_t(n * wide * wide)), by_xy(std::size_t(n * n * wide));
  for (const Mode& m : all)
    for (int i = 0; i < n; ++i) {
      const C p = phase(m.k[0], i);
      auto& to = by_x[std::size_t((i * wide + m.k[1] + top) * wide + m.k[2] + top)];
      for (std::size_t d = 0; d < 3; ++d) to[d] += p * m.a[d];
    }
  for (int i = 0; i < n; ++i)
    for (int y = -top; y <= top; ++y)
      for (int j = 0; j < n; ++j) {
        const C p = phase(y, j);
        for (int z = 0; z < wide; ++z)
          for (std::size_t d = 0; d < 3; ++d)
            by_xy[std::size_t((i * n + j) * wide + z)][d] += p * by_x[std::size_t((i * wide + y + top) * wide + z)][d];
      }
  std::vector<std::array<double, 3>> u(std::size_t(n * n * n));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int z = -top; z <= top; ++z)
        for (int k = 0; k < n; ++k) {
          const C p = phase(z, k);
          for (std::size_t d = 0; d < 3; ++d)
            u[std::size_t((k * n + j) * n + i)][d] += 2.0 * (p * by_xy[std::size_t((i * n + j) * wide + z + top)][d]).real();
        }
  return u;
}

/// Energy and what drained it between two stations [m2/s2]: the closure and the laminar viscosity by their fluxes through the
/// faces, the rest is the scheme's (its flux, its step).
struct Fall {
  double energy = 0.0, lost = 0.0, closure = 0.0, viscous = 0.0;
  double scheme() const { return lost - closure - viscous; }
};
struct Decay {
  double at_42;
  Fall to_98, to_171;
};
Decay decay_of(const std::string& closure, int n, double upwinding) {
  FlowSetting s = air(0.1);
  s.stream = {};
  const double faster = s.speed / 1.0;  // 1 m/s of the experiment is Mach 0.1: as fast as costs little and compresses nothing
  s.viscous = true, s.turbulence = closure, s.upwinding = upwinding;
  s.gas.viscosity = {.mu0 = gas::density(s.gas, s.stream) * 1.5e-5 * faster, .T0 = 288.15, .S = 110.33};
  const double window = 0.0508 / 10.0 / faster;  // M / U0
  s.time_order = 2;
  s.march = {.cfl_start = 1e3, .drop = 1e-2, .max_steps = 40, .matrix_free_below = 2.0};
  BoxOptions o{.ni = n, .nj = n, .nk = n, .high = Eigen::Vector3d::Constant(box_side)};
  o.periodic = {true, true, true};
  constexpr int first_steps = 28, second_steps = 36;
  const double first_step = (98 - 42) * window / first_steps, second_step = (171 - 98) * window / second_steps;
  s.dt = first_step;
  Case c(cartesian_box(o), s, {}, {});
  const auto u = modes(n);
  c.solver->start([&](const Eigen::Vector3d& x) {
    const auto at = [&](int d) { return std::min(n - 1, int(x[d] / box_side * n)); };
    const auto& v = u[std::size_t((at(2) * n + at(1)) * n + at(0))];
    return gas::Primitive<double>{0.0, faster * v[0], faster * v[1], faster * v[2], 0.0};
  });
  c.prepare(MPI_COMM_SELF, {.threads = 1});
  const auto for_cells = [&](FlowTile& tile, auto&& body) {
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; ++i)
        body(gas::load_primitive<double>(tile.state.data() + tile.cells.at(k, j, i), std::size_t(tile.cells.component)),
             tile.inner.at(k, j, i));
    });
  };
  const auto energy = [&] {
    double sum = 0.0, cells = 0.0;
    for (FlowTile& tile : c.solver->tiles())
      for_cells(tile, [&](const auto& q, std::ptrdiff_t) { sum += gas::kinetic(q), cells += 1.0; });
    return sum / cells / (faster * faster);
  };
  // Per time of the experiment: velocity times the force of all friction, and of the laminar one alone.
  struct Drain {
    double all, laminar;
  };
  const auto drain = [&] {
    double sums[2] = {}, cells = 0.0;
    for (FlowTile& tile : c.solver->tiles()) {
      const bool eddies = tile.eddies;
      for (const bool laminar : {false, true}) {
        AlignedArray<double> force(tile.inner.size(tile.unknowns()));
        tile.eddies = eddies && !laminar;
        sweep_viscous(tile, tile.state.data(), force.data(), {.gas = s.gas, .active = true});
        for_cells(tile, [&](const auto& q, std::ptrdiff_t at) {
          const double* f = force.data() + at;
          const std::ptrdiff_t component = tile.inner.component;
          sums[laminar] += q.u * f[component] + q.v * f[2 * component] + q.w * f[3 * component];
        });
      }
      tile.eddies = eddies;
      for_cells(tile, [&](const auto&, std::ptrdiff_t) { cells += 1.0; });
    }
    const double unit = gas::density(s.gas, s.stream) * std::pow(box_side / n, 3) * cells * std::pow(faster, 3);
    return Drain{sums[0] / unit, sums[1] / unit};
  };
  Decay d{energy(), {}, {}};
  double before = d.at_42;
  const auto advance = [&](int steps, double step) {
    Fall f;
    Drain last = drain();  // nothing before the first step, for want of gradients
    for (int m = 0; m < steps; ++m) {
      c.run();
      REQUIRE(c.solver->march().verdict == Verdict::converged);
      c.solver->judgement().rows.all.clear();
      const Drain now = drain();
      const bool first = last.all == 0.0;
      const double time = step * faster, laminar = first ? now.laminar : 0.5 * (last.laminar + now.laminar),
                   all = first ? now.all : 0.5 * (last.all + now.all);
      f.viscous += time * laminar, f.closure += time * (all - laminar), last = now;
    }
    f.energy = energy(), f.lost = before - f.energy, before = f.energy;
    return f;
  };
  d.to_98 = advance(first_steps, first_step);
  c.solver->set_time_step(second_step);
  d.to_171 = advance(second_steps, second_step);
  return d;
}

}  // namespace

// Random phases transfer nothing at first, so the fall from 42 to 98 lags; from 98 to 171 the flow is its own.
TEST_CASE("a closure for large eddies drains isotropic turbulence at the rate of the experiment", "[flow][nightly]") {
  constexpr int n = 32;
  const double first = held(n, &Spectrum::at_42), second = held(n, &Spectrum::at_98), third = held(n, &Spectrum::at_171);
  const std::string closure = GENERATE(as<std::string>{}, "les_wale", "les_smagorinsky");
  const Decay d = decay_of(closure, n, 0.25);
  CAPTURE(closure, first, second, third, d.at_42, d.to_98.energy, d.to_171.energy);
  CHECK(d.at_42 == Approx(first).epsilon(0.03));
  CHECK(d.to_98.energy == Approx(second).epsilon(0.15));
  CHECK(d.to_171.energy == Approx(third).epsilon(0.15));
  CHECK(d.to_171.energy / d.to_98.energy == Approx(third / second).epsilon(0.05));
}

// Which part of the drain is whose: with a twentieth of the flux's dissipation left the scheme alone drains far too little, and
// what the closure adds is what was missing. The closure's and the viscous part are those of their fluxes, cell by cell; the
// scheme's is the rest.
TEST_CASE("what drains isotropic turbulence is the closure and not the scheme", "[flow][nightly]") {
  constexpr int n = 24;
  const double kept = held(n, &Spectrum::at_171) / held(n, &Spectrum::at_98);  // by the experiment
  const Decay with = decay_of("les_wale", n, 0.05), without = decay_of("none", n, 0.05);
  const Fall &f = with.to_171, &g = without.to_171;
  CAPTURE(kept, f.energy / with.to_98.energy, g.energy / without.to_98.energy, f.closure / f.lost, f.viscous / f.lost,
          f.scheme() / f.lost, g.viscous / g.lost);
  CHECK(f.energy / with.to_98.energy == Approx(kept).epsilon(0.03));
  CHECK(f.closure > 0.75 * f.lost);
  CHECK(f.scheme() > 0.0);
  CHECK(f.scheme() < 0.15 * f.lost);
  CHECK(g.closure == 0.0);
  CHECK(g.energy / without.to_98.energy > 1.3 * kept);
}
