// Preconditioners with a coarse level: elimination and groups against dense algebra, the same flow as block ILU in fewer
// iterations, bits on threads, reruns and ranks, tolerance where multigrid depends on ranks. SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/coarse_correction.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "src/aero/flow/block_elimination.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

/// A swirl in a skewed box of many small tiles; CFL numbers at which tiles matter.
FlowSetting swirling(const char* preconditioner, PreconditionerOptions coarse = {}) {
  FlowSetting s = air(0.05, {1.0, 0.4, 0.2});
  s.preconditioner = preconditioner;
  s.coarse = coarse;
  s.march = {.cfl_start = 1000.0, .drop = 0.0, .max_steps = 1, .krylov_steps = 30, .krylov_drop = 1e-2};
  return s;
}
Case swirl(const FlowSetting& setting, int n = 16, int ranks = 1, int rank = 0) {
  const BoxOptions box{.ni = n, .nj = n, .nk = n};
  Case c(perturbed(cartesian_box(box), box, 0.03), setting, {}, {.across_j = 4, .across_k = 4, .normal = 4}, ranks, rank);
  c.solver->start([&](const Eigen::Vector3d& x) {
    gas::Primitive<double> q = setting.stream;
    q.u += 0.3 * setting.speed * std::sin(6.0 * x[1] + 2.0 * x[2]), q.v += 0.3 * setting.speed * std::cos(5.0 * x[0]);
    q.p += 0.1 * gas::density(setting.gas, q) * setting.speed * setting.speed * std::sin(3.0 * x[0] + x[2]);
    return q;
  });
  return c;
}
Case solved(const FlowSetting& setting, int threads = 1) {
  Case c = swirl(setting);
  c.prepare(MPI_COMM_SELF, {.threads = threads});
  c.run();
  return c;
}

}  // namespace

TEST_CASE("elimination of block rows gives what dense algebra gives, in any order of its entries", "[flow][fast]") {
  constexpr int rows = 40, n = 5;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  std::vector<BlockElimination::Entry> entries;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(rows * n, rows * n);
  for (int r = 0; r < rows; ++r)
    for (const int c : {r, (r + 1) % rows, (r + rows - 1) % rows, (r + 7) % rows, (r + rows - 7) % rows}) {
      BlockElimination::Entry e{r, c, {}};
      for (int a = 0; a < 25; ++a) e.block[std::size_t(a)] = number(random) + (r == c && a % 6 == 0 ? 8.0 : 0.0);
      for (int a = 0; a < 25; ++a) dense(r * n + a % n, c * n + a / n) += e.block[std::size_t(a)];
      entries.push_back(e);
    }
  std::vector<double> b(rows * n), x(rows * n);
  for (double& value : b) value = number(random);
  BlockElimination elimination;
  elimination.factorise(rows, entries);
  elimination.solve(b, x);
  const Eigen::VectorXd wanted = dense.partialPivLu().solve(Eigen::Map<const Eigen::VectorXd>(b.data(), rows * n));
  for (int i = 0; i < rows * n; ++i) CHECK(x[std::size_t(i)] == Approx(wanted[i]).margin(1e-12));

  const std::vector<double> first = x;
  BlockElimination used;  // by a larger matrix without couplings before
  std::vector<BlockElimination::Entry> apart;
  for (int r = 0; r < 2 * rows; ++r) apart.push_back({r, r, entries.front().block});
  used.factorise(2 * rows, apart);
  used.factorise(rows, entries);
  used.solve(b, x);
  CHECK(x == first);

  for (BlockElimination::Entry& e : entries) e.block.fill(0.0);
  CHECK_THROWS_WITH(elimination.factorise(rows, entries), Catch::Contains("singular"));
}

TEST_CASE("a coarse correction ends in the solution of block ILU in fewer iterations, by elimination or multigrid",
          "[flow][fast]") {
  const Case ilu = solved(swirling("block_ilu"));
  REQUIRE(ilu.solver->tiles().size() == 64);
  const std::vector<double> state = state_of(*ilu.solver);
  const int alone = ilu.solver->march().last.krylov;
  const std::vector<double> before = state_of(*swirl(swirling("block_ilu")).solver);
  double change = 0.0;
  for (std::size_t n = 0; n < state.size(); ++n) change = std::max(change, std::abs(state[n] - before[n]));
  for (const PreconditionerOptions& o :
       {PreconditionerOptions{.group_cells = 0}, PreconditionerOptions{.group_cells = 0, .direct_groups = 0},
        PreconditionerOptions{.group_cells = 2}}) {
    const Case c = solved(swirling("coarse", o));
    CAPTURE(o.group_cells, o.direct_groups, alone);
    CHECK(c.solver->march().last.linear_drop <= 1e-2);
    CHECK(c.solver->march().last.krylov < alone);
    double apart = 0.0;
    const std::vector<double> other = state_of(*c.solver);
    for (std::size_t n = 0; n < state.size(); ++n) apart = std::max(apart, std::abs(other[n] - state[n]));
    CHECK(apart < 0.05 * change);
  }
}

TEST_CASE("threads and reruns leave every bit of preconditioners with a coarse level", "[flow][fast]") {
  for (const FlowSetting& s :
       {swirling("coarse", {.group_cells = 4}), swirling("coarse", {.group_cells = 2, .direct_groups = 0})}) {
    const Case one = solved(s), again = solved(s), three = solved(s, 3);
    CHECK(state_of(*one.solver) == state_of(*again.solver));
    CHECK(state_of(*one.solver) == state_of(*three.solver));
    CHECK(fingerprint(*one.solver) == fingerprint(*three.solver));
  }
}

namespace {
void coarse_on(int ranks) {
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  for (const FlowSetting& s :
       {swirling("coarse", {.group_cells = 4}), swirling("coarse", {.group_cells = 2, .direct_groups = 0})}) {
    Case whole = swirl(s), part = swirl(s, 16, ranks, rank);
    whole.prepare();
    whole.run();
    part.prepare(MPI_COMM_WORLD, {.threads = 2});
    part.run();
    if (s.coarse.direct_groups > 0)
      CHECK(fingerprint(*whole.solver) == fingerprint(*part.solver));
    else
      CHECK(part.solver->march().last.linear_drop <= 1e-2);
    CHECK(std::abs(whole.solver->march().last.krylov - part.solver->march().last.krylov) <= 2);
    CHECK(part.solver->rows().back().density_residual == Approx(whole.solver->rows().back().density_residual).epsilon(0.1));
  }
}
}  // namespace

TEST_CASE("two ranks give an eliminated coarse correction the bits of one, multigrid its tolerance", "[flow][mpi2]") {
  coarse_on(2);
}
TEST_CASE("four ranks give an eliminated coarse correction the bits of one, multigrid its tolerance", "[flow][mpi4]") {
  coarse_on(4);
}

TEST_CASE("groups grow until there are few enough to eliminate", "[flow][fast]") {
  const BoxOptions box{.ni = 16, .nj = 16, .nk = 16};
  const Tiling tiling = make_tiling(cartesian_box(box), {}, {.across_j = 8, .across_k = 8, .normal = 8});
  REQUIRE(tiling.size() == 8);
  CHECK(side_of_groups(tiling, 2, 512) == 2);
  CHECK(side_of_groups(tiling, 2, 511) == 4);
  CHECK(side_of_groups(tiling, 2, 8) == 8);
  CHECK(side_of_groups(tiling, 0, 8) == 0);
  CHECK(side_of_groups(tiling, 2, 7) == std::nullopt);
}
