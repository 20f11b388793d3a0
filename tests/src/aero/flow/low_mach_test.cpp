// With the settings a user starts from, an inviscid march takes as many pseudo-steps at Mach 1e-4 as at 0.1: the matrix has the
// waves of the preconditioned equations. Flow round a cylinder, where the stream stands still at two points.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

struct March3 {
  int steps;  ///< to three orders of the density residual
  double drag;
};
March3 cylinder(double mach) {
  FlowSetting s = air(mach);
  s.march.drop = 1e-3, s.march.max_steps = 100;
  MultiBlockGrid grid;
  grid.planar = true;
  constexpr int around = 64, out = 32;
  grid.blocks.push_back(mapped_block("ring", around, out, 1, [](double u, double v, double w) {
    const double angle = 2.0 * std::numbers::pi * u, r = 0.5 * std::pow(40.0, v);
    return Eigen::Vector3d(r * std::cos(angle), w, r * std::sin(angle));
  }));
  grid.connections.push_back(
      {.from = {0, Side::i_max, {0, 0}, {out, 1}}, .to = {0, Side::i_min, {0, 0}, {out, 1}}, .orientation = {1, 2, 3}});
  grid.boundaries.push_back({{0, Side::j_min, {0, 0}, {around, 1}}, "wall"});
  grid.boundaries.push_back({{0, Side::j_max, {0, 0}, {around, 1}}, "far"});
  Case c(grid, s, {{"wall", {Condition::slip, true}}, {"far", {Condition::far_field, false}}});
  c.prepare();
  c.run();
  CHECK(c.solver->march().verdict == Verdict::converged);
  CHECK_FALSE(c.solver->march().spent);
  const double q = 0.5 * gas::density(s.gas, s.stream) * s.speed * s.speed;
  return {c.solver->march().steps, c.solver->rows().back().force[0] / q};
}

}  // namespace

TEST_CASE("a march with default settings takes as many steps at Mach 1e-4 as at 0.1", "[flow][fast]") {
  const March3 at_1e1 = cylinder(0.1), at_1e3 = cylinder(1e-3), at_1e4 = cylinder(1e-4);
  CAPTURE(at_1e1.steps, at_1e3.steps, at_1e4.steps, at_1e1.drag, at_1e3.drag, at_1e4.drag);
  CHECK(at_1e1.steps < 30);
  CHECK(at_1e3.steps <= 2 * at_1e1.steps);
  CHECK(at_1e4.steps <= 2 * at_1e1.steps);
  CHECK(std::abs(at_1e4.drag) < 0.05);
  CHECK(std::abs(at_1e4.drag - at_1e3.drag) < 0.01);
}
