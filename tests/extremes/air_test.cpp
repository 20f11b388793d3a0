// The air at its extremes: impulsive starts, CFL numbers of seven orders of magnitude. Each march converges, or goes on slowly,
// or gives up with a sentence; whatever it leaves is finite, with positive pressure, temperature and turbulence.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "src/aero/grid/generators/plane_cases.hpp"
#include "src/aero/grid/wall_distance.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

struct Left {
  bool sound = true;
  double residual, first, cfl;
  int rejections;
  Verdict verdict;
  std::string why;
};

/// A wing (planar: its section) at 10 degrees in a wind of this Mach number, from the wind or from rest; CFL number as given from
/// the start.
Left march(const MultiBlockGrid& grid, double mach, bool from_rest, double cfl, int steps, const std::string& model = "sa") {
  const double alpha = 10.0 * 3.14159265358979 / 180.0;
  FlowSetting s = air(mach, {std::cos(alpha), 0.0, std::sin(alpha)});
  const double rho = gas::density(s.gas, s.stream);
  s.gas.viscosity = {.mu0 = rho * s.speed / 6e6, .T0 = 288.15, .S = 110.33};
  s.viscous = true, s.turbulence = model;
  if (mach > 0.5) s.limiter = "van_albada";
  s.march.cfl_start = cfl, s.march.cfl_max = std::max(cfl, 1e4), s.march.max_steps = steps, s.march.drop = 1e-4;
  Case c(grid, s,
         {{"wall", {Condition::no_slip, true}},
          {"farfield", {Condition::far_field, false}},
          {"outflow", {Condition::far_field, false}},
          {"sides", {Condition::symmetry, false}}});
  const WallSurface wall = wall_surface(c.grid, std::array<std::string, 1>{"wall"});
  for (FlowTile& tile : c.solver->tiles()) fill_wall_distance(*tile.geometry, wall);
  if (from_rest) c.solver->start([](const Eigen::Vector3d&) { return gas::Primitive<double>{}; });
  c.prepare();
  c.run();
  const MarchState& m = c.solver->march();
  Left left{true, m.now.density, m.first.density, m.cfl, m.rejections, m.verdict, m.why};
  for (const FlowTile& tile : c.solver->tiles())
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; ++i) {
        const double* at = tile.state.data() + tile.cells.at(k, j, i);
        const auto q = gas::load_primitive<double>(at, std::size_t(tile.cells.component));
        left.sound = left.sound && gas::absolute_pressure(s.gas, q) > 0.0 && gas::absolute_temperature(s.gas, q) > 0.0 &&
                     std::isfinite(q.u + q.v + q.w);
        for (int t = 0; t < tile.turbulence; ++t)
          left.sound = left.sound && at[(mean_unknowns + t) * tile.cells.component] >= 0.0;
      }
    });
  return left;
}

void check(const Left& left) {
  CAPTURE(left.verdict, left.why, left.cfl, left.rejections, left.residual, left.first);
  CHECK(left.sound);
  CHECK(std::isfinite(left.residual));
  // It went on, or it says why it gave up.
  if (left.verdict == Verdict::failed) {
    CHECK(left.rejections > 0);
    CHECK(!left.why.empty());
  } else {
    CHECK(left.residual <= left.first);
  }
}

}  // namespace

TEST_CASE("an aerofoil put into wind at Mach 0.3 with any CFL number: it converges or backs off", "[flow][extremes][fast]") {
  const double cfl = GENERATE(0.1, 5.0, 1e3, 1e5);
  CAPTURE(cfl);
  const Left left = march(naca0012({.n = 1}), 0.3, false, cfl, 25);
  check(left);
}

TEST_CASE("wind at Mach 0.9 breaks into air at rest round an aerofoil: it converges or backs off", "[flow][extremes][fast]") {
  const double cfl = GENERATE(0.1, 5.0, 1e5);
  CAPTURE(cfl);
  check(march(naca0012({.n = 1}), 0.9, true, cfl, 25));
}

TEST_CASE("two equations of turbulence survive an impulsive start", "[flow][extremes][fast]") {
  check(march(naca0012({.n = 1}), 0.3, false, 1e3, 25, "sst"));
}

TEST_CASE("a wing put into wind at Mach 0.3 converges", "[flow][extremes][nightly]") {
  const Left left = march(extruded(naca0012({.n = 1}), 4, 0.5, false), 0.3, false, 5.0, 120);
  check(left);
  CHECK(left.verdict == Verdict::converged);
  CHECK(left.residual <= 1e-4 * left.first);
}
