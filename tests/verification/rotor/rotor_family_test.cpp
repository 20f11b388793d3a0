// The DTU 10-MW rotor with friction on a family of grids at 11 and 8 m/s, tip-speed ratio 7.5, against the 2013 report (Bak et
// al., DTU Wind Energy I-0092: 1507.4 kN and 9698 kW, 797.3 kN and 3731 kW) and blade element momentum along the span: orders,
// Richardson values, dT/dU. Each grid's march begins with the flow of the one before; 8 m/s with that of 11 m/s scaled to it.
// Printed as it goes, the table of docs/developer/rotor_resolved.md. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <string>

#include "kernels/base/constants.hpp"
#include "src/aero/coarse_start.hpp"
#include "tests/verification/rotor/bem_rows.hpp"

using namespace spindrift;
using namespace spindrift::aero;

namespace {

constexpr double tip_radius = 89.166;

ResolvedRotorSetup setup(double resolution, double wind, double rpm, int steps) {
  ResolvedRotorSetup s;
  s.grid.resolution = resolution, s.grid.sectors = "one", s.grid.first_cell_chords = 5.8e-4 / resolution;
  // Far sides at six and five tip radii: at three, air that the rotor pushes aside comes back through it (docs/developer/rotor_resolved.md).
  s.grid.radial_extent = 6.0, s.grid.upstream_extent = 5.0;
  s.grid.cells_outboard = int(std::lround(6.9 * resolution)), s.grid.cells_upstream = int(std::lround(5.0 * resolution));
  s.rotor.turbine = std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/turbines/dtu_10mw.toml";
  s.rotor.hub_m = {0.0, 0.0, 119.0}, s.rotor.speed = rpm * pi / 30.0;
  s.wind = {wind, 0.0, 0.0};
  s.flow.time = "steady", s.flow.turbulence = "sa", s.flow.blades = Condition::wall_law;
  s.flow.cfl = 2.0, s.flow.cfl_max = 1000.0, s.flow.drop = 0.0, s.flow.max_pseudo_steps = steps;
  return s;
}

/// Means of the last pseudo-steps; where flow separates at the thick root sections, loads go on swinging.
struct Point {
  double thrust = 0.0, power = 0.0;  ///< [N], [W]
  double swing = 0.0, creep = 0.0;   ///< of the thrust: largest less smallest there, and the second half's mean over the first's
  long cells = 0;
  double worst = 0.0;  ///< normal force off blade element momentum between 30 and 90 % of the span
};
constexpr std::size_t averaged = 30;

Point march(ResolvedRotor& rotor, double wind, const std::string& name) {
  const std::clock_t begin = std::clock();
  rotor.prepare(MPI_COMM_SELF);
  rotor.run();
  const March& m = rotor.solver().march();
  CAPTURE(name, m.why(), m.rejections());
  CHECK(m.verdict() == Verdict::converged);
  const auto& rows = rotor.solver().rows();
  REQUIRE(rows.size() > averaged);
  Point p{.cells = rotor.solver().cells()};
  double low = 1e30, high = 0.0, half[2] = {0.0, 0.0};
  for (std::size_t n = 0; n < averaged; ++n) {
    const RotorLoad load = rotor.load(rows[rows.size() - averaged + n]);
    p.thrust += load.thrust / averaged, p.power += load.power / averaged, half[2 * n / averaged] += load.thrust;
    low = std::min(low, load.thrust), high = std::max(high, load.thrust);
  }
  p.swing = (high - low) / p.thrust, p.creep = half[1] / half[0] - 1.0;
  fmt::print(
      "{}: {} cells, {} steps, CFL {:.0f}, residual fallen by {:.2g}, {:.0f} s of CPU\n  thrust {:.1f} kN, power {:.0f} kW; "
      "thrust swings by "
      "{:.2f} % and creeps by {:+.2f} % in 15 steps\n",
      name, p.cells, m.steps() - 1, m.cfl(), m.density_residual() / m.first_density_residual(),
      double(std::clock() - begin) / CLOCKS_PER_SEC, 1e-3 * p.thrust, 1e-3 * p.power, 100.0 * p.swing, 100.0 * p.creep);
  for (const SpanLoad& row : rotor.span_loads(MPI_COMM_SELF)) {
    const double share = row.radius / tip_radius;
    const testing::BemLoad bem = testing::bem_load(row.radius, wind);
    fmt::print("  r/R {:.3f}: normal {:7.1f} ({:+6.1f} %), tangential {:7.1f} (BEM {:7.1f}), friction {:6.1f} N/m\n", share,
               row.load.normal, 100.0 * (row.load.normal / bem.normal - 1.0), row.load.tangential, bem.tangential,
               row.friction.tangential);
    if (share > 0.3 && share < 0.9) p.worst = std::max(p.worst, std::abs(row.load.normal / bem.normal - 1.0));
  }
  std::fflush(stdout);
  return p;
}

/// A flow of the same tip-speed ratio in another wind: velocities with the wind, pressures and temperatures with its square.
void scale(FlowSolver& solver, double factor) {
  for (FlowTile& tile : solver.tiles())
    for (int c = 0; c < tile.unknowns(); ++c)
      for_rows(tile.box, [&](int k, int j) {
        double* at = tile.state.data() + c * tile.cells.component + tile.cells.at(k, j, 0);
        for (int i = 0; i < tile.box.ni; ++i) at[i] *= c == 0 || c == 4 ? factor * factor : factor;
      });
}

/// Of three grids whose sizes go by one ratio: observed order and the value it leads to; no order where differences do not
/// shrink.
struct Limit {
  double order, value;
};
Limit richardson(double coarse, double medium, double fine, double ratio) {
  const double first = medium - coarse, second = fine - medium, order = std::log(std::abs(first / second)) / std::log(ratio);
  return {order, fine + second / (std::pow(ratio, order) - 1.0)};
}

}  // namespace

TEST_CASE("the rotor with friction on a family of grids at 11 and 8 m/s: thrust, power, loads along the span, their limits",
          "[rotor][long]") {
  constexpr std::array<double, 3> resolutions{1.6, 2.1, 2.75};
  constexpr std::array<int, 3> steps{240, 120, 100}, steps_scaled{50, 40, 40};
  constexpr double ratio = 1.31, rpm = 8.836;
  std::array<Point, 3> at11, at8;
  std::unique_ptr<ResolvedRotor> last;
  double slope = 0.0;
  for (std::size_t n = 0; n < resolutions.size(); ++n) {
    auto rotor = std::make_unique<ResolvedRotor>(setup(resolutions[n], 11.0, rpm, steps[n]));
    rotor->solver().start_uniform();
    if (last) interpolate(*last, *rotor);
    at11[n] = march(*rotor, 11.0, fmt::format("n = {}, 11 m/s", resolutions[n]));
    {
      ResolvedRotor slower(setup(resolutions[n], 8.0, rpm * 8.0 / 11.0, steps_scaled[n]));
      slower.solver().start_from(rotor->solver());
      scale(slower.solver(), 8.0 / 11.0);
      at8[n] = march(slower, 8.0, fmt::format("n = {}, 8 m/s", resolutions[n]));
    }
    if (n == 1) {  // more wind at the same speed of rotation
      ResolvedRotor more(setup(resolutions[n], 11.5, rpm, 100));
      more.solver().start_from(rotor->solver());
      more.solver().add_velocity([](const Eigen::Vector3d&) { return Eigen::Vector3d(0.5, 0.0, 0.0); });
      slope = (march(more, 11.5, "n = 2.1, 11.5 m/s").thrust - at11[n].thrust) / 0.5;
      fmt::print("dT/dU {:.1f} kN per m/s\n", 1e-3 * slope);
    }
    last = std::move(rotor);
  }
  const auto limit = [&](const char* what, const std::array<Point, 3>& p, double Point::*value, double unit) {
    const Limit l = richardson(p[0].*value, p[1].*value, p[2].*value, ratio);
    fmt::print("{}: {:.1f}, {:.1f}, {:.1f}; order {:.2f}, limit {:.1f}\n", what, unit * (p[0].*value), unit * (p[1].*value),
               unit * (p[2].*value), l.order, unit * l.value);
  };
  limit("thrust at 11 m/s [kN]", at11, &Point::thrust, 1e-3);
  limit("power at 11 m/s [kW]", at11, &Point::power, 1e-3);
  limit("thrust at 8 m/s [kN]", at8, &Point::thrust, 1e-3);
  limit("power at 8 m/s [kW]", at8, &Point::power, 1e-3);
  std::fflush(stdout);
  CHECK(at11[2].thrust == Approx(1507.4e3).epsilon(0.05));
  CHECK(at11[2].power == Approx(9698e3).epsilon(0.08));
  CHECK(at11[2].worst < 0.10);
  CHECK(at8[2].thrust == Approx(797.3e3).epsilon(0.05));
  CHECK(at8[2].power == Approx(3731e3).epsilon(0.08));
  CHECK(at8[2].worst < 0.10);
  CHECK(slope == Approx(162e3).epsilon(0.15));
}
