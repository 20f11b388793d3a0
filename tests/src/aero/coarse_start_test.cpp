// Grid sequencing of a resolved rotor: a flow goes from a coarse to a fine grid by its place in the blocks, uniform ones to the
// bit, varying ones as the cells allow, and the march that begins with it is nearer its end.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/coarse_start.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;

namespace {

ResolvedRotorSetup setup(double resolution) {
  ResolvedRotorSetup s;
  s.grid.resolution = resolution, s.grid.sectors = "one", s.grid.first_cell_chords = 4e-3 / resolution;
  s.rotor.turbine = std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/turbines/dtu_10mw.toml";
  s.rotor.hub_m = {0.0, 0.0, 119.0}, s.rotor.speed = 8.836 * pi / 30.0;
  s.wind = {11.0, 0.0, 0.0};
  s.flow.time = "steady", s.flow.viscous = "none", s.flow.cfl = 2.0, s.flow.cfl_max = 100.0, s.flow.krylov_steps = 8,
  s.flow.matrix_free_below = 0.0, s.flow.drop = 0.0;
  return s;
}

}  // namespace

TEST_CASE("a flow goes from a coarse rotor grid to a fine one: uniform to the bit, varying one as the cells allow",
          "[rotor][fast]") {
  ResolvedRotor coarse(coarser(setup(2.0))), fine(setup(2.0));
  CHECK(8 * coarse.solver().cells() < 1.8 * fine.solver().cells());
  CHECK(8 * coarse.solver().cells() > 0.5 * fine.solver().cells());
  coarse.solver().start_uniform();
  fine.solver().start([](const Eigen::Vector3d&) { return gas::Primitive<double>{}; });
  interpolate(coarse, fine);
  CHECK(testing::stream_deviation(fine.solver()) < 1e-14);

  // Pressure and speed that vary over some tip radii; cells next to the far field are hundreds of metres long.
  const auto varying = [](const Eigen::Vector3d& x) {
    const double a = std::sin(x.x() / 600.0), b = std::cos((x.z() - 119.0) / 600.0);
    return gas::Primitive<double>{100.0 * a * b, 11.0 + a, b, 0.0, 0.1 * a};
  };
  coarse.solver().start(varying);
  interpolate(coarse, fine);
  double squares = 0.0, volume = 0.0;
  for (const FlowTile& tile : fine.solver().tiles()) {
    const TileGeometry& g = *tile.geometry;
    const std::ptrdiff_t c = g.cell_box.component;
    for (int k = 0; k < tile.box.nk; ++k)
      for (int j = 0; j < tile.box.nj; ++j)
        for (int i = 0; i < tile.box.ni; ++i) {
          const std::ptrdiff_t at = g.cell_box.at(k, j, i);
          const double *x = g.centre_data.data() + at, v = g.volume_data.data()[at];
          const double p = tile.state.data()[tile.cells.at(k, j, i)];
          squares += v * std::pow(p - varying({x[0], x[c], x[2 * c]}).p, 2), volume += v;
        }
  }
  const double error = std::sqrt(squares / volume) / 100.0;
  CAPTURE(error);
  CHECK(error < 0.05);  // cells beside the far field are hundreds of metres long
}

TEST_CASE("a march that begins with a coarser grid's flow is nearer its end after as many steps", "[rotor][fast]") {
  ResolvedRotorSetup s = setup(2.0);
  s.flow.max_pseudo_steps = 6;
  double thrust[2];
  for (const bool sequenced : {false, true}) {
    ResolvedRotor rotor(s);
    rotor.solver().start_uniform();
    if (sequenced) CHECK(start_from_coarser(s, 60, rotor).thrust > 0.8e6);
    rotor.prepare(MPI_COMM_SELF, {.threads = 1});
    rotor.run();
    CHECK(rotor.solver().march().rejections == 0);
    thrust[sequenced] = rotor.load().thrust;
  }
  constexpr double settled = 1.65e6;  // of inviscid demo grids, within five per cent
  CAPTURE(thrust[0], thrust[1]);
  CHECK(std::abs(thrust[1] - settled) < 0.5 * std::abs(thrust[0] - settled));
}
