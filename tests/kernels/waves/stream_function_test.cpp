// Steady nonlinear waves: the equations, the low and the high wave, published numbers.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/waves/stream_function.hpp"

#include <catch2/catch.hpp>

#include "kernels/waves/stokes.hpp"

using namespace spindrift;
using namespace spindrift::waves;

TEST_CASE("the derivatives of the stream function's equations are those of differences", "[waves][fast]") {
  const StreamFunctionEquations equations(6, 0.3, 7.0);
  Eigen::VectorXd x = equations.linear(), f, shifted;
  Eigen::MatrixXd d, other;
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] += 0.01 * std::sin(double(3 * i));
  equations.evaluate(x, f, d);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    constexpr double h = 1e-6;
    Eigen::VectorXd up = x, down = x, f_up, f_down;
    up[i] += h, down[i] -= h;
    equations.evaluate(up, f_up, other), equations.evaluate(down, f_down, other);
    CHECK((d.col(i) - (f_up - f_down) / (2.0 * h)).norm() < 1e-7 * (1.0 + d.col(i).norm()));
  }
}

TEST_CASE("a steady wave keeps the pressure at its surface, on the surface and between the points", "[waves][fast]") {
  // Kinematic and dynamic condition from the harmonics, in the frame of the wave.
  const double height = 8.0, period = 12.0, depth = 20.0, g = 9.81;
  const std::vector<Component> wave = stream_function_components(height, period, depth, g, 0.0, 0.0);
  REQUIRE(!wave.empty());
  const double k = wave[0].wave_number, c = wave[0].angular_frequency / k;
  double first_head = 0.0, first_flow = 0.0;
  for (int i = 0; i <= 40; ++i) {
    const double psi = pi * i / 40.0;
    double eta = 0.0;
    for (std::size_t j = 0; j < wave.size(); ++j) eta += wave[j].amplitude * std::cos(double(j + 1) * psi);
    double u = -c, w = 0.0, flow = -c * (eta + depth);
    for (std::size_t j = 0; j < wave.size(); ++j) {
      const double kj = wave[j].wave_number, bed = std::sinh(kj * depth), angle = double(j + 1) * psi;
      u += wave[j].speed_amplitude * std::cosh(kj * (eta + depth)) / bed * std::cos(angle);
      w += wave[j].speed_amplitude * std::sinh(kj * (eta + depth)) / bed * std::sin(angle);
      flow += wave[j].speed_amplitude / kj * std::sinh(kj * (eta + depth)) / bed * std::cos(angle);
    }
    const double head = 0.5 * (u * u + w * w) / g + eta;
    if (i == 0) first_head = head, first_flow = flow;
    CHECK(head == Approx(first_head).margin(1e-4 * height));
    CHECK(flow == Approx(first_flow).epsilon(1e-5));
  }
}

TEST_CASE("a low steady wave is Stokes's of second order", "[waves][fast]") {
  const double depth = 20.6, g = 9.81, period = 8.8, height = 0.2;
  const std::vector<Component> wave = stream_function_components(height, period, depth, g, 0.4, 0.3);
  REQUIRE(wave.size() >= 8);
  const double k = wave_number(2.0 * pi / period, depth, g);
  const Component first{.wave_number = k,
                        .angular_frequency = 2.0 * pi / period,
                        .amplitude = 0.5 * height,
                        .speed_amplitude = 0.5 * height * 2.0 * pi / period,
                        .phase = 0.4,
                        .direction = 0.3};
  const Component second = stokes_second(first, depth);
  CHECK(wave[0].wave_number == Approx(k).epsilon(1e-4));
  CHECK(wave[0].amplitude == Approx(first.amplitude).epsilon(1e-4));
  CHECK(wave[0].speed_amplitude == Approx(first.speed_amplitude).epsilon(1e-3));
  CHECK(wave[1].amplitude == Approx(second.amplitude).epsilon(2e-3));
  CHECK(wave[1].speed_amplitude == Approx(second.speed_amplitude).epsilon(2e-3));
  CHECK(wave[1].phase == Approx(0.8));
  CHECK(wave[1].direction == 0.3);
}

TEST_CASE("a steep wave of Fenton's program is found again", "[waves][fast]") {
  // Fenton's FOURIER (johndfenton.com), 8 terms, as published with ERDC's proteus: H/d 0.375, T sqrt(g/d) 9.9045.
  const auto wave = stream_function_wave(8, 0.375, 9.9045);
  REQUIRE(wave);
  CHECK(2.0 * pi / wave->wave_number == Approx(9.7556).epsilon(2e-5));
  CHECK(wave->speed == Approx(0.9850).epsilon(1e-4));
  const double k = wave->wave_number, unit = k * std::sqrt(k);  // Fenton makes B dimensionless with g and k
  CHECK(wave->coefficients[0] * unit == Approx(1.3540388e-01).epsilon(1e-4));
  CHECK(wave->coefficients[1] * unit == Approx(2.4808040e-02).epsilon(1e-4));
  CHECK(wave->coefficients[2] * unit == Approx(4.2638109e-03).epsilon(1e-3));
}

TEST_CASE("waves up to 94 % of the breaking height are found, none beyond it", "[waves][fast]") {
  const double g = 9.80665, period = 12.0, breaking = 0.142 * g * period * period / (2.0 * pi);  // Miche, deep water
  CHECK(!stream_function_components(0.94 * breaking, period, 300.0, g, 0.0, 0.0).empty());
  CHECK(stream_function_components(1.3 * breaking, period, 300.0, g, 0.0, 0.0).empty());
  // Deep water: c = sqrt(g/k) (1 + e^2/2 + e^4/8), e = kH/2 (Fenton 1985, J. Waterway 111, 216-234).
  const auto wave = stream_function_components(20.0, period, 300.0, g, 0.0, 0.0);
  const double k = wave[0].wave_number, c = wave[0].angular_frequency / k, e2 = 0.25 * k * k * 400.0;
  CHECK(c * c * k / g == Approx(std::pow(1.0 + 0.5 * e2 + 0.125 * e2 * e2, 2)).epsilon(1e-3));
}
