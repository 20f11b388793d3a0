// The decisions of a march: growth, back-off, ends.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/control.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <vector>

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
  CHECK(march.state().cfl == 100.0);
  CHECK(march.state().verdict == Verdict::converged);
  CHECK(march.state().steps == 11);
  CHECK(march.state().mass_residual == 2.0 * march.state().now.density);
}

TEST_CASE("a residual that leaps or is not finite takes the step back and makes the next one smaller", "[flow][fast]") {
  for (const double leap : {1e3, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    March march({.cfl_start = 10.0});
    march.begin_step();
    REQUIRE(march.judge(of(1.0), 0.0) == Verdict::go_on);
    march.updated(1.0, 5, 0.1);
    CHECK(march.judge(of(leap), 0.0) == Verdict::rejected);
    CHECK(march.state().cfl == Approx(2.0));
    CHECK(march.judge(of(1.0), 0.0) == Verdict::go_on);
  }
}

TEST_CASE("a step whose matrix was singular is taken back and the next one is smaller", "[flow][fast]") {
  March march({.cfl_start = 10.0});
  march.begin_step();
  REQUIRE(march.judge(of(1.0), 0.0) == Verdict::go_on);
  march.not_updated();
  CHECK(march.judge(of(1.0), 0.0) == Verdict::rejected);
  CHECK(march.state().cfl == Approx(2.0));
  CHECK(march.judge(of(1.0), 0.0) == Verdict::go_on);
}

TEST_CASE("a march that is asked to stop ends as one whose steps are spent; an eased one keeps to a smaller CFL number",
          "[flow][fast]") {
  March march({.cfl_start = 10.0, .cfl_max = 1000.0});
  march.begin_step();
  march.judge(of(1.0), 0.0);
  march.stop();
  CHECK(ends_march(march.state().verdict));
  CHECK(march.state().spent);
  march.ease(0.1);
  CHECK(march.state().cfl == Approx(1.0));
  march.ease(1.0);
  CHECK(march.state().cfl == Approx(1.0));  // it grows from there
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
  CHECK(std::string(march.state().why) == "no pseudo-step was small enough");
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
  CHECK(march.state().cfl == Approx(6.0));
  march.updated(0.5, 20, 0.1);
  march.judge(of(0.8), 0.0);
  CHECK(march.state().cfl == Approx(6.0));
}

TEST_CASE("cells that had a limit are those of the step that led to a state, also where a restart judges it again",
          "[flow][fast]") {
  March march({.cfl_start = 10.0});
  march.begin_step();
  march.judge(of(1.0), 0.0);
  march.updated(0.5, 5, 0.1);
  Norms counted = of(0.9);
  counted.limited = 3.0, counted.clipped = 7.0;
  march.judge(counted, 0.0);
  CHECK(march.state().last.limited == 3.0);
  CHECK(march.state().last.clipped == 7.0);
  March again({.cfl_start = 10.0});
  again.load(march.save());
  again.resume();
  again.judge(of(0.9), 0.0);  // tiles that were made anew have counted nothing
  CHECK(again.state().last.limited == 3.0);
  CHECK(again.state().last.clipped == 7.0);
  again.updated(1.0, 5, 0.1);
  again.judge(of(0.8), 0.0);
  CHECK(again.state().last.limited == 0.0);
  CHECK(again.state().last.clipped == 0.0);
}

TEST_CASE("a density residual below the absolute limit ends a march whatever its drop", "[flow][fast]") {
  March march({.drop = 0.0, .absolute = 1e-2});
  march.begin_step();
  double residual = 1.0;
  while (march.judge(of(residual), 0.0) == Verdict::go_on) march.updated(1.0, 5, 0.1), residual *= 0.5;
  CHECK(march.state().verdict == Verdict::converged);
  CHECK_FALSE(march.state().spent);
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

TEST_CASE("loads that rest as steps have no length have not settled", "[flow][fast]") {
  const MarchOptions options{.cfl_start = 2.0, .drop = 0.0, .load_change = 1e-3, .load_window = 5, .max_steps = 60};
  const auto steps = [&](double fraction, double linear_drop) {
    March march(options);
    march.begin_step();
    while (march.judge(of(1.0), 10.0) == Verdict::go_on) march.updated(fraction, 5, linear_drop);
    return march.state().steps;
  };
  CHECK(steps(1.0, 0.1) == 6);   // full steps
  CHECK(steps(0.01, 0.1) > 60);  // updates cut short
  CHECK(steps(1.0, 0.95) > 60);  // a CFL number that falls, as linear systems are not solved
}

TEST_CASE("by the flux balance a march ends when mean flow and turbulence have both fallen from the start", "[flow][fast]") {
  const auto state = [](double mean, double model) {
    return Norms{.density = 1e-12, .mean = mean * mean, .model = model * model, .cells = 1.0};
  };
  March march({.drop = 1e-2, .by_balance = true});
  march.begin_step();
  march.judge(state(1.0, 0.0), 0.0);
  march.updated(1.0, 5, 0.1);
  CHECK(march.judge(state(1e-3, 0.5), 0.0) == Verdict::go_on);  // turbulence is on its way
  march.updated(1.0, 5, 0.1);
  CHECK(march.judge(state(1e-3, 1e-3), 0.0) == Verdict::converged);
  CHECK(march.state().balance_drop() == Approx(1e-3));
  // Turbulence that starts with a thousand times the mean flow's is no reason to leave that where it is.
  March other({.drop = 1e-2, .by_balance = true});
  other.begin_step();
  other.judge(state(1.0, 1e3), 0.0);
  other.updated(1.0, 5, 0.1);
  CHECK(other.judge(state(0.5, 1.0), 0.0) == Verdict::go_on);
  other.updated(1.0, 5, 0.1);
  CHECK(other.judge(state(1e-3, 1.0), 0.0) == Verdict::converged);
}

TEST_CASE("the drop of a start at rest counts from what was judged before it, alone", "[flow][fast]") {
  const auto steps_to_end = [](bool alone, double judged) {
    March march({.drop = 1e-3, .by_balance = true, .matrix_free_below = 0.0});
    march.judge_only();
    march.begin_step();
    march.judge(of(judged), 0.0);
    march.begin_after_judging(alone);
    double residual = 128.0;
    while (march.judge(of(residual), 0.0) == Verdict::go_on) march.updated(1.0, 5, 0.1), residual *= 0.5;
    return march.state().steps - 1;
  };
  CHECK(steps_to_end(false, 1.0) == 10);
  CHECK(steps_to_end(true, 1.0) == 17);
  CHECK(steps_to_end(true, 0.0) == 10);  // a stream that nothing disturbs is no start to count from
}

TEST_CASE("a balance that is round-off from the start has converged", "[flow][fast]") {
  March march({.drop = 1e-6, .by_balance = true});
  march.begin_step();
  const Norms noise{.mean = 1e-26, .cells = 1.0, .noise = 1e-24};
  march.judge(noise, 0.0);
  march.updated(1.0, 5, 0.1);
  CHECK(march.judge(noise, 0.0) == Verdict::converged);
  CHECK_FALSE(march.state().spent);
}

TEST_CASE("marches that end for want of steps are counted, and the count goes through a restart", "[flow][fast]") {
  March march({.drop = 1e-6, .max_steps = 3});
  for (int window = 0; window < 2; ++window) {
    march.begin_step();
    while (march.judge(of(1.0), 0.0) == Verdict::go_on) march.updated(1.0, 5, 0.1);
    CHECK(march.state().spent);
  }
  March again({.drop = 1e-6, .max_steps = 3});
  again.load(march.save());
  CHECK(again.state().unconverged == 2);
  CHECK(again.state().ended == 2);
  again.resume();  // a steady march that goes on has not ended
  CHECK(again.state().unconverged == 1);
}

TEST_CASE("a steady march makes as many steps at once as it is told, and no more than its options have", "[flow][fast]") {
  March march({.drop = 0.0, .max_steps = 5});
  const auto made = [&] {
    int steps = 0;
    for (; march.judge(of(1.0), 0.0) == Verdict::go_on; ++steps) march.updated(1.0, 5, 0.1);
    return steps;
  };
  march.limit(2);
  march.begin_step();
  CHECK(made() == 2);
  march.limit(3);
  march.resume();
  CHECK(made() == 3);
  march.limit(100);
  march.resume();
  CHECK(made() == 5);
}

TEST_CASE("a march stands still where its balance is not halved for long, far from its end or at no step size", "[flow][fast]") {
  const auto marched = [](double from, double to, int steps) {
    March march({.drop = 1e-6, .by_balance = true, .max_steps = 1000});
    march.begin_step();
    march.judge(of(1.0), 0.0);
    for (double residual = from; steps > 0; --steps, residual = to) march.updated(1.0, 5, 0.1), march.judge(of(residual), 0.0);
    return march;
  };
  CHECK_FALSE(marched(0.1, 0.09, 200).stands_still());
  const March still = marched(0.1, 0.09, 201);
  CHECK(still.stands_still());
  CHECK_FALSE(marched(0.1, 0.04, 201).stands_still());   // it came to half once more
  CHECK_FALSE(marched(1e-4, 9e-5, 400).stands_still());  // a flow that swings a little is near its end
  March again({.drop = 1e-6, .by_balance = true});
  again.load(still.save());
  CHECK(again.stands_still());
  again.begin_again();
  CHECK_FALSE(again.stands_still());
  CHECK(again.state().cfl == 5.0);
  again.judge(of(1.0), 0.0);
  CHECK(again.state().steps_made() == 201);  // what was spent counts
  March no_length({.cfl_start = 0.01, .cfl_max = 0.01, .drop = 1e-6, .by_balance = true});
  no_length.begin_step();
  no_length.judge(of(1.0), 0.0);
  CHECK(no_length.stands_still());
  March all_steps({.cfl_start = 0.01, .cfl_max = 0.01, .drop = 0.0, .by_balance = true});  // it is to take them all
  all_steps.begin_step();
  all_steps.judge(of(1.0), 0.0);
  CHECK_FALSE(all_steps.stands_still());
}

TEST_CASE("a march that goes in circles with the stored matrix takes the linearised residual for good", "[flow][fast]") {
  const MarchOptions options{.drop = 1e-3, .by_balance = true, .max_steps = 50, .matrix_free_below = 1e-2};
  const auto circle = [](March& march, double at, int steps) {
    for (int n = 0; n < steps; ++n) {
      REQUIRE(march.judge(of(at), 0.0) == Verdict::go_on);
      march.updated(1.0, 5, 0.1);
    }
  };
  March march(options);
  march.begin_step();
  circle(march, 1.0, 1);
  const std::vector<double> before = march.save();
  circle(march, 0.1, 6);
  CHECK(!march.state().matrix_free);
  circle(march, 0.1, 1);
  CHECK(march.state().matrix_free);
  march.begin_step();
  circle(march, 1.0, 1);
  CHECK(march.state().matrix_free);
  March restarted(options);
  restarted.load(march.save());
  restarted.begin_step();
  circle(restarted, 1.0, 1);
  CHECK(restarted.state().matrix_free);
  march.load(before);  // a window that is made again begins as it did
  circle(march, 0.1, 1);
  CHECK(!march.state().matrix_free);

  // A balance that falls, however it goes on, and windows whose number of steps is given keep the matrix.
  March falls(options);
  falls.begin_step();
  double at = 1.0;
  for (int n = 0; n < 20; ++n, at *= 0.87) circle(falls, at, 1);
  CHECK(!falls.state().matrix_free);
  March all({.drop = 0.0, .by_balance = true, .max_steps = 50, .matrix_free_below = 1e-2});
  all.begin_step();
  circle(all, 1.0, 1), circle(all, 0.1, 20);
  CHECK(!all.state().matrix_free);
}

TEST_CASE("a look at a march that has begun judges its state again and changes nothing", "[flow][fast]") {
  March march({.drop = 1e-6, .by_balance = true, .max_steps = 3});
  march.begin_step();
  while (march.judge(of(0.5), 0.0) == Verdict::go_on) march.updated(1.0, 5, 0.1);
  const int steps = march.state().steps;
  const double cfl = march.state().cfl;
  march.judge_only();
  march.resume();
  CHECK(march.judge(of(0.5), 0.0) == Verdict::converged);
  CHECK(march.state().spent);
  CHECK(march.state().steps == steps);
  CHECK(march.state().cfl == cfl);
  CHECK(march.state().unconverged == 1);
}
