// Waveforms and predictors reproduce polynomials of their degree, on unequal times, and go through data bit for bit.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/coupling/staggered.hpp"

using namespace spindrift::coupling;

namespace {

Vector power(double t, int degree) { return Vector{{std::pow(t, degree), 2.0 - std::pow(t, degree)}}; }

}  // namespace

TEST_CASE("a waveform of degree p carries polynomials of degree p exactly, between unequal samples and beyond them",
          "[coupling][fast]") {
  const std::vector<double> times{0.5, 0.7, 1.2, 1.3, 2.0};
  for (const auto& [kind, degree] : {std::pair{Interpolation::linear, 1}, std::pair{Interpolation::cubic, 3}}) {
    std::vector<Vector> values;
    for (double t : times) values.push_back(power(t, degree));
    const Waveform waveform(kind, times, values);
    for (double t : {0.5, 0.6, 0.7, 1.0, 1.25, 1.9, 2.0, 2.2}) CHECK((waveform.at(t) - power(t, degree)).norm() < 1e-13 * 40);
    CHECK((waveform.at(0.6) - power(0.6, degree + 1)).norm() > 1e-3);
  }
  const Waveform steps(Interpolation::constant, {0.0, 1.0, 2.0}, {power(0, 1), power(1, 1), power(2, 1)});
  CHECK(steps.at(0.1)[0] == 1.0);
  CHECK(steps.at(1.0)[0] == 1.0);
  CHECK(steps.at(1.1)[0] == 2.0);
  CHECK(Waveform::held(power(3, 1)).at(17.0)[0] == 3.0);
}

TEST_CASE("a predictor of order k is exact for polynomials of degree k on unequal windows, and lower while young",
          "[coupling][fast]") {
  for (int order : {0, 1, 2}) {
    Extrapolation e(order);
    e.add(0.0, power(0.0, order));
    CHECK(e.at(0.3) == e.last());
    for (double t : {0.2, 0.5, 0.6}) e.add(t, power(t, order));
    CHECK((e.at(1.0) - power(1.0, order)).norm() < 1e-13);
  }
  Extrapolation linear(1);
  linear.add(0.0, Vector::Constant(1, 1.0)), linear.add(0.5, Vector::Constant(1, 2.0));
  CHECK(linear.at(0.75)[0] == Approx(2.0 + 0.25 / 0.5 * (2.0 - 1.0)));  // v_n + dt_new / dt_old (v_n - v_{n-1})
}

TEST_CASE("waveforms, predictors and staggered marches go through data bit for bit", "[coupling][fast]") {
  Waveform w(Interpolation::cubic, {0.0, 0.1, 0.3}, {power(0, 2), power(0.1, 2), power(0.3, 2)}), w2;
  Staggered s(Staggering::cps2()), s2(Staggering::cps2());
  s.begin(0.0, power(1, 1), power(2, 1));
  std::vector<double> data;
  save_history(w, data), save_history(s, data);
  std::span<const double> in = data;
  REQUIRE(restore_history(w2, in));
  REQUIRE(restore_history(s2, in));
  CHECK(in.empty());
  CHECK(w2.at(0.2) == w.at(0.2));
  CHECK(s2.load().at(0.4) == s.load().at(0.4));
}
