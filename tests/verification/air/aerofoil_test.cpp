// NACA 0012 at 10 degrees, Mach 0.15, Re 6e6, Spalart-Allmaras, on grids of NASA's Turbulence Modeling Resource
// (inputs/validation/naca0012). SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <optional>

#include "src/aero/flow/transfer.hpp"
#include "src/aero/grid/generators/plane_cases.hpp"
#include "src/aero/grid/wall_distance.hpp"
#include "tests/src/aero/flow/flows.hpp"
#include "tests/verification/air/tmr_grids.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

struct Result {
  double lift, drag, drop;
  Verdict verdict;
  int steps;
  double drift;  ///< of the drag over the last ten steps
};
Case aerofoil_case(MultiBlockGrid grid, double mach, double drop, int steps) {
  const double alpha = 10.0 * std::numbers::pi / 180.0;
  FlowSetting s = air(mach, {std::cos(alpha), 0.0, std::sin(alpha)});
  const double rho = gas::density(s.gas, s.stream);
  s.gas.viscosity = {.mu0 = rho * s.speed / 6e6, .T0 = 288.15, .S = 105.97};
  s.viscous = true;
  s.turbulence = "sa";
  s.march.max_steps = steps;
  s.march.drop = drop;
  Case c(std::move(grid), s,
         {{"wall", {Condition::no_slip, true}},
          {"far", {Condition::far_field, false}},
          {"farfield", {Condition::far_field, false}},
          {"outflow", {Condition::far_field, false}}});
  const WallSurface wall = wall_surface(c.grid, std::array<std::string, 1>{"wall"});
  for (FlowTile& tile : c.solver->tiles()) fill_wall_distance(*tile.geometry, wall);
  c.prepare(MPI_COMM_SELF, {.threads = 2});
  return c;
}
Result result(const Case& c) {
  const double alpha = 10.0 * std::numbers::pi / 180.0;
  const FlowSetting& s = c.solver->setting();
  const std::vector<PseudoRow>& rows = c.solver->rows();
  const double q = 0.5 * gas::density(s.gas, s.stream) * s.speed * s.speed;
  const auto drag = [&](const PseudoRow& row) { return (row.force[0] * std::cos(alpha) + row.force[2] * std::sin(alpha)) / q; };
  const std::array<double, 3>& f = rows.back().force;
  const MarchState& m = c.solver->march();
  return {(f[2] * std::cos(alpha) - f[0] * std::sin(alpha)) / q,
          drag(rows.back()),
          m.density_drop(),
          m.verdict,
          m.steps,
          drag(rows.back()) / drag(rows[rows.size() - std::min<std::size_t>(rows.size(), 11)]) - 1.0};
}
Result aerofoil(MultiBlockGrid grid, double mach, double drop, int steps = 250) {
  Case c = aerofoil_case(std::move(grid), mach, drop, steps);
  c.run();
  return result(c);
}

/// Our own family, 112 x 32 cells and finer: each grid begins with the flow on the one before it, which is every second node of
/// it.
std::vector<Result> family(int members, double drop) {
  std::vector<Result> all;
  std::optional<Case> coarse;
  for (int m = 0; m < members; ++m) {
    Case fine = aerofoil_case(naca0012({.n = 1 << m}), 0.15, drop, 400);
    if (coarse) {
      fine.solver->judgement().march.judge_only();
      fine.run();
      fine.solver->judgement().rows.all.clear();
      transfer(*coarse->solver, *fine.solver);
      fine.solver->judgement().march.begin_after_judging();
    }
    fine.run();
    all.push_back(result(fine));
    const Result& r = all.back();
    std::printf("NACA 0012, %d x %d cells: CL %.5f CD %.6f, drop %.1e in %d steps, drag over the last ten %+.1e\n", 112 << m,
                32 << m, r.lift, r.drag, r.drop, r.steps, r.drift);
    std::fflush(stdout);
    CHECK(r.drop <= drop);
    CHECK(std::abs(r.drift) < 5e-4);
    coarse.emplace(std::move(fine));
  }
  return all;
}

/// What three grids of halved cells tend to: Richardson's limit and order.
struct Limit {
  double value, order;
};
Limit limit(double coarse, double middle, double fine) {
  const double ratio = (middle - coarse) / (fine - middle);
  return {fine + (fine - middle) / (ratio - 1.0), std::log2(ratio)};
}

}  // namespace

TEST_CASE("a coarse aerofoil converges by five orders to its lift", "[flow][fast]") {
  const Result r = aerofoil(tmr_c_grid(SPINDRIFT_SOURCE_DIR, "tmr_112x32"), 0.15, 1e-5);
  CAPTURE(r.lift, r.drag);
  CHECK(r.drop <= 1e-5);
  CHECK(r.lift == Approx(1.0534).epsilon(0.003));  // our own converged value: a change of the scheme shows here
}

// CFL3D there: CL 1.0838, CD .014488; on its finest grid .01231.
TEST_CASE("NACA 0012 on 225 x 65 nodes: lift within two per cent of CFL3D on the same grid, drag within two of its finest",
          "[flow][nightly]") {
  const Result r = aerofoil(tmr_c_grid(SPINDRIFT_SOURCE_DIR, "tmr_224x64"), 0.15, 1e-6);
  CAPTURE(r.lift, r.drag, r.drop);
  CHECK(r.lift == Approx(1.0838).epsilon(0.02));
  CHECK(r.drag == Approx(0.01231).epsilon(0.02));
}

// CFL3D and FUN3D on the finest grids of the resource: CL 1.0909 and 1.0983, CD .01231 and .01242; seven codes within 1 and 4 %.
// The drag's errors at the coarse grids are small and cancel in part: it comes nearer at every step, but not by a single order.
TEST_CASE("NACA 0012 on our own family of grids converges into the spread of seven codes", "[flow][nightly]") {
  const std::vector<Result> r = family(3, 1e-7);
  const Limit lift = limit(r[0].lift, r[1].lift, r[2].lift);
  CAPTURE(lift.value, lift.order);
  std::printf("limit: CL %.5f (order %.2f)\n", lift.value, lift.order);
  CHECK(std::abs(r[2].lift - r[1].lift) < 0.5 * std::abs(r[1].lift - r[0].lift));
  CHECK(lift.value == Approx(1.0946).epsilon(0.01));
  CHECK(lift.order > 1.5);
  CHECK(r[2].lift == Approx(1.0946).epsilon(0.01));
  const auto off = [](const Result& one) { return std::abs(one.drag - 0.01236); };
  CHECK(off(r[1]) < off(r[0]));
  CHECK(off(r[2]) < 0.5 * off(r[1]));
  CHECK(r[0].drag == Approx(0.01236).epsilon(0.04));
  CHECK(r[2].drag == Approx(0.01236).epsilon(0.015));
}
