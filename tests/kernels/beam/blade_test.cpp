// Modes of blades against exact and published frequencies. SPDX-License-Identifier: Apache-2.0
#include "kernels/beam/blade.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"

using namespace spindrift;
using namespace spindrift::beam;

namespace {

BladeTable uniform_blade(double length, double mass, double flap, double edge, double twist_root = 0.0, double twist_tip = 0.0) {
  return {{0.0, length}, {mass, mass}, {flap, flap}, {edge, edge}, {twist_root, twist_tip}};
}

/// Slowest frequency of a uniform flapping blade that turns with `speed` about its root, in units of sqrt(EI / m L^4).
double turning(double speed, int mode) {
  const BladeModes modes(uniform_blade(1.0, 1.0, 1.0, 1e6));
  const auto points = blade_points(uniform_blade(1.0, 1.0, 1.0, 1e6), modes);
  BladeModes::Square k = speed * speed * tension_stiffness(points, [](double at) { return at; });
  for (int i = 0; i < BladeModes::count; ++i) k(i, i) += modes.omega()[std::size_t(i)] * modes.omega()[std::size_t(i)];
  return std::sqrt(Eigen::SelfAdjointEigenSolver<BladeModes::Square>(k).eigenvalues()[mode]);
}

}  // namespace

TEST_CASE("a straight uniform blade has a cantilever's frequencies in both planes", "[fast]") {
  const double length = 40.0, mass = 300.0, flap = 2e9, edge = 2.3e9;
  const BladeModes modes(uniform_blade(length, mass, flap, edge));
  const double unit = std::sqrt(flap / mass) / (length * length), first = 1.8751040687 * 1.8751040687,
               second = 4.6940911330 * 4.6940911330;
  CHECK(modes.omega()[0] == Approx(first * unit).epsilon(1e-6));
  CHECK(modes.omega()[1] == Approx(first * unit * std::sqrt(edge / flap)).epsilon(1e-6));
  CHECK(modes.omega()[2] == Approx(second * unit).epsilon(1e-5));
  // Of a cantilever of mass 1 per length 1 the tip moves by 2 in a mode of mass 1.
  const auto tip = modes.value(length);
  CHECK(tip(0, 0) == Approx(2.0 / std::sqrt(mass * length)).epsilon(1e-6));
  CHECK(tip(1, 1) == Approx(2.0 / std::sqrt(mass * length)).epsilon(1e-6));
  CHECK(std::abs(tip(1, 0)) < 1e-9 * tip(0, 0));
}

TEST_CASE("one twist all along turns the modes and leaves their frequencies", "[fast]") {
  const double twist = 0.3;
  const BladeModes straight(uniform_blade(40.0, 300.0, 2e9, 5e9)), turned(uniform_blade(40.0, 300.0, 2e9, 5e9, twist, twist));
  for (std::size_t k = 0; k < 3; ++k) CHECK(turned.omega()[k] == Approx(straight.omega()[k]).epsilon(1e-7));
  const auto tip = turned.value(40.0);
  CHECK(tip(1, 0) / tip(0, 0) == Approx(std::tan(twist)).epsilon(1e-6));  // flapwise goes ahead as it goes downwind
  CHECK(tip(0, 1) / tip(1, 1) == Approx(-std::tan(twist)).epsilon(1e-6));
}

TEST_CASE("a blade twisted by 45 degrees has published frequencies", "[fast]") {
  // Subrahmanyam, Kulkarni & Rao (1981), Int. J. Mech. Sci. 23, 517: steel, 152.4 x 25.4 x 1.7272 mm; 62.0, 305.1, 955.1 Hz.
  const double length = .1524, breadth = .0254, depth = .0017272, e = 206.85e9, rho = 7857.6;
  const BladeModes modes(uniform_blade(length, rho * breadth * depth, e * breadth * std::pow(depth, 3) / 12.0,
                                       e * depth * std::pow(breadth, 3) / 12.0, 0.0, pi / 4.0));
  CHECK(modes.omega()[0] / (2.0 * pi) == Approx(62.0).epsilon(.01));
  CHECK(modes.omega()[1] / (2.0 * pi) == Approx(305.1).epsilon(.01));
  CHECK(modes.omega()[2] / (2.0 * pi) == Approx(955.1).epsilon(.02));
}

TEST_CASE("a turning blade stiffens as published", "[fast]") {
  // Wright, Smith, Thresher & Wang (1982), J. Appl. Mech. 49, 197: uniform cantilever, no hub, in units of sqrt(EI / m L^4).
  CHECK(turning(0.0, 0) == Approx(3.5160).epsilon(1e-4));
  CHECK(turning(1.0, 0) == Approx(3.6817).epsilon(1e-3));
  CHECK(turning(3.0, 0) == Approx(4.7973).epsilon(1e-3));
  CHECK(turning(6.0, 0) == Approx(7.3604).epsilon(2e-3));
  CHECK(turning(3.0, 1) == Approx(23.3203).epsilon(1e-3));
  CHECK(turning(6.0, 1) == Approx(26.8091).epsilon(2e-3));
}

TEST_CASE("points of a blade keep its mass and both moments", "[fast]") {
  const BladeTable table{
      {0.0, 10.0, 25.0, 40.0}, {1000.0, 400.0, 250.0, 20.0}, {1e10, 1e9, 3e8, 1e7}, {1e10, 3e9, 9e8, 1e8}, {.2, .1, .05, 0.0}};
  const BladeModes modes(table);
  double mass = 0.0, first = 0.0;
  BladeModes::Square generalised = BladeModes::Square::Zero();
  for (const BladePoint& p : blade_points(table, modes))
    mass += p.mass, first += p.mass * p.at, generalised += p.mass * p.value.transpose() * p.value;
  const auto piece = [](double a, double b, double ma, double mb) {
    return std::pair{(b - a) * (ma + mb) / 2, (b - a) * (a * (2 * ma + mb) + b * (ma + 2 * mb)) / 6};
  };
  double exact = 0.0, exact_first = 0.0;
  for (std::size_t k = 1; k < 4; ++k) {
    const auto [m, f] = piece(table.position[k - 1], table.position[k], table.mass[k - 1], table.mass[k]);
    exact += m, exact_first += f;
  }
  CHECK(mass == Approx(exact).epsilon(1e-12));
  CHECK(first == Approx(exact_first).epsilon(1e-12));
  CHECK((generalised - BladeModes::Square::Identity()).norm() < 1e-4);
}
