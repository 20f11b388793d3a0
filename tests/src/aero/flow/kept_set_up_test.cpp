// A set-up of the coarse correction or of multigrid that outlives physical steps: made at fixed steps, carried by snapshots and
// restarts, so that a march goes on with the same bits; repeated windows leave none behind. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

constexpr int every = 3;  // physical steps that a set-up serves

/// A swirl carried through a skewed box of 27 tiles in steps of two cells' passage.
FlowSetting unsteady(const char* preconditioner, PreconditionerOptions coarse) {
  FlowSetting s = air(0.05, {1.0, 0.4, 0.2});
  s.preconditioner = preconditioner;
  s.coarse = coarse, s.coarse.common_every = 1000, s.coarse.common_steps = every;
  s.time_order = 2, s.dt = 2.0 / 12.0 / s.speed;
  s.march = {.cfl_start = 100.0,
             .cfl_max = 100.0,
             .drop = 1e-2,
             .max_steps = 3,
             .krylov_steps = 8,
             .krylov_drop = 0.1,
             .matrix_free_below = 0.0};
  return s;
}
const FlowSetting settings[]{unsteady("coarse", {.group_cells = 4}), unsteady("coarse", {.group_cells = 2, .direct_groups = 0})};

Case carried_swirl(const FlowSetting& setting, int threads = 1, int ranks = 1, int rank = 0) {
  const BoxOptions box{.ni = 12, .nj = 12, .nk = 12};
  Case c(perturbed(cartesian_box(box), box, 0.03), setting, {}, {.across_j = 4, .across_k = 4, .normal = 4}, ranks, rank);
  c.solver->start([&](const Eigen::Vector3d& x) {
    gas::Primitive<double> q = setting.stream;
    q.u += 0.3 * setting.speed * std::sin(6.0 * x[1] + 2.0 * x[2]), q.v += 0.3 * setting.speed * std::cos(5.0 * x[0]);
    return q;
  });
  c.prepare(ranks > 1 ? MPI_COMM_WORLD : MPI_COMM_SELF, {.threads = threads});
  return c;
}
SetUpNote of_another(SetUpNote note) {
  note.number = 0;
  return note;
}

}  // namespace

TEST_CASE("a set-up kept over physical steps goes on over a restart with the same bits, on any threads", "[flow][fast]") {
  for (const FlowSetting& s : settings) {
    CAPTURE(s.preconditioner, s.coarse.direct_groups);
    for (const int before : {every + 1, 2 * every}) {  // in the middle of a set-up's life, and where a new one is due
      Case whole = carried_swirl(s), first = carried_swirl(s), second = carried_swirl(s, 3), forgetful = carried_swirl(s);
      whole.run(std::uint32_t(before + 2));
      first.run(std::uint32_t(before));
      carry_over(*first.solver, *second.solver);
      second.solver->restart().load_set_up(of_another(first.solver->restart().save_set_up()));
      second.run(2);
      CHECK(state_of(*whole.solver) == state_of(*second.solver));
      carry_over(*first.solver, *forgetful.solver);  // without it a set-up of its own is made at once
      forgetful.run(2);
      CHECK((state_of(*whole.solver) == state_of(*forgetful.solver)) == (before % every == 0));
    }
  }
}

TEST_CASE("windows undone and done again, with or without a new set-up in them, leave the bits of one done once",
          "[flow][fast]") {
  for (const FlowSetting& s : settings) {
    CAPTURE(s.preconditioner, s.coarse.direct_groups);
    Case once = carried_swirl(s), twice = carried_swirl(s);
    once.run(2 * every + 1);
    for (int step = 0; step < 2 * every + 1; ++step) {
      const FlowSnapshot start = twice.solver->restart().snapshot();
      TileStates off = start.tiles;  // a little off: a window that will be undone
      for (std::vector<double>& tile : off)
        for (double& value : tile) value *= 1.001;
      twice.solver->restart().load_tiles(off);
      twice.run();
      twice.solver->restart().restore(start);
      twice.run();
    }
    CHECK(state_of(*once.solver) == state_of(*twice.solver));
  }
}

TEST_CASE("a set-up kept over steps takes hardly more iterations than one for each matrix", "[flow][fast]") {
  for (FlowSetting s : settings) {
    Case kept = carried_swirl(s);
    kept.run(2 * every);
    s.coarse.common_every = 1, s.coarse.common_steps = 1;
    Case each = carried_swirl(s);
    each.run(2 * every);
    const auto iterations = [](const Case& c) {
      long sum = 0;
      for (const PseudoRow& row : c.solver->rows()) sum += row.krylov;
      return sum;
    };
    CAPTURE(s.preconditioner, s.coarse.direct_groups, iterations(kept), iterations(each));
    CHECK(iterations(kept) <= 1.1 * double(iterations(each)));
  }
}

TEST_CASE("two ranks give a kept set-up that is eliminated the bits of one", "[flow][mpi2]") {
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  Case whole = carried_swirl(settings[0]), part = carried_swirl(settings[0], 2, 2, rank);
  whole.run(every + 2), part.run(every + 2);
  CHECK(fingerprint(*whole.solver) == fingerprint(*part.solver));
}
