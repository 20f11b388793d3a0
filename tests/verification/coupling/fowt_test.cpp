// Order and error of the schemes on the reduced floating turbine against everything advanced together.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/coupling/iqn_ils.hpp"
#include "kernels/coupling/relaxation_aitken.hpp"
#include "tests/order.hpp"
#include "tests/verification/coupling/fowt.hpp"

using namespace spindrift::coupling;
using namespace spindrift::coupling::test;

namespace {

double order_of(const Staggering& scheme, std::initializer_list<double> windows) {
  std::vector<double> h(windows), error;
  for (double w : h) error.push_back(loose_error({}, scheme, w));
  return spindrift::observed_order(h, error);
}

}  // namespace

TEST_CASE("cps is of order 1, cps2, css1 and the strong window of order 2 on the floating turbine", "[coupling][fast]") {
  CHECK(order_of(Staggering::cps(), {0.04, 0.02, 0.01}) == Approx(1.0).margin(0.1));
  CHECK(order_of(Staggering::css(0), {0.04, 0.02, 0.01}) == Approx(1.0).margin(0.1));
  CHECK(order_of(Staggering::cps2(), {0.2, 0.1, 0.05}) == Approx(2.0).margin(0.15));
  CHECK(order_of(Staggering::css(1), {0.2, 0.1, 0.05}) == Approx(2.0).margin(0.15));
  std::vector<double> h{0.2, 0.1, 0.05}, error;
  for (double w : h) error.push_back(strong_error({}, IqnIls(0.5, {.reuse = 2}), w, 1e-8));
  CHECK(spindrift::observed_order(h, error) == Approx(2.0).margin(0.15));
}

TEST_CASE("at windows of 0.02 s cps2 is at least 50 times more accurate than cps, the strong window most", "[coupling][fast]") {
  const double cps = loose_error({}, Staggering::cps(), 0.02), cps2 = loose_error({}, Staggering::cps2(), 0.02),
               css1 = loose_error({}, Staggering::css(1), 0.02), strong = strong_error({}, RelaxationAitken(1.0), 0.02, 1e-6);
  INFO("cps " << cps << " cps2 " << cps2 << " css1 " << css1 << " strong " << strong);
  CHECK(cps > 50.0 * cps2);
  CHECK(cps2 > css1);
  CHECK(css1 > strong);
}

TEST_CASE("what a strong window leaves unconverged shows in proportion", "[coupling][fast]") {
  // Fixed point with the evaluations cut short: one more reduces the error until the discretisation's is left.
  double last = strong_error({}, RelaxationConstant(1.0), 0.1, 0.5);
  for (const double relative : {0.05, 5e-4}) {
    const double error = strong_error({}, RelaxationConstant(1.0), 0.1, relative);
    INFO("relative " << relative << ": " << error);
    CHECK(error <= last * (1 + 1e-9));
    last = error;
  }
}
