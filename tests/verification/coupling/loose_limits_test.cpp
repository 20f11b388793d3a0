// Added-mass limits of loose coupling, marched with the schemes themselves, against the roots of their characteristic polynomials
// and the published 1, 1/3, 1/7, 1/5. Relaxation on a linear interface converges below 2 / (1 + r). SPDX-License-Identifier:
// Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/coupling/loose_limits.hpp"
#include "kernels/coupling/solve_window.hpp"
#include "kernels/coupling/staggered.hpp"

using namespace spindrift::coupling;

namespace {

/// A mass of 1 kg on a soft spring and an added mass r that sees velocities; backward Euler both.
struct AddedMass {
  double r, stiffness = 1e-3, x = 0.0, v = 0.0, given = 0.0;
  template <class Load>
  Vector move(const Load& load, double begin, double end) {
    const double dt = end - begin;
    v = (v + dt * (load.at(end)[0] - stiffness * x)) / (1.0 + stiffness * dt * dt);
    x += dt * v;
    return Vector::Constant(1, v);
  }
  Vector load(const Waveform& motion, double begin, double end) {
    const double now = motion.at(end)[0], y = -r * (now - given) / (end - begin);
    given = now;
    return Vector::Constant(1, y);
  }
};

/// Does a kick die out? Half of the marched windows apart, velocities and loads have grown or fallen.
bool grows(const Staggering& scheme, double r) {
  AddedMass parts{.r = r};
  Staggered march(scheme);
  march.begin(0.0, Vector::Zero(1), Vector::Constant(1, 1.0));
  constexpr double dt = 0.01;
  double early = 0.0, late = 0.0;
  for (int n = 0; n < 6000; ++n) {
    REQUIRE(march.advance(parts, n * dt, (n + 1) * dt));
    if (n >= 1000 && n < 1100) early = std::max(early, march.load().last().norm());
    if (n >= 1900 && n < 2000) {
      late = std::max(late, march.load().last().norm());
      if (n == 1999) return late > early;
    }
  }
  return late > early;
}

void check_limit(const Staggering& scheme, double limit) {
  CHECK_FALSE(grows(scheme, 0.99 * limit));
  CHECK(grows(scheme, 1.01 * limit));
}

}  // namespace

TEST_CASE("loose schemes become unstable at the added-mass ratio their polynomial gives, within 1 %", "[coupling][fast]") {
  const double css[3] = {1.0, 1.0 / 3.0, 1.0 / 7.0};
  for (int order = 0; order < 3; ++order) {
    CHECK(stability_ratio([order](double r) { return css_polynomial(order, r); }) == Approx(css[order]).epsilon(1e-9));
    check_limit(Staggering::css(order), css[order]);
  }
  CHECK(stability_ratio(cps_polynomial) == Approx(1.0).epsilon(1e-9));
  check_limit(Staggering::cps(), 1.0);
  const double cps2 = stability_ratio(cps2_polynomial);
  INFO("cps2's own limit " << cps2);
  CHECK(cps2 > 0.1);
  CHECK(cps2 < 1.0 / 3.0);
  check_limit(Staggering::cps2(), cps2);
}

TEST_CASE("a predictor of positions with F differencing them is stable up to 1/5", "[coupling][fast]") {
  CHECK(stability_ratio(predicted_position_polynomial) == Approx(0.2).epsilon(1e-9));
  const auto march = [](double r) {
    double x = 0.0, v = 1.0, v_old = 1.0, p[3] = {0.0, 0.0, 1.0}, early = 0.0, late = 0.0;  // dt = 1
    for (int n = 0; n < 4000; ++n) {
      const double predicted = x + 1.5 * v - 0.5 * v_old;
      p[0] = p[1], p[1] = p[2], p[2] = predicted;
      const double a = -r * (p[2] - 2.0 * p[1] + p[0]);
      v_old = v, v += a, x += v;
      (n < 2000 ? early : late) = n < 1900   ? early
                                  : n < 2000 ? std::max(early, std::abs(a))
                                  : n < 3900 ? late
                                             : std::max(late, std::abs(a));
    }
    return late > early;
  };
  CHECK_FALSE(march(0.99 * 0.2));
  CHECK(march(1.01 * 0.2));
}

TEST_CASE("constant relaxation converges below 2 / (1 + r)", "[coupling][fast]") {
  struct Window {
    double r;
    bool finished = false;
    Vector evaluate(const Vector& x) { return -r * x + Vector::Constant(1, 1.0); }
    Vector guess() const { return Vector::Zero(1); }
    void accept() { finished = true; }
    bool done() const { return finished; }
    bool halve() { return false; }
  };
  for (const double r : {1e-3, 0.5, 1.0, 10.0, 100.0}) {
    const double limit = 2.0 / (1.0 + r);
    const IterationLimits limits{.relative = 1e-8, .max_evaluations = 5000, .fallback_steps = 0};
    Window window{r};
    RelaxationConstant below(0.99 * limit), above(1.01 * limit);
    CHECK(solve_window(window, below, limits).ok());
    Window again{r};
    CHECK_FALSE(solve_window(again, above, limits).ok());
  }
}
