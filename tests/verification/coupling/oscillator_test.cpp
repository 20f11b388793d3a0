// Two masses on three springs, a mass each to a part (the partitioned oscillator of the preCICE tutorials: m = 1, k = 4 pi^2, 16
// pi^2, 4 pi^2, u0 = (1, 0)): constant, linear and cubic waveforms give order 1, 2, 4, judged over all window ends. At t = 1, a
// whole period, errors cancel. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/coupling/iqn_ils.hpp"
#include "tests/order.hpp"
#include "tests/verification/coupling/fowt.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using namespace spindrift::coupling::test;

namespace {

constexpr double k_wall = 4 * pi * pi, k_middle = 16 * pi * pi;

/// A mass under the other's displacement; samples of its own at equal parts of the window.
Vector swing(Vector& state, const Waveform& other, double begin, double end, int samples) {
  Vector out(samples);
  for (int s = 0; s < samples; ++s) {
    const double a = begin + (end - begin) * s / samples, b = begin + (end - begin) * (s + 1) / samples;
    march_rk4(state, a, b, (b - a) / 8, [&](double t, const Vector& z) {
      Vector rate(2);
      rate << z[1], -(k_wall + k_middle) * z[0] + k_middle * other.at(t)[0];
      return rate;
    });
    out[s] = state[0];
  }
  return out;
}

struct Oscillator {
  Interpolation kind;
  int samples;
  double window;
  long number = 0;
  Vector left{{1.0, 0.0}}, right{{0.0, 0.0}}, left_now{}, right_now{};
  bool finished = false;

  Waveform waveform(double start, const Vector& x) const {
    std::vector<double> times{number * window};
    std::vector<Vector> values{Vector::Constant(1, start)};
    for (int s = 0; s < samples; ++s)
      times.push_back(times[0] + window * (s + 1) / samples), values.push_back(Vector::Constant(1, x[s]));
    return Waveform(kind, times, values);
  }
  Vector first(const Vector& x) {
    return swing(left_now = left, waveform(right[0], x), number * window, (number + 1) * window, samples);
  }
  Vector second(const Vector& y) {
    return swing(right_now = right, waveform(left[0], y), number * window, (number + 1) * window, samples);
  }
  Vector evaluate(const Vector& x) { return evaluate_serial(*this, x); }
  Vector guess() const { return Vector::Constant(samples, right[0]); }
  void accept() {
    left = left_now, right = right_now;
    ++number;
    finished = true;
  }
  bool done() const { return finished; }
  bool halve() { return false; }
};

double error_of(Interpolation kind, int samples, int windows) {
  Oscillator parts{kind, samples, 1.0 / windows};
  IqnIls scheme(0.5, {});
  double worst = 0.0;
  for (int n = 0; n < windows; ++n) {
    parts.finished = false;
    REQUIRE(solve_window(parts, scheme, {.relative = 1e-11, .absolute = 1e-13}).ok());
    const double t = double(n + 1) / windows;
    worst = std::max({worst, std::abs(parts.left[0] - 0.5 * (std::cos(2 * pi * t) + std::cos(6 * pi * t))),
                      std::abs(parts.right[0] - 0.5 * (std::cos(2 * pi * t) - std::cos(6 * pi * t)))});
  }
  return worst;
}

}  // namespace

TEST_CASE("waveforms of a value, lines and cubics couple two oscillators to order 1, 2 and 4", "[coupling][fast]") {
  const std::vector<double> h{1.0 / 40, 1.0 / 80, 1.0 / 160};
  const auto order = [&](Interpolation kind, int samples) {
    std::vector<double> error;
    for (double w : h) error.push_back(error_of(kind, samples, int(std::lround(1 / w))));
    return observed_order(h, error);
  };
  CHECK(order(Interpolation::constant, 1) == Approx(1.0).margin(0.15));
  CHECK(order(Interpolation::linear, 1) == Approx(2.0).margin(0.15));
  CHECK(order(Interpolation::cubic, 3) == Approx(4.0).margin(0.2));
}
