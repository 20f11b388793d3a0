// Wilcox's k-omega models: exact balances of the logarithmic layer, the sublayer and free decay; limiter, cross diffusion,
// stretching. SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_k_omega.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace spindrift;
using namespace spindrift::turbulence;

namespace {
const Vector<double> flat{0, 0, 0};
}

// nu_t = kappa u y, k = u^2 / sqrt(beta*), omega = u / (sqrt(beta*) kappa y) solve both equations for one kappa:
// kappa^2 = sqrt(beta*) (beta / beta* - gamma) / sigma. It is .408 (1988) and .4000 (2006: no cross diffusion, as k does not
// vary).
TEMPLATE_TEST_CASE("the logarithmic layer of k-omega has von Karman's constant", "[turbulence][fast]", KOmega1988, KOmega) {
  const bool old = std::is_same_v<TestType, KOmega1988>;
  const double beta = old ? 0.075 : 0.0708, gamma = old ? 5.0 / 9.0 : 0.52, u = 0.5, y = 0.01, nu = 1e-8;
  const double kappa = std::sqrt(0.3 * (beta / 0.09 - gamma) / 0.5);
  CHECK(kappa == Approx(old ? 0.4082 : 0.4000).epsilon(1e-3));
  const double k = u * u / 0.3, omega = u / (0.3 * kappa * y);
  const Flow<double> flow{1.2, 1.2 * nu, y, {0.0, u / (kappa * y), 0.0}, flat, flat};
  const Turbulence<double, 2> t{{k, omega}, {flat, {0.0, -omega / y, 0.0}}};
  const auto s = TestType{}.source(flow, t);
  CHECK(TestType{}.closure(flow, t).eddy_viscosity == Approx(1.2 * kappa * u * y));
  CHECK(s.rate[0] == Approx(0.0).margin(1e-12 * 1.2 * 0.09 * k * omega));
  const double diffusion = 1.2 * 0.5 * kappa * u * omega / y;  // d/dy(sigma nu_t d(omega)/dy)
  CHECK(s.rate[1] + diffusion == Approx(0.0).margin(1e-12 * 1.2 * beta * omega * omega));
}

// omega = 6 nu / (beta y^2): nu omega'' = beta omega^2.
TEMPLATE_TEST_CASE("omega of the sublayer is an exact solution", "[turbulence][fast]", KOmega1988, KOmega) {
  const double nu = 1.5e-5, y = 2e-5, omega = 6.0 * nu / (TestType::wall_beta * y * y);
  const Flow<double> flow{1.2, 1.2 * nu, y, flat, flat, flat};
  const auto s = TestType{}.source(flow, {{0.0, omega}, {flat, {0.0, -2.0 * omega / y, 0.0}}});
  CHECK(s.rate[1] == Approx(-1.2 * nu * 6.0 * omega / (y * y)).epsilon(1e-12));
  CHECK(TestType{}.wall(y, nu)[1] == Approx(10.0 * omega));
  CHECK(TestType{}.wall(y, nu)[0] == 0.0);
}

TEST_CASE("free turbulence of k-omega decays as t^(-beta*/beta)", "[turbulence][fast]") {
  const Flow<double> flow{1.2, 1.8e-5, 1e3, flat, flat, flat};
  const Turbulence<double, 2> t{{0.1, 50.0}, {flat, flat}};
  for (const auto& [s, beta] : {std::pair{KOmega1988{}.source(flow, t), 0.075}, std::pair{KOmega{}.source(flow, t), 0.0708}}) {
    CHECK(s.rate[0] / 0.1 == Approx(-0.09 * 1.2 * 50.0));
    CHECK(s.rate[1] / 50.0 == Approx(-beta * 1.2 * 50.0));
  }
}

TEST_CASE("the stress of Wilcox 2006 is limited, that of 1988 is not", "[turbulence][fast]") {
  const Flow<double> flow{1.2, 1.8e-5, 1.0, {0.0, 1000.0, 0.0}, flat, flat};
  const Turbulence<double, 2> t{{0.1, 50.0}, {flat, flat}};
  CHECK(KOmega1988{}.closure(flow, t).eddy_viscosity == Approx(1.2 * 0.1 / 50.0));
  const auto c = KOmega{}.closure(flow, t);
  CHECK(c.eddy_viscosity * 1000.0 == Approx(0.3 / 0.875 * 1.2 * 0.1));  // of the shear stress: .343 rho k
  CHECK(c.diffusivity[0] == Approx(1.8e-5 + 0.6 * 1.2 * 0.1 / 50.0));   // k and omega spread unlimited
}

TEST_CASE("cross diffusion of Wilcox 2006 acts where k and omega rise together", "[turbulence][fast]") {
  const Flow<double> flow{1.2, 1.8e-5, 1.0, flat, flat, flat};
  const auto rate = [&](double slope) {
    return KOmega{}.source(flow, {{0.1, 50.0}, {{0.0, 2.0, 0.0}, {0.0, slope, 0.0}}}).rate[1];
  };
  CHECK(rate(300.0) - rate(0.0) == Approx(0.125 * 1.2 * 2.0 * 300.0 / 50.0));
  CHECK(rate(-300.0) == rate(0.0));
}

TEST_CASE("stretched vortices lower the destruction of omega, plane flow does not", "[turbulence][fast]") {
  const Turbulence<double, 2> t{{1e-12, 50.0}, {flat, flat}};
  const double w = 80.0, a = 30.0;  // vorticity along z, stretched at the rate a
  const Flow<double> flow{1.2, 1.8e-5, 1e3, {-0.5 * a, -0.5 * w, 0.0}, {0.5 * w, -0.5 * a, 0.0}, {0.0, 0.0, a}};
  const double chi = 0.25 * w * w * a / std::pow(0.09 * 50.0, 3), beta = 0.0708 * (1.0 + 85.0 * chi) / (1.0 + 100.0 * chi);
  const double rate2 = 2.0 * (0.5 * a * a + a * a), made = 0.52 * 1.2 * 50.0 * rate2 / (0.875 * std::sqrt(rate2 / 0.09));
  CHECK(KOmega{}.source(flow, t).rate[1] == Approx(made - beta * 1.2 * 2500.0).epsilon(1e-12));
  // The definition, Omega_ij Omega_jk S_ki, of this flow: Omega = w/2 (e_y e_x - e_x e_y), its square -w^2/4 in the plane.
  CHECK(std::abs(2.0 * (-0.25 * w * w) * (-0.5 * a)) == Approx(0.25 * w * w * a));
}
