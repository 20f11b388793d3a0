// Preconditioners of the implicit air against each other, each row measured in turn in one run, user CPU of one thread per cell:
// what 256 tiles cost over one; the map of one pseudo-step's linear system over Mach number, CFL number and tiles, with the
// winner, and of two million cells over the CFL number; a march to six orders round a cylinder at Mach 1e-3. Forms: block ILU;
// coarse correction by groups of 8 cells a side, eliminated or left to BoomerAMG with ILU smoothing; by groups of 4, left to it.
// What it says: docs/developer/notes/air_linear.md. Run by perf/run. SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <tuple>

#include "perf/harness.hpp"
#include "src/aero/grid/generators/plane_cases.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

struct Form {
  const char* name;
  const char* preconditioner;
  PreconditionerOptions coarse;
};
const Form block_ilu{"block_ilu", "block_ilu", {}}, by_tile{"coarse_by_tile", "coarse", {.group_cells = 0}},
    eliminated{"coarse_8", "coarse", {.group_cells = 8}},
    by_eights{"coarse_8_amg", "coarse", {.group_cells = 8, .direct_groups = 0}},
    multigrid{"coarse_4_amg", "coarse", {.group_cells = 4, .direct_groups = 0}};

struct Problem {
  int n = 32, nk = 32;
  std::array<int, 3> tile{64, 16, 8};  ///< most cells of a tile along i, j, k
  double mach = 0.05, cfl = 1e3, drop = 1e-2;
};
struct Solved {
  double us = 0.0;        ///< per cell: residual, matrix, set-up and solution of one pseudo-step
  double per_drop = 0.0;  ///< the same for the drop asked for, by the mean rate where 40 iterations were not enough
  int iterations = 0;
  double drop = 0.0;
};

/// One pseudo-step of a swirl in a skewed box, from an undisturbed start each time.
Solved solve(const Problem& p, const Form& form) {
  FlowSetting s = air(p.mach, {1.0, 0.4, 0.2});
  s.preconditioner = form.preconditioner, s.coarse = form.coarse;
  s.march = {.cfl_start = p.cfl,
             .cfl_max = p.cfl,
             .drop = 0.0,
             .max_steps = 1,
             .krylov_steps = 40,
             .krylov_drop = p.drop,
             .matrix_free_below = 0.0};
  const BoxOptions box{.ni = p.n, .nj = p.n, .nk = p.nk};
  Case c(perturbed(cartesian_box(box), box, 0.03), s, {},
         {.across_j = p.tile[1], .across_k = p.tile[2], .normal = p.tile[0], .max_cells = 1 << 24});
  c.solver->start([&](const Eigen::Vector3d& x) {
    gas::Primitive<double> q = s.stream;
    q.u += 0.3 * s.speed * std::sin(6.0 * x[1] + 2.0 * x[2]), q.v += 0.3 * s.speed * std::cos(5.0 * x[0]);
    q.p += 0.1 * gas::density(s.gas, q) * s.speed * s.speed * std::sin(3.0 * x[0] + x[2]);
    return q;
  });
  c.prepare();
  const double begin = perf::user_seconds();
  c.run();
  Solved r{.us = (perf::user_seconds() - begin) / double(c.solver->cells()) * 1e6,
           .iterations = c.solver->march().last.krylov,
           .drop = c.solver->march().last.linear_drop};
  r.per_drop = r.us * std::max(1.0, std::log(p.drop) / std::log(r.drop));
  return r;
}
/// The cheaper of two: others on the machine only add.
Solved solve_twice(const Problem& p, const Form& form) {
  const Solved a = solve(p, form), b = solve(p, form);
  return a.us < b.us ? a : b;
}

void many_tiles(perf::Group& group) {
  const Problem whole{.n = 64, .nk = 32, .tile = {64, 64, 64}}, cut{.n = 64, .nk = 32, .tile = {8, 8, 8}};
  const Solved one = solve_twice(whole, block_ilu), without = solve_twice(cut, block_ilu);
  group.figure("one_tile_iterations", one.iterations, "-", "64 x 64 x 32 cells, CFL 1000, Mach 0.05, to 1e-2");
  group.figure("256_tiles_block_ilu_iterations", without.iterations * without.per_drop / without.us, "-",
               "extended by the mean rate beyond 40");
  for (const Form& form : {by_tile, eliminated, multigrid}) {
    const Solved with = solve_twice(cut, form);
    const std::string name = std::string("256_tiles_") + form.name;
    group.at_most(name + "_iterations_over_one_tile", double(with.iterations) / one.iterations, "-", 1.3);
    group.at_most(name + "_time_over_block_ilu", with.us / without.per_drop, "-", 1.0, perf::Ceiling::none,
                  "user CPU to 1e-2, same run");
  }
  // More cells in tiles as the program cuts them.
  const Problem large{.n = 64, .nk = 64};
  const Solved alone = solve(large, block_ilu);
  group.figure("262k_cells_block_ilu", alone.per_drop, "us/cell", "32 tiles of 64 x 16 x 8");
  for (const Form& form : {eliminated, by_eights})
    group.at_most(std::string("262k_cells_") + form.name + "_time_over_block_ilu", solve(large, form).us / alone.per_drop, "-",
                  1.0, perf::Ceiling::none, "512 groups");
}

void map(perf::Group& group) {
  std::printf(
      "\n| Mach | CFL | tiles | block ILU | coarse, 8 | coarse, 4, AMG | winner "
      "|\n|---|---|---|---|---|---|---|\n");
  int won = 0, of = 0;
  for (const double mach : {0.3, 0.05, 1e-3})
    for (const double cfl : {10.0, 100.0, 1e3, 1e4})
      for (const int side : {16, 8}) {
        const Problem p{.tile = {2 * side, side, 8}, .mach = mach, .cfl = cfl};
        std::printf("| %g | %g | %d |", mach, cfl, side == 16 ? 8 : 32);
        const char* best = "";
        double least = 1e300;
        for (const Form& form : {block_ilu, eliminated, multigrid}) {
          const Solved r = solve(p, form);
          std::printf(" %.1f, %s%d |", r.per_drop, r.drop > p.drop ? "more than " : "", r.iterations);
          if (r.per_drop < least) least = r.per_drop, best = form.name;
        }
        std::printf(" %s |\n", best);
        std::fflush(stdout);
        won += best != block_ilu.name, ++of;
      }
  group.figure("map_won_by_other_than_block_ilu", won, "-",
               "of " + std::to_string(of) + " rows; 32^3 cells, us per cell to 1e-2");
}

/// Two million cells in tiles as the program cuts them, coarse levels of 4,096 and 32,768 groups by hypre.
void two_million(perf::Group& group) {
  std::printf("\n| CFL, 2 M cells | block ILU | coarse, 8 | coarse, 8, AMG | coarse, 4, AMG |\n|---|---|---|---|---|\n");
  const Form without_hypre{"coarse_8", "coarse", {.group_cells = 8, .direct_groups = 4096}};
  for (const double cfl : {10.0, 100.0, 1e3, 1e4}) {
    std::printf("| %g |", cfl);
    double by_hypre = 1e300, others = 1e300;
    for (const Form& form : {block_ilu, without_hypre, by_eights, multigrid}) {
      const Solved r = solve({.n = 128, .nk = 128, .cfl = cfl}, form);
      std::printf(" %.1f, %s%d |", r.per_drop, r.drop > 1e-2 ? "more than " : "", r.iterations);
      std::fflush(stdout);
      double& least = form.coarse.direct_groups == 0 ? by_hypre : others;
      least = std::min(least, r.per_drop);
    }
    std::printf("\n");
    group.figure("2M_cells_cfl_" + std::to_string(int(cfl)) + "_hypre_over_best_of_others", by_hypre / others, "-",
                 "2,097,152 cells, user CPU to 1e-2, same run");
  }
}

/// Ten physical steps of two cells' passage, three pseudo-steps each, one set-up for each matrix, for each step, for all ten.
void kept(perf::Group& group) {
  double each = 0.0;
  for (const auto& [name, every, steps] : {std::tuple{"each_matrix", 1, 1}, {"each_step", 3, 1}, {"ten_steps", 3, 10}}) {
    FlowSetting s = air(0.05, {1.0, 0.4, 0.2});
    s.preconditioner = multigrid.preconditioner, s.coarse = multigrid.coarse;
    s.coarse.common_every = every, s.coarse.common_steps = steps;
    s.time_order = 2, s.dt = 2.0 / 32.0 / s.speed;
    s.march = {.cfl_start = 100.0,
               .cfl_max = 100.0,
               .drop = 0.0,
               .max_steps = 3,
               .krylov_steps = 20,
               .krylov_drop = 0.1,
               .matrix_free_below = 0.0};
    const BoxOptions box{.ni = 32, .nj = 32, .nk = 32};
    Case c(perturbed(cartesian_box(box), box, 0.03), s, {}, {.across_j = 16, .across_k = 8, .normal = 32});
    c.solver->start([&](const Eigen::Vector3d& x) {
      gas::Primitive<double> q = s.stream;
      q.u += 0.3 * s.speed * std::sin(6.0 * x[1] + 2.0 * x[2]), q.v += 0.3 * s.speed * std::cos(5.0 * x[0]);
      return q;
    });
    c.prepare();
    const double begin = perf::user_seconds();
    c.run(10);
    const double us = (perf::user_seconds() - begin) / double(c.solver->cells()) * 1e5;
    long iterations = 0;
    for (const PseudoRow& row : c.solver->rows()) iterations += row.krylov;
    const std::string figure = std::string("set_up_for_") + name + "_" + multigrid.name;
    group.figure(figure, us, "us/cell/step",
                 std::to_string(iterations) + " iterations in 10 steps of 3 pseudo-steps, 32^3 cells");
    if (every == 1)
      each = us;
    else if (steps > 1)
      group.at_most(figure + "_over_each_matrix", us / each, "-", 1.0, perf::Ceiling::none, "user CPU, same run");
  }
}

/// The scene of inputs/validation/cylinder_low_mach on twice its cells a side.
void cylinder(perf::Group& group) {
  double alone = 0.0;
  for (const Form& form : {block_ilu, eliminated, by_eights}) {
    FlowSetting s = air(1e-3);
    s.preconditioner = form.preconditioner, s.coarse = form.coarse;
    s.march.drop = 1e-6, s.march.max_steps = 150;
    Case c(aero::cylinder({.around = 192, .outward = 96, .far = 20.0}), s,
           {{"wall", {Condition::slip, true}}, {"farfield", {Condition::far_field, false}}});
    c.prepare();
    const double begin = perf::user_seconds();
    c.run();
    const double us = (perf::user_seconds() - begin) / double(c.solver->cells()) * 1e6;
    const std::string name = std::string("cylinder_m0001_6_orders_") + form.name;
    group.figure(name, us, "us/cell", "192 x 96 cells, inviscid, default march");
    group.figure(name + "_steps", c.solver->march().steps, "-");
    group.figure(name + "_krylov", double(c.solver->march().krylov_total), "-");
    if (alone == 0.0)
      alone = us;
    else
      group.figure(name + "_over_block_ilu", us / alone, "-", "same run");
  }
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);  // hypre asks for its rank
  {
    perf::Group group("air_amg", argc, argv);
    kept(group);
    many_tiles(group);
    map(group);
    two_million(group);
    cylinder(group);
  }
  MPI_Finalize();
}
