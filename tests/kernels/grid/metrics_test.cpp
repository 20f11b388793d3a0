// SPDX-License-Identifier: Apache-2.0
#include "kernels/grid/metrics.hpp"

#include <catch2/catch.hpp>

#include <random>

#include "kernels/rigid/rotation.hpp"

using namespace spindrift;
using Eigen::Vector3d;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// A cell of edge lengths (1, 1, thin), sheared, its corners displaced by `warp` times the edges, turned and moved far away.
Hexahedron random_cell(std::mt19937& random, double thin, double warp, double far) {
  std::uniform_real_distribution<double> u(-1, 1);
  Hexahedron h;
  const Eigen::Matrix3d turn = attitude(Vector3d(u(random), u(random), u(random))).toRotationMatrix();
  const Vector3d away = far * Vector3d(u(random), u(random), u(random));
  const double shear_x = u(random), shear_y = u(random);
  for (int n = 0; n < 8; ++n) {
    Vector3d x(n % 2, n / 2 % 2, n / 4);
    x += warp * Vector3d(u(random), u(random), u(random));
    x.z() *= thin;
    x.x() += shear_x * x.z(), x.y() += shear_y * x.z();
    h.x[n] = turn * x + away;
  }
  return h;
}
Quad side(const Hexahedron& h, int s) {
  static constexpr int corners[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 4, 5, 1}, {2, 6, 7, 3}, {0, 1, 3, 2}, {4, 5, 7, 6}};
  return {h.x[corners[s][0]], h.x[corners[s][1]], h.x[corners[s][2]], h.x[corners[s][3]]};
}

/// Volume of the trilinear map by Gauss points, three each way: its Jacobian is of second degree in each coordinate.
long double gauss_volume(const Hexahedron& h) {
  using V = Eigen::Matrix<long double, 3, 1>;
  const long double at[] = {0.5L - 0.5L * std::sqrt(0.6L), 0.5L, 0.5L + 0.5L * std::sqrt(0.6L)},
                    w[] = {5 / 18.0L, 8 / 18.0L, 5 / 18.0L};
  long double sum = 0;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      for (int c = 0; c < 3; ++c) {
        V d[3] = {V::Zero(), V::Zero(), V::Zero()};
        for (int n = 0; n < 8; ++n) {
          const long double f[3] = {n % 2 ? at[a] : 1 - at[a], n / 2 % 2 ? at[b] : 1 - at[b], n / 4 ? at[c] : 1 - at[c]};
          const long double g[3] = {n % 2 ? 1.0L : -1.0L, n / 2 % 2 ? 1.0L : -1.0L, n / 4 ? 1.0L : -1.0L};
          const V x = h.x[n].cast<long double>() - h.x[0].cast<long double>();
          d[0] += g[0] * f[1] * f[2] * x, d[1] += f[0] * g[1] * f[2] * x, d[2] += f[0] * f[1] * g[2] * x;
        }
        sum += w[a] * w[b] * w[c] * d[0].dot(d[1].cross(d[2]));
      }
  return sum;
}

}  // namespace

TEST_CASE("the volume of a warped cell is that of its trilinear map", "[grid][fast]") {
  std::mt19937 random(1);
  for (int n = 0; n < 200; ++n) {
    const Hexahedron h = random_cell(random, 1.0, 0.2, 0.0);
    CHECK(hexahedron_volume(h) == Approx(double(gauss_volume(h))).epsilon(1e-14));
  }
  CHECK(hexahedron_volume({{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {2, 3, 0}, {0, 0, 5}, {2, 0, 5}, {0, 3, 5}, {2, 3, 5}}}) == 30.0);
}

TEST_CASE("a sheared and turned cell of aspect ratio 1e5 keeps its volume to a few units in the last place", "[grid][fast]") {
  std::mt19937 random(2);
  double worst = 0;
  for (int n = 0; n < 1000; ++n) {
    const Hexahedron h =
        random_cell(random, 1e-5, 0.0, 0.0);  // at the origin: far away the node positions are rounded, not the volume
    const long double exact = gauss_volume(h);
    worst = std::max(worst, double(std::abs((hexahedron_volume(h) - exact) / exact)));
  }
  INFO("largest relative error " << worst);
  CHECK(worst < 1e-14);
}

TEST_CASE("the face vectors of a closed cell cancel", "[grid][fast]") {
  std::mt19937 random(3);
  const double thin = GENERATE(1.0, 1e-5);
  for (int n = 0; n < 200; ++n) {
    const Hexahedron h = random_cell(random, thin, 0.2, 100.0);
    Vector3d sum = Vector3d::Zero();
    double size = 0;
    for (int s = 0; s < 6; ++s) {
      sum += (s % 2 ? 1.0 : -1.0) * face_vector(side(h, s));
      size += face_vector(side(h, s)).norm();
    }
    CHECK(sum.norm() <= 4 * eps * size);
  }
}

TEST_CASE("a cell that moves and deforms grows by what its faces sweep", "[grid][fast]") {
  std::mt19937 random(4);
  const double thin = GENERATE(1.0, 1e-5);
  double worst = 0;
  for (int n = 0; n < 500; ++n) {
    const Hexahedron before = random_cell(random, thin, 0.2, 0.0), after = random_cell(random, thin, 0.2, 0.0);
    double swept = 0, size = 0;
    for (int s = 0; s < 6; ++s) {
      const double v = swept_volume(side(before, s), side(after, s));
      swept += (s % 2 ? 1.0 : -1.0) * v;
      size += std::abs(v);
    }
    worst = std::max(worst, std::abs(hexahedron_volume(after) - hexahedron_volume(before) - swept) / size);
  }
  INFO("relative to the sum of what the faces sweep " << worst);
  CHECK(worst < 1e-14);
}

TEST_CASE("BDF weights sum to zero and make the rates of swept volumes match the change of volume", "[grid][fast]") {
  const double ratio = GENERATE(0.5, 1.0, 1.7);
  const TimeWeights w = bdf2(ratio);
  CHECK(w.now + w.old + w.older == Approx(0).margin(1e-15));
  // Exact for parabolas: times 0 (now), -1 (old), -1 - 1/ratio (older), in steps of one.
  const auto parabola = [](double t) { return 3.0 + 2.0 * t - 0.7 * t * t; };
  CHECK(w.now * parabola(0) + w.old * parabola(-1) + w.older * parabola(-1 - 1 / ratio) == Approx(2.0));
  const double v0 = 1.0, v1 = 1.3, v2 = 1.1;  // older, old, now
  CHECK(swept_rate(w, v2 - v1, v1 - v0, 0.1) == Approx((w.now * v2 + w.old * v1 + w.older * v0) / 0.1));
}

TEST_CASE("BDF3 weights are exact for cubics, whatever the steps were, and are those of Curtiss and Hirschfelder for equal ones",
          "[grid][fast]") {
  const double ratio = GENERATE(0.5, 1.0, 1.7), ratio_before = GENERATE(0.5, 1.0, 2.0);
  const TimeWeights w = bdf3(ratio, ratio_before);
  CHECK(w.now + w.old + w.older + w.oldest == Approx(0).margin(1e-15));
  // Times in steps of one: 0 is now.
  const double older = -1.0 - 1.0 / ratio, oldest = older - 1.0 / (ratio * ratio_before);
  const auto cubic = [](double t) { return 3.0 + 2.0 * t - 0.7 * t * t + 1.3 * t * t * t; };
  CHECK(w.now * cubic(0) + w.old * cubic(-1) + w.older * cubic(older) + w.oldest * cubic(oldest) == Approx(2.0));
  const double v0 = 1.2, v1 = 1.0, v2 = 1.3, v3 = 1.1;  // oldest, older, old, now
  CHECK(swept_rate(w, v3 - v2, v2 - v1, v1 - v0, 0.1) == Approx((w.now * v3 + w.old * v2 + w.older * v1 + w.oldest * v0) / 0.1));
  const TimeWeights equal = bdf3();
  CHECK(equal.now == Approx(11.0 / 6.0));
  CHECK(equal.old == Approx(-3.0));
  CHECK(equal.older == Approx(1.5));
  CHECK(equal.oldest == Approx(-1.0 / 3.0));
}
