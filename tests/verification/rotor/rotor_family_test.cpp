// The DTU 10-MW rotor with friction on a family of grids at 11 and 8 m/s, tip-speed ratio 7.5, against the 2013 report (Bak et
// al., DTU Wind Energy I-0092: 1507.4 kN and 9698 kW, 797.3 kN and 3731 kW) and blade element momentum along the span: orders,
// Richardson values, dT/dU. Each grid is marched once for all test cases of a process, so that each case can be run by itself.
// Printed as it goes, the table of docs/developer/notes/rotor_resolved.md. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>
#include <span>
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
  s.grid.resolution = resolution, s.grid.sectors = "one";
  s.grid.cells_layers = int(std::lround(8.0 * resolution)), s.grid.cells_upstream = int(std::lround(7.0 * resolution));
  s.rotor.turbine = std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/turbines/dtu_10mw.toml";
  s.rotor.hub_m = {0.0, 0.0, 119.0}, s.rotor.speed = rpm * pi / 30.0;
  s.wind = {wind, 0.0, 0.0};
  s.flow.time = "steady", s.flow.turbulence = "sa", s.flow.blades = Condition::wall_function;
  s.flow.cfl = 2.0, s.flow.cfl_max = 1000.0, s.flow.drop = 0.0, s.flow.max_pseudo_steps = steps;
  s.flow.preconditioner = "coarse",
  s.flow.group_cells = 16;  // tile by tile alone, air between far sides that far goes on swaying to and fro
  return s;
}

/// For a march that goes on from a flow like its own: Newton's steps from the first, which a drop of the residual would put off.
ResolvedRotorSetup going_on(ResolvedRotorSetup s) {
  s.flow.cfl = 20.0, s.flow.matrix_free_below = 1.0;
  return s;
}

/// Means of the last pseudo-steps; where flow separates at the thick root sections, loads go on swinging.
struct Point {
  double thrust = 0.0, power = 0.0;  ///< [N], [W]
  double swing = 0.0, creep = 0.0;   ///< of the thrust: largest less smallest there, and the second half's mean over the first's
  long cells = 0;
  double worst = 0.0;  ///< normal force off blade element momentum between 30 and 90 % of the span
};
constexpr std::size_t averaged = 40;

Point march(ResolvedRotor& rotor, double wind, const std::string& name) {
  const std::clock_t begin = std::clock();
  rotor.prepare(MPI_COMM_SELF);
  rotor.solver().judgement().rows.watcher = [&](const PseudoRow& row) {  // hours may pass
    if (row.step % 10 != 0) return;
    fmt::print("  {} step {}: CFL {:.0f}, density residual {:.3g}, thrust {:.1f} kN\n", name, row.step, row.cfl,
               row.density_residual, 1e-3 * rotor.load(row).thrust);
    std::fflush(stdout);
  };
  rotor.run();
  rotor.solver().judgement().rows.watcher = {};
  const MarchState& m = rotor.solver().march();
  CAPTURE(name, m.why, m.rejections);
  CHECK(m.verdict == Verdict::converged);
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
      "{:.2f} % and creeps by {:+.2f} % in 20 steps\n",
      name, p.cells, m.steps - 1, m.cfl, m.density_drop(), double(std::clock() - begin) / CLOCKS_PER_SEC, 1e-3 * p.thrust,
      1e-3 * p.power, 100.0 * p.swing, 100.0 * p.creep);
  for (const SpanLoad& row : rotor.span_loads(std::span(rows).last(averaged))) {
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

constexpr double ratio = 1.31, rpm = 8.836;
constexpr std::array<double, 3> resolutions{1.5, 2.0, 2.6};

/// What a grid of the family gives; of the coarser two the flow at 11 m/s.
struct Member {
  Point at11, at8;
  std::unique_ptr<ResolvedRotor> rotor;
};

/// The coarsest grid begins with the wind, the next with the flow of the coarsest, the finest, whose case is to run by itself,
/// with that of a grid of half its resolution; 8 m/s with the flow of 11 m/s scaled to it.
Member& member(std::size_t n) {
  static std::array<std::optional<Member>, 3> family;
  if (family[n]) return *family[n];
  constexpr std::array<int, 3> steps{140, 100, 110};
  constexpr int coarse_steps = 140, steps_scaled = 60;
  ResolvedRotorSetup s = setup(resolutions[n], 11.0, rpm, steps[n]);
  if (n > 0) s.flow.matrix_free_below = 0.1;  // a coarser grid's flow has a tenth of the residual that the wind has
  Member m{.at11 = {}, .at8 = {}, .rotor = std::make_unique<ResolvedRotor>(s)};
  m.rotor->solver().start_uniform();
  if (n == 1) interpolate(*member(0).rotor, *m.rotor);
  if (n == 2) {
    const RotorLoad coarse = start_from_coarser(setup(resolutions[n], 11.0, rpm, steps[n]), coarse_steps, *m.rotor);
    fmt::print("half of n = {}: thrust {:.1f} kN, power {:.0f} kW\n", resolutions[n], 1e-3 * coarse.thrust, 1e-3 * coarse.power);
  }
  m.at11 = march(*m.rotor, 11.0, fmt::format("n = {}, 11 m/s", resolutions[n]));
  ResolvedRotor slower(going_on(setup(resolutions[n], 8.0, rpm * 8.0 / 11.0, steps_scaled)));
  slower.solver().start_from(m.rotor->solver());
  scale(slower.solver(), 8.0 / 11.0);
  m.at8 = march(slower, 8.0, fmt::format("n = {}, 8 m/s", resolutions[n]));
  if (n == 2) m.rotor.reset();  // no one asks for its flow
  family[n] = std::move(m);
  return *family[n];
}

/// Of three grids whose sizes go by one ratio: observed order and the value it leads to; no order where differences do not
/// shrink.
struct Limit {
  double order, value;
};
Limit richardson(double coarse, double medium, double fine) {
  const double first = medium - coarse, second = fine - medium, order = std::log(std::abs(first / second)) / std::log(ratio);
  return {order, fine + second / (std::pow(ratio, order) - 1.0)};
}

}  // namespace

TEST_CASE(
    "the rotor with friction on the finest grid of the family has the published thrust and power at 11 and 8 m/s, and the loads "
    "of blade elements along the span",
    "[rotor][long]") {
  const Member& m = member(2);
  CHECK(m.at11.thrust == Approx(1507.4e3).epsilon(0.05));
  CHECK(m.at11.power == Approx(9698e3).epsilon(0.08));
  CHECK(m.at11.worst < 0.10);
  CHECK(m.at8.thrust == Approx(797.3e3).epsilon(0.05));
  CHECK(m.at8.power == Approx(3731e3).epsilon(0.08));
  CHECK(m.at8.worst < 0.10);
}

TEST_CASE("thrust grows with the wind at fixed speed of rotation as that of blade elements does", "[rotor][long]") {
  ResolvedRotor more(going_on(setup(resolutions[1], 11.5, rpm, 80)));
  more.solver().start_from(member(1).rotor->solver());
  add_velocity(more.solver().tiles(), [](const Eigen::Vector3d&) { return Eigen::Vector3d(0.5, 0.0, 0.0); });
  const double slope = (march(more, 11.5, "n = 2.1, 11.5 m/s").thrust - member(1).at11.thrust) / 0.5;
  fmt::print("dT/dU {:.1f} kN per m/s\n", 1e-3 * slope);
  CHECK(slope == Approx(162e3).epsilon(0.15));
}

TEST_CASE("thrust and power of the rotor with friction converge with the grid", "[rotor][long]") {
  const auto limit = [&](const char* what, Point Member::*wind, double Point::*value, double unit) {
    std::array<double, 3> of{};
    for (std::size_t n = 0; n < 3; ++n) of[n] = unit * (member(n).*wind.*value);
    const Limit l = richardson(of[0], of[1], of[2]);
    fmt::print("{}: {:.1f}, {:.1f}, {:.1f}; order {:.2f}, limit {:.1f}\n", what, of[0], of[1], of[2], l.order, l.value);
    CAPTURE(what, l.order, l.value);
    CHECK(std::abs(of[2] - of[1]) < std::abs(of[1] - of[0]));
  };
  limit("thrust at 11 m/s [kN]", &Member::at11, &Point::thrust, 1e-3);
  limit("power at 11 m/s [kW]", &Member::at11, &Point::power, 1e-3);
  limit("thrust at 8 m/s [kN]", &Member::at8, &Point::thrust, 1e-3);
  limit("power at 8 m/s [kW]", &Member::at8, &Point::power, 1e-3);
}
