// Lines and discs of force: spreading and sampling against exact integrals, what the width takes from the velocity against closed
// forms and lifting-line theory. SPDX-License-Identifier: Apache-2.0
#include "kernels/rotor/actuator_line.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "tests/order.hpp"

using namespace spindrift;

namespace {

/// Weights of the kernel on cells of size one, normalised, applied to field(x, y, z); the point lies anywhere among the cells.
template <class Field>
double sampled(double width, double x, double y, double z, const Field& field) {
  const int reach = int(std::ceil(kernel_reach * width)) + 1;
  double sum = 0.0, weights = 0.0;
  for (int k = -reach; k <= reach; ++k)
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach; i <= reach; ++i) {
        const double d2 = (i - x) * (i - x) + (j - y) * (j - y) + (k - z) * (k - z);
        if (d2 > kernel_reach * kernel_reach * width * width) continue;
        weights += gaussian_kernel(d2, width), sum += gaussian_kernel(d2, width) * field(i, j, k);
      }
  CHECK(weights == Approx(1.0).margin(2e-3));
  return sum / weights;
}

constexpr HelicalWake straight{pi / 2, 1.0};

/// Downwash at y of the straight wake of an elliptic wing of span 2 and unit circulation in the middle, spread over `width`: the
/// sum over its trailing vortices of Lamb and Oseen's, n of them.
double filtered_downwash(double y, double width, int n) {
  double sum = 0.0;
  for (int m = 0; m < n; ++m) {
    const double inner = -std::cos(pi * m / n), outer = -std::cos(pi * (m + 1) / n), middle = -std::cos(pi * (m + 0.5) / n);
    const double shed = std::sqrt(std::max(0.0, 1.0 - outer * outer)) - std::sqrt(std::max(0.0, 1.0 - inner * inner));
    const double d = y - middle;
    sum += shed * (1.0 - std::exp(-d * d / (width * width))) / (4.0 * pi * d);
  }
  return sum;
}

}  // namespace

TEST_CASE("the Gaussian samples a straight field exactly and a curved one to second order of its width", "[rotor][fast]") {
  const double x = GENERATE(0.0, 0.3, 0.5);
  CHECK(sampled(2.0, x, 0.2, 0.1, [](double, double, double) { return 3.0; }) == Approx(3.0).epsilon(1e-14));
  CHECK(sampled(2.0, x, 0.2, 0.1, [](double a, double b, double) { return 1.0 + a - b; }) == Approx(0.8 + x).margin(2e-3));
  std::vector<double> width, error;
  for (const double w : {2.0, 3.0, 4.0}) {
    const double wave = 0.05;
    const double got = sampled(w, x, 0.0, 0.0, [&](double a, double, double) { return std::cos(wave * (a - x)); });
    width.push_back(w), error.push_back(std::abs(got - 1.0));
    // Exact for the whole Gaussian: exp(-(wave width)^2 / 4); cut at three widths it has lost a hundredth of that.
    CHECK(error.back() == Approx(1.0 - std::exp(-0.25 * wave * wave * w * w)).epsilon(0.02));
  }
  CHECK(observed_order(width, error) == Approx(2.0).margin(0.05));
}

TEST_CASE("what a straight trailing vortex lacks is the difference of two of Lamb and Oseen's", "[rotor][fast]") {
  const double d = GENERATE(0.02, 0.1, -0.3, 0.6), wide = GENERATE(0.1, 0.4), narrow = 0.03;
  const TrailedVelocity missing = missing_velocity(2.0 + d, 2.0, 0.0, straight, narrow, wide);
  const double exact = (std::exp(-d * d / (wide * wide)) - std::exp(-d * d / (narrow * narrow))) / (4.0 * pi * d);
  CAPTURE(d, wide);
  CHECK(missing.ahead == Approx(exact).epsilon(0.01).margin(1e-4));
  CHECK(std::abs(missing.axial) < 1e-12);
}

TEST_CASE("an elliptic wing has the downwash of lifting-line theory at any width once corrected", "[rotor][fast]") {
  // Prandtl: circulation over twice the span, constant. Points lie where elements meet, between the vortices of their middles.
  constexpr int n = 200;
  const double theory = 1.0 / 4.0, narrow = 2e-3, width = GENERATE(0.05, 0.1, 0.2, 0.4);
  for (const int at : {100, 125, 150, 170}) {
    const double y = -std::cos(pi * at / n);
    const double spread = filtered_downwash(y, width, n);
    double missing = 0.0;
    for (int m = 0; m < n; ++m) {
      const double inner = -std::cos(pi * m / n), outer = -std::cos(pi * (m + 1) / n), middle = -std::cos(pi * (m + 0.5) / n);
      const double shed = std::sqrt(std::max(0.0, 1.0 - outer * outer)) - std::sqrt(std::max(0.0, 1.0 - inner * inner));
      missing += shed * missing_velocity(3.0 + y, 3.0 + middle, 0.0, straight, narrow, width).ahead;
    }
    CAPTURE(width, y, spread, missing);
    CHECK(spread < theory);
    CHECK(spread + missing == Approx(theory).epsilon(0.03));
  }
}

TEST_CASE("a tip vortex slows the wind at its own blade, and all blades' helices more than one", "[rotor][fast]") {
  const HelicalWake wake{0.09, 1.0};
  const auto lacks = [&](double offset) { return missing_velocity(0.8, 1.0, offset, wake, 0.01, 0.3).axial; };
  CHECK(lacks(0.0) < 0.0);
  CHECK(lacks(2.0 * pi / 3.0) < 0.0);
  CHECK(lacks(4.0 * pi / 3.0) < 0.0);
  // A rotor that turns the other way sees the mirror image.
  const HelicalWake mirrored{pi - 0.09, 1.0};
  const TrailedVelocity one = missing_velocity(0.8, 1.0, 0.4, wake, 0.01, 0.3),
                        other = missing_velocity(0.8, 1.0, -0.4, mirrored, 0.01, 0.3);
  CHECK(other.axial == Approx(-one.axial).epsilon(1e-9));
  CHECK(other.ahead == Approx(one.ahead).epsilon(1e-9));
  CHECK(missing_velocity(0.8, 1.0, 0.0, wake, 0.3, 0.3).axial == 0.0);
}

TEST_CASE("helices lack on the mean over the azimuth what a disc of their circulation lacks", "[rotor][fast]") {
  // Three blades of one circulation each: induced velocity of the disc B / (4 pi R tan(angle)), of which the width keeps the
  // mean.
  const double wide = std::sqrt(2.0) * 0.2, angle = GENERATE(0.09, 0.13), r = GENERATE(0.6, 0.8, 0.95);
  const HelicalWake wake{angle, 1.0};
  constexpr int azimuths = 120, rings = 40;
  double helices = 0.0, kept = 0.0;
  for (int n = 0; n < azimuths; ++n)
    helices += 3.0 / azimuths * missing_velocity(r, 1.0, 2.0 * pi * (n + 0.37) / azimuths, wake, 0.003, wide).axial;
  for (int k = 0; k < rings; ++k) kept += ring_mean(r, double(k) / rings, double(k + 1) / rings, wide, false);
  const double disc = 3.0 / (4.0 * pi * std::tan(angle));
  CHECK(helices == Approx(-disc * (1.0 - kept)).epsilon(3e-3));
  // The blade itself meets more than the mean: the loss at the tip.
  double blade = 0.0;
  for (int b = 0; b < 3; ++b) blade += missing_velocity(r, 1.0, 2.0 * pi * b / 3.0, wake, 0.003, wide).axial;
  CHECK(blade < helices * (r > 0.9 ? 1.3 : 0.99));
}

TEST_CASE("the Gaussian mean over rings is that over the plane they fill", "[rotor][fast]") {
  const double width = GENERATE(0.05, 0.2), radius = GENERATE(0.1, 0.5, 0.95, 1.1);
  double sum = 0.0, swirl = 0.0;
  for (int m = 0; m < 40; ++m) {
    sum += ring_mean(radius, 0.05 * m, 0.05 * (m + 1), width, false);
    swirl += 0.05 * (m + 0.5) * ring_mean(radius, 0.05 * m, 0.05 * (m + 1), width, true);
  }
  CHECK(sum == Approx(1.0).epsilon(1e-3));
  CHECK(swirl == Approx(radius).epsilon(0.02));  // a solid body's turning is a straight field, here by rings of constant speed
}
