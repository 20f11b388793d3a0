// Detached eddies: the length of DES97 and DDES, the shield of DDES, and the equilibrium that makes both Smagorinsky-like far
// from walls. SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_sa_des.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace spindrift;
using namespace spindrift::turbulence;

namespace {
const Vector<double> nothing{0, 0, 0};
Flow<double> sheared(double rate, double distance, double side, double nu = 1.5e-5) {
  return {1.2, 1.2 * nu, distance, {0.0, rate, 0.0}, nothing, nothing, nothing, side, side};
}
}  // namespace

TEST_CASE("where the grid is long both are Spalart-Allmaras", "[turbulence][fast]") {
  const auto f = sheared(1e3, 1e-2, 1.0);
  const Turbulence<double, 1> t{{1e-3}, {{0.1, 0.2, 0.0}}};
  const double sa = Sa{}.source(f, t).rate[0];
  CHECK(Des97{}.source(f, t).rate[0] == sa);
  CHECK(Ddes{}.source(f, t).rate[0] == sa);
  CHECK(Ddes{}.closure(f, t).eddy_viscosity == Sa{}.closure(f, t).eddy_viscosity);
}

TEST_CASE("inside the logarithmic layer DDES keeps the wall's distance on any grid, DES97 does not", "[turbulence][fast]") {
  const double u = 0.5, kappa = Sa::kappa, nu = 1.5e-5;
  for (const double y_plus : {30.0, 300.0, 3000.0})
    for (const double share : {0.1, 0.5, 1.0}) {  // of the cell's longest side in the distance
      const double y = y_plus * nu / u, chi = kappa * y_plus;
      const auto f = sheared(u / (kappa * y), y, share * y);
      const double length = DdesLength::length(f, chi);
      CAPTURE(y_plus, share, length / y);
      CHECK(length > 0.999 * y);  // r_d is 1: 1 - tanh(512)
      CHECK(length <= y);
      CHECK(1.0 / std::sqrt(Des97Length::inverse_square(f, chi)) == Approx(std::min(1.0, 0.65 * share) * y));
    }
}

TEST_CASE("outside layers DDES has the grid's length", "[turbulence][fast]") {
  // Large velocity gradients far from walls: r_d is small.
  const auto f = sheared(1e4, 1.0, 1e-2);
  const double chi = 300.0;
  CHECK(DdesLength::length(f, chi) == Approx(0.65e-2).epsilon(1e-3));
  CHECK(DdesLength::low_reynolds(1e6) == Approx(1.0).epsilon(1e-4));
  CHECK(DdesLength::low_reynolds(0.0) == Approx(10.0));
  CHECK(DdesLength::low_reynolds(1.0) > 1.0);
}

TEST_CASE("the shield of DDES goes from 0 to 1", "[turbulence][fast]") {
  double before = 1.0;
  for (double r = 1e-3; r < 10.0; r *= 1.1) {
    const double outside = DdesLength::outside(r);
    CHECK(outside <= before);
    CHECK(outside >= 0.0);
    before = outside;
  }
  CHECK(before == Approx(0.0).margin(1e-12));
  CHECK(DdesLength::outside(1.0 / 8.0) == Approx(1.0 - std::tanh(1.0)));  // eq. 5
}

// Production balances destruction far from walls: cb1 S nu~ = cw1 fw (nu~/l)^2 with r = nu~ / (S l^2 kappa^2) and fw as of that
// r: r = 1 is not the balance; the root gives nu_t = (C l)^2 S with a constant, as Smagorinsky's.
TEST_CASE("detached eddies in balance have an eddy viscosity of Smagorinsky's form", "[turbulence][fast]") {
  const auto balanced = [](double rate, double side) {
    double low = 1e-8, high = 1e3;
    for (int n = 0; n < 200; ++n) {
      const double middle = std::sqrt(low * high);
      (Des97{}.source(sheared(rate, 1e3, side, 1e-12), {{middle}, {nothing}}).rate[0] > 0.0 ? low : high) = middle;
    }
    return std::sqrt(low * high);
  };
  const double one = balanced(100.0, 0.1);
  CHECK(balanced(200.0, 0.1) == Approx(2.0 * one).epsilon(1e-3));
  CHECK(balanced(100.0, 0.2) == Approx(4.0 * one).epsilon(1e-3));
  const double constant = std::sqrt(one / 100.0) / 0.1;
  CAPTURE(constant);
  CHECK(constant > 0.10);
  CHECK(constant < 0.30);
}
