// Vortex shedding of a circular cylinder at Re 100: frequency after Williamson (1996), Annu. Rev. Fluid Mech. 28, 477: St =
// 0.2665 - 1.018 / sqrt(Re) = 0.1647 (0.164 to 0.166 in the literature); mean drag 1.32 to 1.38 and lift of amplitude 0.31 to
// 0.35 in computations. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "src/aero/grid/generators/plane_cases.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

/// The program's O grid with its lines gathered behind the cylinder, where they are (1 - gather) of the mean distance apart: it
/// is the street that asks for cells.
MultiBlockGrid ring(int around, double gather) {
  MultiBlockGrid grid =
      aero::cylinder({.around = around, .outward = around * 4 / 7, .radius = 0.5, .far = 30.0, .first_cell = 0.03});
  for (Eigen::Vector3d& x : grid.blocks[0].nodes) {
    const double r = std::hypot(x[0], x[2]), even = std::atan2(x[2], x[0]), angle = even - gather * std::sin(even);
    x[0] = r * std::cos(angle), x[2] = r * std::sin(angle);
  }
  return grid;
}

}  // namespace

TEST_CASE("a cylinder at Re 100 sheds vortices at Strouhal number 0.164 to 0.166", "[flow][nightly]") {
  FlowSetting s = air(0.1);
  const double rho = gas::density(s.gas, s.stream), q = 0.5 * rho * s.speed * s.speed;
  s.gas.viscosity = {.mu0 = rho * s.speed / 100.0, .T0 = 288.15, .S = 110.33};
  s.viscous = true;
  s.time_order = 2;
  const double settling = 100.0, shedding = 55.0;              // diameters of stream
  const double coarse = 0.3 / s.speed, fine = 0.02 / s.speed;  // at 0.06, a hundred a period, BDF2 slows it by 0.1 %
  s.dt = coarse;
  s.march.cfl_start = 100.0, s.march.drop = 1e-2, s.march.max_steps = 40, s.march.matrix_free_below = 2.0;
  s.upwinding = 0.25;  // with the flux's whole dissipation this grid gives 0.1632, the next 0.1637
  Case c(ring(112, 0.5), s, {{"wall", {Condition::no_slip, true}}, {"farfield", {Condition::far_field, false}}});
  // A push to one side in the wake, so that shedding sets in at once.
  c.solver->start([&](const Eigen::Vector3d& x) {
    gas::Primitive<double> p = s.stream;
    p.w += 0.6 * s.speed * std::exp(-(x[0] - 2.0) * (x[0] - 2.0) - x[2] * x[2]);
    return p;
  });
  c.prepare();
  std::vector<double> time, lift, drag;
  int steps = 0;
  const auto advance = [&](double until, double dt) {
    for (double t = time.empty() ? 0.0 : time.back(); t < until - 0.5 * dt;) {
      c.run();
      REQUIRE(c.solver->march().verdict == Verdict::converged);
      REQUIRE(!c.solver->march().spent);  // two orders within 40 pseudo-steps
      t += dt, steps += c.solver->march().steps;
      const PseudoRow& row = c.solver->rows().back();
      time.push_back(t), lift.push_back(row.force[2] / q), drag.push_back(row.force[0] / q);
      c.solver->judgement().rows.all.clear();
    }
  };
  advance(settling / s.speed, coarse);
  c.solver->set_time_step(fine, coarse);
  const std::size_t settled = time.size();
  advance((settling + shedding) / s.speed, fine);
  std::vector<double> crossings;  // upward, after three periods: what the coarse steps left fades over two
  double mean = 0.0, largest = 0.0, weight = 0.0;
  for (std::size_t n = settled + 900; n < time.size(); ++n)
    if (lift[n - 1] < 0.0 && lift[n] >= 0.0)
      crossings.push_back(time[n - 1] + (time[n] - time[n - 1]) * lift[n - 1] / (lift[n - 1] - lift[n]));
  REQUIRE(crossings.size() >= 4);
  for (std::size_t n = 0; n < time.size(); ++n)
    if (time[n] >= crossings.front() && time[n] < crossings.back())
      mean += drag[n], weight += 1.0, largest = std::max(largest, std::abs(lift[n]));
  mean /= weight;
  const double period = (crossings.back() - crossings.front()) / double(crossings.size() - 1);
  const double strouhal = 1.0 / (period * s.speed);
  const double first = crossings[1] - crossings[0], last = crossings.back() - crossings[crossings.size() - 2];
  CAPTURE(strouhal, mean, largest, steps, first / last);
  CHECK(strouhal > 0.164);
  CHECK(strouhal < 0.166);
  CHECK(first == Approx(last).epsilon(1.5e-3));  // settled
  CHECK(mean == Approx(1.345).margin(0.03));
  CHECK(largest == Approx(0.33).margin(0.02));
}
