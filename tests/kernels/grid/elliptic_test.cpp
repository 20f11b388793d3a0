// Elliptic smoothing: symmetry stays, a shaken grid returns, boundaries hold.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/grid/elliptic.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "kernels/base/constants.hpp"

using namespace spindrift;
using Eigen::Vector2d;

namespace {

/// Rings of radius growth^j: conformal, with sizes that grow by a constant factor.
std::vector<Vector2d> rings(RingShape ring, double growth) {
  std::vector<Vector2d> p(ring.size());
  for (int j = 0; j <= ring.layers; ++j)
    for (int i = 0; i < ring.round; ++i) {
      const double a = 2.0 * pi * i / ring.round, r = std::pow(growth, j);
      p[ring.at(i, j)] = {r * std::cos(a), r * std::sin(a)};
    }
  return p;
}

double distance(const std::vector<Vector2d>& a, const std::vector<Vector2d>& b) {
  double worst = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) worst = std::max(worst, (a[n] - b[n]).norm());
  return worst;
}

}  // namespace

TEST_CASE("elliptic smoothing keeps the symmetry of rings, and shaken rings return to where the smooth ones settle",
          "[grid][fast]") {
  const RingShape ring{64, 12};
  const std::vector<Vector2d> exact = rings(ring, 1.1);
  std::vector<double> phi(ring.size()), psi(ring.size()), share(ring.size(), 0.6);
  middlecoff_controls(ring, exact, phi, psi);
  std::vector<Vector2d> still(exact), next(exact);
  for (int sweep = 0; sweep < 300; ++sweep) winslow_sweep(ring, still, phi, psi, share, next), still.swap(next);
  for (int j = 0; j < ring.layers; ++j) {
    CHECK(still[ring.at(0, j)].norm() < still[ring.at(0, j + 1)].norm());
    for (int i = 0; i < ring.round; ++i) CHECK(still[ring.at(i, j)].norm() == Approx(still[ring.at(0, j)].norm()).epsilon(1e-12));
  }

  std::vector<Vector2d> shaken(exact);
  for (int j = 1; j < ring.layers; ++j)
    for (int i = 0; i < ring.round; ++i) shaken[ring.at(i, j)] *= 1.0 + 0.02 * std::sin(13.0 * i + 7.0 * j);
  const double before = distance(shaken, still);
  for (int sweep = 0; sweep < 300; ++sweep) winslow_sweep(ring, shaken, phi, psi, share, next), shaken.swap(next);
  CHECK(distance(shaken, still) < 0.02 * before);
  for (int i = 0; i < ring.round; ++i) CHECK((shaken[ring.at(i, 0)] - exact[ring.at(i, 0)]).norm() == 0.0);
}

TEST_CASE("a frozen node does not move", "[grid][fast]") {
  const RingShape ring{16, 4};
  std::vector<Vector2d> p = rings(ring, 1.3);
  p[ring.at(3, 2)] *= 1.05;
  std::vector<double> zero(ring.size(), 0.0);
  std::vector<Vector2d> next(p.size());
  winslow_sweep(ring, p, zero, zero, zero, next);
  CHECK(distance(p, next) == 0.0);
}
