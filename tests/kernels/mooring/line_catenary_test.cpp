// The static elastic catenary of kernels/mooring/line_catenary.hpp: its own equations, limits, continuity and stiffness; then
// MAP++, OrcaFlex and an independent least-squares solution. SPDX-License-Identifier: Apache-2.0
#include "kernels/mooring/line_catenary.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <random>

#include "kernels/base/constants.hpp"
#include "stiffness_check.hpp"

using namespace spindrift;
using Eigen::Vector3d;

namespace {

const LineCatenary oc3{.length = 902.2, .weight_per_m = 698.0945, .axial_stiffness = 384.243e6, .bed_friction = 0.001};
const LineCatenary chain{.length = 410.0, .weight_per_m = 3323.25, .axial_stiffness = 1.674e9};

/// Jonkman (2007), eqs. 2-34 to 2-37, written out as printed: where the fairlead must be for given H, V.
Eigen::Vector2d fairlead_of(const LineCatenary& line, double h, double v) {
  const double w = line.weight_per_m, l = line.length, ea = line.axial_stiffness, cb = line.bed_friction;
  const double va = v - w * l, bed = l - v / w;
  if (!line.bed_contact || va >= 0.0)
    return {h / w * (std::asinh(v / h) - std::asinh(va / h)) + h * l / ea,
            h / w * (std::sqrt(1 + v * v / (h * h)) - std::sqrt(1 + va * va / (h * h))) + (v * l - 0.5 * w * l * l) / ea};
  double x = bed + h / w * std::asinh(v / h) + h * l / ea;
  if (cb > 0.0) {
    const double free = bed - h / (cb * w);
    x += cb * w / (2 * ea) * (-bed * bed + free * std::max(free, 0.0));
  }
  return {x, h / w * (std::sqrt(1 + v * v / (h * h)) - 1) + v * v / (2 * ea * w)};
}

}  // namespace

TEST_CASE("the OC3 line agrees with MAP++ to one part in a million", "[mooring][fast]") {
  // MAP++ 1.20.10, old-NWTC/FAST CertTest/TstFiles/Test24.MAP.sum: H 736939.302 N, V 535728.001 N, anchor 736845.209 N.
  const CatenaryState s = oc3.solve(848.67, 250.0);
  CHECK(s.horizontal == Approx(736939.302).epsilon(1e-6));
  CHECK(s.vertical == Approx(535728.001).epsilon(1e-6));
  CHECK(s.lower_horizontal == Approx(736845.209).epsilon(1e-6));
  CHECK(s.on_bed == Approx(134.785).epsilon(1e-5));
  CHECK(s.regime == CatenaryRegime::grounded);
}

TEST_CASE("the chains in 50, 200 and 600 m of water agree with OrcaFlex to 1.5 per cent", "[mooring][fast]") {
  // Chain D 0.252 m, 390 kg/m, EA 1.674e9 N. OrcaFlex statics: FloatingArrayDesign/MoorDyn, tests/quasi_static_chain.cpp (BSD-3).
  // reference: least squares on the same equations to a cost below 1e-26, for bed friction 0 and 0.5.
  struct Case {
    double x, z, length, orca_fairlead, orca_anchor, h[2], v[2], bed[2], anchor[2];
  };
  const Case c = GENERATE(
      Case{400, 50, 410, 991.6e3, 826.2e3, {835594, 840494}, {552373, 553843}, {243.79, 243.34}, {835594, 436149}},
      Case{700, 200, 760, 2065.4e3, 1402.2e3, {1406150, 1408485}, {1519243, 1520262}, {302.84, 302.54}, {1406150, 905781}},
      Case{1500, 600, 1700, 5232.6e3, 3244.2e3, {3247255, 3251089}, {4107647, 4109497}, {463.97, 463.41}, {3247255, 2481075}});
  LineCatenary line = chain;
  line.length = c.length;
  for (int i : {0, 1}) {
    line.bed_friction = i == 0 ? 0.0 : 0.5;
    const CatenaryState s = line.solve(c.x, c.z);
    CHECK(s.horizontal == Approx(c.h[i]).epsilon(1e-6));
    CHECK(s.vertical == Approx(c.v[i]).epsilon(1e-6));
    CHECK(s.on_bed == Approx(c.bed[i]).epsilon(3e-5));
    CHECK(s.lower_horizontal == Approx(c.anchor[i]).epsilon(2e-6));
    if (i == 1) continue;  // their anchor tension shows that OrcaFlex was run without friction
    CHECK(std::hypot(s.horizontal, s.vertical) == Approx(c.orca_fairlead).epsilon(0.015));
    CHECK(s.lower_horizontal == Approx(c.orca_anchor).epsilon(0.015));
  }
}

TEST_CASE("forces put back into the printed equations return the fairlead, anywhere from sagging to bar-taut",
          "[mooring][fast]") {
  std::mt19937 random(7);
  const auto pick = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  int suspended = 0, grounded = 0, most = 0;
  for (int n = 0; n < 20000; ++n) {
    LineCatenary line{.length = std::exp(pick(0, 8)),
                      .weight_per_m = std::exp(pick(-2, 10)),
                      .axial_stiffness = 0.0,
                      .bed_friction = n % 2 ? std::exp(pick(-8, 1)) : 0.0,
                      .bed_contact = n % 3 != 0};
    line.axial_stiffness = line.weight_per_m * line.length * std::exp(pick(0, 16));
    const double angle = pick(0, 0.5 * pi), chord = line.length * (n % 4 ? pick(0.3, 1.0) : 1.0 + std::exp(pick(-20, 0)));
    const double x = chord * std::cos(angle), z = chord * std::sin(angle);
    const CatenaryState s = line.solve(x, z);
    REQUIRE(s.converged);
    most = std::max(most, s.evaluations);
    if (s.regime == CatenaryRegime::slack) continue;
    (s.regime == CatenaryRegime::grounded ? grounded : suspended) += 1;
    INFO("L " << line.length << " w " << line.weight_per_m << " EA " << line.axial_stiffness << " x " << x << " z " << z << " H "
              << s.horizontal);
    REQUIRE(s.horizontal > 0.0);
    REQUIRE((s.regime == CatenaryRegime::grounded) == (s.on_bed > 0.0));
    // The printed form cancels where a line is taut: judge it by how far rounding of H and V moves the fairlead.
    const double slope = 1e-13 * (line.length + s.horizontal * line.length / line.axial_stiffness) +
                         1e-15 * std::hypot(s.horizontal, s.vertical) / line.weight_per_m;
    REQUIRE((fairlead_of(line, s.horizontal, s.vertical) - Eigen::Vector2d(x, z)).norm() < 20 * slope + 1e-12);
  }
  CHECK(suspended > 1000);
  CHECK(grounded > 1000);
  CHECK(most <= 30);
}

TEST_CASE("an inextensible line hangs in the classical catenary", "[mooring][fast]") {
  LineCatenary line{.length = 100.0, .weight_per_m = 50.0, .axial_stiffness = 1e16, .bed_contact = false};
  const double a = GENERATE(20.0, 80.0, 900.0);  // H / w of a symmetric catenary of 100 m: ends level, distance 2 a asinh(L / 2a)
  const CatenaryState s = line.solve(2 * a * std::asinh(50.0 / a), 0.0);
  CHECK(s.horizontal == Approx(50.0 * a).epsilon(1e-6));
  CHECK(s.vertical == Approx(2500.0));
  CHECK(s.lower_vertical == Approx(-2500.0));
}

TEST_CASE("a weightless limit is an elastic bar, a vertical one carries its weight at the top", "[mooring][fast]") {
  const LineCatenary line{.length = 100.0, .weight_per_m = 1e-6, .axial_stiffness = 1e6, .bed_contact = GENERATE(true, false)};
  const CatenaryState s = line.solve(81.0, 60.0);
  CHECK(std::hypot(s.horizontal, s.vertical) == Approx(1e6 * (std::hypot(81.0, 60.0) / 100.0 - 1.0)).epsilon(1e-6));
  CHECK(s.vertical / s.horizontal == Approx(60.0 / 81.0).epsilon(1e-6));
  const LineCatenary rope{.length = 100.0, .weight_per_m = 1e3, .axial_stiffness = 1e6, .bed_contact = GENERATE(true, false)};
  const CatenaryState taut = rope.solve(0.0, 110.0);  // 10 m = mean tension x L / EA
  CHECK(taut.horizontal == 0.0);
  CHECK(taut.vertical == Approx(1e6 * 0.1 + 5e4));
  CHECK(taut.lower_vertical == Approx(1e6 * 0.1 - 5e4));
}

TEST_CASE("a slack line carries the weight it lifts and nothing else", "[mooring][fast]") {
  const CatenaryState s = chain.solve(300.0, 50.0);
  CHECK(s.regime == CatenaryRegime::slack);
  CHECK(s.horizontal == 0.0);
  const double lifted = 410.0 - s.on_bed;
  CHECK(s.vertical == Approx(3323.25 * lifted));
  CHECK(lifted + 3323.25 * lifted * lifted / (2 * 1.674e9) == Approx(50.0));
  LineCatenary hanging = chain;
  hanging.bed_contact = false;
  const CatenaryState u = hanging.solve(0.0, 50.0);
  CHECK(u.vertical - u.lower_vertical == Approx(3323.25 * 410.0));
  CHECK(u.vertical + u.lower_vertical == Approx(3323.25 * 50.0).epsilon(1e-3));  // less by the stretch
}

TEST_CASE("forces are continuous through slack, touch-down, lift-off, taut and the fairlead sinking past the anchor",
          "[mooring][fast]") {
  LineCatenary line = chain;
  line.bed_friction = GENERATE(0.0, 0.5);
  const auto slope_bound = [&](const Vector3d& from, const Vector3d& to) {
    constexpr int steps = 20000;
    LineForces last = line.forces(from, Vector3d::Zero());
    double worst = 0.0;
    for (int i = 1; i <= steps; ++i) {
      const LineForces now = line.forces(from + (to - from) * i / steps, Vector3d::Zero());
      worst = std::max({worst, (now.on_fairlead - last.on_fairlead).norm(), (now.on_anchor - last.on_anchor).norm()});
      last = now;
    }
    return worst;
  };
  // The stiffest line is the straight one, EA / L; a step of 20 to 40 m / 20000 may change the force by that much and no more.
  const double bar = 1.674e9 / 410.0;
  CHECK(slope_bound({370, 0, 50}, {412, 0, 50}) < bar * 42.0 / 20000);   // slack, touching, lifted off, taut
  CHECK(slope_bound({400, 0, -20}, {400, 0, 20}) < bar * 40.0 / 20000);  // through the level of the anchor
  CHECK(slope_bound({-1, 0, 395}, {1, 1, 415}) < bar * 21.0 / 20000);    // overhead
  line.bed_contact = false;
  CHECK(slope_bound({-5, 1e-3, 50}, {5, 1e-3, 50}) < bar * 10.0 / 20000);  // the U passing through itself
}

TEST_CASE("the stiffness of a catenary agrees with differences in every regime", "[mooring][fast]") {
  LineCatenary line = chain;
  line.bed_friction = GENERATE(0.0, 0.5);
  const Vector3d span =
      GENERATE(Vector3d(340, 100, 50), Vector3d(-380, 90, 50), Vector3d(300, -250, 120), Vector3d(300, -285, 50),
               Vector3d(200, 100, 50), Vector3d(-380, 90, -50), Vector3d(300, -250, -120), Vector3d(5, 0.5, 415));
  const Eigen::Matrix3d exact = line.stiffness(span), differences = difference_stiffness(line, span, 1e-3);
  INFO(exact << "\n\n" << differences);
  CHECK((exact - differences).norm() < 2e-7 * (exact.norm() + 1.0));
}

TEST_CASE("a line free of the bed and one without friction derive from a potential: their stiffness is symmetric, and definite",
          "[mooring][fast]") {
  LineCatenary line = chain;
  line.bed_contact = GENERATE(true, false);
  const Vector3d span = GENERATE(Vector3d(390, 0, 50), Vector3d(100, 200, 340), Vector3d(300, -287, 20), Vector3d(40, 0, 30));
  const Eigen::Matrix3d k = line.stiffness(span);
  CHECK((k - k.transpose()).norm() < 1e-9 * k.norm());
  CHECK(k.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() >= -1e-12 * k.norm());
}

TEST_CASE("what a line does to its ends balances its weight and its bed", "[mooring][fast]") {
  LineCatenary line = chain;
  line.bed_contact = false;
  const Vector3d span = GENERATE(Vector3d(340, 100, 50), Vector3d(-380, 90, -50), Vector3d(0, 0, 12), Vector3d(0, 0, -420));
  const LineForces f = line.forces(span, Vector3d::Zero());
  CHECK((f.on_fairlead + f.on_anchor + Vector3d(0, 0, 3323.25 * 410)).norm() < 1e-6);
  CHECK(f.fairlead_tension == Approx(f.on_fairlead.norm()));
  CHECK(f.anchor_tension == Approx(f.on_anchor.norm()));
  const LineForces turned = line.forces(-span, Vector3d::Zero());  // the same line seen from its other end
  CHECK((turned.on_fairlead - f.on_anchor).norm() < 1e-6);
}
