// SPDX-License-Identifier: Apache-2.0
#include "kernels/grid/spacing.hpp"

#include <catch2/catch.hpp>

#include "kernels/grid/transfinite.hpp"

using namespace spindrift;

namespace {
template <class Law>
double slope(const Law& law, double s) {
  constexpr double h = 1e-6;
  if (s < h) return (-3 * law(0.0) + 4 * law(h) - law(2 * h)) / (2 * h);
  if (s > 1 - h) return (3 * law(1.0) - 4 * law(1 - h) + law(1 - 2 * h)) / (2 * h);
  return (law(s + h) - law(s - h)) / (2 * h);
}
}  // namespace

TEST_CASE("the sinh law has the slope asked for, no curvature at its start, and rises all the way", "[grid][fast]") {
  const double asked = GENERATE(1e-8, 1e-4, 0.3, 0.999999, 1.0, 1.2, 1.45);
  const SinhLaw law(asked);
  CHECK(law(0.0) == 0.0);
  CHECK(law(1.0) == Approx(1.0).epsilon(1e-14));
  CHECK(slope(law, 0.0) == Approx(asked).epsilon(1e-4));
  const double h = 1e-3;
  CHECK(law(2 * h) == Approx(2 * law(h)).epsilon(1e-3));
  for (int n = 1; n <= 100; ++n) CHECK(law(0.01 * n) > law(0.01 * (n - 1)));
}

TEST_CASE("the Vinokur law has the slopes asked for at both ends", "[grid][fast]") {
  const double start = GENERATE(1e-5, 0.01, 0.5, 1.0, 1.6, 2.5), end = GENERATE(1e-4, 0.2, 1.0, 1.5, 3.0);
  const VinokurLaw law(start, end);
  CHECK(law(0.0) == Approx(0.0).margin(1e-15));
  CHECK(law(1.0) == Approx(1.0).epsilon(1e-14));
  CHECK(slope(law, 0.0) == Approx(start).epsilon(1e-2));
  CHECK(slope(law, 1.0) == Approx(end).epsilon(1e-2));
  for (int n = 1; n <= 100; ++n) CHECK(law(0.01 * n) > law(0.01 * (n - 1)));
}

TEST_CASE("the wave law is as dense at its ends as asked", "[grid][fast]") {
  const WaveLaw law(0.145);
  CHECK(law(0.0) == 0.0);
  CHECK(law(1.0) == Approx(1.0));
  CHECK(slope(law, 0.0) == Approx(0.145).epsilon(1e-4));
  CHECK(slope(law, 0.5) == Approx(1.855).epsilon(1e-4));
}

TEST_CASE("a transfinite patch keeps its edges and reproduces bilinear surfaces", "[grid][fast]") {
  const auto surface = [](double u, double v) { return Eigen::Vector3d(u, v, 1 + u - 2 * v + 3 * u * v); };
  const auto at = [&](double u, double v) {
    return transfinite(
        u, v, [&](double q) { return surface(0, q); }, [&](double q) { return surface(1, q); },
        [&](double q) { return surface(q, 0); }, [&](double q) { return surface(q, 1); });
  };
  CHECK((at(0.3, 0.7) - surface(0.3, 0.7)).norm() < 1e-15);
  const auto bent = [](double q) { return Eigen::Vector3d(q, 0, std::sin(3.14159265358979 * q)); };
  const auto straight = [](double y, double q) { return Eigen::Vector3d(q, y, 0); };
  const auto side = [](double x, double q) { return Eigen::Vector3d(x, q, 0); };
  const auto p = transfinite(
      0.25, 0.0, [&](double q) { return side(0, q); }, [&](double q) { return side(1, q); }, bent,
      [&](double q) { return straight(1, q); });
  CHECK((p - bent(0.25)).norm() < 1e-15);
}
