// Modes of beams against exact ones: cantilevers with and without a mass at the end, free beams, beams under axial force.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/beam/euler_bernoulli.hpp"
#include "tests/order.hpp"

using namespace spindrift;

namespace {

/// Length 2, mass 3 kg/m, stiffness 5 N m2: omega = b^2 sqrt(EI / m) / L^2.
const beam::Table uniform{{0.0, 2.0}, {3.0, 3.0}, {5.0, 5.0}};
double omega_of(double b) { return b * b * std::sqrt(5.0 / 3.0) / 4.0; }

/// The root of f in [low, high] by bisection.
template <class F>
double root(F&& f, double low, double high) {
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (f(low) * f(middle) <= 0.0 ? high : low) = middle;
  }
  return low;
}

}  // namespace

TEST_CASE("a cantilever vibrates at the roots of 1 + cos b cosh b, to the fourth order of its elements", "[beam][fast]") {
  const double exact[3] = {1.8751040687119611, 4.694091132974175, 7.854757438237613};
  beam::Problem problem;
  const beam::Modes modes = beam::modes(uniform, problem, 3);
  for (int k = 0; k < 3; ++k) CHECK(modes.omega[std::size_t(k)] == Approx(omega_of(exact[k])).epsilon(1e-5));
  std::vector<double> h, error;
  for (const int n : {4, 8, 16}) {
    problem.elements = n;
    h.push_back(1.0 / n);
    error.push_back(std::abs(beam::modes(uniform, problem, 2).omega[1] - omega_of(exact[1])));
  }
  CHECK(observed_order(h, error) > 3.8);
}

TEST_CASE("a cantilever with a mass at its end vibrates at the roots of the exact equation", "[beam][fast]") {
  // 1 + cos b cosh b + r b (cos b sinh b - sin b cosh b) = 0 for a point mass of r times the beam's (Blevins 1979, table 8-8).
  const double r = GENERATE(0.1, 1.0, 20.0);
  beam::Problem problem;
  problem.tip.mass = r * 6.0;
  const beam::Modes modes = beam::modes(uniform, problem, 2);
  const auto equation = [r](double b) {
    return 1.0 + std::cos(b) * std::cosh(b) + r * b * (std::cos(b) * std::sinh(b) - std::sin(b) * std::cosh(b));
  };
  CHECK(modes.omega[0] == Approx(omega_of(root(equation, 0.1, 1.9))).epsilon(1e-6));
  CHECK(modes.omega[1] == Approx(omega_of(root(equation, 3.0, 4.7))).epsilon(1e-5));
}

TEST_CASE("a free beam moves as a whole at no stiffness, then at the roots of 1 - cos b cosh b", "[beam][fast]") {
  beam::Problem problem;
  problem.base = beam::EndBody{};
  const beam::Modes modes = beam::modes(uniform, problem, 4);
  CHECK(modes.omega[1] < 1e-4 * modes.omega[2]);
  CHECK(modes.omega[2] == Approx(omega_of(4.730040744862704)).epsilon(1e-5));
  CHECK(modes.omega[3] == Approx(omega_of(7.853204624095838)).epsilon(1e-5));
}

TEST_CASE("a cantilever loses its stiffness under Euler's load and under its own critical weight", "[beam][fast]") {
  beam::Problem problem;
  const double euler = pi * pi * 5.0 / (4.0 * 4.0);
  const double free = beam::modes(uniform, problem, 1).omega[0];
  problem.tension = -0.9999 * euler;
  CHECK(beam::modes(uniform, problem, 1).omega[0] < 0.02 * free);
  problem.tension = -1.0001 * euler;
  CHECK(beam::modes(uniform, problem, 1).omega[0] == 0.0);
  problem.tension = 0.0;
  const double greenhill = 7.8373474 * 5.0 / (3.0 * 8.0);  // m/s2: q L^3 / EI = 7.837 (Timoshenko & Gere 1961, section 2.12)
  problem.weight = 0.999 * greenhill;
  CHECK(beam::modes(uniform, problem, 1).omega[0] > 0.0);
  problem.weight = 1.001 * greenhill;
  CHECK(beam::modes(uniform, problem, 1).omega[0] == 0.0);
}

TEST_CASE("a step in the table is where the table says, not where the elements end", "[beam][fast]") {
  const beam::Table stepped{{0.0, 0.77, 0.77, 2.0}, {4.0, 4.0, 3.0, 3.0}, {10.0, 10.0, 5.0, 5.0}};
  beam::Problem problem;
  problem.elements = 200;  // one of their ends is on the step
  const double exact = beam::modes(stepped, problem, 1).omega[0];
  problem.elements = 24;
  CHECK(beam::modes(stepped, problem, 1).omega[0] == Approx(exact).epsilon(1e-3));
  const beam::Table moved{{0.0, 0.81, 0.81, 2.0}, {4.0, 4.0, 3.0, 3.0}, {10.0, 10.0, 5.0, 5.0}};  // in the same element
  CHECK(beam::modes(moved, problem, 1).omega[0] > 1.005 * exact);
}
