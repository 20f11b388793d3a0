// Bound waves of second order: pairs against Stokes and deep water, sums of products against plain sums, set-down and skewness.
// The surface's conditions to second order are tested on the whole sea, in tests/src/sea/wave_field_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/waves/bound_waves.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "kernels/base/random.hpp"
#include "kernels/waves/realisation.hpp"
#include "kernels/waves/stokes.hpp"

using namespace spindrift;
using namespace spindrift::waves;

namespace {

constexpr double gravity = 9.81;

Component airy(double amplitude, double omega, double depth, double phase = 0.3, double direction = 0.0) {
  return {wave_number(omega, depth, gravity), omega, amplitude, amplitude * omega, phase, direction};
}

std::vector<Component> random_sea(std::size_t count, double depth, double direction) {
  const SeaState state{4.0, 9.0, 3.3};
  std::vector<Component> sea(count);
  equal_energy(state, sea);
  finish_realisation(state, 5, direction, depth, gravity, sea);
  return sea;
}

/// The double sum over m and n as it is written, harmonic by harmonic.
struct Plain {
  Surface surface;
  Kinematics kinematics;
};
Plain plain(std::span<const Component> sea, double depth, double t, double x, double y, double z) {
  Plain sum;
  const double cb = std::cos(sea[0].direction), sb = std::sin(sea[0].direction), along = cb * x + sb * y;
  for (const Component& m : sea)
    for (const Component& n : sea)
      for (const BoundAt at : {BoundAt::sum, BoundAt::difference}) {
        const double sign = at == BoundAt::sum ? 1.0 : -1.0;
        const BoundPair pair = bound_pair(m, n, at, depth, gravity);
        const double k = m.wave_number + sign * n.wave_number, w = m.angular_frequency + sign * n.angular_frequency;
        const double psi = k * along - w * t + m.phase + sign * n.phase, a = m.amplitude * n.amplitude;
        const double c = std::cosh(k * (z + depth)) / std::cosh(k * depth), s = std::sinh(k * (z + depth)) / std::cosh(k * depth);
        const double phi = a * pair.potential, slope = -a * pair.elevation * k * std::sin(psi);
        sum.surface.elevation += a * pair.elevation * std::cos(psi);
        sum.surface.slope_x += slope * cb, sum.surface.slope_y += slope * sb;
        const double u = phi * k * c * std::cos(psi), du = phi * k * w * c * std::sin(psi);
        sum.kinematics.velocity += Eigen::Vector3d(u * cb, u * sb, phi * k * s * std::sin(psi));
        sum.kinematics.acceleration += Eigen::Vector3d(du * cb, du * sb, -phi * k * w * s * std::cos(psi));
        sum.kinematics.pressure_over_density += phi * w * c * std::cos(psi);
      }
  return sum;
}

}  // namespace

TEST_CASE("a wave and itself carry the harmonic of Stokes and the set-down, deep and shallow", "[waves][fast]") {
  const double depth = GENERATE(8.0, 20.6, 900.0), a = 0.7;
  const Component first = airy(a, 0.714, depth), second = stokes_second(first, depth);
  const double k = first.wave_number;
  const BoundPair sum = bound_pair(first, first, BoundAt::sum, depth, gravity);
  CHECK(a * a * sum.elevation == Approx(second.amplitude).epsilon(1e-10));
  CHECK(a * a * sum.potential * 2.0 * k * std::tanh(2.0 * k * depth) == Approx(second.speed_amplitude).margin(1e-14));
  const BoundPair difference = bound_pair(first, first, BoundAt::difference, depth, gravity);
  CHECK(difference.elevation == Approx(-0.5 * k / std::sinh(2.0 * k * depth)).margin(1e-16));
  CHECK(difference.potential == 0.0);
  // Two waves of half the amplitude and one frequency are that wave, as a sea.
  const BoundWaves two(std::vector{airy(0.5 * a, 0.714, depth), airy(0.5 * a, 0.714, depth)}, depth, gravity);
  ComponentGroup stokes;
  set_lane(stokes, 0, second, depth);
  const double set_down = -0.5 * a * a * k / std::sinh(2.0 * k * depth);
  for (const double t : {0.0, 1.3, 5.0}) {
    const Surface s = two.surface(t, 12.0, 3.0), of_stokes = surface({&stokes, 1}, t, 12.0, 3.0);
    CHECK(s.elevation == Approx(of_stokes.elevation + set_down).epsilon(1e-9));
    CHECK(s.slope_x == Approx(of_stokes.slope_x).epsilon(1e-9));
    for (const double z : {0.0, -0.4 * depth, -depth}) {
      const Kinematics q = two.kinematics(t, 12.0, 3.0, z), p = kinematics({&stokes, 1}, t, 12.0, 3.0, z);
      CHECK((q.velocity - p.velocity).norm() < 1e-10);
      CHECK((q.acceleration - p.acceleration).norm() < 1e-10);
    }
  }
}

TEST_CASE("two waves in deep water carry the waves of Longuet-Higgins", "[waves][fast]") {
  const double depth = 1e5, wm = 0.9, wn = GENERATE(0.3, 0.7, 0.89);
  const Component m = airy(1.0, wm, depth), n = airy(1.0, wn, depth);
  const BoundPair sum = bound_pair(m, n, BoundAt::sum, depth, gravity);
  CHECK(sum.elevation == Approx(0.25 * (m.wave_number + n.wave_number)));
  CHECK(sum.potential == Approx(0.0).margin(1e-12));
  for (const auto& [one, other] : {std::pair{m, n}, std::pair{n, m}}) {
    const double sign = one.angular_frequency > other.angular_frequency ? 1.0 : -1.0;
    const BoundPair difference = bound_pair(one, other, BoundAt::difference, depth, gravity);
    CHECK(difference.elevation == Approx(-0.25 * (m.wave_number - n.wave_number)).epsilon(1e-9));
    CHECK(difference.potential == Approx(-0.5 * wm * sign).epsilon(1e-9));
  }
}

TEST_CASE("close waves carry the set-down of their group", "[waves][fast]") {
  // Longuet-Higgins & Stewart (1962): eta = -S / (rho (g h - c_g^2)), S = E (2 c_g/c - 1/2), E = rho g a^2 / 2 of the group's a.
  const double depth = GENERATE(6.0, 20.6), omega = 0.714, apart = 1e-4;
  const Component m = airy(1.0, omega + apart, depth), n = airy(1.0, omega - apart, depth);
  const WaveProperties wave = wave_properties(2.0 * pi / omega, depth, gravity);
  const double stress = 0.5 * gravity * (2.0 * wave.group_speed / wave.phase_speed - 0.5);
  const double group = -stress / (gravity * depth - wave.group_speed * wave.group_speed);
  // a^2 = 2 + 2 cos(psi_m - psi_n): the pair in both orders is the part that swings.
  const double swing = 2.0 * bound_pair(m, n, BoundAt::difference, depth, gravity).elevation;
  CHECK(swing == Approx(2.0 * group).epsilon(1e-3));
}

TEST_CASE("sums of products are the double sum over pairs, from the surface to the bed", "[waves][fast]") {
  const double depth = GENERATE(12.0, 40.0, 250.0);
  const std::vector<Component> sea = random_sea(61, depth, 0.4);  // a part-filled group of lanes
  const BoundWaves bound(sea, depth, gravity);
  // What is left out is below exp(-18) of the sum of all pairs.
  for (const double z : {0.0, -1.0, -0.2 * depth, -0.7 * depth, -depth}) {
    const Plain exact = plain(sea, depth, 37.0, 20.0, -6.0, z);
    const Surface s = bound.surface(37.0, 20.0, -6.0);
    CHECK(s.elevation == Approx(exact.surface.elevation).epsilon(1e-9));
    CHECK(s.slope_x == Approx(exact.surface.slope_x).epsilon(1e-9));
    CHECK(s.slope_y == Approx(exact.surface.slope_y).epsilon(1e-9));
    const Kinematics k = bound.kinematics(37.0, 20.0, -6.0, z);
    CHECK((k.velocity - exact.kinematics.velocity).norm() < 1e-7);
    CHECK((k.acceleration - exact.kinematics.acceleration).norm() < 1e-7);
    CHECK(k.pressure_over_density == Approx(exact.kinematics.pressure_over_density).margin(1e-7));
  }
}

TEST_CASE("bound waves are a potential flow over the bed", "[waves][fast]") {
  const double depth = 25.0, d = 1e-3, t = 3.0;
  const BoundWaves bound(random_sea(40, depth, 0.7), depth, gravity);
  const auto at = [&](double time, const Eigen::Vector3d& p) { return bound.kinematics(time, p.x(), p.y(), p.z()); };
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(4, -7, -0.1), Eigen::Vector3d(-30, 11, -9), Eigen::Vector3d(60, 2, -23)}) {
    Eigen::Matrix3d gradient;  // column j: d velocity / d x_j
    Eigen::Vector3d pressure;
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector3d step = d * Eigen::Vector3d::Unit(j);
      const Kinematics ahead = at(t, p + step), behind = at(t, p - step);
      gradient.col(j) = (ahead.velocity - behind.velocity) / (2 * d);
      pressure[j] = (ahead.pressure_over_density - behind.pressure_over_density) / (2 * d);
    }
    CHECK(gradient.norm() > 1e-4);
    CHECK(gradient.trace() == Approx(0.0).margin(2e-8));
    CHECK((gradient - gradient.transpose()).norm() < 2e-8);
    const Kinematics k = at(t, p);
    CHECK(k.acceleration.norm() > 1e-4);
    CHECK((k.acceleration + pressure).norm() < 2e-7);
    CHECK((k.acceleration - (at(t + d, p).velocity - at(t - d, p).velocity) / (2 * d)).norm() < 2e-7);
    CHECK(std::abs(at(t, {p.x(), p.y(), -depth}).velocity.z()) < 1e-12);
  }
}

TEST_CASE("a narrow sea has the skewness and the mean set-down of theory", "[waves][fast]") {
  // Skewness 3 k sigma in deep water (Longuet-Higgins 1963; Tayfun 1980), mean -sigma^2 k / sinh 2kh in any.
  const double depth = GENERATE(3000.0, 18.0), omega = 0.7, sigma = 0.5;
  const std::size_t count = 32;
  const double k = wave_number(omega, depth, gravity), step = 0.02 * omega / double(count);
  double mean = 0.0, cube = 0.0;
  const int seeds = 40, times = 243;
  for (int seed = 0; seed < seeds; ++seed) {
    Random random{std::uint64_t(seed)};
    std::vector<Component> sea;
    for (std::size_t i = 0; i < count; ++i)
      sea.push_back(airy(sigma * std::sqrt(2.0 / double(count)), omega + (double(i) - 0.5 * double(count)) * step, depth,
                         2.0 * pi * random.uniform()));
    const BoundWaves bound(sea, depth, gravity);
    for (int i = 0; i < times; ++i) {
      const double t = 2.0 * pi / step * i / times;
      double first = 0.0;
      for (const Component& c : sea) first += c.amplitude * std::cos(c.phase - c.angular_frequency * t);
      const double second = bound.surface(t, 0.0, 0.0).elevation;
      mean += second / (seeds * times);
      // With all phases shifted by half a turn the linear sea changes its sign and the bound waves do not: the mean of both.
      for (const double eta : {first + second, second - first}) cube += 0.5 * eta * eta * eta / (seeds * times);
    }
  }
  // Sums repeat with the record but alias to no mean: exact but for the width of the band. Skewness is that of 40 records.
  CHECK(mean == Approx(-sigma * sigma * k / std::sinh(2.0 * k * depth)).epsilon(2e-3).margin(1e-12));
  if (depth > 1000.0) CHECK(cube / (sigma * sigma * sigma) == Approx(3.0 * k * sigma).epsilon(0.04));
}
