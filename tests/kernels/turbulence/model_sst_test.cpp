// k-omega SST: exact balances of its inner and outer sets, limiters, values on walls and in the far field.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_sst.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace spindrift;
using namespace spindrift::turbulence;

namespace {
const Vector<double> no_gradient{0, 0, 0};
/// Of 2003, with its rounded constants.
template <class Model>
constexpr bool newer = std::is_same_v<Model, Sst> || std::is_same_v<Model, Sst2003Vm>;
}  // namespace

TEMPLATE_TEST_CASE("the log layer balances production and destruction of k", "[turbulence][fast]", Sst, Sst2003Vm, Sst1994, SstV,
                   SstVm) {
  const double u_tau = 0.5, y = 0.01, nu = 1e-8, kappa = 0.41, root = 0.3;  // sqrt(beta*)
  const double k = u_tau * u_tau / root, omega = u_tau / (root * kappa * y);
  const Flow<double> flow{1.2, 1.2 * nu, y, {0.0, u_tau / (kappa * y), 0.0}, no_gradient, no_gradient};
  const Turbulence<double, 2> t{{k, omega}, {no_gradient, {0.0, -omega / y, 0.0}}};
  const auto s = TestType{}.source(flow, t);
  const auto c = TestType{}.closure(flow, t);
  CHECK(c.eddy_viscosity ==
        Approx(1.2 * kappa * u_tau * y).epsilon(0.01));  // the shear limiter is at its threshold: a1 = 0.31, not 0.3
  CHECK(s.rate[0] == Approx(0.0).margin(0.01 * 1.2 * 0.09 * k * omega));
  // d/dy(sigma nu_t domega/dy) = sigma kappa u_tau omega / y: with the constants of 1994 the layer is exact, those of 2003 are
  // rounded.
  const double diffusion = 1.2 * 0.5 * kappa * u_tau * omega / y, tolerance = newer<TestType> ? 0.02 : 1e-10;
  CHECK(s.rate[1] + diffusion == Approx(0.0).margin(tolerance * 1.2 * 0.075 * omega * omega));
  // Inner constants near the wall.
  CHECK(c.diffusivity[0] == Approx(1.2 * nu + 0.85 * c.eddy_viscosity).epsilon(1e-6));
}

// Decay of free turbulence: k ~ t^(-beta*/beta2), so d(k)/k over d(omega)/omega is beta*/beta2.
TEMPLATE_TEST_CASE("free turbulence decays with the outer constants", "[turbulence][fast]", Sst, Sst2003Vm, Sst1994, SstV,
                   SstVm) {
  const Flow<double> flow{1.2, 1.8e-5, 1e3, no_gradient, no_gradient, no_gradient};
  const Turbulence<double, 2> t{{0.1, 50.0}, {no_gradient, no_gradient}};
  const auto s = TestType{}.source(flow, t);
  CHECK(s.rate[0] == Approx(-0.09 * 1.2 * 0.1 * 50.0).epsilon(1e-12));
  // Without cross diffusion F1 is 1 where arg1 is large; far from walls it is small.
  CHECK(s.rate[1] == Approx(-0.0828 * 1.2 * 2500.0).epsilon(1e-3));
}

TEMPLATE_TEST_CASE("production of k is at most the limiter times its destruction", "[turbulence][fast]", Sst, Sst2003Vm, Sst1994,
                   SstV, SstVm) {
  const double limiter = newer<TestType> ? 10.0 : 20.0;
  const Flow<double> flow{1.2, 1.8e-5, 1e3, {0.0, 3e4, 0.0}, no_gradient, no_gradient};
  const auto s = TestType{}.source(flow, {{0.1, 50.0}, {no_gradient, no_gradient}});
  const double destruction = 0.09 * 1.2 * 0.1 * 50.0;
  CHECK(s.rate[0] == Approx((limiter - 1.0) * destruction).epsilon(1e-12));
}

// Far from walls F1 = F2 = 0, so that nu_t = k / omega.
TEMPLATE_TEST_CASE("production of omega is gamma / nu_t times that of k, which SST of 2003 limits in both equations",
                   "[turbulence][fast]", Sst, Sst2003Vm, Sst1994, SstV, SstVm) {
  const double rho = 1.2, omega = 50.0, unit = rho * omega * omega, gamma = newer<TestType> ? 0.44 : sst_gamma2;
  const Turbulence<double, 2> t{{0.1, omega}, {no_gradient, no_gradient}};
  const auto check = [&](const Vector<double>& u, const Vector<double>& v, const Vector<double>& w, double over_nu_t) {
    const Flow<double> flow{rho, 1.8e-5, 1e5, u, v, w};
    if (newer<TestType>) over_nu_t = std::min(over_nu_t, 10.0 * 0.09 * unit);
    CHECK(TestType{}.source(flow, t).rate[1] == Approx(gamma * over_nu_t - 0.0828 * unit).epsilon(1e-9));
  };
  for (const double rate : {1e-2, 100.0, 3e4}) check({0.0, rate, 0.0}, no_gradient, no_gradient, rho * rate * rate);
  // Compressed and expanded evenly: no strain but what changes the volume.
  const bool pressed =
      TestType{}.closure(Flow<double>{rho, 1.8e-5, 1e5, no_gradient, no_gradient, no_gradient}, t).pressure > 0.0;
  for (const double div : {-300.0, -3.0, 3.0})
    check({div / 3.0, 0.0, 0.0}, {0.0, div / 3.0, 0.0}, {0.0, 0.0, div / 3.0}, pressed ? -2.0 / 3.0 * rho * omega * div : 0.0);
}

TEST_CASE("the vorticity variant makes no turbulence in a stagnation flow, the strain variant does", "[turbulence][fast]") {
  const Flow<double> flow{1.2, 1.8e-5, 1.0, {100.0, 0.0, 0.0}, {0.0, -100.0, 0.0}, no_gradient};
  const Turbulence<double, 2> t{{0.1, 100.0}, {no_gradient, no_gradient}};
  const double destruction = 0.09 * 1.2 * 0.1 * 100.0;
  CHECK(SstVm{}.source(flow, t).rate[0] == Approx(-destruction).epsilon(1e-10));
  CHECK(Sst{}.source(flow, t).rate[0] > 0.0);
  CHECK(Sst{}.closure(flow, t).pressure == Approx(2.0 / 3.0 * 1.2 * 0.1));
  CHECK(SstVm{}.closure(flow, t).pressure == 0.0);
}

TEST_CASE("variants of SST differ in what makes turbulence, what limits the stress and what 2/3 k does", "[turbulence][fast]") {
  // Sheared, strained and compressed.
  const Flow<double> flow{1.2, 1.8e-5, 0.003, {-20.0, 300.0, 0.0}, {100.0, 5.0, 0.0}, no_gradient};
  const Turbulence<double, 2> t{{0.1, 500.0}, {no_gradient, no_gradient}};
  const double omega = 200.0, strain2 = 2.0 * (400.0 + 25.0) + 400.0 * 400.0, div = -15.0, k = 0.1, d = 0.09 * 1.2 * k * 500.0;
  const double by_strain = strain2 - 2.0 / 3.0 * div * div, pressed = -2.0 / 3.0 * 1.2 * k * div;
  const double limit_vorticity = 1.2 * 0.31 * k / std::max(0.31 * 500.0, omega),
               limit_strain = 1.2 * 0.31 * k / std::max(0.31 * 500.0, std::sqrt(strain2));
  const auto check = [&](const auto& model, double eddy, double rate2, double pressure) {
    const auto c = model.closure(flow, t);
    CHECK(c.eddy_viscosity == Approx(eddy).epsilon(1e-6));  // F2 is 1 here
    CHECK(model.source(flow, t).rate[0] == Approx(eddy * rate2 + pressure - d).epsilon(1e-6));
    // Close to the wall F1 is 1: inner gamma and beta.
    const double gamma = newer<std::decay_t<decltype(model)>> ? 5.0 / 9.0 : sst_gamma1;
    CHECK(model.source(flow, t).rate[1] ==
          Approx(gamma * 1.2 / eddy * (eddy * rate2 + pressure) - 0.075 * 1.2 * 500.0 * 500.0).epsilon(1e-6));
    CHECK(c.pressure == Approx(pressure == 0.0 ? 0.0 : 2.0 / 3.0 * 1.2 * k));
  };
  check(Sst1994{}, limit_vorticity, by_strain, pressed);
  check(SstV{}, limit_vorticity, omega * omega, pressed);
  check(SstVm{}, limit_vorticity, omega * omega, 0.0);
  check(Sst{}, limit_strain, by_strain, pressed);
  check(Sst2003Vm{}, limit_strain, omega * omega, 0.0);
}

TEST_CASE("SST values on walls and in the far field are Menter's and the TMR's", "[turbulence][fast]") {
  const double nu = 1.5e-5, d = 1e-5;
  CHECK(Sst{}.wall(d, nu)[0] == 0.0);
  CHECK(Sst{}.wall(d, nu)[1] == Approx(10.0 * 6.0 * nu / (0.075 * d * d)));
  const auto far = SstVm{}.far_field(nu, 50.0, 340.0);
  CHECK(far[0] / far[1] == Approx(0.009 * nu));
  const Flow<double> flow{1.2, 1.2 * nu, 1e3, no_gradient, no_gradient, no_gradient};
  CHECK(SstVm{}.closure(flow, {{far[0], far[1]}, {no_gradient, no_gradient}}).eddy_viscosity / flow.mu ==
        Approx(0.009).epsilon(1e-6));
}
