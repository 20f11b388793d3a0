// Inviscid flow round a circular cylinder from Mach 0.1 to 1e-5 on one grid: potential flow in the limit, no drag, a pressure
// that varies with M^2 and not with M, no alternating pressure, steps that do not grow. Rieper (2011), J. Comput. Phys. 230,
// section 5; Guillard & Viozat (1999), Comput. Fluids 28, 63, for the M^2. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include <algorithm>
#include <numbers>

#include "tests/order.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

/// An O of `around` by `out` cells, radius 0.5 m to `far`, spacing growing with the radius; i round from downstream through +z.
MultiBlockGrid o_grid(int around, int out, double far) {
  MultiBlockGrid grid;
  grid.planar = true;
  grid.blocks.push_back(mapped_block("ring", around, out, 1, [&](double u, double v, double w) {
    const double angle = 2 * std::numbers::pi * u, r = 0.5 * std::pow(2.0 * far, v);
    return Eigen::Vector3d(r * std::cos(angle), w, r * std::sin(angle));
  }));
  grid.connections.push_back(
      {.from = {0, Side::i_max, {0, 0}, {out, 1}}, .to = {0, Side::i_min, {0, 0}, {out, 1}}, .orientation = {1, 2, 3}});
  grid.boundaries.push_back({{0, Side::j_min, {0, 0}, {around, 1}}, "wall"});
  grid.boundaries.push_back({{0, Side::j_max, {0, 0}, {around, 1}}, "far"});
  return grid;
}

struct Outcome {
  double pressure_range;  ///< of the static pressure
  double drag, lowest_cp, highest_cp, sawtooth;
  int steps_to_3_orders;
  bool converged;
};

Outcome cylinder(double mach, const std::string& flux, int around = 96) {
  FlowSetting s = air(mach);
  s.flux = flux;
  s.march.drop = 1e-6, s.march.max_steps = 150;
  Case c(o_grid(around, around / 2, 20.0), s, {{"wall", {Condition::slip, true}}, {"far", {Condition::far_field, false}}},
         {.across_j = 48, .across_k = 1, .normal = 48});
  c.prepare();
  c.run();
  const double q = 0.5 * gas::density(s.gas, s.stream) * s.speed * s.speed;
  Outcome r{0, c.solver->rows().back().force[0] / q, 1e9, -1e9, 0, 0, c.solver->march().verdict == Verdict::converged};
  const double first = c.solver->rows().front().density_residual;
  for (const PseudoRow& row : c.solver->rows())
    if (row.density_residual > 1e-3 * first) r.steps_to_3_orders = row.step + 1;
  double saw = 0, count = 0;
  for (const FlowTile& tile : c.solver->tiles())
    for (int j = 0; j < tile.box.nj; ++j)
      for (int i = 0; i < tile.box.ni; ++i) {
        const double* p = tile.state.data() + tile.cells.at(0, j, i);
        const double cp = *p / q;
        r.lowest_cp = std::min(r.lowest_cp, cp), r.highest_cp = std::max(r.highest_cp, cp);
        saw += std::abs(p[-1] - 3 * p[0] + 3 * p[1] - p[2]) / 8.0, count += 1;
      }
  r.pressure_range = (r.highest_cp - r.lowest_cp) * q / s.gas.pressure_reference;
  r.sawtooth = saw / count / q / (r.highest_cp - r.lowest_cp);
  return r;
}

}  // namespace

TEST_CASE("a cylinder in inviscid flow with default settings: pressure with the square of the Mach number, drag without it",
          "[air][nightly]") {
  const std::vector<double> mach{1e-1, 1e-2, 1e-3, 1e-4, 1e-5};
  std::vector<double> range, drag;
  std::vector<int> steps;
  for (const double m : mach) {
    const Outcome r = cylinder(m, "roe_low_mach");
    INFO("M " << m << " range " << r.pressure_range << " CD " << r.drag << " cp " << r.lowest_cp << " ... " << r.highest_cp
              << " sawtooth " << r.sawtooth << " steps to 3 orders " << r.steps_to_3_orders);
    range.push_back(r.pressure_range), drag.push_back(r.drag), steps.push_back(r.steps_to_3_orders);
    CHECK(r.lowest_cp == Approx(-2.75).margin(0.05));  // first centres: 3 % of a radius off the wall, where potential flow has -3
    CHECK(r.highest_cp == Approx(1.0).margin(0.03));
    // Far below Mach 0.01 nothing but the velocities couples neighbouring pressures: a saw of a hundredth of their range stays.
    CHECK(r.sawtooth < (m >= 0.01 ? 5e-3 : 1.2e-2));
    CHECK(r.converged);
    CHECK(std::abs(r.drag) < 0.003);
    CHECK(r.steps_to_3_orders < 25);
  }
  CAPTURE(drag, steps, range);
  CHECK(observed_order(mach, range) == Approx(2.0).margin(0.05));
  for (std::size_t m = 2; m < drag.size(); ++m) CHECK(drag[m] == Approx(drag[2]).margin(1e-4));
  CHECK(std::ranges::max(drag) - std::ranges::min(drag) < 0.002);  // of q D, from Mach 0.1 to 1e-5
  for (const int n : steps) CHECK(n <= 2 * steps[0]);
}

// Beside rho u the mass flux has the jump of the pressure over c: M of it. That is why the drag at 0.1 is above that of the
// limit, by 0.05 % of what cp spans; third-order differences of the pressure take it away as the grid is refined.
TEST_CASE("what drag an inviscid cylinder has above its low-Mach limit at Mach 0.1 falls with the cells", "[air][nightly]") {
  const auto above = [](int around) {
    return cylinder(1e-1, "roe_low_mach", around).drag - cylinder(1e-3, "roe_low_mach", around).drag;
  };
  const double coarse = above(96), fine = above(192);
  CAPTURE(coarse, fine);
  CHECK(std::abs(coarse) < 0.002);
  CHECK(std::abs(fine) < 0.25 * std::abs(coarse));
}
