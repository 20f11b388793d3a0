// The grid that a rotor's solvers share: the same however many ranks look through it, refused on all of them alike.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/made_rotor_grid.hpp"

#include <signal.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "runtime/mpi/stop_request.hpp"
#include "src/aero/resolved_rotor.hpp"
#include "src/aero/rotor_grid/quality.hpp"
#include "src/scene/error.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Catch::Matchers::Contains;

namespace {

ResolvedRotorSetup eddying(double resolution) {
  ResolvedRotorSetup s;
  s.grid.resolution = resolution, s.grid.sectors = "all", s.grid.first_cell_chords = 4e-3;
  s.rotor.turbine = std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/turbines/dtu_10mw.toml";
  s.rotor.hub_m = {1.0, -2.0, 119.0};
  s.rotor.speed = 0.9;
  s.wind = {11.0, 0.0, 0.0};
  s.flow.viscous = "full", s.flow.turbulence = "sa";
  return s;
}

void require_same(const MadeRotorGrid& a, const MadeRotorGrid& b) {
  CHECK(a.moments == b.moments);
  CHECK(a.radii == b.radii);
  CHECK((a.walls == b.walls));  // in brackets: thousands of faces are not for printing
  for (int n = 0; n < int(a.grid.blocks.size()); ++n) CHECK(a.edges.of(n) == b.edges.of(n));
  REQUIRE(a.stations.size() == b.stations.size());
  for (std::size_t blade = 0; blade < a.stations.size(); ++blade) {
    REQUIRE(a.stations[blade].size() == b.stations[blade].size());
    for (std::size_t n = 0; n < a.stations[blade].size(); ++n) {
      const BladeStation &p = a.stations[blade][n], &q = b.stations[blade][n];
      CHECK((p.block == q.block && p.k == q.k && p.radius == q.radius && p.length == q.length && p.chord == q.chord));
      CHECK((p.wetted_area == q.wetted_area && p.quarter == q.quarter && p.normal == q.normal));
      CHECK((p.tangential == q.tangential && p.chordwise == q.chordwise));
    }
  }
}

}  // namespace

TEST_CASE("a rotor's grid has a station for each row, walls and radii", "[rotor][fast]") {
  const auto made = made_rotor_grid(eddying(1.2));
  REQUIRE(made->blades() == 3);
  CHECK(int(made->stations[2].size()) == made->span_cells());
  CHECK(int(made->radii.size()) == made->radial_cells() + 1);
  for (std::size_t k = 1; k < made->radii.size(); ++k) CHECK(made->radii[k] > made->radii[k - 1]);
  const RotorGridSizes& z = made->spec.sizes;  // round the blades, and the plates that close them
  CHECK(int(made->walls.size()) == 3 * (z.span * z.round + z.edge * z.chordwise()));
  double nodes = 0.0;
  const MultiBlockGrid whole = make_rotor_grid(made->turbine, made->spec);
  for (const Block& b : whole.blocks) nodes += double(b.nodes.size());
  CHECK(made->moments[0] == nodes);
}

TEST_CASE("two ranks that share a rotor's grid see what one sees", "[rotor][mpi2]") {
  require_same(*made_rotor_grid(eddying(1.7)), *made_rotor_grid(eddying(1.7), MPI_COMM_WORLD));
}

TEST_CASE("a rotor's grid that one of two ranks finds bad is refused by both", "[rotor][mpi2]") {
  ResolvedRotorSetup s = eddying(1.0);
  const auto sound = made_rotor_grid(s);
  const int layers = sound->radial_cells();
  const auto worst = [&](int first, int last) {
    return rotor_grid_quality(sound->maker->make(first, last, true), {"blade_"}).general.scaled_jacobian.value;
  };
  const double inner = worst(0, layers / 2), outer = worst(layers / 2, layers);
  REQUIRE(std::abs(inner - outer) > 1e-3);
  s.grid.least_scaled_jacobian = 0.5 * (inner + outer);
  std::string alone;
  try {
    made_rotor_grid(s);
  } catch (const scene::SceneError& e) { alone = e.what(); }
  CHECK_THAT(alone, Contains("scaled Jacobian"));
  CHECK_THROWS_WITH(made_rotor_grid(s, MPI_COMM_WORLD), alone);
}

TEST_CASE("a turbine that cannot be read is refused by both ranks", "[rotor][mpi2]") {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  ResolvedRotorSetup s = eddying(1.0);
  if (rank == 1) s.rotor.turbine += ".gone";  // as a disk that only one node has lost
  CHECK_THROWS_WITH(made_rotor_grid(s, MPI_COMM_WORLD), Contains("dtu_10mw.toml.gone"));
}

TEST_CASE("a grid, its tiles and wall distances are given up on all ranks where one is asked to stop", "[rotor][mpi2]") {
  runtime::World world;
  MPI_Comm_rank(world.comm, &world.rank);
  MPI_Comm_size(world.comm, &world.size);
  const ResolvedRotorSetup setup = eddying(1.2);
  const auto made = made_rotor_grid(setup, world.comm);
  for (const std::string_view stage : {"rotor grid", "tiles", "wall distances"}) {
    const runtime::StopRequest stop;
    const auto asks = [&](std::string_view what, double) {
      if (what == stage && world.rank == 1) ::raise(SIGUSR1);
    };
    if (stage == "rotor grid")
      CHECK_THROWS_AS(made_rotor_grid(setup, world.comm, asks), runtime::StopAsked);
    else
      CHECK_THROWS_AS(ResolvedRotor::on(world, setup, 0, made, asks), runtime::StopAsked);
    MPI_Barrier(world.comm);
  }
}
