// The Campbell table of the paper's turbine and the judgement of loose schemes.
// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/campbell.hpp"

#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"
#include "kernels/coupling/loose_limits.hpp"
#include "src/coupling/limits.hpp"
#include "tests/src/coupling/windows.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using namespace spindrift::coupling::test;

namespace {
using Catch::Matchers::Contains;
const std::string case3 = SPINDRIFT_SOURCE_DIR "/inputs/leble_barakos/case3_engineering.toml";
}  // namespace

TEST_CASE("1P of the DTU rotor and the sea states are the paper's, and meet near 9 m/s", "[coupling][fast]") {
  const auto floating = floating_of(case3, {});
  const Start start = make_start(*floating);
  const Stability s = stability(*floating, start.state);
  const Campbell c = campbell(floating->scenario(), s.linearisation, 8.8 * rad_s_per_rpm);
  REQUIRE(c.rows.size() == sea_states.size() + 1);
  CHECK(c.rows[1].wave == Approx(1 / 7.5));
  CHECK(c.rows[2].wave == Approx(1 / 8.8));
  CHECK(c.rows[2].once == Approx(0.131).epsilon(0.01));  // 7.5 U / R at 9.8 m/s
  CHECK(c.rows[3].once == Approx(0.160));                // 9.6 rpm from 12 m/s
  CHECK(c.rows[3].passing == Approx(0.480));
  CHECK(c.rows.back().once == Approx(8.8 / 60));
  CHECK(c.rows.back().wave == Approx(1 / 8.8));
  REQUIRE(c.meets_waves_m_s.size() == 1);
  CHECK(c.meets_waves_m_s[0] ==
        Approx(9.0).margin(0.3));  // "for sea states between 3 and 4 (or wind speed about 9m/s) resonances may occur"
  const auto& pairs = c.rows.back().together;
  CHECK(std::any_of(pairs.begin(), pairs.end(), [](const std::string& p) { return p.rfind("waves and heave", 0) == 0; }));
}

TEST_CASE("a loose scheme will do for the paper's turbine at windows of 0.02 s, not at 5 s", "[coupling][fast]") {
  const auto verdict_at = [](const std::string& window) {
    const auto floating = floating_of(case3, {"time.end_s=10.0", "time.window_s=" + window, "time.step_s=0.02"});
    const Start start = make_start(*floating);
    const bodies::Linearisation linear = stability(*floating, start.state).linearisation;
    return loose_verdict(*floating, start.state, campbell(floating->scenario(), linear, 8.8 * rad_s_per_rpm), linear);
  };
  const LooseVerdict fine = verdict_at("0.02"), coarse = verdict_at("5.0");
  CHECK(fine.slope_N_s_m == Approx(162.5e3).epsilon(0.03));
  CHECK(fine.hub_mass_kg == Approx(1.6e6).epsilon(0.3));  // 1 / (1/m + h^2/I), with the water's mass
  CHECK(fine.schemes[1].will_do);
  CHECK(fine.schemes[1].missed < 0.1 * fine.schemes[0].missed);
  for (const auto& scheme : coarse.schemes) CHECK_FALSE(scheme.will_do);
  // 259 m of blade with a chord of 4.7 m (root mean square) carry 5.5 t of air: far below what any loose scheme bears.
  CHECK(fine.air_mass_kg == Approx(259.0 * 0.25 * pi * 1.225 * 4.7 * 4.7).epsilon(0.1));
  CHECK(fine.mass_ratio() == Approx(fine.air_mass_kg / fine.hub_mass_kg));
  CHECK(fine.schemes[0].mass_ratio_limit == Approx(1.0).epsilon(1e-6));
  CHECK(fine.schemes[1].mass_ratio_limit == Approx(stability_ratio(cps2_polynomial)));
  CHECK(fine.schemes[2].mass_ratio_limit == Approx(1.0 / 3.0).epsilon(1e-6));
}

TEST_CASE("a tower that stretches and twists does not count among what a loose scheme must follow", "[coupling][fast]") {
  const auto floating = floating_of(SPINDRIFT_SOURCE_DIR "/inputs/leble_barakos/flexible_tower.toml", {});
  const Start start = make_start(*floating);
  const bodies::Linearisation linear = stability(*floating, start.state).linearisation;
  const Campbell c = campbell(floating->scenario(), linear, 8.8 * rad_s_per_rpm);
  const LooseVerdict verdict = loose_verdict(*floating, start.state, c, linear);
  double stretching = 0.0, rest = 0.0;
  for (const auto& [name, f] : c.platform) {
    double& most = name == "stretching of tower" ? stretching : rest;
    most = std::max(most, f);
  }
  INFO(stretching << " Hz, " << rest << " Hz, " << verdict.fastest_Hz << " Hz");
  CHECK(stretching > 2.0 * rest);
  CHECK(verdict.fastest_Hz == rest);
}

TEST_CASE("no loose scheme will do where the air weighs as much as the floating system", "[coupling][fast]") {
  const auto floating = floating_of(
      case3, {"time.end_s=10.0", "time.window_s=0.02", "time.step_s=0.02", "environment.air_density_kg_m3=99.0",
              "bodies.platform.mass_kg=2000", "bodies.rotor.mass_kg=1000", "bodies.platform.inertia_kg_m2=[1e7, 1e7, 1e7]",
              "bodies.rotor.inertia_kg_m2=[1e6, 1e6, 1e6]", "start.equilibrium=false", "sea.added_mass_coefficient=0.0"});
  const Start start = make_start(*floating);
  const bodies::Linearisation linear = stability(*floating, start.state).linearisation;
  const LooseVerdict verdict =
      loose_verdict(*floating, start.state, campbell(floating->scenario(), linear, 8.8 * rad_s_per_rpm), linear);
  CHECK(verdict.mass_ratio() > 1.0);
  for (const auto& scheme : verdict.schemes) CHECK_FALSE(scheme.will_do);
}

TEST_CASE("a scene's own loose scheme is judged by the order that it asks for, and refused beyond its limit",
          "[coupling][fast]") {
  const auto asked = [](int order, const std::string& window) {
    return floating_of(case3, {"time.end_s=70.0", "time.window_s=" + window, "time.step_s=0.02", "coupling.scheme=css",
                               "coupling.predictor_order=" + std::to_string(order)});
  };
  const auto judged = [&](int order) {
    const auto floating = asked(order, "0.02");
    const Start start = make_start(*floating);
    const bodies::Linearisation linear = stability(*floating, start.state).linearisation;
    return loose_verdict(*floating, start.state, campbell(floating->scenario(), linear, 8.8 * rad_s_per_rpm), linear)
        .schemes.back();
  };
  const LooseVerdict::Scheme zero = judged(0), one = judged(1), two = judged(2);
  CHECK(zero.name == "css0");
  CHECK(two.name == "css2");
  CHECK(zero.mass_ratio_limit == Approx(1.0).epsilon(1e-6));
  CHECK(two.mass_ratio_limit == Approx(1.0 / 7.0).epsilon(1e-6));
  CHECK(zero.window_limit_s > one.window_limit_s);
  CHECK(one.window_limit_s > two.window_limit_s);
  const auto require = [&](int order) {
    const auto floating = asked(order, "5");
    const Start start = make_start(*floating);
    require_limits(*floating, start.state, stability(*floating, start.state));
  };
  CHECK_NOTHROW(require(1));
  CHECK_THROWS_WITH(require(2), Contains("time.window_s") && Contains("css2"));
}

TEST_CASE("what a scheme misses falls with its order in the window", "[coupling][fast]") {
  const double omega = 1.0;
  for (const auto& [scheme, p] : {std::pair{Staggering::cps(), 1},
                                  {Staggering::css(0), 1},
                                  {Staggering::cps2(), 2},
                                  {Staggering::css(1), 2},
                                  {Staggering::css(2), 3}})
    CHECK(missed_part(scheme, omega, 0.02) / missed_part(scheme, omega, 0.01) == Approx(std::pow(2.0, p)).epsilon(0.03));
  CHECK(missed_part(Staggering::cps(), omega, 0.01) == Approx(0.02).epsilon(0.01));  // two windows late at its end
}

namespace {

/// A mass of 1 kg under the damping load y = -v, and the spring that holds it.
LooseLoop mass_on_spring(double stiffness) {
  LooseLoop loop{Eigen::MatrixXd::Zero(2, 2), Eigen::Vector2d(0.0, 1.0), Eigen::RowVector2d(0.0, -1.0)};
  loop.matrix(0, 1) = 1.0, loop.matrix(1, 0) = -stiffness;
  return loop;
}
double limit(const LooseLoop& loop, const Staggering& scheme) { return window_limit(loop, scheme, 1e-6, 0.01, 100.0); }

}  // namespace

TEST_CASE("a load that damps a free mass has limits that are known", "[coupling][fast]") {
  const LooseLoop free = mass_on_spring(0.0);
  CHECK(limit(free, Staggering::css(0)) == Approx(2.0).epsilon(1e-3));         // Euler's
  CHECK(limit(free, Staggering::css(1)) == Approx(1.0).epsilon(1e-3));         // Adams and Bashforth's, of order 2
  CHECK(limit(free, Staggering::css(2)) == Approx(6.0 / 11.0).epsilon(1e-3));  // and 3
  CHECK(limit(free, Staggering::cps()) == Approx(1.0).epsilon(1e-3));          // z^2 - z + s
}

TEST_CASE("a spring lowers the window at which a load that damps makes a mass swing", "[coupling][fast]") {
  for (const Staggering& scheme : {Staggering::cps(), Staggering::cps2(), Staggering::css(0)}) {
    const double free = limit(mass_on_spring(0.0), scheme), held = limit(mass_on_spring(9.0), scheme);
    CHECK(held < free);
    for (const double share : {0.97, 1.03}) {
      const double radius = growth(mass_on_spring(9.0), scheme, share * held);
      CHECK((radius > 1.0) == (share > 1.0));
    }
  }
}
