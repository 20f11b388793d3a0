// Coupling at its extremes: added-mass ratios by scheme, parts that answer nonsense, limits hit, time scales far apart.
// Each ends converged or with a named bound; nothing that is not finite is ever accepted.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "tests/kernels/coupling/linear_window.hpp"
#include "tests/verification/coupling/fowt.hpp"

using namespace spindrift::coupling;
using namespace spindrift::coupling::test;

namespace {

template <class F>
void with_each_scheme(const F& f) {
  constexpr double relaxation = 0.01;
  f(RelaxationConstant(relaxation)), f(RelaxationAitken(relaxation)), f(RelaxationSteepestDescent(relaxation));
  f(IqnIls(relaxation, {.reuse = 2})), f(IbqnLs(relaxation, {.reuse = 2})), f(InterfaceGmres(relaxation, {.reuse = 2}));
  f(Newton(1e-3));
}

/// A part that answers by `rule`, given the number of the call.
struct Odd {
  std::function<Vector(const Vector&, int)> rule;
  int calls = 0;
  bool finished = false;
  std::vector<Vector> accepted{};
  Vector last{};
  Vector first(const Vector& x) { return x; }
  Vector second(const Vector& y) { return last = rule(y, ++calls); }
  Vector evaluate(const Vector& x) { return evaluate_serial(*this, x); }
  Vector guess() const { return Vector::Zero(6); }
  void accept() { accepted.push_back(last), finished = true; }
  bool done() const { return finished; }
  bool halve() { return calls < 500; }
};

}  // namespace

TEST_CASE("added mass from a thousandth to a hundred times the structure's: every scheme converges or names its limit",
          "[extremes][fast]") {
  const double r = GENERATE(1e-3, 0.1, 1.0, 10.0, 100.0);
  with_each_scheme([r](auto scheme) {
    INFO(scheme.name << " at r = " << r);
    LinearWindow window(r);
    const WindowLog log = solve_window(window, scheme, {.relative = 1e-6, .max_evaluations = 3000, .fallback_relaxation = 0.01});
    CHECK(log.ok());
    CHECK(log.evaluations <= 3000);
    CHECK(log.residual <= 1e-6 * log.first_residual);
  });
}

TEST_CASE("a part that returns NaN is named and nothing of it is accepted", "[extremes][fast]") {
  const int from = GENERATE(1, 2);
  with_each_scheme([from](auto scheme) {
    INFO(scheme.name << ", NaN from call " << from);
    Odd part{[from](const Vector& x, int call) {
      return Vector(call >= from ? Vector::Constant(6, std::nan("")) : Vector(Vector::Constant(6, 1.0) - 5.0 * x));
    }};
    const WindowLog log = solve_window(part, scheme, {.max_evaluations = 30});
    CHECK_FALSE(log.ok());
    CHECK(log.bound == Bound::not_finite);
    CHECK(part.accepted.empty());
  });
}

TEST_CASE("a part that returns NaN once is retried", "[extremes][fast]") {
  Odd part{[](const Vector& x, int call) {
    return Vector(call == 2 ? Vector::Constant(6, std::nan("")) : Vector(Vector::Constant(6, 1.0) - 5.0 * x));
  }};
  IqnIls scheme(0.1, {});
  const WindowLog log = solve_window(part, scheme, {});
  CHECK(log.ok());
  CHECK(log.retries == 1);
  CHECK(part.accepted.front().allFinite());
}

TEST_CASE("a part that answers noise ends at a named limit within the evaluations allowed", "[extremes][fast]") {
  with_each_scheme([](auto scheme) {
    INFO(scheme.name);
    unsigned state = 12345;
    Odd part{[&state](const Vector& x, int) {
      Vector noise(x.size());
      for (double& n : noise) state = 1664525u * state + 1013904223u, n = double(state) / 4294967296.0 - 0.5;
      return noise;
    }};
    const IterationLimits limits{.relative = 1e-6, .max_evaluations = 40, .fallback_steps = 3, .max_cuts = 2};
    const WindowLog log = solve_window(part, scheme, limits);
    CHECK_FALSE(log.ok());
    CHECK((log.bound == Bound::evaluations || log.bound == Bound::divergence));
    CHECK(log.evaluations <= (2 * 40 + 3) * 3);
    CHECK(part.accepted.empty());
  });
}

TEST_CASE("a part that answers a constant is agreed with", "[extremes][fast]") {
  with_each_scheme([](auto scheme) {
    INFO(scheme.name);
    Odd part{[](const Vector&, int) { return Vector(Vector::Constant(6, 7.0)); }};
    const WindowLog log = solve_window(part, scheme, {.relative = 1e-6, .max_evaluations = 2000});
    CHECK(log.ok());
    CHECK(part.accepted.front() == Vector::Constant(6, 7.0));
  });
}

TEST_CASE("a limit of one evaluation is a limit", "[extremes][fast]") {
  LinearWindow window(10.0);
  IqnIls scheme(0.1, {});
  const WindowLog log = solve_window(window, scheme, {.max_evaluations = 1, .fallback_steps = 0, .max_cuts = 0});
  CHECK(log.bound == Bound::evaluations);
  CHECK(log.evaluations == 1);
}

TEST_CASE("one part a thousand times slower or faster than the other, windows of 2e-4 to 5 s: bounded", "[extremes][fast]") {
  const double window = GENERATE(2e-4, 0.02, 1.0, 5.0);
  for (const double lag : {8.8e3, 8.8, 8.8e-3}) {
    Fowt f;
    f.lag = lag;
    f.step = std::min(2e-3, lag);
    const double end = window < 0.01 ? 0.2 : 30.0;
    INFO("window " << window << " s, lag " << lag << " s");
    const double strong = strong_error(f, IqnIls(0.5, {.reuse = 2}), window, 1e-6, end);
    CHECK(strong < 2.0);  // degrees, of a pitch of 10
    if (window <= 1.0) {
      CHECK(loose_error(f, Staggering::cps(), window, end) < 5.0);
      CHECK(loose_error(f, Staggering::css(1), window, end) < 5.0);
    }
  }
}

TEST_CASE("wave, three times the rotor's turn and pitch at one frequency: the scheme's error grows with the motion alone",
          "[extremes][fast]") {
  Fowt resonant;
  resonant.wave_period = resonant.pitch_period;
  const double cps = loose_error(resonant, Staggering::cps(), 0.02, 120.0),
               cps2 = loose_error(resonant, Staggering::cps2(), 0.02, 120.0);
  CHECK(std::isfinite(cps));
  CHECK(cps < 0.1);
  CHECK(cps > 50.0 * cps2);
}
