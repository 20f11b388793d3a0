// Laws every smoothing kernel obeys: unit integral, slope is the derivative, compact support, consistency of order two on a
// lattice.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sph/kernel.hpp"

#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"
#include "kernels/sph/kernel_cubic.hpp"
#include "kernels/sph/kernel_quintic.hpp"
#include "kernels/sph/kernel_wendland.hpp"

using namespace spindrift;
using namespace spindrift::sph;

#define KERNELS KernelWendland<2>, KernelWendland<3>, KernelCubic<2>, KernelCubic<3>, KernelQuintic<2>, KernelQuintic<3>

TEMPLATE_TEST_CASE("the integral of a kernel over space is one", "[sph][fast]", KERNELS) {
  const double h = GENERATE(0.01, 1.0, 30.0);
  const TestType kernel(h);
  const int n = 4000;
  const double dr = TestType::support * h / n;
  double integral = 0.0;
  for (int k = 0; k < n; ++k) {
    const double r = (k + 0.5) * dr;
    integral += kernel.value(r * r) * (TestType::dimensions == 2 ? 2.0 * pi * r : 4.0 * pi * r * r) * dr;
  }
  CHECK(integral == Approx(1.0).epsilon(1e-6));
}

TEMPLATE_TEST_CASE("the slope of a kernel is its derivative over r", "[sph][fast]", KERNELS) {
  const double h = 0.7, r = h * GENERATE(0.05, 0.3, 0.9, 0.999, 1.001, 1.4, 1.9, 1.99), e = 1e-6 * h;
  const TestType kernel(h);
  const double difference = (kernel.value((r + e) * (r + e)) - kernel.value((r - e) * (r - e))) / (2.0 * e);
  CHECK(kernel.slope(r * r) * r == Approx(difference).epsilon(1e-6).margin(1e-9));
  CHECK(kernel.slope(r * r) <= 0.0);
}

TEMPLATE_TEST_CASE("a kernel and its slope are exactly zero beyond the support", "[sph][fast]", KERNELS) {
  const TestType kernel(0.7);
  const double r = 0.7 * TestType::support * GENERATE(1.0 + 1e-12, 1.5, 1e6);
  CHECK(kernel.value(r * r) == 0.0);
  CHECK(kernel.slope(r * r) == 0.0);
}

TEMPLATE_TEST_CASE("lanes and one number agree on a kernel", "[sph][fast]", (KernelWendland<3, float>), (KernelCubic<3, float>),
                   (KernelCubic<2, float>), (KernelQuintic<3, float>), (KernelQuintic<2, float>)) {
  const TestType kernel(0.7);
  for (double r = 0.01; r < 1.6; r += 0.037) {
    const NativeWide<float> r2(r * r);
    CHECK(kernel.slope(r2)[2] == Approx(kernel.slope(float(r * r))).epsilon(2e-5).margin(1e-4));
    CHECK(kernel.value(r2)[2] == Approx(kernel.value(float(r * r))).epsilon(2e-5).margin(1e-4));
  }
}

TEMPLATE_TEST_CASE("on a lattice a kernel interpolates a quadratic with error of second order in h", "[sph][fast][order]",
                   KERNELS) {
  // sum V W (x - x')^2 is the second moment, proportional to h^2; with constant h/d it falls by four when d is halved.
  const auto moment = [](double d) {
    const TestType kernel(2.0 * d);
    double one = 0.0, second = 0.0;
    const int n = 5, m = TestType::dimensions == 3 ? n : 0;
    for (int a = -n; a <= n; ++a)
      for (int b = -n; b <= n; ++b)
        for (int c = -m; c <= m; ++c) {
          const double w = kernel.value(std::max((a * a + b * b + c * c) * d * d, 1e-30)) * std::pow(d, TestType::dimensions);
          one += w, second += w * a * a * d * d;
        }
    CHECK(one == Approx(1.0).epsilon(5e-3));
    return second;
  };
  CHECK(moment(0.2) / moment(0.1) == Approx(4.0).epsilon(1e-9));
  CHECK(moment(0.1) < 0.03);
}

namespace {

/// Fourier transform of a kernel in space at wave number k [1/m], by the midpoint rule.
template <class Kernel>
double transform(const Kernel& kernel, double k) {
  const int n = 4000;
  const double dr = Kernel::support * kernel.h() / n;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double r = (i + 0.5) * dr;
    sum += 4.0 * pi * r * kernel.value(r * r) * std::sin(k * r) / k * dr;
  }
  return sum;
}

}  // namespace

TEST_CASE("at h/d 1.5 the quintic spline does not see a lattice of particles, nor one a tenth denser", "[sph][fast]") {
  const double d = 0.2, wave_number = 2.0 * pi / d;
  const KernelQuintic<3> quintic(1.5 * d);
  const KernelWendland<3> wendland(1.5 * d);
  CHECK(transform(quintic, 1e-3) == Approx(1.0).epsilon(1e-5));
  CHECK(std::abs(transform(quintic, wave_number)) < 1e-8);
  CHECK(std::abs(transform(quintic, 1.1 * wave_number)) < 2e-6);
  CHECK(std::abs(transform(quintic, 0.9 * wave_number)) < 1e-5);
  CHECK(transform(wendland, wave_number) == Approx(3.4e-4).epsilon(0.02));
}
