// Grids that follow walls: rigid motions to round-off, no fold where other ways fold or lean, a uniform stream stays one, lift by
// a turned aerofoil is lift by a turned wind. SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid_motion.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>

#include "kernels/base/constants.hpp"
#include "src/aero/grid/checks.hpp"
#include "src/aero/grid/generators/plane_cases.hpp"
#include "src/aero/grid/node_field.hpp"
#include "src/aero/grid/quality.hpp"
#include "src/scene/error.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;
using Eigen::Vector3d;

namespace {

const std::vector<std::string> outer{"farfield", "outflow"};

GridMotionOptions pitching(double degrees, double amplitude_degrees = 0.0) {
  GridMotionOptions o;
  o.patches = {"wall"};
  o.centre_m = {0.25, 0.0, 0.0};
  o.pitch = degrees * radians_per_degree, o.pitch_amplitude = amplitude_degrees * radians_per_degree;
  return o;
}
/// Cells with a corner that is folded, and the worst scaled Jacobian.
struct Judged {
  std::size_t faults;
  double jacobian;
};
Judged judged(const MultiBlockGrid& grid) { return {grid_faults(grid).size(), grid_quality(grid).scaled_jacobian.value}; }

/// Displacements of the wall spread along the lines that leave it, by arc length; along the wake they fade by distance.
MultiBlockGrid transfinite(const MultiBlockGrid& made, const TurnAndShift& motion) {
  MultiBlockGrid grid = made;
  Block& b = grid.blocks[0];
  const auto on_wall = [&](const Vector3d& x) { return x[0] <= 1.0 + 1e-12; };
  const Vector3d edge(1.0, 0.0, 0.0), far = b.nodes[b.node(0, 0, 0)];
  for (int k = 0; k <= 1; ++k)
    for (int i = 0; i <= b.ni; ++i) {
      const Vector3d start = made.blocks[0].nodes[b.node(k, 0, i)];
      const double fades = on_wall(start) ? 1.0 : 1.0 - (start[0] - edge[0]) / (far[0] - edge[0]);
      const Vector3d from = on_wall(start) ? start : edge + Vector3d(0.0, start[1], 0.0);
      const Vector3d displacement = fades * (moved(motion, 1.0, from) - from);
      std::vector<double> arc(1, 0.0);
      for (int j = 1; j <= b.nj; ++j)
        arc.push_back(arc.back() + (made.blocks[0].nodes[b.node(k, j, i)] - made.blocks[0].nodes[b.node(k, j - 1, i)]).norm());
      for (int j = 0; j <= b.nj; ++j) b.nodes[b.node(k, j, i)] += (1.0 - arc[std::size_t(j)] / arc.back()) * displacement;
    }
  return grid;
}
/// Displacements as three fields of their own.
MultiBlockGrid by_components(const MultiBlockGrid& made, const TurnAndShift& motion) {
  MultiBlockGrid grid = made;
  NodeField field(made, {"wall", "farfield", "outflow"}, std::vector<std::string>{"wall"});
  for (const int d : {0, 2}) {
    const NodeField::Values f =
        field.solve([&](int patch, const Vector3d& x) { return patch == 0 ? (moved(motion, 1.0, x) - x)[d] : 0.0; });
    for (std::size_t n = 0; n < f[0].size(); ++n) grid.blocks[0].nodes[n][d] += f[0][n];
  }
  return grid;
}

}  // namespace

TEST_CASE("a grid all of whose patches move, moves rigidly to round-off; one that is held keeps what is held to the bit",
          "[grid][fast]") {
  const MultiBlockGrid grid = naca0012({.n = 1, .far = 20.0});
  GridMotionOptions o = pitching(25.0);
  o.patches = {"wall", "farfield", "outflow"};
  o.heave_m = {0.1, 0.0, 0.3}, o.heave_phase = 0.5 * pi;
  for (const bool as_one : {true, false}) {
    o.grid = as_one ? "rigid" : "elliptic";
    const GridMotion motion(grid, o, {}, {});
    const MultiBlockGrid to = motion.moved_grid(0.0);
    double apart = 0.0;
    for (std::size_t n = 0; n < grid.blocks[0].nodes.size(); ++n) {
      const Vector3d &a = grid.blocks[0].nodes[n], &b = grid.blocks[0].nodes[n / 2];
      apart = std::max(apart, std::abs((to.blocks[0].nodes[n] - to.blocks[0].nodes[n / 2]).norm() - (a - b).norm()));
    }
    CHECK(apart < 1e-13);
    CHECK((to.blocks[0].nodes[0] - moved(motion.at(0.0), 1.0, grid.blocks[0].nodes[0])).norm() == 0.0);
  }
  const GridMotion held(grid, pitching(25.0), outer, {});
  const MultiBlockGrid to = held.moved_grid(0.0);
  const Block &b = grid.blocks[0], &c = to.blocks[0];
  for (int i = 0; i <= b.ni; ++i) CHECK(c.nodes[c.node(0, b.nj, i)] == b.nodes[b.node(0, b.nj, i)]);
  const int nose = b.ni / 2;
  CHECK((c.nodes[c.node(0, 0, nose)] -
         Vector3d(0.25 - 0.25 * std::cos(25.0 * radians_per_degree), 0.0, 0.25 * std::sin(25.0 * radians_per_degree)))
            .norm() < 1e-12);
}

TEST_CASE(
    "an aerofoil turned inside a grid that is held: no cell folds, and cells at the wall keep their shape better than by "
    "displacements",
    "[grid][fast]") {
  const MultiBlockGrid grid = naca0012({.n = 2, .far = 20.0});
  const Judged before = judged(grid);
  std::cout << "turned aerofoil, 224 x 64: scaled Jacobian " << before.jacobian << " as made\n";
  for (const double degrees : {15.0, 30.0, 45.0}) {
    const TurnAndShift motion = {Vector3d(0.0, degrees * radians_per_degree, 0.0), {0.25, 0.0, 0.0}, Vector3d::Zero()};
    const GridMotion by_shares(grid, pitching(degrees), outer, {});
    const Judged shares = judged(by_shares.moved_grid(0.0)), components = judged(by_components(grid, motion)),
                 algebraic = judged(transfinite(grid, motion));
    std::cout << "  " << degrees << " deg: shares " << shares.jacobian << ", components " << components.jacobian << " ("
              << components.faults << " faults), transfinite " << algebraic.jacobian << " (" << algebraic.faults << " faults); "
              << by_shares.description() << "\n";
    CHECK(shares.faults == 0);
    CHECK(shares.jacobian > algebraic.jacobian);
    CHECK(shares.jacobian > components.jacobian);
    if (degrees == 15.0) CHECK(shares.jacobian > 0.9 * before.jacobian);
  }
}

TEST_CASE("a uniform stream stays one while a grid follows an aerofoil that pitches and heaves", "[grid][fast]") {
  FlowSetting s = air(0.2, {1.0, 0.0, 0.3});
  GridMotionOptions o = pitching(3.0, 12.0);
  o.heave_m = {0.0, 0.0, 0.1}, o.heave_phase = 1.0, o.period_s = 0.2;
  s.time_order = 2, s.dt = o.period_s / 20.0;
  s.march = {.drop = 0.0, .max_steps = 2, .krylov_steps = 10, .matrix_free_below = 0.0};
  Case c(naca0012({.n = 1, .far = 20.0}), s, {}, {}, 1, 0, true);
  const GridMotion motion(c.grid, o, outer, {});
  c.solver->motion().place(motion.poses(-s.dt), motion.poses(0.0));
  c.prepare();
  for (int n = 1; n <= 10; ++n) {
    c.solver->motion().move_to(motion.poses(n * s.dt));
    c.run();
  }
  const double of_bound = stream_deviation(*c.solver) / 1e-12;  // printed with digits
  CHECK(of_bound < 1.0);
}

namespace {
/// Lift across the wind and steps of an inviscid march, aerofoil turned by `turned` in a wind turned by `wind` degrees.
double lift(double wind, double turned) {
  const double a = wind * radians_per_degree;
  FlowSetting s = air(0.2, {std::cos(a), 0.0, std::sin(a)});
  s.march.drop = 1e-4, s.march.max_steps = 300, s.march.cfl_start = 20.0;
  const MultiBlockGrid made = naca0012({.n = 1, .far = 20.0, .first_cell = 4e-3});
  const GridMotion motion(made, pitching(turned), outer, {});
  Case c(motion.moved_grid(0.0), s, {{"wall", {Condition::slip, true}}});
  c.prepare();
  c.run();
  REQUIRE(c.solver->march().verdict == Verdict::converged);
  const auto& f = c.solver->rows().back().force;
  return (std::cos(a) * f[2] - std::sin(a) * f[0]) / (0.5 * gas::density(s.gas, s.stream) * s.speed * s.speed);
}
}  // namespace

TEST_CASE("an aerofoil turned inside its grid lifts as the grid as made does in a wind turned the other way", "[grid][fast]") {
  const double by_wind = lift(3.0, 0.0), by_turn = lift(0.0, 3.0);
  CAPTURE(by_wind, by_turn);
  CHECK(by_wind > 0.3);
  CHECK(by_turn == Approx(by_wind).epsilon(0.01));
}

TEST_CASE("motions that a grid cannot follow are refused with the reason", "[grid][fast]") {
  const MultiBlockGrid grid = naca0012({.n = 1, .far = 20.0});
  GridMotionOptions o = pitching(0.0);
  o.patches = {"blade"};
  CHECK_THROWS_WITH(GridMotion(grid, o, outer, {}), Catch::Contains("no patch \"blade\"; it has: wall, farfield, outflow"));
  o = pitching(0.0);
  o.heave_m = {0.0, 0.0, 30.0};
  CHECK_THROWS_WITH(GridMotion(grid, o, outer, {}), Catch::Contains("cells fold"));
  const MultiBlockGrid wing = extruded(grid, 2, 1.0, false);
  o = pitching(5.0);
  GridMotion(wing, o, outer, {"sides"});
  o.axis = {1.0, 0.0, 0.0};
  CHECK_THROWS_WITH(GridMotion(wing, o, outer, {"sides"}), Catch::Contains("out of its plane"));
}

TEST_CASE("a planar grid keeps to its plane", "[flow][fast]") {
  const MultiBlockGrid grid = naca0012({.n = 1});
  for (const char* way : {"rigid", "elliptic"}) {
    GridMotionOptions o = pitching(5.0);
    o.grid = way, o.axis = {0.0, -2.0, 0.0};
    CHECK_NOTHROW(GridMotion(grid, o, outer, {}));
    o.axis = {1.0, 0.0, 0.0};
    CHECK_THROWS_WITH(GridMotion(grid, o, outer, {}), Catch::Contains("aero.flow.motion.axis") && Catch::Contains("along y"));
    o.axis = {0.0, 1.0, 0.0}, o.heave_m = {0.0, 0.1, 0.1};
    CHECK_THROWS_WITH(GridMotion(grid, o, outer, {}), Catch::Contains("aero.flow.motion.heave_amplitude_m"));
  }
}
