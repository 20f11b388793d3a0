// The decisions of a march: growth, back-off, ends.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/control.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace spindrift::aero;

namespace {
Norms of(double residual) {
  return {.density = residual * residual, .mass = 4.0 * residual * residual, .mean = residual * residual, .cells = 1.0};
}
}  // namespace

TEST_CASE("a falling residual raises the CFL number up to its limit and ends at the drop asked for", "[flow][fast]") {
  March march({.cfl_start = 5.0, .cfl_max = 100.0, .drop = 1e-3});
  march.begin_step();
  double residual = 1.0;
  for (int n = 0; n < 30 && march.judge(of(residual), 0.0) == Verdict::go_on; ++n) march.updated(1.0, 5, 0.1), residual *= 0.5;
  CHECK(march.cfl() == 100.0);
  CHECK(march.verdict() == Verdict::converged);
  CHECK(march.steps() == 11);
  CHECK(march.mass_residual() == 2.0 * march.density_residual());
}

TEST_CASE("a residual that leaps or is not finite takes the step back and makes the next one smaller", "[flow][fast]") {
  for (const double leap : {1e3, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    March march({.cfl_start = 10.0});
    march.begin_step();
    REQUIRE(march.judge(of(1.0), 0.0) == Verdict::go_on);
    march.updated(1.0, 5, 0.1);
    CHECK(march.judge(of(leap), 0.0) == Verdict::rejected);
    CHECK(march.cfl() == Approx(2.0));
    CHECK(march.judge(of(1.0), 0.0) == Verdict::go_on);
  }
}

TEST_CASE("a step whose matrix was singular is taken back and the next one is smaller", "[flow][fast]") {
  March march({.cfl_start = 10.0});
  march.begin_step();
  REQUIRE(march.judge(of(1.0), 0.0) == Verdict::go_on);
  march.not_updated();
  CHECK(march.judge(of(1.0), 0.0) == Verdict::rejected);
  CHECK(march.cfl() == Approx(2.0));
  CHECK(march.judge(of(1.0), 0.0) == Verdict::go_on);
}

TEST_CASE("a march that is asked to stop ends as one whose steps are spent; an eased one keeps to a smaller CFL number",
          "[flow][fast]") {
  March march({.cfl_start = 10.0, .cfl_max = 1000.0});
  march.begin_step();
  march.judge(of(1.0), 0.0);
  march.stop();
  CHECK(ends_march(march.verdict()));
  CHECK(march.spent());
  march.ease(0.1);
  CHECK(march.cfl() == Approx(1.0));
  march.ease(1.0);
  CHECK(march.cfl() == Approx(1.0));  // it grows from there
}

TEST_CASE("what no step size cures ends in a failure with its reason", "[flow][fast]") {
  March march({.cfl_start = 10.0});
  march.begin_step();
  march.judge(of(1.0), 0.0);
  Verdict verdict = Verdict::go_on;
  for (int n = 0; n < 100 && verdict != Verdict::failed; ++n) {
    march.updated(1.0, 5, 0.1);
    verdict = march.judge(of(1e9), 0.0);
    if (verdict == Verdict::rejected) march.judge(of(1.0), 0.0);
  }
  CHECK(verdict == Verdict::failed);
  CHECK(std::string(march.why()) == "no pseudo-step was small enough");
  March broken({});
  broken.begin_step();
  CHECK(broken.judge(of(std::numeric_limits<double>::quiet_NaN()), 0.0) == Verdict::failed);
}

TEST_CASE("linear systems that were hardly solved lower the CFL number, shortened updates hold it", "[flow][fast]") {
  March march({.cfl_start = 10.0});
  march.begin_step();
  march.judge(of(1.0), 0.0);
  march.updated(1.0, 20, 0.95);
  march.judge(of(0.9), 0.0);
  CHECK(march.cfl() == Approx(6.0));
  march.updated(0.5, 20, 0.1);
  march.judge(of(0.8), 0.0);
  CHECK(march.cfl() == Approx(6.0));
}

TEST_CASE("a density residual below the absolute limit ends a march whatever its drop", "[flow][fast]") {
  March march({.drop = 0.0, .absolute = 1e-2});
  march.begin_step();
  double residual = 1.0;
  while (march.judge(of(residual), 0.0) == Verdict::go_on) march.updated(1.0, 5, 0.1), residual *= 0.5;
  CHECK(march.verdict() == Verdict::converged);
  CHECK_FALSE(march.spent());
  CHECK(residual == 1.0 / 128);
}

TEST_CASE("loads that have settled end a march where asked", "[flow][fast]") {
  March march({.drop = 0.0, .load_change = 1e-3, .load_window = 5});
  march.begin_step();
  int steps = 0;
  for (double load = 1.0; steps < 100 && march.judge(of(1.0), 10.0 + load) == Verdict::go_on; ++steps)
    march.updated(1.0, 5, 0.1), load *= 0.5;
  CHECK(steps > 5);
  CHECK(steps < 20);
}
