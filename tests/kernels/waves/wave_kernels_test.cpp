// Dispersion, Airy and Stokes kinematics, wavemaker transfer: laws of the fluid, then published numbers.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "kernels/waves/components.hpp"
#include "kernels/waves/dispersion.hpp"
#include "kernels/waves/stokes.hpp"
#include "kernels/waves/wavemaker.hpp"

using namespace spindrift;
using namespace spindrift::waves;

namespace {

constexpr double gravity = 9.81;

Component airy(double amplitude, double period, double depth, double direction = 0.0) {
  const double omega = 2.0 * pi / period;
  return {wave_number(omega, depth, gravity), omega, amplitude, amplitude * omega, 0.3, direction};
}

std::vector<ComponentGroup> groups(const std::vector<Component>& components, double depth) {
  std::vector<ComponentGroup> sea((components.size() + lanes - 1) / lanes);
  for (std::size_t i = 0; i < components.size(); ++i) set_lane(sea[i / lanes], int(i % lanes), components[i], depth);
  return sea;
}

std::vector<ComponentGroup> wave(bool second_order, double amplitude, double period, double depth) {
  const Component first = airy(amplitude, period, depth);
  return second_order ? groups({first, stokes_second(first, depth)}, depth) : groups({first}, depth);
}

/// Root-mean-square residuals over one wave of the two conditions at the surface z = eta:
/// d eta/dt + u d eta/dx - w, and (d phi/dt + (u^2 + w^2)/2) / g + eta less its mean (the Bernoulli constant).
struct SurfaceResidual {
  double kinematic = 0.0, dynamic = 0.0;
};
SurfaceResidual surface_residual(const std::vector<ComponentGroup>& sea, double period, double depth) {
  const int n = 64;
  const double length = wave_properties(period, depth, gravity).length, dt = 1e-4 * period;
  std::vector<double> bernoulli;
  SurfaceResidual r;
  for (int i = 0; i < n; ++i) {
    const double x = length * i / n, t = 1.7;
    const Surface s = surface(sea, t, x, 0.0);
    const double rate = (surface(sea, t + dt, x, 0.0).elevation - surface(sea, t - dt, x, 0.0).elevation) / (2.0 * dt);
    const Kinematics k = kinematics(sea, t, x, 0.0, s.elevation);
    r.kinematic += std::pow(rate + k.velocity.x() * s.slope_x - k.velocity.z(), 2) / n;
    bernoulli.push_back(s.elevation + (0.5 * k.velocity.squaredNorm() - k.pressure_over_density) / gravity);
  }
  double mean = 0.0;
  for (double b : bernoulli) mean += b / n;
  for (double b : bernoulli) r.dynamic += (b - mean) * (b - mean) / n;
  return {std::sqrt(r.kinematic), std::sqrt(r.dynamic)};
}

}  // namespace

TEST_CASE("the dispersion relation is solved to round-off in any depth", "[waves][fast]") {
  for (double depth : {0.01, 1.0, 20.6, 320.0, 5000.0})
    for (double period : {0.3, 1.0, 3.0, 8.8, 20.0, 120.0, 3600.0}) {
      const double omega = 2.0 * pi / period, k = wave_number(omega, depth, gravity);
      CHECK(gravity * k * std::tanh(k * depth) == Approx(omega * omega).epsilon(2e-15));
    }
  CHECK(wave_number(2.0, 1e4, gravity) == Approx(4.0 / gravity));                             // deep: omega^2 / g
  CHECK(wave_number(0.01, 1.0, gravity) == Approx(0.01 / std::sqrt(gravity)).epsilon(1e-4));  // shallow: omega / sqrt(g h)
}

TEST_CASE("the wave of Leble and Barakos in their tank has its known length, speeds and numbers", "[waves][fast]") {
  const WaveProperties w = wave_properties(8.8, 20.6, 9.81);
  CHECK(w.length == Approx(102.8).margin(0.05));
  CHECK(w.phase_speed == Approx(11.7).margin(0.05));
  CHECK(w.group_speed == Approx(8.2).margin(0.05));
  CHECK(w.relative_depth == Approx(1.26).margin(0.005));
  CHECK(ursell_number(1.88, w.length, 20.6) == Approx(2.3).margin(0.05));
  CHECK(1.88 / piston_transfer(w.relative_depth) == Approx(1.56).margin(0.01));  // stroke of the piston
}

TEST_CASE("group speed is the derivative of frequency by wave number", "[waves][fast]") {
  for (double period : {2.0, 8.8, 40.0}) {
    const double d = 1e-4 * period;
    const auto a = wave_properties(period - d, 20.6, gravity), b = wave_properties(period + d, 20.6, gravity);
    const double slope = (a.angular_frequency - b.angular_frequency) / (a.wave_number - b.wave_number);
    CHECK(wave_properties(period, 20.6, gravity).group_speed == Approx(slope).epsilon(1e-6));
  }
}

TEST_CASE("the flow under waves is irrotational and solenoidal, stands still at the bottom and obeys Euler's equation",
          "[waves][fast]") {
  const double depth = 20.6, d = 1e-3;
  const bool second = GENERATE(false, true);
  std::vector<Component> components = {airy(0.94, 8.8, depth, 0.4), airy(0.5, 5.0, depth, -1.0)};
  if (second) components.push_back(stokes_second(components[0], depth));
  const auto sea = groups(components, depth);
  const auto velocity = [&](double t, const Eigen::Vector3d& p) { return kinematics(sea, t, p.x(), p.y(), p.z()).velocity; };
  const auto pressure = [&](const Eigen::Vector3d& p) { return kinematics(sea, 3.0, p.x(), p.y(), p.z()).pressure_over_density; };
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(4, -7, -0.1), Eigen::Vector3d(-30, 11, -9), Eigen::Vector3d(60, 2, -19)}) {
    Eigen::Matrix3d gradient;  // column j: d velocity / d x_j
    Eigen::Vector3d pressure_gradient;
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector3d step = d * Eigen::Vector3d::Unit(j);
      gradient.col(j) = (velocity(3.0, p + step) - velocity(3.0, p - step)) / (2 * d);
      pressure_gradient[j] = (pressure(p + step) - pressure(p - step)) / (2 * d);
    }
    CHECK(gradient.trace() == Approx(0.0).margin(1e-9));
    CHECK((gradient - gradient.transpose()).norm() == Approx(0.0).margin(1e-9));
    const Eigen::Vector3d acceleration = kinematics(sea, 3.0, p.x(), p.y(), p.z()).acceleration;
    CHECK(acceleration.norm() > 0.01);
    CHECK((acceleration + pressure_gradient).norm() == Approx(0.0).margin(1e-8));
    CHECK((acceleration - (velocity(3.0 + d, p) - velocity(3.0 - d, p)) / (2 * d)).norm() == Approx(0.0).margin(1e-6));
    CHECK(std::abs(velocity(3.0, {p.x(), p.y(), -depth}).z()) < 1e-14);
  }
}

TEST_CASE("surface conditions hold to the second power of steepness for Airy and to the third for Stokes", "[waves][order]") {
  const double depth = 20.6, period = GENERATE(5.0, 8.8, 11.0);
  for (const bool second : {false, true}) {
    const double a = 0.2;
    const SurfaceResidual coarse = surface_residual(wave(second, a, period, depth), period, depth);
    const SurfaceResidual fine = surface_residual(wave(second, 0.5 * a, period, depth), period, depth);
    const double expected = second ? 3.0 : 2.0;
    CHECK(std::log2(coarse.kinematic / fine.kinematic) == Approx(expected).margin(0.1));
    CHECK(std::log2(coarse.dynamic / fine.dynamic) == Approx(expected).margin(0.1));
  }
}

TEST_CASE("a Stokes wave has high crests, flat troughs and its linear height", "[waves][fast]") {
  const double depth = 20.6, period = 8.8, a = 0.94;
  const Component first = airy(a, period, depth), second = stokes_second(first, depth);
  const auto sea = groups({first, second}, depth);
  const double at_crest = 0.3 / first.angular_frequency, at_trough = at_crest + 0.5 * period;  // phase 0.3 - omega t
  const double crest = surface(sea, at_crest, 0, 0).elevation, trough = surface(sea, at_trough, 0, 0).elevation;
  CHECK(crest - trough == Approx(2.0 * a).epsilon(1e-14));
  CHECK(crest + trough == Approx(2.0 * second.amplitude).epsilon(1e-12));
  // Published form (Dean & Dalrymple 1991, eq. 11.4): (H^2 k / 16) cosh kh (2 + cosh 2kh) / sinh^3 kh.
  const double kh = first.wave_number * depth;
  CHECK(second.amplitude == Approx(4.0 * a * a * first.wave_number / 16.0 * std::cosh(kh) * (2.0 + std::cosh(2.0 * kh)) /
                                   std::pow(std::sinh(kh), 3)));
  const Component deep = airy(1.0, 5.0, 400.0);
  CHECK(stokes_second(deep, 400.0).amplitude == Approx(0.5 * deep.wave_number));  // deep water: k a^2 / 2, no second flow
  CHECK(stokes_second(deep, 400.0).speed_amplitude < 1e-15);
  CHECK(stokes_ratio(2.0 * a, first.wave_number, depth) == Approx(second.amplitude / a));
}

TEST_CASE("wavemaker transfer follows Biesel and its limits", "[waves][fast]") {
  for (double kh : {0.01, 0.3, 0.4999, 0.5001, 1.26, 5.0, 40.0}) {
    CHECK(piston_transfer(kh) == Approx(2.0 * (std::cosh(2 * kh) - 1.0) / (std::sinh(2 * kh) + 2 * kh)).epsilon(1e-9));
    if (kh > 0.1)
      CHECK(flap_transfer(kh) ==
            Approx(4.0 * std::sinh(kh) / kh * (kh * std::sinh(kh) - std::cosh(kh) + 1.0) / (std::sinh(2 * kh) + 2 * kh))
                .epsilon(1e-10));
  }
  CHECK(piston_transfer(1e-3) == Approx(1e-3).epsilon(1e-5));  // Galvin: H/S = kh
  CHECK(flap_transfer(1e-3) == Approx(0.5e-3).epsilon(1e-5));  // half of a piston's
  CHECK(piston_transfer(299.0) == Approx(2.0));
  CHECK(piston_transfer(1000.0) == 2.0);
  CHECK(flap_transfer(301.0) == Approx(flap_transfer(299.9)).epsilon(1e-4));
}
