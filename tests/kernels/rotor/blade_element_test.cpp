// Laws of kernels/rotor/blade_element.hpp: the balance it claims, mirrors, limits, and every kind of wind.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/rotor/blade_element.hpp"

#include <catch2/catch.hpp>
#include <random>

using namespace spindrift;

namespace {

/// A section that stalls: thin-aerofoil lift to 12 degrees, flat-plate force beyond.
SectionForce section(double attack) {
  const double a = std::remainder(attack, 2 * pi), stall = 12 * radians_per_degree;
  if (std::abs(a) <= stall) return {2 * pi * std::sin(a), 0.01 + 0.1 * a * a};
  const double lift = 2.0 * std::sin(a) * std::cos(a), drag = 0.02 + 1.8 * std::sin(a) * std::sin(a);
  return {lift, drag};
}

constexpr Annulus ring{.radius = 60.0, .hub_radius = 2.8, .tip_radius = 89.0, .blades = 3, .chord = 3.9, .setting = 0.02};

}  // namespace

TEMPLATE_TEST_CASE("blade and momentum theory give the same force on the annulus", "[rotor][fast]", InductionMadsen,
                   InductionBuhl) {
  const double vx = GENERATE(3.0, 8.0, 11.0, 16.0), vy = GENERATE(30.0, 55.0, 70.0);
  const ElementState s = solve_element(ring, vx, vy, TestType(), section);
  REQUIRE(s.balanced);
  const double a = s.axial_induction, loss = loss_factor(ring, std::sin(s.inflow)), solidity = 3 * 3.9 / (2 * pi * 60.0);
  CHECK(s.speed * std::sin(s.inflow) == Approx(vx * (1 - a)));
  CHECK(s.speed * std::cos(s.inflow) == Approx(vy * (1 + s.tangential_induction)));
  const double ct = solidity * s.speed * s.speed * s.normal / (vx * vx);  // of the annulus, on the undisturbed wind
  if (std::is_same_v<TestType, InductionBuhl>) {
    const double momentum =
        a <= 0.4 ? 4 * a * loss * (1 - a) : 8.0 / 9 + (4 * loss - 40.0 / 9) * a + (50.0 / 9 - 4 * loss) * a * a;
    CHECK(ct == Approx(momentum).epsilon(1e-8));
  } else {
    const double c = ct / loss;
    CHECK(a == Approx(c > 0 ? ((0.0883 * c + 0.0586) * c + 0.246) * c : 0.5 * (1 - std::sqrt(1 - c))).epsilon(1e-8));
  }
  const double torque = solidity * s.speed * s.speed * s.tangential;
  CHECK(torque == Approx(4 * loss * s.tangential_induction * (1 - a) * vx * vy).epsilon(1e-7).margin(1e-9));
}

TEMPLATE_TEST_CASE("across the wind an annulus slows and turns all the air that goes along its wake", "[rotor][fast]",
                   InductionMadsen, InductionBuhl) {
  const double vx = GENERATE(3.0, 8.0, 16.0), vy = GENERATE(30.0, 60.0), cross = GENERATE(0.5, 5.0, 40.0);
  const ElementState s = solve_element(ring, vx, vy, TestType(), section, cross);
  REQUIRE(s.balanced);
  const double a = s.axial_induction, loss = loss_factor(ring, std::sin(s.inflow)), solidity = 3 * 3.9 / (2 * pi * 60.0);
  const double share = SkewedWake(std::atan2(cross, vx)).straight_share(a), through = vx * (1 - a) / share;
  const double ct = solidity * s.speed * s.speed * s.normal / (vx * vx), c = ct / loss * share;
  if (a <= 0.0 || (std::is_same_v<TestType, InductionBuhl> && a <= 0.4))
    CHECK(ct == Approx(4 * a * loss * through / vx).epsilon(1e-8));
  else if (std::is_same_v<TestType, InductionMadsen>)
    CHECK(a == Approx(((0.0883 * c + 0.0586) * c + 0.246) * c).epsilon(1e-8));
  CHECK(solidity * s.speed * s.speed * s.tangential ==
        Approx(4 * loss * s.tangential_induction * through * vy).epsilon(1e-7).margin(1e-9));
  // The more wind blows across, the less it is slowed; from the side alone hardly.
  CHECK(std::abs(a) < std::abs(solve_element(ring, vx, vy, TestType(), section).axial_induction));
  CHECK(solve_element(ring, 0.0, vy, TestType(), section, cross).speed == Approx(vy).epsilon(0.01));
}

TEST_CASE("a wake across the wind leans as a skewed cylinder of vortices does", "[rotor][fast]") {
  // tan(chi) = (tan(gamma) - a tan(chi/2)) / (1 - a): Burton et al. (2011), section 3.10.6.
  for (const double degrees : {5.0, 20.0, 40.0, 60.0, 80.0, 89.0})
    for (const double a : {0.0, 0.1, 0.2, 0.35}) {
      const double across = std::tan(degrees * radians_per_degree),
                   found = std::atan(SkewedWake(degrees * radians_per_degree).lean(a));
      double chi = found;
      for (int n = 0; n < 200; ++n) chi = std::atan((across - a * std::tan(0.5 * chi)) / (1 - a));
      CAPTURE(degrees, a);
      CHECK(found == Approx(chi).epsilon(0.01));
    }
  CHECK(SkewedWake(0.5 * pi).straight_share(0.3) < 1e-6);
}

TEST_CASE("the two inductions agree with momentum theory at light loading and differ beyond", "[rotor][fast]") {
  const double loss = GENERATE(0.5, 1.0), k = GENERATE(-0.5, 0.01, 0.1, 0.3);
  CHECK(InductionBuhl().slowdown(k, loss) == Approx(1 + k));
  CHECK(InductionMadsen().slowdown(k, loss) == Approx(1 + k).epsilon(0.006));
  CHECK(InductionBuhl().slowdown(2.0 / 3 + 1e-9, loss) == Approx(5.0 / 3).epsilon(1e-6));  // a = 0.4: the two branches meet
  double last = 0.0;
  for (double high = 1e-3; high < 1e9; high *= 2) {
    const double madsen = InductionMadsen().slowdown(high, loss);
    CHECK(madsen > last);  // more load, more induction, and never a standstill
    last = madsen;
    CHECK(std::isfinite(InductionBuhl().slowdown(high, loss)));
  }
}

TEST_CASE("Prandtl's factor is one far from the ends, zero at them, and both ends count", "[rotor][fast]") {
  Annulus s = ring;
  CHECK(loss_factor(s, 0.01) == Approx(1.0));
  s.radius = 88.999;
  CHECK(loss_factor(s, 0.1) < 0.05);
  s.radius = 2.801;
  CHECK(loss_factor(s, 0.5) < 0.05);
  s.radius = 80.0;
  CHECK(loss_factor(s, 0.1) == Approx(2 / pi * std::acos(std::exp(-1.5 * 9.0 / (80.0 * 0.1)))));
}

TEST_CASE("an empty section disturbs nothing", "[rotor][fast]") {
  const ElementState s = solve_element(ring, 11.0, 60.0, InductionMadsen(), [](double) { return SectionForce{0.0, 0.0}; });
  CHECK(s.axial_induction == Approx(0.0).margin(1e-12));
  CHECK(s.speed == Approx(std::hypot(11.0, 60.0)));
}

TEST_CASE("a symmetric blade in wind from behind is its mirror", "[rotor][fast]") {
  Annulus s = ring;
  const double vy = GENERATE(20.0, 60.0, -40.0), vx = GENERATE(5.0, 12.0);
  const ElementState front = solve_element(s, vx, vy, InductionBuhl(), section);
  s.setting = -s.setting;
  const ElementState back = solve_element(s, -vx, vy, InductionBuhl(), section);
  CHECK(back.normal == Approx(-front.normal));
  CHECK(back.tangential == Approx(front.tangential));
  CHECK(back.speed == Approx(front.speed));
}

TEST_CASE("no wind, wind from anywhere, standstill and feather give bounded forces", "[rotor][fast]") {
  std::mt19937 random(3);
  const auto pick = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  int unbalanced = 0;
  for (int n = 0; n < 20000; ++n) {
    Annulus s{.radius = pick(3.0, 88.9),
              .hub_radius = 2.8,
              .tip_radius = 89.0,
              .blades = 1 + n % 4,
              .chord = pick(0.1, 6.0),
              .setting = pick(-pi, pi)};
    const double vx = n % 7 == 0 ? 0.0 : pick(-60.0, 60.0), vy = n % 5 == 0 ? 0.0 : pick(-100.0, 100.0);
    const double cross = n % 3 == 0 ? 0.0 : pick(0.0, 60.0);
    const ElementState e = n % 2 ? solve_element(s, vx, vy, InductionMadsen(), section, cross)
                                 : solve_element(s, vx, vy, InductionBuhl(), section, cross);
    REQUIRE(std::isfinite(e.speed));
    REQUIRE(std::abs(e.normal) < 4.0);
    REQUIRE(e.speed <= 1.01 * std::hypot(vx, vy));  // a wake with many times the wind's speed would be a false balance
    unbalanced += !e.balanced && (vx != 0.0 || vy != 0.0);
  }
  CHECK(unbalanced == 0);
  CHECK(solve_element(ring, 0.0, 0.0, InductionMadsen(), section).speed == 0.0);
}

TEST_CASE("a blade that drives still air draws it along", "[rotor][fast]") {
  Annulus s = ring;
  s.setting = -0.1;  // nose out of the plane: thrust downwind on the blade, so air is sent upwind
  const ElementState e = solve_element(s, 0.0, 60.0, InductionMadsen(), section);
  REQUIRE(e.balanced);
  CHECK(e.inflow < 0.0);
  CHECK(e.normal > 0.0);
  const double near = solve_element(s, 1e-6, 60.0, InductionMadsen(), section).normal;
  CHECK(near == Approx(e.normal).epsilon(1e-4));
  // So it does against a weak wind, in whose place the other balance has air that stands.
  CHECK(solve_element(s, 0.1, 60.0, InductionMadsen(), section).normal == Approx(e.normal).epsilon(0.02));
  CHECK(solve_element(s, 1.0, 60.0, InductionMadsen(), section).speed == Approx(60.0).epsilon(0.01));
  // A breath of wind across is nothing beside what it draws.
  for (const double wind : {0.0, 1e-6, 1e-3})
    CHECK(solve_element(s, wind, 60.0, InductionMadsen(), section, 0.1).normal == Approx(e.normal).epsilon(0.01));
}

TEST_CASE("a skewed wake takes from the downwind side what it leaves to the upwind side", "[rotor][fast]") {
  const ElementState level = solve_element(ring, 11.0, 60.0, InductionMadsen(), section);
  const double skew = 30 * radians_per_degree,
               expected = 15 * pi / 32 * SkewedWake(skew).tangent_of_half(level.axial_induction) * 0.67;
  const double down = skewed(ring, level, 11.0, 60.0, skew, 0.67, section).axial_induction;
  const double up = skewed(ring, level, 11.0, 60.0, skew, -0.67, section).axial_induction;
  CHECK(down == Approx(level.axial_induction * (1 + expected)));
  CHECK(up == Approx(level.axial_induction * (1 - expected)));
  CHECK(skewed(ring, level, 11.0, 60.0, 0.0, 0.67, section).normal == Approx(level.normal));
}

TEST_CASE("a skewed wake tilts the induction as a skewed cylinder of vortex rings does", "[rotor][fast]") {
  const double skew = GENERATE(20.0, 30.0, 40.0) * radians_per_degree;
  const ElementState level = solve_element(ring, 11.0, 60.0, InductionMadsen(), section);
  const double slope = (skewed(ring, level, 11.0, 60.0, skew, 0.67, section).axial_induction / level.axial_induction - 1) / 0.67;
  // Rings of radius 1 along the skewed axis, closer together near the disc; normal velocity by Biot and Savart.
  const double chi = (0.6 * level.axial_induction + 1) * skew;
  constexpr int parts = 240, rings = 160;
  const auto induced = [&](double x, double y) {
    double sum = 0.0, from = 0.0;
    for (int k = 0; k < rings; ++k) {
      const double to = 1e-3 * std::pow(3e5, double(k + 1) / rings), at = 0.5 * (from + to);
      const double dx0 = x - at * std::sin(chi), dz = -at * std::cos(chi);
      for (int n = 0; n < parts; ++n) {
        const double angle = 2 * pi * (n + 0.5) / parts, c = std::cos(angle), s = std::sin(angle);
        const double dx = dx0 - c, dy = y - s;
        sum += (to - from) * (-s * dy - c * dx) / std::pow(dx * dx + dy * dy + dz * dz, 1.5) / parts;
      }
      from = to;
    }
    return sum;
  };
  double area = 0.0, total = 0.0, second = 0.0, first = 0.0;  // best straight line over the disc
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 12; ++j) {
      const double r = 0.95 * (i + 0.5) / 8, psi = pi * (j + 0.5) / 12, x = r * std::cos(psi), v = induced(x, r * std::sin(psi));
      area += r, total += r * v, second += r * x * x, first += r * x * v;
    }
  CHECK(slope == Approx(first / second * area / total).epsilon(0.1));
}

TEST_CASE("a section that stands still has the forces of one that hardly moves, to either side", "[rotor][fast]") {
  for (const double still : {0.0, -0.0, 1e-21, 1e-300})
    for (const double nearly : {1e-9, -1e-9}) {
      const auto at = [&](double motion) {
        return skewed(ring, solve_element(ring, 11.0, motion, InductionMadsen(), section), 11.0, motion, 0.2, 0.67, section);
      };
      CHECK(at(still).normal == Approx(at(nearly).normal).epsilon(1e-5));
      CHECK(at(still).tangential == Approx(at(nearly).tangential).epsilon(1e-5));
      CHECK(at(still).speed == Approx(at(nearly).speed).epsilon(1e-5));
    }
}
