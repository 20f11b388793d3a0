// The steps of a window as plain numbers: they end where the window does, none is beyond the limit, and failures are named.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/step_plan.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace spindrift;
using namespace spindrift::sph;

namespace {

constexpr double anywhere = 1e9;  // particles may go [m]

Parameters still_water() {
  Parameters p;
  p.spacing = 0.1, p.eos = {1000.0, 30.0};
  return p;
}

/// Runs a window of one second with a limit that grows and shrinks; returns the lengths of its steps.
std::vector<double> steps_of_window(const StepControl& control) {
  Plan plan;
  Work work;
  plan.left = 1.0;
  std::vector<double> made;
  for (int n = 0; plan.left > 0.0 && n < 10000; ++n) {
    plan.limit = 0.01 * (1.0 + 0.5 * std::sin(double(n)));
    plan.choose_steps(control, anywhere);
    REQUIRE_FALSE(plan.failure);
    REQUIRE(plan.planned > 0);
    CHECK(std::max(plan.dt, plan.last_dt) <= plan.limit * (1.0 + 1e-12));
    for (int k = 0; k < plan.planned; ++k) made.push_back(plan.dt_of(k));
    plan.finish_steps(control, StepChoice::symplectic, work);
  }
  CHECK(plan.time == Approx(1.0).epsilon(1e-12));
  CHECK(work.steps == long(made.size()));
  CHECK(work.evaluations == 2 * work.steps);
  return made;
}

}  // namespace

TEST_CASE("after a sort nothing of what moved before it counts", "[sph][step_plan][fast]") {
  Plan plan;
  plan.drift = plan.travel = plan.solid_drift = plan.solid_travel = plan.shifted = 0.01;
  plan.sort = true;
  plan.sorted();
  CHECK_FALSE(plan.sort);
  for (const double moved : {plan.drift, plan.travel, plan.solid_drift, plan.solid_travel, plan.shifted}) CHECK(moved == 0.0);
}

TEST_CASE("the steps of a window add up to it and stay below the limit", "[sph][step_plan][fast]") {
  SECTION("one by one") { CHECK(steps_of_window({}).size() > 66); }
  SECTION("some at a time, with a margin for limits that tighten") {
    const auto several = steps_of_window({.steps_per_check = 7});
    CHECK(several.size() > steps_of_window({}).size());
  }
  SECTION("fixed ones") {
    const auto fixed = steps_of_window({.dt = 4e-3, .steps_per_check = 3});
    CHECK(fixed.size() == 250);
  }
  SECTION("chosen from outside") {
    int asked = 0;
    const auto chosen = steps_of_window({.choose = [&](double, int most) {
      CHECK(most == 1);
      return StepControl::Choice{1e-3, ++asked == 1000};
    }});
    CHECK(chosen.size() == 1000);
  }
  SECTION("chosen from outside, some at a time, the last of them longer") {
    int asked = 0;
    const auto chosen = steps_of_window({.steps_per_check = 7, .choose = [&](double, int most) {
                                           CHECK(most == 7);
                                           return StepControl::Choice{1e-3, ++asked == 100, 7, 4e-3};
                                         }});
    CHECK(asked == 100);
    REQUIRE(chosen.size() == 700);
    CHECK(chosen[5] == 1e-3);
    CHECK(chosen[6] == 4e-3);
  }
}

TEST_CASE("a window whose steps are chosen from outside is as long as who chooses them says", "[sph][step_plan][fast]") {
  Plan plan;
  Work work;
  plan.left = 1.0;
  int asked = 0;
  const StepControl control{.choose = [&](double, int) { return StepControl::Choice{0.3, ++asked == 10}; }};
  while (plan.left > 0.0) plan.choose_steps(control, anywhere), plan.finish_steps(control, StepChoice::symplectic, work);
  CHECK(asked == 10);
  CHECK(plan.time == Approx(3.0));
}

TEST_CASE("steps between two checks keep particles near where they were sorted", "[sph][step_plan][fast]") {
  const Parameters p = still_water();
  Plan plan;
  plan.check_limits(p, 1e9, 4.0, 0.0, 0.0);  // 2 m/s
  const int most = plan.steps_within(p.drift(), 1000);
  CHECK(most > 1);
  CHECK(most < 1000);
  CHECK(2.0 * most * plan.limit <= p.drift());
  CHECK(2.0 * (most + 1) * plan.limit > p.drift());
  CHECK(plan.steps_within(p.drift(), 2) == 2);
  plan.choose_steps({.steps_per_check = 1000,
                     .choose =
                         [&](double limit, int allowed) {
                           CHECK(allowed == most);
                           return StepControl::Choice{limit, false, allowed};
                         }},
                    p.drift());
  CHECK(plan.planned == most);
  CHECK(plan.steps_within(p.drift(), 1000) == 1);
  // What shifting adds is known of the farthest step alone.
  plan.shifted = 1e-3;
  Work work;
  plan.finish_steps({.choose = [](double, int) { return StepControl::Choice{1.0, false}; }}, StepChoice::symplectic, work);
  CHECK(plan.shifted == Approx(most * 1e-3));
}

TEST_CASE("steps that cannot be made end the window with a failure that says why", "[sph][step_plan][fast]") {
  Plan plan;
  plan.left = 1.0;
  SECTION("a fixed step beyond the limit") {
    plan.limit = 1e-3;
    plan.choose_steps({.dt = 2e-3}, anywhere);
    REQUIRE(plan.failure);
    CHECK_THAT(plan.failure->what(), Catch::Contains("0.002 s is beyond the limit of 0.001 s"));
    CHECK(plan.planned == 0);
  }
  SECTION("a driver that gives up") {
    plan.choose_steps({.choose = [](double, int) -> StepControl::Choice {
                        throw NumericalFailure("bodies: no step is small enough", "bodies", 3, 0.5, 1.0);
                      }},
                      anywhere);
    REQUIRE(plan.failure);
    CHECK_THAT(plan.failure->what(), Catch::Contains("bodies: no step"));
    CHECK(plan.planned == 0);
  }
  SECTION("particles that fly at a hundred times the speed of sound") {
    const double speed = 1e4 * still_water().eos.c0;
    plan.check_limits(still_water(), 1e9, speed * speed, 1e12 * speed * speed, 0.0);
    REQUIRE(plan.failure);
    CHECK_THAT(plan.failure->what(), Catch::Contains("the stable step fell to"));
  }
  Work work;
  plan.finish_steps({}, StepChoice::symplectic, work);
  CHECK(plan.left == 0.0);
  CHECK(work.steps == 0);
}

TEST_CASE("particles are sorted before they could leave their cells, bodies' ways counted", "[sph][step_plan][fast]") {
  const Parameters p = still_water();
  Plan plan;
  plan.check_limits(p, 1e9, 4.0, 0.0, 0.0);  // 2 m/s
  CHECK(plan.limit == Approx(plan.limits.smallest()));
  int steps = 0;
  for (; !plan.sort_is_due(p.drift()); ++steps) plan.start_steps(1e-3, 1);
  CHECK(steps * 2.0 * 1e-3 <= p.drift());
  CHECK((steps + 3) * 2.0 * 1e-3 > p.drift());
  plan.sorted();
  CHECK_FALSE(plan.sort_is_due(p.drift()));
  plan.count_travel_of_body(1.1 * p.drift());
  CHECK(plan.sort_is_due(p.drift()));
  plan.sorted();
  CHECK(plan.solid_path == Approx(1.1 * p.drift()));
}
