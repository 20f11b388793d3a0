// Spalart-Allmaras: exact balances that its constants were made for, its damping, its negative branch.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_sa.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace spindrift;
using namespace spindrift::turbulence;

namespace {
const Vector<double> none{0, 0, 0};
Flow<double> shear(double rate, double distance, double nu = 1.5e-5) {
  return {1.2, 1.2 * nu, distance, {0.0, rate, 0.0}, none, none};
}
}  // namespace

// nu_tilde = kappa u_tau y and Omega chosen so that S_tilde = u_tau / (kappa y): source + diffusion = 0 at every y+.
TEST_CASE("the wall layer is an exact solution of the SA equation, from the wall to the log layer", "[turbulence][fast]") {
  const double u_tau = 0.5, nu = 1.5e-5, kappa = Sa::kappa;
  for (const double y_plus : {60.0, 300.0, 1e4, 1e6}) {  // below, ft2 (made for laminar flow) is not zero
    const double y = y_plus * nu / u_tau, nu_tilde = kappa * u_tau * y, chi = nu_tilde / nu;
    const double fv1 = std::pow(chi, 3) / (std::pow(chi, 3) + std::pow(7.1, 3)), fv2 = 1.0 - chi / (1.0 + chi * fv1);
    const double omega = u_tau / (kappa * y) - nu_tilde * fv2 / (kappa * kappa * y * y);
    const Turbulence<double, 1> t{{nu_tilde}, {{0.0, kappa * u_tau, 0.0}}};
    const double diffusion = 1.2 / Sa::sigma * std::pow(kappa * u_tau, 2);  // d/dy of rho (nu + nu_tilde)/sigma d(nu_tilde)/dy
    for (const double rate : {Sa{}.source(shear(omega, y), t).rate[0], SaNeg{}.source(shear(omega, y), t).rate[0]})
      CHECK(rate + diffusion == Approx(0.0).margin(1e-12 * diffusion));
    CHECK(Sa{}.closure(shear(omega, y), t).eddy_viscosity == Approx(1.2 * nu_tilde * fv1).epsilon(1e-14));
  }
}

TEST_CASE("SA keeps its modified vorticity positive", "[turbulence][fast]") {
  // chi between 1 and 18 has negative fv2: at weak vorticity Omega + S_bar would be negative, and r with it.
  const double nu = 1.5e-5, y = 1e-3, nu_tilde = 8.0 * nu;
  double before = Sa{}.source(shear(1e-6, y), {{nu_tilde}, {none}}).rate[0];
  CHECK(before < 0.0);  // destruction wins where nothing turns
  for (double rate = 1e-3; rate < 1e6; rate *= 2.0) {
    const double s = Sa{}.source(shear(rate, y), {{nu_tilde}, {none}}).rate[0];
    CHECK(std::isfinite(s));
    CHECK(s >= before - 1e-12 * std::abs(before));  // more vorticity, more turbulence
    before = s;
  }
  CHECK(before > 0.0);
}

TEST_CASE("the branches of SA-neg meet in value and slope, and the negative one returns to zero", "[turbulence][fast]") {
  const double y = 1e-2, rate = 1e3, nu = 1.5e-5;
  const auto at = [&](double nu_tilde) { return SaNeg{}.source(shear(rate, y), {{nu_tilde}, {none}}).rate[0]; };
  const double h = 1e-6 * nu;
  CHECK(at(h) == Approx(-at(-h)).epsilon(1e-4));
  CHECK(at(-2 * nu) > 0.0);
  const auto c = SaNeg{}.closure(shear(rate, y), {{-50.0 * nu}, {none}});
  CHECK(c.eddy_viscosity == 0.0);
  CHECK(c.diffusivity[0] > 0.0);
  // Far above zero nothing differs.
  const Turbulence<double, 1> t{{20 * nu}, {{0.1, 0.2, 0.3}}};
  CHECK(SaNeg{}.source(shear(rate, y), t).rate[0] == Sa{}.source(shear(rate, y), t).rate[0]);
}

TEST_CASE("SA values on walls and in the far field", "[turbulence][fast]") {
  CHECK(Sa{}.wall(1e-5, 1.5e-5)[0] == 0.0);
  CHECK(Sa{}.far_field(1.5e-5, 50.0, 340.0)[0] == Approx(4.5e-5));
  // TMR: nu_t / nu = 0.210438 for nu_tilde / nu = 3.
  const auto c = Sa{}.closure(shear(0.0, 1.0), {{4.5e-5}, {none}});
  CHECK(c.eddy_viscosity / (1.2 * 1.5e-5) == Approx(0.210438).epsilon(1e-5));
}
