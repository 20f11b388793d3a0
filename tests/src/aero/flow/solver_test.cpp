// The march as a whole: a uniform stream stays one, a disturbed one becomes one, and the bits are the same for any threads, ranks
// and schedules. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

/// A bump of pressure, temperature and cross wind in a skewed box of several tiles.
Case bump(const FlowSetting& setting, int ranks, int rank) {
  const BoxOptions box{.ni = 12, .nj = 12, .nk = 8};
  Case c(perturbed(cartesian_box(box), box, 0.04), setting, {}, {.across_j = 6, .across_k = 4, .normal = 12}, ranks, rank);
  c.solver->start([&](const Eigen::Vector3d& x) {
    gas::Primitive<double> q = setting.stream;
    const double height = std::exp(-20.0 * (x - Eigen::Vector3d::Constant(0.5)).squaredNorm());
    q.p += 2000.0 * height, q.T += 3.0 * height, q.v += 10.0 * height;
    return q;
  });
  return c;
}

FlowSetting viscous_air() {
  FlowSetting s = air(0.3, {1.0, 0.4, 0.2});
  s.viscous = true;
  s.turbulence = "sa";
  s.gas.viscosity.mu0 = 1e-2;
  s.march.drop = 1e-6;
  s.march.max_steps = 8;
  return s;
}

int rank_of(MPI_Comm comm) {
  int rank;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

}  // namespace

TEST_CASE("a disturbance in a box of far fields leaves and the stream comes back", "[flow][fast]") {
  FlowSetting setting = air(0.3, {1.0, 0.4, 0.2});
  setting.march.drop = 1e-9;
  setting.march.max_steps = 60;
  Case c = bump(setting, 1, 0);
  c.prepare();
  c.run();
  CHECK(c.solver->march().verdict == Verdict::converged);
  CHECK(c.solver->march().now.density < 1.1e-9 * c.solver->march().first.density);
  CHECK(stream_deviation(*c.solver) < 1e-8);
}

TEST_CASE("a uniform stream through a skewed box is no flow's business: nothing moves", "[flow][fast]") {
  for (const double mach : {1e-3, 0.3, 0.9}) {
    FlowSetting setting = air(mach, {0.3, -0.5, 0.8});
    setting.march.absolute = 0.0;
    setting.march.drop = 0.0;
    setting.march.max_steps = 20;
    setting.march.matrix_free_below = 0.0;
    const BoxOptions box{.ni = 10, .nj = 8, .nk = 8};
    Case c(perturbed(cartesian_box(box), box, 0.05), setting, {}, {.across_j = 4, .across_k = 4, .normal = 10});
    c.prepare();
    c.run();
    CHECK(stream_deviation(*c.solver) < 1e-12);
  }
}

TEST_CASE("threads and random schedules leave every bit of a viscous march as it is", "[flow][fast]") {
  std::vector<double> expected, state;
  for (const int threads : {1, 2, 4}) {
    for (const std::uint64_t seed : {0u, 1u, 2u}) {
      if (threads == 1 && seed > 0) continue;
      Case c = bump(viscous_air(), 1, 0);
      runtime::ExecutorOptions options{.threads = threads};
      if (seed > 0) options.random_schedule = seed;
      c.prepare(MPI_COMM_SELF, options);
      c.run();
      const auto rows = fingerprint(*c.solver);
      const auto now = state_of(*c.solver);
      if (expected.empty()) expected = rows, state = now;
      CHECK(rows == expected);
      CHECK(now == state);
    }
  }
  CHECK(expected.size() == 9 * 6);
}

namespace {
void same_bits(int ranks) {
  const int rank = rank_of(MPI_COMM_WORLD);
  Case whole = bump(viscous_air(), 1, 0), part = bump(viscous_air(), ranks, rank);
  whole.prepare();
  whole.run();
  part.prepare(MPI_COMM_WORLD, {.threads = 2});
  part.run();
  CHECK(fingerprint(*whole.solver) == fingerprint(*part.solver));
  for (std::size_t n = 0; n < part.solver->tiles().size(); ++n) {
    const int tile = part.solver->tiles()[n].index;
    std::vector<double> mine(part.solver->restart().size(int(n))), same(mine.size());
    part.solver->restart().save(int(n), mine);
    whole.solver->restart().save(tile, same);
    CHECK(mine == same);
  }
}
}  // namespace

TEST_CASE("two ranks give the bits of one", "[flow][mpi2]") { same_bits(2); }
TEST_CASE("four ranks give the bits of one", "[flow][mpi4]") { same_bits(4); }

TEST_CASE("a march restarted from what was saved goes on with the same bits", "[flow][fast]") {
  FlowSetting setting = viscous_air();
  setting.time_order = 2, setting.dt = 1e-3;
  setting.march.drop = 1e-2;
  Case whole = bump(setting, 1, 0), first = bump(setting, 1, 0), second = bump(setting, 1, 0);
  for (Case* c : {&whole, &first, &second}) c->prepare();
  for (int n = 0; n < 4; ++n) whole.run();
  for (int n = 0; n < 2; ++n) first.run();
  carry_over(*first.solver, *second.solver);
  for (int n = 0; n < 2; ++n) second.run();
  CHECK(state_of(*whole.solver) == state_of(*second.solver));
}

TEST_CASE("a state without a finite residual is refused by name, not marched on", "[flow][fast]") {
  Case c = bump(viscous_air(), 1, 0);
  c.solver->tiles()[1].state.data()[c.solver->tiles()[1].cells.at(1, 1, 1)] = std::nan("");
  c.prepare();
  c.run();
  CHECK(c.solver->march().verdict == Verdict::failed);
  CHECK(c.solver->judgement().trouble().find("no finite residual in the row of block 0 cell (") != std::string::npos);
}

TEST_CASE("cells whose bounds shorten an update are counted, and the worst of them has its place", "[flow][fast]") {
  FlowSetting setting = viscous_air();
  setting.march.cfl_start = 1e3, setting.march.max_steps = 12;
  Case weak = bump(setting, 1, 0), strong = bump(setting, 1, 0);
  const auto hot_middle = [&](const Eigen::Vector3d& x) {
    gas::Primitive<double> q = setting.stream;
    const double height = std::exp(-20.0 * (x - Eigen::Vector3d::Constant(0.5)).squaredNorm());
    q.p += 6e4 * height, q.T += 60.0 * height;
    return q;
  };
  strong.solver->start(hot_middle);
  for (Case* c : {&weak, &strong}) {
    c->prepare();
    c->run();
  }
  for (const PseudoRow& row : weak.solver->rows()) CHECK(row.limited == 0.0);
  CHECK(weak.solver->limited_cells(Updates::all, MPI_COMM_SELF).text().find("the change of velocity") == std::string::npos);
  double most = 0.0, least_fraction = 1.0;
  for (const PseudoRow& row : strong.solver->rows()) {
    CHECK((row.limited > 0.0) == (row.fraction < 1.0));
    most = std::max(most, row.limited), least_fraction = std::min(least_fraction, row.fraction);
  }
  CHECK(most > 1.0);
  CHECK(most < double(strong.solver->cells()));
  const std::string worst = strong.solver->limited_cells(Updates::all, MPI_COMM_SELF).text();
  INFO(worst);
  CHECK(worst.find("the change of ") == 0);
  CHECK(worst.find("block 0 cell (") != std::string::npos);
  CHECK(worst.find(fmt::format("to {:.2g} of itself", least_fraction)) != std::string::npos);
  // Of the last update alone: nothing where it had no limit, its own place where it had.
  CHECK(strong.solver->rows().back().limited == 0.0);
  CHECK(strong.solver->limited_cells(Updates::last, MPI_COMM_SELF).mean.text.empty());
  setting.march.max_steps = 1;
  Case once = bump(setting, 1, 0);
  once.solver->start(hot_middle);
  once.prepare();
  once.run();
  CHECK(once.solver->rows().back().limited > 0.0);
  const LimitPlace last = once.solver->limited_cells(Updates::last, MPI_COMM_SELF).mean;
  CHECK(last.text == once.solver->limited_cells(Updates::all, MPI_COMM_SELF).mean.text);
  CHECK(last.fraction == once.solver->rows().back().fraction);
}

// The vectors of the linear solver are made as iterations come to them. Steady marches come to all of them; a physical step keeps
// two more states of the past and comes to few. Of a box that is open on all sides 3 B are mass fluxes of its faces.
TEST_CASE("memory stays below 2 kB per cell with a turbulence model, the implicit solver and block ILU, all at defaults",
          "[flow][fast]") {
  for (const int order : {0, 2}) {
    FlowSetting setting = air(0.3, {1.0, 0.4, 0.2});
    setting.viscous = true, setting.turbulence = "sa", setting.gas.viscosity.mu0 = 1e-2;
    setting.time_order = order, setting.dt = 1e-3;
    if (order == 0)
      setting.march.drop = 0.0, setting.march.krylov_drop = 0.0, setting.march.cfl_start = 1e4, setting.march.max_steps = 1;
    const BoxOptions box{.ni = 64, .nj = 16, .nk = 8};
    Case c(perturbed(cartesian_box(box), box, 0.005), setting, {}, {.across_j = 16, .across_k = 8, .normal = 64});
    for (FlowTile& tile : c.solver->tiles()) std::ranges::fill(tile.geometry->wall_distance_data.span(), 0.1);
    c.solver->start([&](const Eigen::Vector3d& x) {
      gas::Primitive<double> q = setting.stream;
      q.v += 5.0 * std::sin(6.0 * x[0]);
      return q;
    });
    c.prepare();
    c.run(order == 0 ? 1 : 3);
    int most = 0;
    for (const PseudoRow& row : c.solver->rows()) most = std::max(most, row.krylov);
    CHECK(c.solver->march().verdict == Verdict::converged);
    CHECK((order == 0 ? most == setting.march.krylov_steps : most >= 3));
    const double per_cell = double(c.solver->bytes() + c.store->bytes()) / double(c.solver->cells());
    CAPTURE(order, most, per_cell);
    CHECK(per_cell < 2004.0);
    std::printf("memory, order %d: %d iterations, %.0f B per cell\n", order, most, per_cell);
  }
}
