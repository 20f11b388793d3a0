// Paddle and damping zones by themselves: the strokes that theory asks for, ramps, the exact decay of a damped velocity.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/waves/dispersion.hpp"
#include "kernels/waves/wavemaker.hpp"
#include "src/sea/sph/damping.hpp"
#include "src/sea/sph/ordering.hpp"
#include "src/sea/sph/wavemaker.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

constexpr double depth = 20.6, period = 8.8, height = 1.88;  // the paper's wave

waves::Component regular() {
  const double omega = 2.0 * pi / period;
  return {.wave_number = waves::wave_number(omega, depth, 9.81),
          .angular_frequency = omega,
          .amplitude = 0.5 * height,
          .speed_amplitude = 0.5 * height * omega,
          .phase = 0.0,
          .direction = 0.0};
}
double stroke_of(const Wavemaker& maker, double from = 100.0) {
  double low = 1e9, high = -1e9;
  for (int n = 0; n < 2000; ++n) {
    const double x = maker.stroke(from + n * period / 2000).displacement;
    low = std::min(low, x), high = std::max(high, x);
  }
  return high - low;
}

}  // namespace

TEST_CASE("a piston has the stroke of Biesel, 1.56 m for the paper's wave", "[sea][sph][fast]") {
  const waves::Component wave = regular();
  const Wavemaker maker({.x = -250.0, .bed = -depth}, std::span(&wave, 1), false);
  CHECK(stroke_of(maker) == Approx(1.56).margin(0.005));
  const Wavemaker given({.x = -250.0, .bed = -depth}, std::span(&wave, 1), false, 2.0);
  CHECK(stroke_of(given) == Approx(2.0).epsilon(1e-5));
}

TEST_CASE("the paddle's velocity is the rate of its displacement, through the ramp too", "[sea][sph][fast]") {
  const waves::Component wave = regular();
  const bool flap = GENERATE(false, true);
  const Wavemaker maker({.flap = flap, .x = 3.0, .hinge = -depth, .bed = -depth, .start_s = 1.0, .ramp_s = 12.0},
                        std::span(&wave, 1), !flap);
  for (double t : {0.5, 1.5, 6.0, 12.9, 14.0, 30.0}) {
    const double e = 1e-5;
    CHECK(maker.stroke(t).velocity ==
          Approx((maker.stroke(t + e).displacement - maker.stroke(t - e).displacement) / (2 * e)).margin(1e-7));
    const Motion a = maker.motion(t - e), b = maker.motion(t + e), now = maker.motion(t);
    const Eigen::Vector3d top(0.0, 0.0, flap ? depth : 0.0);
    CHECK((now.point_velocity(top) - (b.point(top) - a.point(top)) / (2 * e)).norm() < 1e-6);
  }
  CHECK(maker.stroke(0.9).displacement == 0.0);
}

TEST_CASE("a paddle without a ramp does not jump at its start: from rest in still water, in its place where the water has waves",
          "[sea][sph][fast]") {
  std::vector<waves::Component> record{regular(), regular()};
  record[0].phase = 0.5 * pi, record[1].phase = 1.0, record[1].angular_frequency *= 1.3, record[1].wave_number *= 1.6;
  const bool in_waves = GENERATE(false, true);
  const Paddle paddle{.x = -3.0, .bed = -depth, .start_s = 1.0, .in_waves = in_waves};
  const Wavemaker maker(paddle, record, false);
  const double before = maker.stroke(0.0).displacement;
  CHECK(maker.stroke(0.0).velocity == 0.0);
  CHECK((before == 0.0) == !in_waves);
  CHECK(maker.stroke(1.0).displacement == before);
  CHECK(maker.stroke(1.0 + 1e-9).displacement == Approx(before).margin(1e-8));
  double harmonics = 0.0;
  for (const Wavemaker::Harmonic& h : maker.harmonics())
    harmonics += h.amplitude * (std::sin(h.omega * 9.0 + h.phase) - std::sin(h.omega * 1.0 + h.phase));
  CHECK(maker.stroke(9.0).displacement - before == Approx(harmonics));
  for (double t = 1.0; t < 100.0; t += 0.3) CHECK(std::abs(maker.stroke(t).displacement) <= maker.reach());
}

TEST_CASE("Madsen's second-order piston adds a tenth of the first harmonic or less where the wave is Stokes'",
          "[sea][sph][fast]") {
  const waves::Component wave = regular();
  const Wavemaker maker({.x = 0.0, .bed = -depth}, std::span(&wave, 1), true);
  REQUIRE(maker.harmonics().size() == 2);
  CHECK(maker.harmonics()[1].omega == 2.0 * maker.harmonics()[0].omega);
  // By hand at kh = 1.2588: 3 cosh/sinh^3 = 1.3593, 2/m1 = 1.6575, H^2/(32 h) = 5.3616e-3 m.
  const double kh = wave.wave_number * depth;
  const double by_hand =
      height * height / (32.0 * depth) * (3.0 * std::cosh(kh) / std::pow(std::sinh(kh), 3) - 2.0 / waves::piston_transfer(kh));
  CHECK(maker.harmonics()[1].amplitude == Approx(by_hand).epsilon(1e-12));
  CHECK(std::abs(maker.harmonics()[1].amplitude) < 0.1 * maker.harmonics()[0].amplitude);
}

TEST_CASE("a flap hinged at the bottom is the limit of raised hinges, and short flaps make smaller waves", "[sea][sph][fast]") {
  const double kh = GENERATE(0.3, 1.26, 4.0);
  CHECK(waves::flap_transfer(kh, 1e-9) == Approx(waves::flap_transfer(kh)).epsilon(1e-6));
  CHECK(waves::flap_transfer(kh, 0.5 * kh) < waves::flap_transfer(kh));
  CHECK(waves::flap_transfer(kh, 0.0) == waves::flap_transfer(kh));
}

TEST_CASE("a damped velocity decays exactly and only in the zone and in the water", "[sea][sph][fast]") {
  std::vector<Seed<2>> seeds;
  for (int n = 0; n < 40; ++n)
    seeds.push_back({.position = {0.25 * n, 0.0}, .velocity = {1.0, -2.0}, .owner = std::uint16_t(n >= 36)});
  const Domain<2> domain{{-1.0, -1.0}, {11.0, 1.0}};
  Store<2, float> store;
  fill<2, float>(store, seeds, Columns<2>(domain, 1.0, 1.0), 0.25);
  const Damping zones{.zones = {{4.0, 8.0, 3.0}}};
  damp(store, zones, 0.0, 0.1, 0, store.clusters(), [](double) {});
  for (std::size_t slot = 0; slot < store.slots(); ++slot) {
    if (store.id[slot] == no_particle) continue;
    const double s = std::clamp((store.x[0][slot] - 4.0) / 4.0, 0.0, 1.0);
    const bool water = store.owner[slot / cluster_size] == 0;
    CHECK(store.v[0][slot] == Approx(water ? std::exp(-3.0 * s * s * 0.1) : 1.0));
    CHECK(store.v[1][slot] == Approx(-2.0 * store.v[0][slot]));
  }
}

TEST_CASE("a damping zone across the tank brakes by y alone", "[sea][sph][fast]") {
  std::vector<Seed<3>> seeds;
  for (int n = 0; n < 40; ++n) seeds.push_back({.position = {5.0 - 0.1 * n, 0.25 * n, 0.0}, .velocity = {1.0, 0.0, 0.0}});
  Store<3, float> store;
  fill<3, float>(store, seeds, Columns<3>({{-1.0, -1.0, -1.0}, {11.0, 11.0, 1.0}}, 1.0, 1.0), 0.25);
  const Damping zones{.zones = {{.from = 4.0, .to = 8.0, .rate = 3.0, .axis = 1}}};
  damp(store, zones, 0.0, 0.1, 0, store.clusters(), [](double) {});
  for (std::size_t slot = 0; slot < store.slots(); ++slot) {
    if (store.id[slot] == no_particle) continue;
    const double s = std::clamp((store.x[1][slot] - 4.0) / 4.0, 0.0, 1.0);
    CHECK(store.v[0][slot] == Approx(std::exp(-3.0 * s * s * 0.1)));
  }
}

TEST_CASE("a zone that leads to waves leaves of the difference to their motion what exponential decay does", "[sea][sph][fast]") {
  constexpr double t = 3.0, ahead = 0.7, dt = 0.1, rate = 2.0;
  std::vector<Seed<3>> seeds;
  for (int n = 0; n < 40; ++n)
    seeds.push_back(
        {.position = {0.25 * n, 0.1 * n, 0.4 - 0.1 * n}, .velocity = {1.0, 0.3, -2.0}, .owner = std::uint16_t(n >= 36)});
  Store<3, float> store;
  fill<3, float>(store, seeds, Columns<3>({{-1.0, -1.0, -5.0}, {11.0, 11.0, 1.0}}, 1.0, 1.0), 0.25);
  const std::array<waves::Component, 1> sea{regular()};
  const Damping zones{
      .zones = {{4.0, 8.0, rate, 0, true}, {2.0, 0.0, rate}}, .waves = waves::grouped(sea, depth), .ahead = ahead};
  double taken = 0.0, expected = 0.0;
  damp(store, zones, t, dt, 0, store.clusters(), [&](double speed2) { taken += speed2; });
  for (std::size_t slot = 0; slot < store.slots(); ++slot) {
    if (store.id[slot] == no_particle) continue;
    const double x = store.x[0][slot], y = store.x[1][slot], z = store.x[2][slot];
    const double s = std::max(0.0, 1.0 - std::abs(x - 6.0) / 2.0), beyond = std::clamp((x - 6.0) / 2.0, 0.0, 1.0);
    const double other = std::clamp((2.0 - x) / 2.0, 0.0, 1.0), to_rest = other * other + 0.2 * beyond * beyond;
    const waves::Component& c = sea[0];
    const double phase = c.wave_number * x - c.angular_frequency * (t + ahead) + c.phase, k = c.wave_number;
    const double over = z > 0.0 ? 1.0 : 0.0, at = z > 0.0 ? 0.0 : z;  // above still water along the tangent
    const double even = std::cosh(k * (at + depth)), odd = std::sinh(k * (at + depth)), bottom = std::sinh(k * depth);
    const std::array<double, 3> start{1.0, 0.3, -2.0},
        motion{c.speed_amplitude * (even + over * k * z * odd) / bottom * std::cos(phase), 0.0,
               c.speed_amplitude * (odd + over * k * z * even) / bottom * std::sin(phase)};
    const bool water = store.owner[slot / cluster_size] == 0;
    CAPTURE(x, y, z, water);
    for (int d = 0; d < 3; ++d) {
      const double goal = s > 0.0 ? motion[std::size_t(d)] * s * s / (s * s + to_rest) : 0.0,
                   left = water ? std::exp(-rate * (s * s + to_rest) * dt) : 1.0;
      CHECK(store.v[d][slot] == Approx(goal + (start[std::size_t(d)] - goal) * left).margin(1e-12));
      expected += start[std::size_t(d)] * start[std::size_t(d)] - store.v[d][slot] * store.v[d][slot];
    }
  }
  CHECK(taken == Approx(expected));
}
