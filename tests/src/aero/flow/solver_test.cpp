// The march as a whole: a uniform stream stays one, a disturbed one becomes one, with the same bits for any threads and ranks.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

double largest_deviation(const FlowSolver& solver) {
  double largest = 0.0;
  const gas::Primitive<double>& s = solver.setting().stream;
  const double stream[5] = {s.p, s.u, s.v, s.w, s.T}, unit[5] = {101325.0, solver.setting().speed, solver.setting().speed, solver.setting().speed, 288.15};
  for (const FlowTile& tile : solver.tiles())
    for (int c = 0; c < 5; ++c)
      for_rows(tile.box, [&](int k, int j) {
        for (int i = 0; i < tile.box.ni; ++i)
          largest = std::max(largest, std::abs(tile.state.data()[c * tile.cells.component + tile.cells.at(k, j, i)] - stream[c]) / unit[c]);
      });
  return largest;
}

}  // namespace

TEST_CASE("a disturbance in a box of far fields leaves and the stream comes back", "[flow][fast]") {
  FlowSetting setting = air(0.3, {1.0, 0.4, 0.2});
  setting.march.drop = 1e-9;
  setting.march.max_steps = 60;
  const BoxOptions box{.ni = 12, .nj = 12, .nk = 12};
  Case c(perturbed(cartesian_box(box), box, 0.04), setting, {}, {.across_j = 6, .across_k = 6, .normal = 12});
  c.solver->start([&](const Eigen::Vector3d& x) {
    gas::Primitive<double> q = setting.stream;
    const double bump = std::exp(-20.0 * (x - Eigen::Vector3d::Constant(0.5)).squaredNorm());
    q.p += 2000.0 * bump, q.T += 3.0 * bump, q.v += 10.0 * bump;
    return q;
  });
  c.prepare();
  c.run();
  for (const PseudoRow& row : c.solver->rows())
    UNSCOPED_INFO(row.step << " cfl " << row.cfl << " residual " << row.density_residual << " krylov " << row.krylov << " fraction " << row.fraction);
  CHECK(c.solver->march().verdict() == Verdict::converged);
  CHECK(c.solver->march().density_residual() < 1e-8 * c.solver->march().first_density_residual());
  CHECK(largest_deviation(*c.solver) < 1e-8);
}
