// An isentropic vortex carried through a periodic box (Shu 1998, ICASE 97-65; Hu & Shu 1999, J. Comput. Phys. 150, 97): an exact
// solution of the Euler equations. Space and time are refined together; the scheme claims second order in both.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/order.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

constexpr double mach = 0.3, radius = 0.1, strength = 0.5;  // strength: of the largest swirl over the stream's speed

/// At time t in the box [0, 1]^2 of the x-z plane; the vortex starts in the middle and goes along the diagonal.
gas::Primitive<double> vortex(const FlowSetting& s, const Eigen::Vector3d& x, double t) {
  const auto wrapped = [](double d) { return d - std::round(d); };
  const double dx = wrapped(x[0] - 0.5 - s.stream.u * t), dz = wrapped(x[2] - 0.5 - s.stream.w * t);
  const double r2 = (dx * dx + dz * dz) / (radius * radius), swirl = strength * s.speed * std::exp(0.5 * (1.0 - r2));
  const double T0 = s.gas.temperature_reference, cp = s.gas.cp();
  const double T = -0.5 * swirl * swirl / cp;  // of dp/dr = rho v^2 / r at constant entropy
  gas::Primitive<double> q = s.stream;
  q.u += swirl * dz / radius, q.w -= swirl * dx / radius;
  q.T = T;
  q.p = s.gas.pressure_reference * (std::pow(1.0 + T / T0, s.gas.gamma / (s.gas.gamma - 1.0)) - 1.0);
  return q;
}

/// Error of the velocity over the stream's speed (root mean square) after the vortex has gone a fifth of the box.
double error(int n, int steps, bool skewed) {
  FlowSetting s = air(mach, {1.0, 0.0, 1.0});
  const double end = 0.2 / s.stream.u;
  s.time_order = 2, s.dt = end / steps;
  s.preconditioned = false;
  s.march = {.cfl_start = 20.0, .drop = 1e-4, .max_steps = 60, .krylov_drop = 0.02, .matrix_free_below = 2.0};
  BoxOptions box{.ni = n, .nj = n, .nk = 1};
  box.periodic = {true, true, false};
  const MultiBlockGrid square = planar_box(box);
  Case c(skewed ? perturbed(square, box, 0.03) : square, s, {}, {.planar_across = 16, .planar_normal = 16});
  c.solver->start([&](const Eigen::Vector3d& x) { return vortex(s, x, 0.0); });
  c.prepare();
  for (int m = 0; m < steps; ++m) {
    c.run();
    REQUIRE(c.solver->march().now.density < 1.01e-4 * c.solver->march().first.density);
  }
  double sum = 0.0;
  long cells = 0;
  for (const FlowTile& tile : c.solver->tiles())
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; ++i, ++cells) {
        const TileGeometry& g = *tile.geometry;
        const std::ptrdiff_t at = g.cell_box.at(k, j, i), step = g.cell_box.component;
        const double* x = g.centre_data.data() + at;
        const auto q = gas::load_primitive<double>(tile.state.data() + tile.cells.at(k, j, i), std::size_t(tile.cells.component));
        const auto exact = vortex(s, {x[0], x[step], x[2 * step]}, end);
        sum += (q.u - exact.u) * (q.u - exact.u) + (q.w - exact.w) * (q.w - exact.w);
      }
    });
  return std::sqrt(sum / double(cells)) / s.speed;
}

}  // namespace

TEST_CASE("a vortex carried by the stream keeps its shape at second order in space and time", "[flow][order][nightly]") {
  for (const bool skewed : {false, true}) {
    const std::vector<double> h{1.0 / 64, 1.0 / 96, 1.0 / 128},
        errors{error(64, 24, skewed), error(96, 36, skewed), error(128, 48, skewed)};
    CAPTURE(skewed, errors[0], errors[1], errors[2]);
    CHECK(observed_order(h, errors) > 1.9);
  }
}

TEST_CASE("a vortex in a coarse box is carried with the error that second order leaves", "[flow][fast]") {
  const double coarse = error(16, 6, false), fine = error(32, 12, false);
  CAPTURE(coarse, fine);
  CHECK(fine < 0.45 * coarse);
}
