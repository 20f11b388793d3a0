// Dynamic inflow and dynamic stall: Oye's filters against their closed solutions, and a measured loop.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <vector>

#include "kernels/base/interpolation.hpp"
#include "kernels/rotor/dynamic_inflow_oye.hpp"
#include "kernels/rotor/dynamic_stall_oye.hpp"

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

namespace {

/// LS(1)-0417MOD, clean, Re 1e6, steady, and pitched as 14 - 10.5 cos(2 pi 1.1949 Hz t) degrees in 32.58 m/s, chord 0.457 m: Ohio
/// State University (Reuss Ramsay, Hoffmann & Gregorek 1995, NREL/TP-442-7819), case C10m100AM14 as in OpenFAST's CertTest
/// (Apache-2.0). Angle [deg], lift, drag; two turns.
struct Row {
  double attack, lift, drag;
};
const std::vector<Row> steady{
    {-20.1, -.43, .2726}, {-18, -.39, .2387},  {-16.2, -.37, .2158}, {-14.2, -.69, .0424}, {-12.1, -.73, .0493},
    {-10.3, -.66, .0298}, {-8.1, -.43, .0177}, {-6.3, -.27, .0137},  {-4.1, -.04, .0105},  {-2, .17, .0091},
    {-.1, .3633, .0098},  {2, .59, .0098},     {4.1, .80, .0108},    {6.3, 1.01, .0118},   {8.2, 1.2, .0138},
    {10.3, 1.37, .0175},  {11.4, 1.43, .0196}, {12.2, 1.48, .0215},  {13.2, 1.51, .0254},  {14.3, 1.53, .068},
    {15.3, 1.55, .097},   {16.3, 1.26, .0941}, {17.2, 1.21, .1069},  {18.2, 1.17, .1269},  {19.2, 1.14, .1462},
    {20.2, 1.15, .1678},  {22.3, 1.2, .2214},  {24.2, 1.37, .3034},  {26.2, 1.18, .3305},  {28.2, 1.16, .3973}};
const std::vector<Row> up{{3.9, .81, .0180},   {4.5, .90, .0212},   {5.6, 1.00, .0227},  {7.7, 1.18, .0441},  {9.3, 1.36, .0454},
                          {11.9, 1.58, .0770}, {14.0, 1.75, .0889}, {16.1, 1.88, .0995}, {18.2, 1.96, .1269}, {19.9, 1.99, .2059},
                          {21.3, 1.71, .3692}, {22.9, 1.34, .3149}, {23.9, 1.31, .2945}, {3.5, .81, .0103},   {4.8, .92, .0226},
                          {6.2, 1.07, .0308},  {8.2, 1.24, .0468},  {10.0, 1.43, .0580}, {12.4, 1.61, .0737}, {14.5, 1.80, .0913},
                          {16.6, 1.92, .1041}, {18.7, 1.99, .1411}, {20.3, 1.97, .2332}, {21.8, 1.69, .3658}, {23.4, 1.51, .3397},
                          {23.9, 1.43, .3187}};
const std::vector<Row> down{
    {23.9, 1.16, .2538}, {22.4, 1.16, .2010}, {20.8, 1.13, .1662}, {18.7, 1.11, .1313}, {16.6, 1.09, .0903}, {14.5, 1.10, .0522},
    {12.4, 1.12, .0247}, {10.3, 1.18, .0203}, {8.2, 1.17, .0121},  {6.7, 1.11, .0116},  {5.1, .98, .0078},   {4.1, .89, .0029},
    {23.4, 1.35, .3054}, {21.8, 1.23, .2225}, {20.3, 1.28, .2019}, {18.2, 1.31, .1539}, {16.0, 1.23, .1105}, {13.7, 1.28, .0844},
    {11.4, 1.20, .0518}, {9.3, 1.19, .0324},  {7.7, 1.10, .0266},  {6.1, 1.03, .0142},  {4.7, .94, .0090},   {4.1, .87, .0090}};

double normal_force(double attack, double lift, double drag) { return lift * std::cos(attack) + drag * std::sin(attack); }

}  // namespace

TEST_CASE("the normal force of an aerofoil in dynamic stall follows the measured loop within 10 per cent of its peak",
          "[rotor][fast]") {
  std::vector<double> attack, lift, drag;
  for (const Row& row : steady)
    attack.push_back(row.attack * radians_per_degree), lift.push_back(row.lift), drag.push_back(row.drag);
  const DynamicStallOye stall = DynamicStallOye::of(attack, lift);
  CHECK(stall.zero_lift / radians_per_degree == Approx(-3.7).margin(0.1));
  CHECK(stall.slope == Approx(5.9).epsilon(0.05));
  const double frequency = 1.1949, h = 1.0 / (200 * frequency), omega = 2.0 * pi * frequency;
  std::vector<double> angle, normal;  // of a cycle from the least angle on
  double f = 1.0, before = 1.0;
  for (int n = 0; n <= 600; ++n) {
    const double a = (14.0 - 10.5 * std::cos(omega * n * h)) * radians_per_degree;
    const double still = interpolate_linear(attack, lift, a), now = stall.separation(a, still);
    if (n > 0) f = DynamicStallOye::advance(f, before, now, h, 0.457, 32.5831);
    before = now;
    if (n >= 400) {
      angle.push_back(a);
      normal.push_back(normal_force(a, stall.lift(a, still, f), interpolate_linear(attack, drag, a)));
    }
  }
  double squares = 0.0, peak = 0.0;
  const auto compare = [&](const std::vector<Row>& rows, std::vector<double> a, std::vector<double> c) {
    if (a.front() > a.back()) std::reverse(a.begin(), a.end()), std::reverse(c.begin(), c.end());
    for (const Row& row : rows) {
      const double at = row.attack * radians_per_degree, measured = normal_force(at, row.lift, row.drag);
      squares += std::pow(interpolate_linear(a, c, at) - measured, 2), peak = std::max(peak, measured);
    }
  };
  compare(up, {angle.begin(), angle.begin() + 101}, {normal.begin(), normal.begin() + 101});
  compare(down, {angle.begin() + 100, angle.end()}, {normal.begin() + 100, normal.end()});
  const double rms = std::sqrt(squares / double(up.size() + down.size()));
  CHECK(rms / peak < 0.10);
}

TEST_CASE("held still, stall is the polar's, at every angle", "[rotor][fast]") {
  std::vector<double> attack, lift;
  for (const Row& row : steady) attack.push_back(row.attack * radians_per_degree), lift.push_back(row.lift);
  const DynamicStallOye stall = DynamicStallOye::of(attack, lift);
  for (std::size_t i = 0; i < attack.size(); ++i)
    CHECK(stall.lift(attack[i], lift[i], stall.separation(attack[i], lift[i])) == Approx(lift[i]).epsilon(1e-12));
  CHECK(stall.lift(1.2, 0.7, 1.0) == 0.7);  // beyond 50 degrees the polar alone
  const DynamicStallOye cylinder = DynamicStallOye::of(attack, std::vector<double>(attack.size(), 0.0));
  CHECK(cylinder.lift(0.1, 0.0, 0.5) == 0.0);
}
