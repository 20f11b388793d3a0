// The balance of the water's energy: compression's integral, a closed block, a block over a wall, damping; sums that no order
// changes. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "src/sea/sph/energy_flow.hpp"
#include "src/sea/sph/sea_sph.hpp"
#include "tests/src/sea/sph/scenes.hpp"

using namespace spindrift::sph;

namespace {

/// Kinetic, potential and compression energy of the water [J].
template <int dim, class Real>
double energy(const SeaSph<dim, Real>& sea) {
  const Parameters& p = sea.parameters();
  double sum = 0.0;
  for (std::size_t slot = 0; slot < sea.store().slots(); ++slot) {
    if (sea.store().id[slot] == no_particle || sea.store().owner[slot / cluster_size] != 0) continue;
    double speed2 = 0.0;
    for (int k = 0; k < dim; ++k) speed2 += sea.store().v[k][slot] * sea.store().v[k][slot];
    sum += 0.5 * speed2 + p.gravity * sea.store().x[dim - 1][slot] + p.eos.compression_energy(sea.store().deviation[slot]);
  }
  return p.mass(dim) * sum;
}

Parameters water(double cfl) {
  Parameters p;
  p.spacing = 0.1, p.eos = {1000.0, 20.0}, p.cfl = cfl;
  return p;
}

/// What the sums do not explain of 0.1 s of a disordered block, over the energy that they say was dissipated.
double unexplained(const Parameters& p, bool wall, double* dissipated = nullptr) {
  SeaSph<2, double> sea(p, Domain<2>{{-5, -5}, {5, 5}}, disordered_block<2>(p.spacing, {14, 12}, {0, 0}, wall));
  const double before = energy(sea), quantum = energy_quantum(p, 2);
  sea.advance(0.1);
  const EnergyFlow& sums = sea.state().energy;
  const double lost = quantum * double(sums.from_solids - sums.onto_water), taken = quantum * double(sums.absorbed);
  if (dissipated) *dissipated = lost;
  return std::abs(energy(sea) - before - quantum * double(sums.from_solids) + lost + taken) / (std::abs(lost) + taken);
}

}  // namespace

TEST_CASE("energy of compression is the integral of p over rho squared", "[sph][fast]") {
  const EosTait eos{1000.0, 20.0};
  CHECK(eos.compression_energy(0.0) == 0.0);
  for (const double deviation : {-30.0, -1.0, 1e-3, 2.0, 150.0}) {
    double sum = 0.0;  // Simpson's rule
    constexpr int parts = 200;
    const double step = deviation / parts;
    const auto f = [&](double d) { return eos.pressure(d) / ((eos.rho0 + d) * (eos.rho0 + d)); };
    for (int n = 0; n < parts; ++n) sum += step / 6.0 * (f(n * step) + 4.0 * f((n + 0.5) * step) + f((n + 1) * step));
    CHECK(eos.compression_energy(deviation) == Approx(sum).epsilon(1e-10));
  }
}

TEST_CASE("what goes into the water and out of it explains its energy, the better the smaller the steps", "[sph][fast]") {
  for (const bool wall : {false, true}) {
    INFO((wall ? "over a wall" : "free"));
    double dissipated = 0.0;
    const double coarse = unexplained(water(0.2), wall, &dissipated), fine = unexplained(water(0.05), wall);
    CHECK(dissipated > 0.0);
    CHECK(coarse < 0.01);
    CHECK(fine < 0.3 * coarse);
  }
}

TEST_CASE("without viscosity nothing is dissipated by water alone", "[sph][fast]") {
  Parameters p = water(0.05);
  p.alpha = 0.0;
  SeaSph<2, double> sea(p, Domain<2>{{-5, -5}, {5, 5}}, disordered_block<2>(p.spacing, {14, 12}, {0, 0}, false));
  const double before = energy(sea);
  sea.advance(0.05);
  const EnergyFlow& sums = sea.state().energy;
  CHECK(sums.from_solids == 0);
  CHECK(energy_quantum(p, 2) * std::abs(double(sums.onto_water)) < 2e-3 * before);
}

TEST_CASE("damping zones take what they take", "[sph][fast]") {
  const Parameters p = water(0.1);
  SeaSph<2, double> sea(p, Domain<2>{{-5, -5}, {5, 5}}, disordered_block<2>(p.spacing, {14, 12}, {0, 0}, false));
  sea.state().damping.everywhere = 30.0;
  const double before = energy(sea), quantum = energy_quantum(p, 2);
  sea.advance(0.05);
  const EnergyFlow& sums = sea.state().energy;
  CHECK(sums.absorbed > 0);
  CHECK(energy(sea) - before == Approx(quantum * double(sums.onto_water - sums.absorbed)).epsilon(0.02));
}

TEST_CASE("rounded to quanta, parts add up the same in any order", "[sph][fast]") {
  const ToQuanta quanta(std::exp2(-30.0));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<double> parts(10'000);
  double exact = 0.0;
  for (double& part : parts) part = unit(random), exact += part;
  double forward = 0.0, backward = 0.0;
  for (const double part : parts) forward += quanta(part);
  for (auto part = parts.rbegin(); part != parts.rend(); ++part) backward += quanta(*part);
  CHECK(forward == backward);
  CHECK(quanta.count(forward) == quanta.count(backward));
  CHECK(std::abs(forward - exact) < 1e-6);
}
