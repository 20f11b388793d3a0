// Short-crested seas, constrained crests, diffraction at a column. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <vector>

#include "kernels/waves/constrained.hpp"
#include "kernels/waves/diffraction_maccamy_fuchs.hpp"
#include "kernels/waves/directional.hpp"
#include "kernels/waves/realisation.hpp"

using namespace spindrift;
using namespace spindrift::waves;

namespace {

std::vector<Component> sea(std::uint64_t seed, std::size_t count = 400) {
  const SeaState state{6.0, 10.0, 3.3};
  std::vector<Component> components(count);
  equal_energy(state, components);
  finish_realisation(state, seed, 0.5, 200.0, 9.81, components);
  return components;
}

double elevation(const std::vector<Component>& all, double t, double x, double y) {
  double sum = 0.0;
  for (const Component& c : all)
    sum += c.amplitude *
           std::cos(c.wave_number * (x * std::cos(c.direction) + y * std::sin(c.direction)) - c.angular_frequency * t + c.phase);
  return sum;
}

}  // namespace

TEST_CASE("directions of a short-crested sea have the moments of their density", "[waves][fast]") {
  // Of cos^2s(b/2): mean of cos b is s/(s+1), of cos 2b s(s-1)/((s+1)(s+2)) (Mitsuyasu et al. 1975).
  const double s = GENERATE(1.0, 4.0, 15.0);
  std::vector<Component> all = sea(3);
  spread(all, s, 2.0 * pi, 3);
  const auto means = [](std::span<const Component> some) {
    double one = 0.0, two = 0.0, across = 0.0;
    for (const Component& c : some) {
      const double b = c.direction - 0.5;
      one += std::cos(b) / double(some.size()), two += std::cos(2.0 * b) / double(some.size());
      across += std::sin(b) / double(some.size());
    }
    return std::array{one, two, across};
  };
  CHECK(means(all)[0] == Approx(s / (s + 1.0)).margin(0.004));
  CHECK(means(all)[1] == Approx(s * (s - 1.0) / ((s + 1.0) * (s + 2.0))).margin(0.008));
  CHECK(std::abs(means(all)[2]) < 0.006);
  // Every band of forty neighbours has them.
  for (std::size_t from = 0; from < all.size(); from += 40)
    CHECK(means(std::span(all).subspan(from, 40))[0] == Approx(s / (s + 1.0)).margin(0.04));
  std::vector<Component> half = sea(3);
  spread(half, 1.0, pi, 3);  // cos^2 over half a circle: mean of cos 2b is 1/2
  CHECK(means(half)[1] == Approx(0.5).margin(0.005));
  for (const Component& c : half) CHECK(std::abs(c.direction - 0.5) <= 0.5 * pi);
}

TEST_CASE("a constrained sea has its crest, and its energy elsewhere", "[waves][fast]") {
  std::vector<Component> all = sea(11);
  const std::vector<Component> random = all;
  spread(all, 8.0, 2.0 * pi, 11);
  const Crest crest{5.5, 120.0, 30.0, -20.0, true};
  raise_crest(all, crest);
  CHECK(elevation(all, 120.0, 30.0, -20.0) == Approx(5.5).epsilon(1e-12));
  const double d = 1e-3;
  CHECK((elevation(all, 120.0 + d, 30.0, -20.0) - elevation(all, 120.0 - d, 30.0, -20.0)) / (2.0 * d) ==
        Approx(0.0).margin(1e-6));
  CHECK(elevation(all, 121.5, 30.0, -20.0) < 5.5);
  CHECK(elevation(all, 118.5, 30.0, -20.0) < 5.5);
  for (const Component& c : all) CHECK(c.speed_amplitude == Approx(c.amplitude * c.angular_frequency));
  // Far from the crest the sea is the random one: of long-crested waves, to compare.
  std::vector<Component> constrained = random;
  raise_crest(constrained, crest);
  double difference = 0.0, spread_of = 0.0;
  for (int i = 0; i < 400; ++i) {
    const double t = 700.0 + 0.5 * i, was = elevation(random, t, 30.0, -20.0);
    difference += std::pow(elevation(constrained, t, 30.0, -20.0) - was, 2), spread_of += was * was;
  }
  CHECK(difference < 0.06 * spread_of);
}

TEST_CASE("the mean of many constrained seas is NewWave", "[waves][fast]") {
  const Crest crest{5.0, 0.0, 0.0, 0.0, true}, alone{5.0, 0.0, 0.0, 0.0, false};
  std::vector<Component> shape = sea(1, 200);
  raise_crest(shape, alone);
  CHECK(elevation(shape, 0.0, 0.0, 0.0) == Approx(5.0));
  CHECK(elevation(shape, 3.0, 0.0, 0.0) == Approx(elevation(shape, -3.0, 0.0, 0.0)));  // the autocorrelation
  constexpr int seeds = 200;
  double at_4 = 0.0, at_10 = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    std::vector<Component> one = sea(std::uint64_t(seed), 200);
    raise_crest(one, crest);
    at_4 += elevation(one, 4.0, 0.0, 0.0) / seeds, at_10 += elevation(one, 10.0, 0.0, 0.0) / seeds;
  }
  // Three times the deviation of the mean of 200 records of deviation 1.5 m.
  CHECK(at_4 == Approx(elevation(shape, 4.0, 0.0, 0.0)).margin(0.32));
  CHECK(at_10 == Approx(elevation(shape, 10.0, 0.0, 0.0)).margin(0.32));
}

TEST_CASE("MacCamy and Fuchs's load is the pressure of the scattered wave round the column", "[waves][fast]") {
  CHECK(std::abs(maccamy_fuchs(1e-9) - 2.0) < 1e-12);
  CHECK(std::abs(maccamy_fuchs(0.01) - 2.0) < 2e-3);
  // The whole potential at r = a, harmonic by harmonic, summed round the circle: e_n i^n (J_n - J_n' H_n / H_n') cos n theta.
  const double ka = GENERATE(0.1, 0.5, 1.0, 2.5);
  const auto hankel = [](int n, double x) { return std::complex<double>(std::cyl_bessel_j(n, x), std::cyl_neumann(n, x)); };
  const auto slope = [&](auto f, int n) { return n == 0 ? -f(1, ka) : 0.5 * (f(n - 1, ka) - f(n + 1, ka)); };
  const auto bessel = [](int n, double x) { return std::complex<double>(std::cyl_bessel_j(n, x)); };
  std::complex<double> force = 0.0, i_n = 1.0;
  constexpr int points = 64;
  for (int n = 0; n < 8; ++n, i_n *= std::complex<double>(0.0, 1.0)) {
    const std::complex<double> p =
        (n == 0 ? 1.0 : 2.0) * i_n * (bessel(n, ka) - slope(bessel, n) * hankel(n, ka) / slope(hankel, n));
    for (int m = 0; m < points; ++m) {
      const double theta = 2.0 * pi * m / points;
      force += p * std::cos(n * theta) * std::cos(theta) * ka * 2.0 * pi / double(points);
    }
  }
  // Against the displaced mass times the acceleration at the axis: gradient i k over the area pi a^2.
  CHECK(std::abs(force / (std::complex<double>(0.0, 1.0) * pi * ka * ka) - maccamy_fuchs(ka)) < 1e-10);
}
