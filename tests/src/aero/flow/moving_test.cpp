// Moving grids in the march: a uniform stream stays one whatever the grid does, also where cells are 1e5 times longer than high;
// BDF2 and BDF3 keep their order; a frame that turns sees the flow that a turning grid sees; restarts keep every bit.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/order.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;
using Eigen::Vector3d;

namespace {

BlockPose turned(const Vector3d& turn, const Vector3d& shift) {
  BlockPose pose;
  if (turn.norm() > 0.0) pose.map.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  pose.map.translation = shift;
  return pose;
}

/// A sheared box of 6^3 cells whose height is `ratio` of its other sides.
MultiBlockGrid thin_box(double ratio) {
  const BoxOptions box{.ni = 6, .nj = 6, .nk = 6};
  MultiBlockGrid grid = perturbed(cartesian_box(box), box, 0.05);
  for (Block& b : grid.blocks)
    for (Vector3d& x : b.nodes) x = Vector3d(x[0] + 0.3 * x[1], x[1] + 0.2 * x[2], ratio * (x[2] + 0.3 * x[0]));
  return grid;
}

/// A uniform stream for so many steps of a grid that turns, flies and (where asked) deforms: its deviation over the bound, which
/// is 1e-12 times the larger of one and a thousandth of the acoustic CFL number.
double free_stream(double ratio, double acoustic_cfl, int steps, bool deforms, int order = 2) {
  FlowSetting s = air(0.3, {0.3, -0.5, 0.8});
  const double c = s.speed / 0.3, height = ratio / 6.0;
  s.time_order = order, s.dt = acoustic_cfl * height / c;
  s.march = {.drop = 0.0, .max_steps = 2, .krylov_steps = 10, .matrix_free_below = 0.0};
  Case run(thin_box(ratio), s, {}, {.across_j = 3, .across_k = 6, .normal = 6}, 1, 0, true);
  run.prepare();
  for (int n = 1; n <= steps; ++n) {
    const double t = n * s.dt;
    // Tips move at about a fifth of the sound speed whatever the step.
    BlockPose pose = turned(Vector3d(0.3, 0.1, -0.5) * (0.3 * c * t), Vector3d(0.1, 0.2, -0.05) * (c * t));
    if (deforms)
      pose.shape = [t, c, ratio](const Vector3d& x) -> Vector3d {
        return x + Vector3d(0.03 * std::sin(c * t + 3.0 * x[1]), 0.03 * std::sin(2.0 * x[0] - c * t),
                            ratio * 0.05 * std::sin(c * t + 2.0 * x[0]));
      };
    run.solver->motion().move_to({pose});
    run.run();
  }
  return stream_deviation(*run.solver) / (1e-12 * std::max(1.0, acoustic_cfl * 1e-3));
}

}  // namespace

TEST_CASE("a uniform wind that gusts and turns stays uniform, at rest in pressure and temperature", "[flow][fast]") {
  const int order = GENERATE(1, 2, 3);
  FlowSetting s = air(0.05);
  s.time_order = order, s.dt = 0.01 / s.speed;
  s.march = {
      .cfl_start = 1000.0, .drop = 1e-11, .by_balance = true, .max_steps = 60, .krylov_drop = 0.01, .matrix_free_below = 2.0};
  const BoxOptions box{.ni = 6, .nj = 6, .nk = 6};
  const PatchCondition open{Condition::far_field, false};
  Case run(perturbed(cartesian_box(box), box, 0.05), s,
           {{"i_min", open}, {"i_max", open}, {"j_min", open}, {"j_max", open}, {"k_min", open}, {"k_max", open}});
  run.prepare();
  const auto wind = [&](double t) -> Vector3d {
    const double share = 1.0 + 0.2 * std::sin(20.0 * s.speed * t), turn = 0.3 * std::sin(15.0 * s.speed * t);
    return share * s.speed * Vector3d(std::cos(turn), std::sin(turn), 0.1 * turn);
  };
  for (int n = 1; n <= 8; ++n) {
    const double t = n * s.dt;
    run.solver->set_wind({[&, t](const Vector3d&, double ago) { return wind(t - ago); }, {}});
    run.run();
    double off = 0.0;
    for (const FlowTile& tile : run.solver->tiles())
      for_rows(tile.box, [&](int k, int j) {
        for (int i = 0; i < tile.box.ni; ++i) {
          const double* at = tile.state.data() + tile.cells.at(k, j, i);
          const std::ptrdiff_t c = tile.cells.component;
          off = std::max({off, (Vector3d(at[c], at[2 * c], at[3 * c]) - wind(t)).norm() / s.speed,
                          std::abs(at[0]) / (s.gas.pressure_reference * 0.05 * 0.05), std::abs(at[4 * c])});
        }
      });
    CAPTURE(n, order, run.solver->march().balance_drop());
    CHECK(off < 1e-8);
  }
}

namespace {

/// How far the air in the middle of a box that rises and rolls is off a wind along x that gusts the more the higher, of the
/// wind's speed. The air follows such a wind exactly.
double off_sheared_gust(int steps) {
  FlowSetting s = air(0.05);
  const double end = 0.1 / s.speed;
  s.time_order = 2, s.dt = end / steps;
  s.march = {
      .cfl_start = 1000.0, .drop = 1e-9, .by_balance = true, .max_steps = 60, .krylov_drop = 0.01, .matrix_free_below = 2.0};
  const BoxOptions box{.ni = 6, .nj = 6, .nk = 6};
  const PatchCondition open{Condition::far_field, false};
  Case run(cartesian_box(box), s,
           {{"i_min", open}, {"i_max", open}, {"j_min", open}, {"j_max", open}, {"k_min", open}, {"k_max", open}}, {}, 1, 0,
           true);
  run.prepare();
  const auto wind = [&](const Vector3d& x, double t) -> Vector3d {
    return s.speed * (1.0 + 0.3 * x.z() * (1.0 - std::cos(15.0 * s.speed * t))) * Vector3d::UnitX();
  };
  for (int n = 1; n <= steps; ++n) {
    const double t = n * s.dt, share = t / end;
    run.solver->set_wind({[&, t](const Vector3d& x, double ago) { return wind(x, t - ago); }, {}});
    run.solver->motion().move_to({turned(Vector3d(0.1 * share * share, 0.0, 0.0), Vector3d(0.0, 0.0, 0.1 * share * share))});
    run.run();
    REQUIRE_FALSE(run.solver->march().spent);
  }
  double off = 0.0;
  for (const FlowTile& tile : run.solver->tiles())
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; ++i) {
        if (std::min({i, j, k}) < 2 || std::max({i, j, k}) > 3) continue;
        const double* at = tile.state.data() + tile.cells.at(k, j, i);
        const double* x = tile.geometry->centre_data.data() + tile.geometry->cell_box.at(k, j, i);
        const std::ptrdiff_t c = tile.cells.component, of_cell = tile.geometry->cell_box.component;
        const Vector3d now = wind({x[0], x[of_cell], x[2 * of_cell]}, end);
        off = std::max(off, (Vector3d(at[c], at[2 * c], at[3 * c]) - now).norm() / s.speed);
      }
    });
  return off;
}

}  // namespace

TEST_CASE("a gust that grows with height drives the air of a moving grid where that is: of order two in time", "[flow][fast]") {
  const double coarse = off_sheared_gust(8), middle = off_sheared_gust(16), fine = off_sheared_gust(32);
  CAPTURE(coarse, middle, fine);
  CHECK(fine < 1e-3);
  CHECK(coarse - middle > 3.3 * (middle - fine));  // what is left is the box's sides'
}

TEST_CASE("a uniform stream stays one on grids that turn, fly and deform, up to 1e5 times longer than high", "[flow][fast]") {
  for (const double ratio : {1.0, 1e-5})
    for (const double cfl : {1.0, 1e4})
      for (const bool deforms : {false, true}) {
        const double of_bound = free_stream(ratio, cfl, 100, deforms);
        CAPTURE(1.0 / ratio, cfl, deforms, of_bound);
        CHECK(of_bound <= 1.0);
      }
}

TEST_CASE("by BDF3 too a uniform stream stays one on grids that turn, fly and deform", "[flow][fast]") {
  for (const double ratio : {1.0, 1e-5}) {
    const double of_bound = free_stream(ratio, 1e4, 40, true, 3);
    CAPTURE(1.0 / ratio, of_bound);
    CHECK(of_bound <= 1.0);
  }
}

TEST_CASE("a uniform stream stays one through a thousand steps of moving grids", "[flow][nightly]") {
  for (const double ratio : {1.0, 1e-5})
    for (const double cfl : {1.0, 1e2, 1e4}) {
      const double of_bound = free_stream(ratio, cfl, 1000, true);
      CAPTURE(1.0 / ratio, cfl, of_bound);
      CHECK(of_bound <= 1.0);
    }
}

namespace {

/// Ends of steps over a length of one: equal ones, but for the first, which is divided in halves so many times, so that what it
/// has of lower order is less.
std::vector<double> ends_of_steps(int steps, int halvings) {
  std::vector<double> ends;
  for (int n = halvings; n > 0; --n) ends.push_back(std::ldexp(1.0, -n) / steps);
  for (int n = 1; n <= steps; ++n) ends.push_back(double(n) / steps);
  return ends;
}

/// A vortex in a stream through a plane box that turns, flies and deforms there and back; state of all cells at the end.
std::vector<double> vortex_on_moving_grid(int steps, int order, bool moving, int halvings = 0) {
  FlowSetting s = air(0.3, {1.0, 0.0, 1.0});
  const double end = 0.2 / s.stream.u;
  s.time_order = order, s.dt = end / steps;
  s.preconditioned = false;
  s.march = {.cfl_start = 20.0, .drop = order > 2 ? 1e-9 : 1e-7, .max_steps = 60, .krylov_drop = 0.01, .matrix_free_below = 2.0};
  const BoxOptions box{.ni = 24, .nj = 24, .nk = 1};
  Case c(planar_box(box), s, {}, {.planar_across = 24, .planar_normal = 24}, 1, 0, true);
  c.solver->start([&](const Vector3d& x) { return vortex_in_stream(s, x, 0.15); });
  c.prepare();
  double begin = 0.0;
  for (const double phase : ends_of_steps(moving ? steps : 0, halvings)) {
    if (halvings > 0) c.solver->set_time_step((phase - begin) * end);
    begin = phase;
    const double swing = std::sin(std::numbers::pi * phase), wave = 0.03 * swing;
    BlockPose pose = turned(Vector3d(0.0, 0.06 * swing, 0.0), Vector3d(0.05 * swing, 0.0, -0.03 * swing * phase));
    pose.shape = [wave](const Vector3d& x) -> Vector3d {
      return x + wave * Vector3d(std::sin(6.0 * x[2]), 0.0, std::sin(4.0 * (x[0] + x[2])));
    };
    c.solver->motion().move_to({pose});
    c.run();
    REQUIRE_FALSE(c.solver->march().spent);
  }
  for (int n = 1; n <= steps && !moving; ++n) c.run();
  std::vector<double> all;
  for (const FlowTile& tile : c.solver->tiles())
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; ++i) {
        const auto q = gas::load_primitive<double>(tile.state.data() + tile.cells.at(k, j, i), std::size_t(tile.cells.component));
        all.insert(all.end(), {q.u / s.speed, q.w / s.speed, q.p / (s.speed * s.speed)});
      }
    });
  return all;
}
double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += (a[n] - b[n]) * (a[n] - b[n]);
  return std::sqrt(sum / double(a.size()));
}

}  // namespace

TEST_CASE("BDF2 keeps its order on a grid that turns, flies and deforms", "[flow][order][fast]") {
  const auto coarse = vortex_on_moving_grid(40, 2, true), middle = vortex_on_moving_grid(80, 2, true),
             fine = vortex_on_moving_grid(160, 2, true);
  const double order = std::log2(distance(coarse, middle) / distance(middle, fine));
  CAPTURE(order, distance(coarse, middle), distance(middle, fine));
  CHECK(order > 1.9);
  const auto still = vortex_on_moving_grid(40, 2, false);
  CAPTURE(distance(still, fine));
  CHECK(distance(still, fine) < 0.05);  // the same flow but for what a coarse grid makes of it
}

TEST_CASE("BDF3 has its order on a grid that turns, flies and deforms, by steps that are not equal", "[flow][order][fast]") {
  const auto coarse = vortex_on_moving_grid(40, 3, true, 4), middle = vortex_on_moving_grid(80, 3, true, 5),
             fine = vortex_on_moving_grid(160, 3, true, 6);
  const double order = std::log2(distance(coarse, middle) / distance(middle, fine));
  CAPTURE(order, distance(coarse, middle), distance(middle, fine));
  CHECK(order > 2.8);
  const auto second = vortex_on_moving_grid(80, 2, true);
  CAPTURE(distance(second, fine));
  CHECK(distance(middle, fine) < 0.3 * distance(second, fine));
}

TEST_CASE("a frame that turns sees a vortex that turns with another rate at rest, to second order", "[flow][order][fast]") {
  std::vector<double> h, errors;
  for (const int n : {45, 90}) {
    const double rate = 300.0, frame = 500.0;
    FlowSetting s = air(0.1, {0.0, 1.0, 0.0});
    s.frame_omega = {0.0, frame, 0.0}, s.frame_centre = {0.4, 0.0, 0.6};
    s.march.max_steps = 0;  // the residual of the state as it is
    const BoxOptions box{.ni = n, .nj = n, .nk = 1};
    Case c(perturbed(planar_box(box), box, 0.0), s, {}, {.planar_across = n, .planar_normal = n});
    c.solver->start([&](const Vector3d& x) {
      gas::Primitive<double> q = s.stream;
      const Vector3d r = x - s.frame_centre, u = Vector3d(0.0, rate, 0.0).cross(Vector3d(r[0], 0.0, r[2]));
      q.u += u[0], q.w += u[2];
      // dp/dr = rho v^2 / r at constant temperature
      q.p = s.gas.pressure_reference * std::expm1(0.5 * u.squaredNorm() / (s.gas.gas_constant * s.gas.temperature_reference));
      return q;
    });
    c.prepare();
    c.run();
    const double momentum = gas::density(s.gas, s.stream) * frame * rate;  // of what is to cancel, at a distance of 1
    double largest = 0.0;
    for (const FlowTile& tile : c.solver->tiles())
      for (int j = 3; j < n - 3; ++j)
        for (int i = 3; i < n - 3; ++i)
          for (int r = 0; r < 4; ++r) {
            const double unit = r == 0 ? momentum / s.speed : momentum;
            largest = std::max(largest,
                               std::abs(tile.residual.data()[tile.inner.at(0, j, i) + r * tile.inner.component]) * n * n / unit);
          }
    h.push_back(1.0 / n), errors.push_back(largest);
  }
  CAPTURE(errors[0], errors[1]);
  CHECK(errors[1] < 1e-3);
  CHECK(observed_order(h, errors) > 1.9);
}

TEST_CASE("a uniform stream along the axis stays one in a frame that turns; one across it is refused", "[flow][fast]") {
  FlowSetting s = air(0.05, {0.0, 0.0, 1.0});
  s.frame_omega = {0.0, 0.0, 200.0}, s.frame_centre = {0.5, -3.0, 0.0};
  s.march = {.drop = 0.0, .max_steps = 30, .matrix_free_below = 0.0};
  const BoxOptions box{.ni = 8, .nj = 8, .nk = 8};
  Case c(perturbed(cartesian_box(box), box, 0.05), s, {}, {.across_j = 4, .across_k = 4, .normal = 8});
  c.prepare();
  c.run();
  CHECK(stream_deviation(*c.solver) < 1e-12);
  s.stream.u = 1.0;
  CHECK_THROWS_AS(Case(cartesian_box(box), s, {}), std::invalid_argument);
}

TEST_CASE("a march on a moving grid restarts with the same bits", "[flow][fast]") {
  const int order = GENERATE(2, 3);
  FlowSetting s = air(0.3, {1.0, 0.4, 0.2});
  s.viscous = true, s.turbulence = "sa", s.gas.viscosity.mu0 = 1e-2;
  s.time_order = order, s.dt = 1e-3;
  s.march.max_steps = 6;
  const BoxOptions box{.ni = 12, .nj = 8, .nk = 8};
  const auto make = [&] {
    Case c(perturbed(cartesian_box(box), box, 0.04), s, {}, {.across_j = 4, .across_k = 4, .normal = 12}, 1, 0, true);
    c.solver->start([&](const Vector3d& x) {
      gas::Primitive<double> q = s.stream;
      q.p += 2000.0 * std::exp(-20.0 * (x - Vector3d::Constant(0.5)).squaredNorm());
      return q;
    });
    c.prepare();
    return c;
  };
  const auto step = [&](Case& c, int n) {
    c.solver->motion().move_to({turned(Vector3d(0.2, -0.1, 0.3) * (n * n * 0.1), Vector3d(0.05 * n, 0.0, 0.02 * n * n))});
    c.run();
  };
  Case whole = make(), first = make(), second = make();
  const int restart = order + 1;
  for (int n = 1; n <= restart + 2; ++n) step(whole, n);
  for (int n = 1; n <= restart; ++n) step(first, n);
  carry_over(*first.solver, *second.solver);
  for (int n = restart + 1; n <= restart + 2; ++n) step(second, n);
  CHECK(state_of(*whole.solver) == state_of(*second.solver));
  CHECK_THROWS_AS(whole.solver->motion().move_to({BlockPose{}, BlockPose{}, BlockPose{}}), std::invalid_argument);
}
