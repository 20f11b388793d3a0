// Dynamic inflow and dynamic stall: Oye's filters against their closed solutions, and a measured loop.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <vector>

#include "kernels/rotor/dynamic_inflow_oye.hpp"
#include "kernels/rotor/dynamic_stall_oye.hpp"
#include "tests/kernels/rotor/dynamic_stall_loop.hpp"

using namespace spindrift;

TEST_CASE("a lag follows a ramp exactly, whatever the step", "[rotor][fast]") {
  const double tau = 0.3;
  const auto exact = [&](double t) { return 2.0 * (t - tau) + (1.0 + 2.0 * tau) * std::exp(-t / tau); };  // u = 2 t, y(0) = 1
  for (double h : {1e-3, 0.1, 5.0}) CHECK(lagged(1.0, 0.0, 2.0 * h, h, tau) == Approx(exact(h)).epsilon(1e-10));
}

TEST_CASE("after a step of the quasi-steady induction the wake has the published two time constants", "[rotor][fast]") {
  // Hansen (2008), eqs. 9.19, 9.20: tau_1 = 1.1 R / (U (1 - 1.3 a)), tau_2 = (0.39 - 0.26 (r/R)^2) tau_1, k = 0.6.
  const auto wake = DynamicInflowOye::at(42.0, 60.0, 8.0, 0.3);
  CHECK(wake.far == Approx(1.1 / (1.0 - 0.39) * 60.0 / 8.0));
  CHECK(wake.near == Approx((0.39 - 0.26 * 0.49) * wake.far));
  CHECK(DynamicInflowOye::at(42.0, 60.0, 8.0, 0.9).far == Approx(1.1 / 0.35 * 60.0 / 8.0));  // a at most 0.5
  DynamicInflowOye::Induced w{2.0, 2.0, 2.0};
  const double h = 0.01, rest = 1.0 - DynamicInflowOye::share, ratio = wake.far / (wake.far - wake.near);
  double worst = 0.0;
  for (int n = 1; n <= 5000; ++n) {
    w = wake.advance(w, 3.0, h);
    // Behind the first filter 1 - (1 - k) exp(-t/tau_1), behind both the sum of two exponentials.
    const double t = n * h, far = std::exp(-t / wake.far), near = std::exp(-t / wake.near);
    const double exact = 3.0 - rest * ratio * far - (1.0 - rest * ratio) * near;
    if (n > 5) worst = std::max(worst, std::abs(w.now - exact));
  }
  CHECK(worst < 2e-3);
}

TEST_CASE("the normal force of an aerofoil in dynamic stall follows the measured loop within 10 per cent of its peak",
          "[rotor][fast]") {
  std::vector<double> attack, lift, drag;
  for (const test::Row& row : test::steady)
    attack.push_back(row.attack * radians_per_degree), lift.push_back(row.lift), drag.push_back(row.drag);
  const DynamicStallOye stall = DynamicStallOye::of(attack, lift);
  CHECK(stall.zero_lift / radians_per_degree == Approx(-3.7).margin(0.1));
  CHECK(stall.slope == Approx(5.9).epsilon(0.05));
  const double h = 1.0 / (200 * test::loop_frequency_Hz);
  std::vector<double> angle, normal;  // of a cycle from the least angle on
  double f = 1.0, before = 1.0;
  for (int n = 0; n <= 600; ++n) {
    const double a = test::loop_attack(n * h);
    const double still = interpolate_linear(attack, lift, a), now = stall.separation(a, still);
    if (n > 0) f = DynamicStallOye::advance(f, before, now, h, test::loop_chord_m, test::loop_speed_m_s, 4.0);
    before = now;
    if (n >= 400) {
      angle.push_back(a);
      normal.push_back(test::normal_force(a, stall.lift(a, still, f), interpolate_linear(attack, drag, a)));
    }
  }
  CHECK(test::loop_error(angle, normal).rms < 0.10);
}

TEST_CASE("separation lags by the passage of so many chords", "[rotor][fast]") {
  // A step of the static point, one chord of 2 m at 50 m/s later.
  for (const double chords : {1.5, 4.0})
    CHECK(DynamicStallOye::advance(1.0, 0.0, 0.0, 2.0 / 50.0, 2.0, 50.0, chords) == Approx(std::exp(-1.0 / chords)));
}

TEST_CASE("held still, stall is the polar's, at every angle", "[rotor][fast]") {
  std::vector<double> attack, lift;
  for (const test::Row& row : test::steady) attack.push_back(row.attack * radians_per_degree), lift.push_back(row.lift);
  const DynamicStallOye stall = DynamicStallOye::of(attack, lift);
  for (std::size_t i = 0; i < attack.size(); ++i)
    CHECK(stall.lift(attack[i], lift[i], stall.separation(attack[i], lift[i])) == Approx(lift[i]).epsilon(1e-12));
  CHECK(stall.lift(1.2, 0.7, 1.0) == 0.7);  // beyond 50 degrees the polar alone
  const DynamicStallOye cylinder = DynamicStallOye::of(attack, std::vector<double>(attack.size(), 0.0));
  CHECK(cylinder.lift(0.1, 0.0, 0.5) == 0.0);
}
