// The estimate of the error in time: its constants, that it goes down with the order that a step's own error has, that it is the
// error that is found, and that it is the same on any ranks; how windows are divided by it. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "src/aero/flow/time_error.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;
using Eigen::Vector3d;

namespace {

/// A vortex carried through a plane periodic box, in steps of this length.
Case carried_vortex(int order, double dt, int ranks = 1, int rank = 0) {
  FlowSetting s = air(0.3, {1.0, 0.0, 1.0});
  s.time_order = order, s.dt = dt / s.speed;
  s.time_tolerance = 1e-3;
  s.preconditioned = false;
  s.march = {.cfl_start = 20.0, .drop = 1e-8, .max_steps = 60, .krylov_drop = 0.01, .matrix_free_below = 2.0};
  BoxOptions box{.ni = 16, .nj = 16, .nk = 1};
  box.periodic = {true, true, false};
  Case c(planar_box(box), s, {}, {.planar_across = 8, .planar_normal = 8}, ranks, rank);
  c.solver->start([&](const Vector3d& x) { return vortex_in_stream(s, x, 0.2); });
  c.prepare(ranks > 1 ? MPI_COMM_WORLD : MPI_COMM_SELF);
  return c;
}

/// So many steps, the first of which is divided in halves until what it has of lower order does not count.
void run_from_start(Case& c, double dt, int steps) {
  constexpr int halvings = 7;
  dt /= c.solver->setting().speed;
  double begin = 0.0;
  for (int n = halvings; n >= 0; --n) {
    const double end = std::ldexp(dt, -n);
    c.solver->set_time_step(end - begin);
    c.run();
    begin = end;
  }
  for (int n = 1; n < steps; ++n) c.solver->set_time_step(dt), c.run();
}

/// Momentum of all cells [kg/(m2 s)].
std::vector<double> momentum(const Case& c) {
  std::vector<double> all;
  for (const FlowTile& tile : c.solver->tiles())
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; ++i) {
        const auto w = gas::conserved(
            c.solver->setting().gas,
            gas::load_primitive<double>(tile.state.data() + tile.cells.at(k, j, i), std::size_t(tile.cells.component)));
        all.insert(all.end(), {w.mx, w.mz});
      }
    });
  return all;
}

}  // namespace

TEST_CASE("the share of a difference from the extrapolated past that is a step's error is that of Milne's device",
          "[flow][fast]") {
  CHECK(milne_share(1.5, 3.0) == Approx(2.0 / 11.0));
  CHECK(milne_share(11.0 / 6.0, 4.0) == Approx(3.0 / 25.0));
}

TEST_CASE(
    "the estimated error of a step goes down with the order that it has beyond the scheme's, and is the error that is found",
    "[flow][order][fast]") {
  const int order = GENERATE(2, 3);
  const double dt = 0.01;
  // The same flow, so many steps after the start in each; the first steps have no estimate.
  std::vector<double> estimates;
  for (const int parts : {1, 2}) {
    Case c = carried_vortex(order, dt / parts);
    for (int n = 1; n <= 12 * parts; ++n) {
      c.run();
      REQUIRE_FALSE(c.solver->march().spent);
      CHECK(c.solver->time_error().has_value() == (n > order));
    }
    estimates.push_back(*c.solver->time_error());
  }
  CAPTURE(order, estimates[0], estimates[1]);
  CHECK(std::log2(estimates[0] / estimates[1]) == Approx(order + 1).margin(0.35));

  // Against the same time in steps of an eighth.
  Case coarse = carried_vortex(order, dt), fine = carried_vortex(order, dt / 8.0);
  const int steps = 12;
  run_from_start(fine, dt / 8.0, 8 * steps);
  run_from_start(coarse, dt, steps);
  const std::vector<double> a = momentum(coarse), b = momentum(fine);
  const FlowSetting& s = fine.solver->setting();
  const double rho = gas::density(s.gas, s.stream);
  double off = 0.0, beyond = 0.0;
  for (std::size_t n = 0; n < a.size(); n += 2) {
    off += (a[n] - b[n]) * (a[n] - b[n]) + (a[n + 1] - b[n + 1]) * (a[n + 1] - b[n + 1]);
    beyond += std::pow(b[n] - rho * s.stream.u, 2) + std::pow(b[n + 1] - rho * s.stream.w, 2);
  }
  const double found = std::sqrt(off / beyond);  // adds up over the steps
  CAPTURE(found, found / (steps * estimates[0]));
  CHECK(found > 0.3 * steps * estimates[0]);
  CHECK(found < 3.0 * steps * estimates[0]);
}

TEST_CASE("a stream without anything in it has no error in time to speak of", "[flow][fast]") {
  FlowSetting s = air(0.3, {1.0, 0.4, 0.2});
  s.time_order = 2, s.dt = 0.01 / s.speed, s.time_tolerance = 1e-3;
  const BoxOptions box{.ni = 6, .nj = 6, .nk = 6};
  Case c(perturbed(cartesian_box(box), box, 0.05), s, {});
  c.prepare();
  c.run(4);
  REQUIRE(c.solver->time_error());
  CHECK(*c.solver->time_error() < 1e-6);
}

TEST_CASE("two ranks estimate the error in time of one, bit by bit", "[flow][mpi2]") {
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  Case whole = carried_vortex(3, 0.02), part = carried_vortex(3, 0.02, 2, rank);
  whole.run(5), part.run(5);
  REQUIRE(whole.solver->time_error());
  CHECK(*whole.solver->time_error() > 0.0);
  CHECK(*whole.solver->time_error() == *part.solver->time_error());
}

TEST_CASE("windows are divided in twice as many steps above the tolerance, in half as many far below it", "[flow][fast]") {
  WindowSteps steps(1e-3, 3);
  CHECK(steps.count() == 16);
  CHECK_FALSE(steps.refine(1.0));  // no more than that
  steps.end_window(1e-3 / 30.0);
  CHECK(steps.count() == 16);
  for (const int expected : {8, 4, 2, 1, 1}) {
    steps.end_window(1e-3 / 33.0);
    CHECK(steps.count() == expected);
  }
  CHECK_FALSE(steps.refine(1e-3));
  CHECK(steps.refine(1.1e-3));
  CHECK(steps.count() == 2);
}
