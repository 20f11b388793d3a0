// Wind over height as far field and start: air in parallel layers of one pressure and temperature, each at its own speed, is an
// exact steady flow without friction. Boxes along the wind keep it to rounding, distorted ones with an error that falls by the
// scheme's order. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/order.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

FlowSetting sheared(WindLaw law) {
  FlowSetting s = air(0.03);
  s.profile = {.law = law, .reference_height = 119.0, .least_height = 10.0};
  return s;
}

/// Root mean square of the deviation from the profile, over the reference wind; pressure over its dynamic pressure.
double deviation(const FlowSolver& solver) {
  const FlowSetting& f = solver.setting();
  const double q = 0.5 * gas::density(f.gas, f.stream) * f.speed * f.speed;
  double squares = 0.0, cells = 0.0;
  for (const FlowTile& tile : solver.tiles()) {
    const TileGeometry& g = *tile.geometry;
    for (int k = 0; k < tile.box.nk; ++k)
      for (int j = 0; j < tile.box.nj; ++j)
        for (int i = 0; i < tile.box.ni; ++i) {
          const double z = g.centre_data.data()[g.cell_box.at(k, j, i) + 2 * g.cell_box.component];
          const auto is =
              gas::load_primitive<double>(tile.state.data() + tile.cells.at(k, j, i), std::size_t(tile.cells.component));
          const auto was = stream_at(f.stream, f.profile, z);
          const double off[4] = {(is.p - was.p) / q, (is.u - was.u) / f.speed, (is.v - was.v) / f.speed,
                                 (is.w - was.w) / f.speed};
          for (const double x : off) squares += x * x;
          cells += 1.0;
        }
  }
  return std::sqrt(squares / cells);
}

double after_march(int n, double amplitude, WindLaw law, int steps) {
  const BoxOptions box{.ni = n, .nj = n / 2, .nk = n, .low = {-100.0, -50.0, 20.0}, .high = {100.0, 50.0, 220.0}};
  FlowSetting s = sheared(law);
  s.march.drop = 1e-4, s.march.max_steps = steps;
  const PatchCondition open{Condition::far_field, false};
  Case c(perturbed(cartesian_box(box), box, amplitude), s,
         {{"i_min", open}, {"i_max", open}, {"j_min", open}, {"j_max", open}, {"k_min", open}, {"k_max", open}});
  c.prepare();
  c.run();
  CHECK(c.solver->march().verdict != Verdict::failed);
  return deviation(*c.solver);
}

}  // namespace

TEST_CASE("a box along the wind keeps a profile to rounding", "[flow][fast]") {
  const auto law = GENERATE(WindLaw::uniform, WindLaw::power, WindLaw::logarithmic);
  CHECK(after_march(8, 0.0, law, 20) < 1e-12);
}

TEST_CASE("a distorted box keeps a profile to an error of second order", "[flow][fast]") {
  const auto law = GENERATE(WindLaw::power, WindLaw::logarithmic);
  std::vector<double> h, error;
  for (const int n : {8, 16, 24}) h.push_back(1.0 / n), error.push_back(after_march(n, 0.04, law, 60));
  CAPTURE(error[0], error[1], error[2]);
  CHECK(error[2] < 8e-3);
  CHECK(observed_order(h, error) > 1.7);
}

TEST_CASE("a turning frame refuses a wind that goes with height: nothing would be steady in it", "[flow][fast]") {
  FlowSetting s = sheared(WindLaw::power);
  s.frame_omega = {1.0, 0.0, 0.0};
  const BoxOptions box{.ni = 4, .nj = 4, .nk = 4};
  CHECK_THROWS_WITH(Case(cartesian_box(box), s, {}),
                    Catch::Contains("a wind that goes with height is not steady in a turning frame"));
}
