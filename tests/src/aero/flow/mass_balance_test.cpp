// The balance of the air's mass: a stream's own mass flow, the mass that cells gain as the time scheme has it, closed to
// round-off also while the march is far from converged, the same bits on any number of ranks. SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/mass_balance.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "src/aero/grid/generators/plane_cases.hpp"
#include "tests/src/aero/flow/flows.hpp"
#include "tests/src/aero/grid/examples.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;
using Eigen::Vector3d;

namespace {

/// A bump of pressure in a skewed box of several tiles.
Case stirred_box(const FlowSetting& setting, int ranks = 1, int rank = 0, bool moving = false) {
  const BoxOptions box{.ni = 10, .nj = 8, .nk = 8};
  Case c(perturbed(cartesian_box(box), box, 0.04), setting, {}, {.across_j = 4, .across_k = 4, .normal = 10}, ranks, rank,
         moving);
  c.solver->start([&](const Vector3d& x) {
    gas::Primitive<double> q = setting.stream;
    q.p += 2000.0 * std::exp(-20.0 * (x - Vector3d::Constant(0.5)).squaredNorm());
    return q;
  });
  return c;
}

double mass_in(const Case& c) {
  double mass = 0.0;
  for (const FlowTile& tile : c.solver->tiles())
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; ++i) {
        const auto q = gas::load_primitive<double>(tile.state.data() + tile.cells.at(k, j, i), std::size_t(tile.cells.component));
        mass += tile.geometry->volume_data.data()[tile.geometry->cell_box.at(k, j, i)] * gas::density(c.solver->setting().gas, q);
      }
    });
  return mass;
}

/// The sum of some 1e4 fluxes, each of a few products.
constexpr double round_off = 1e-13;

double gap(const MassBalance& m) { return std::abs(m.growth + m.outflow - m.inflow - m.residual); }

}  // namespace

TEST_CASE("a uniform stream brings and takes density times velocity times area, and leaves nothing", "[flow][fast]") {
  FlowSetting setting = air(0.3, {1.0, 0.4, 0.2});
  setting.march.max_steps = 2;
  Case c(cartesian_box({.ni = 10, .nj = 8, .nk = 8}), setting, {}, {.across_j = 4, .across_k = 4, .normal = 10});
  c.prepare();
  c.run();
  const MassBalance m = c.solver->judgement().mass();
  const double flow = gas::density(setting.gas, setting.stream) * (setting.stream.u + setting.stream.v + setting.stream.w);
  CHECK(m.inflow == Approx(flow).epsilon(1e-12));
  CHECK(m.outflow == Approx(flow).epsilon(1e-12));
  CHECK(m.growth == 0.0);
  CHECK(std::abs(m.residual) < round_off * flow);
}

TEST_CASE("fluxes and what the march has left close at every pseudo-step, and at its end nothing is left", "[flow][fast]") {
  FlowSetting setting = air(0.3, {1.0, 0.4, 0.2});
  setting.march.drop = 1e-9, setting.march.max_steps = 60;
  Case c = stirred_box(setting);
  c.prepare();
  c.run();
  const std::vector<PseudoRow>& rows = c.solver->rows();
  for (const PseudoRow& row : rows) CHECK(gap(row.mass) < round_off * row.mass.inflow);
  CHECK(std::abs(rows.front().mass.outflow - rows.front().mass.inflow) > 1e-4 * rows.front().mass.inflow);
  CHECK(std::abs(rows.back().mass.residual) < 1e-9 * rows.back().mass.inflow);
}

TEST_CASE("the balance closes round a section whose blocks are cut and turned: a face between them has one flux",
          "[flow][fast]") {
  FlowSetting setting = air(0.15);
  setting.gas.viscosity.mu0 = 1e-3, setting.viscous = true;
  setting.march.max_steps = 3;
  const int corner = GENERATE(0, 1);  // a block that sticks at two sides ends the rows of its neighbours
  MultiBlockGrid grid = naca0012({.n = 1});
  const std::array<std::vector<int>, 3> cuts{{{6, 50, 106}, {10, 20}, {}}};
  grid = split_at(grid, std::span(&cuts, 1));
  if (corner)
    for (Boundary& b : grid.boundaries)
      if (b.patch == "outflow") b.patch = "screen";
  turn_blocks(grid, 3);
  const PatchCondition sticks{.condition = Condition::no_slip}, open{.condition = Condition::far_field};
  Case c(grid, setting, {{"wall", sticks}, {"farfield", open}, {corner ? "screen" : "outflow", corner ? sticks : open}});
  c.prepare();
  c.run();
  for (const PseudoRow& row : c.solver->rows()) {
    CHECK(row.mass.inflow > 0.0);
    CHECK(gap(row.mass) < round_off * row.mass.inflow);
  }
}

TEST_CASE("the mass that cells gain is that of the time scheme, on standing and on moving grids", "[flow][fast]") {
  const int order = GENERATE(2, 3);
  for (const bool moves : {false, true}) {
    FlowSetting setting = air(0.3, {1.0, 0.4, 0.2});
    setting.time_order = order, setting.dt = 3e-4;
    setting.march.drop = 1e-4;
    Case c = stirred_box(setting, 1, 0, moves);
    c.prepare();
    double older = 0.0, before = 0.0, now = mass_in(c);
    for (int n = 1; n <= 4; ++n) {
      if (moves) {
        BlockPose pose;
        const double swing = 0.1 * std::sin(20.0 * n * setting.dt);
        pose.shape = [swing](const Vector3d& x) -> Vector3d { return x + swing * Vector3d(x[0] * x[0], x[0], x[2] * x[1]); };
        c.solver->motion().move_to({pose});
      }
      c.run();
      const double oldest = older;
      older = before, before = now, now = mass_in(c);
      const TimeWeights w = n == 1 ? bdf1 : n == 2 || order == 2 ? bdf2() : bdf3();
      const double growth = (w.now * now + w.old * before + w.older * older + w.oldest * oldest) / setting.dt;
      const MassBalance m = c.solver->judgement().mass();
      INFO("step " << n << (moves ? ", moving" : "") << ": growth " << m.growth << ", inflow " << m.inflow);
      CHECK(std::abs(growth) > 1e-3 * m.inflow);
      CHECK(std::abs(m.growth - growth) < 1e-13 * now / setting.dt);
      CHECK(gap(m) < round_off * (m.inflow + now / setting.dt));
      CHECK(std::abs(m.residual) < 1e-2 * std::abs(growth));
    }
  }
}

TEST_CASE("two ranks have the mass balance of one, bit by bit", "[flow][mpi2]") {
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  FlowSetting setting = air(0.3, {1.0, 0.4, 0.2});
  setting.march.drop = 1e-9, setting.march.max_steps = 5;
  Case whole = stirred_box(setting), part = stirred_box(setting, 2, rank);
  whole.prepare();
  whole.run();
  part.prepare(MPI_COMM_WORLD, {.threads = 2});
  part.run();
  REQUIRE(whole.solver->rows().size() == part.solver->rows().size());
  for (std::size_t n = 0; n < part.solver->rows().size(); ++n) {
    const MassBalance &a = whole.solver->rows()[n].mass, &b = part.solver->rows()[n].mass;
    CHECK(a.inflow == b.inflow);
    CHECK(a.outflow == b.outflow);
    CHECK(a.residual == b.residual);
  }
}
