// preconditioner = "auto": the choice follows iterations and the stated model, and is the same for any threads and ranks.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/choice.hpp"

#include <catch2/catch.hpp>

#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

/// Flow against a wall in a box of 27 tiles.
Case into_a_wall(double cfl_max, int ranks = 1, int rank = 0) {
  FlowSetting s = air(0.05, {1.0, 0.4, 0.2});
  s.march.cfl_max = cfl_max, s.march.krylov_drop = 1e-2, s.march.krylov_steps = 30;
  const BoxOptions box{.ni = 12, .nj = 12, .nk = 12};
  return Case(perturbed(cartesian_box(box), box, 0.03), s, {{"i_max", {Condition::slip, true}}},
              {.across_j = 4, .across_k = 4, .normal = 4}, ranks, rank);
}

}  // namespace

TEST_CASE("the automatic choice: block ILU for small steps, a coarse correction for large ones", "[flow][fast]") {
  Case small = into_a_wall(2.0), large = into_a_wall(1e4);
  const Choice of_small = choose_preconditioner(*small.solver, MPI_COMM_SELF, 1),
               of_large = choose_preconditioner(*large.solver, MPI_COMM_SELF, 1);
  CAPTURE(of_small.reason, of_large.reason);
  CHECK(of_small.preconditioner == "block_ilu");
  CHECK(of_large.preconditioner == "coarse");
  CHECK(of_large.trials[1].needed < 0.8 * of_large.trials[0].needed);
  CHECK(of_large.reason.find("coarse: ") != std::string::npos);
  // The solver itself is as it was.
  CHECK(stream_deviation(*large.solver) == 0.0);
  CHECK(large.solver->rows().empty());
  CHECK(choose_preconditioner(*large.solver, MPI_COMM_SELF, 3).reason == of_large.reason);
}

TEST_CASE("the cost model: what a trial leaves is extended by its mean rate, groups cost where multigrid has them",
          "[flow][fast]") {
  const CostModel m;
  const Trial ilu{.preconditioner = "block_ilu", .needed = 10.0}, coarse{.preconditioner = "coarse", .needed = 10.0};
  CHECK(cost_of(ilu, m, 1000, 0, true) == Approx(3.6));
  CHECK(cost_of(coarse, m, 1000, 10, true) == Approx(5.0));
  CHECK(cost_of(coarse, m, 1000, 10, false) == Approx(5.0 + (160.0 + 50.0) * 0.01));
}

TEST_CASE("two ranks choose as one does", "[flow][mpi2]") {
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  Case whole = into_a_wall(1e4), part = into_a_wall(1e4, 2, rank);
  part.solver->fill_geometry(MPI_COMM_WORLD);
  CHECK(choose_preconditioner(*whole.solver, MPI_COMM_SELF, 1).reason ==
        choose_preconditioner(*part.solver, MPI_COMM_WORLD, 2).reason);
}
