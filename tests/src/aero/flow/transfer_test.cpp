// Grid sequencing: the grid of every second node, and a flow's way from there to the fine grid.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/transfer.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "runtime/mpi/exchange.hpp"
#include "src/aero/grid/checks.hpp"
#include "src/aero/grid/coarsen.hpp"
#include "src/aero/grid/generators/plane_cases.hpp"
#include "src/aero/grid/split.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

TEST_CASE("every second node makes a sound grid with the same patches, or the reason is named", "[aero][grid][fast]") {
  for (const MultiBlockGrid& fine :
       {flat_plate(1), naca0012({.n = 1}), split(cartesian_box({.ni = 16, .nj = 8, .nk = 8}), 2, {})}) {
    CHECK(why_not_halved(fine).empty());
    const MultiBlockGrid coarse = halved(fine);
    CHECK(grid_faults(coarse).empty());
    REQUIRE(coarse.blocks.size() == fine.blocks.size());
    REQUIRE(coarse.boundaries.size() == fine.boundaries.size());
    CHECK(coarse.blocks[0].ni * 2 == fine.blocks[0].ni);
    CHECK(coarse.blocks[0].nk * (fine.planar ? 1 : 2) == fine.blocks[0].nk);
    CHECK(coarse.blocks[0].nodes[coarse.blocks[0].node(0, 2, 3)] == fine.blocks[0].nodes[fine.blocks[0].node(0, 4, 6)]);
  }
  CHECK(why_not_halved(planar_box({.ni = 8, .nj = 7, .nk = 1})).find("7 cells along j") != std::string::npos);
  CHECK(why_not_halved(planar_box({.ni = 2, .nj = 8, .nk = 1})).find("2 cells along i") != std::string::npos);
}

TEST_CASE("a flow that varies linearly goes over exactly, up to the sides; turbulence stays positive", "[aero][flow][fast]") {
  FlowSetting s = air(0.2);
  s.viscous = true, s.turbulence = "sa", s.gas.viscosity.mu0 = 1e-3;
  const MultiBlockGrid fine = cartesian_box({.ni = 16, .nj = 8, .nk = 8});
  Case from(halved(fine), s, {}), to(fine, s, {});
  const auto linear = [](const Eigen::Vector3d& x) {
    return gas::Primitive<double>{100.0 * x[0], 60.0 + x[1], x[2], x[0] - x[1], 0.1 * x[2]};
  };
  from.solver->start(linear), to.solver->start_uniform();
  for (FlowTile& tile : from.solver->tiles())  // falls to nothing within the first cell: a straight line would go below zero
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; ++i)
        tile.state.data()[mean_unknowns * tile.cells.component + tile.cells.at(k, j, i)] = i == 0 ? 1e-9 : 1e-3;
    });
  transfer(*from.solver, *to.solver);
  double worst = 0.0, least = 1.0;
  for (const FlowTile& tile : to.solver->tiles()) {
    const TileGeometry& g = *tile.geometry;
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; ++i) {
        const double* x = g.centre_data.data() + g.cell_box.at(k, j, i);
        const double* q = tile.state.data() + tile.cells.at(k, j, i);
        const std::ptrdiff_t c = g.cell_box.component, n = tile.cells.component;
        const gas::Primitive<double> want = linear({x[0], x[c], x[2 * c]});
        for (const double off : {q[0] - want.p, q[n] - want.u, q[2 * n] - want.v, q[3 * n] - want.w, q[4 * n] - want.T})
          worst = std::max(worst, std::abs(off));
        least = std::min(least, q[mean_unknowns * n]);
      }
    });
  }
  CHECK(worst < 1e-11);
  CHECK(least > 0.0);
}

TEST_CASE("a march that begins with a coarser grid's flow ends where the other does, in fewer steps", "[aero][flow][fast]") {
  FlowSetting s = air(0.1);
  s.march.drop = 1e-6;
  const std::vector<std::pair<std::string, PatchCondition>> patches{{"wall", {Condition::slip, true}},
                                                                    {"farfield", {Condition::far_field, false}}};
  const MultiBlockGrid grid = cylinder({.around = 64, .outward = 32, .far = 20.0});
  Case plain(grid, s, patches), sequenced(grid, s, patches), coarse(halved(grid), s, patches);
  for (Case* c : {&plain, &sequenced, &coarse}) c->prepare();
  plain.run(), coarse.run();
  sequenced.solver->judgement().march.judge_only();
  sequenced.run();
  CHECK(sequenced.solver->march().steps == 1);
  CHECK(sequenced.solver->march().now.density == plain.solver->rows().front().density_residual);
  sequenced.solver->judgement().rows.all.clear();
  transfer(*coarse.solver, *sequenced.solver);
  sequenced.solver->judgement().march.begin_after_judging();
  sequenced.run();
  const MarchState &a = plain.solver->march(), &b = sequenced.solver->march();
  CAPTURE(a.steps, b.steps, a.krylov_total, b.krylov_total);
  CHECK(a.verdict == Verdict::converged);
  CHECK(b.verdict == Verdict::converged);
  CHECK(b.now.density <= 1e-6 * a.first.density);
  CHECK(b.first.density == a.first.density);
  CHECK(b.krylov_total < a.krylov_total);
  CHECK(sequenced.solver->rows().back().force[0] ==
        Approx(plain.solver->rows().back().force[0]).margin(1e-4 * 0.5 * 1.225 * 34.0 * 34.0));
}

namespace {

/// Turbulent, with nothing that is alike in two cells.
Case uneven(MultiBlockGrid grid, const TilingOptions& tiling, int ranks = 1, int rank = 0) {
  FlowSetting s = air(0.2);
  s.viscous = true, s.turbulence = "sa", s.gas.viscosity.mu0 = 1e-3;
  Case c(std::move(grid), s, {}, tiling, ranks, rank);
  c.solver->start([](const Eigen::Vector3d& x) {
    return gas::Primitive<double>{100.0 * std::sin(5.0 * x[0]), 60.0 + std::cos(7.0 * x[1]), x[2] * x[0], x[0] - x[1],
                                  std::exp(x[2])};
  });
  return c;
}

/// Ranks that share coarse and fine tiles out leave in their tiles the bits that one rank leaves there.
void same_bits_on(int ranks) {
  const int rank = runtime::rank_in(MPI_COMM_WORLD);
  const MultiBlockGrid fine = split(cartesian_box({.ni = 32, .nj = 16, .nk = 16}), 2, {});
  const TilingOptions cut{.across_j = 4, .across_k = 4, .normal = 4};
  Case one_from = uneven(halved(fine), cut), one_to = uneven(fine, cut);
  Case from = uneven(halved(fine), cut, ranks, rank), to = uneven(fine, cut, ranks, rank);
  const std::size_t whole = transfer(*one_from.solver, *one_to.solver);
  const std::size_t held = transfer(*from.solver, *to.solver, {}, MPI_COMM_WORLD);
  CHECK(whole == std::size_t(8 * one_from.solver->unknowns()) * 16 * 8 * 8);
  CHECK(held < whole);
  const auto saved_of_one = one_to.solver->restart().save_tiles(), saved = to.solver->restart().save_tiles();
  REQUIRE(to.solver->tiles().size() == saved.size());
  for (std::size_t n = 0; n < saved.size(); ++n) CHECK(saved[n] == saved_of_one[std::size_t(to.solver->tiles()[n].index)]);
}

}  // namespace

TEST_CASE("a coarse flow that two ranks share begins the fine one with the bits of one rank", "[flow][mpi2]") { same_bits_on(2); }
TEST_CASE("a coarse flow that four ranks share begins the fine one with the bits of one rank", "[flow][mpi4]") {
  same_bits_on(4);
}

TEST_CASE("of a coarse flow a rank of eight holds what is under its own tiles", "[aero][flow][fast]") {
  const MultiBlockGrid fine = cartesian_box({.ni = 64, .nj = 32, .nk = 32});
  const TilingOptions cut{.across_j = 8, .across_k = 8, .normal = 8};
  Case from = uneven(halved(fine), cut), to = uneven(fine, cut);
  const Tiling &coarse_tiles = from.solver->grid().tiling(), &tiles = to.solver->grid().tiling();
  REQUIRE(tiles.size() >= 32);
  const long whole = 32 * 16 * 16;
  long most = 0;
  for (int rank = 0; rank < 8; ++rank) {
    std::vector<int> own;
    for (int t = 0; t < tiles.size(); ++t)
      if (t * 8 / tiles.size() == rank) own.push_back(t);
    long held = 0;
    for (const WindowOfTile& w : cells_under(coarse_tiles, tiles, own)) held += w.cells.cells();
    most = std::max(most, held);
  }
  CAPTURE(most, whole, tiles.size(), coarse_tiles.size());
  CHECK(3 * most < whole);
  // The whole on one rank is held once.
  CHECK(transfer(*from.solver, *to.solver) == std::size_t(whole * from.solver->unknowns()) * sizeof(double));
}
