// Speed and memory of the compressible solver: the implicit march to given drops on NACA 0012 (TMR grid 225 x 65, SA, 10
// degrees), the residual alone, what a cell costs as grids grow and as they are cut into blocks. User CPU seconds of one thread,
// per cell. Two density residuals are told apart: RMS over cells of R/V, and of the flux balance R itself, which is what CFL3D
// prints (l2norm.F sums res^2, resp.F takes the mean and the root; no volume). Bars that come from CFL3D's runs are held against
// the latter. Run by perf/run; bars and what was tried: docs/developer/notes/air.md. SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "perf/harness.hpp"
#include "src/aero/flow/transfer.hpp"
#include "src/aero/grid/coarsen.hpp"
#include "src/aero/grid/split.hpp"
#include "src/aero/grid/wall_distance.hpp"
#include "tests/src/aero/flow/flows.hpp"
#include "tests/verification/air/tmr_grids.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

constexpr double alpha = 10.0 * std::numbers::pi / 180.0;

FlowSetting aerofoil(double mach, const std::string& flux) {
  FlowSetting s = air(mach, {std::cos(alpha), 0.0, std::sin(alpha)});
  const double rho = gas::density(s.gas, s.stream);
  s.gas.viscosity = {.mu0 = rho * s.speed / 6e6, .T0 = 288.15, .S = 110.33 * 288.15 / 300.0};  // Re 6e6 on a chord of 1 m
  s.viscous = true;
  s.turbulence = "sa";
  s.flux = flux;
  s.march.max_steps = 200;
  return s;
}

struct Coefficients {
  double lift, drag;
};
Coefficients coefficients(const FlowSetting& s, const std::array<double, 3>& force) {
  const double q = 0.5 * gas::density(s.gas, s.stream) * s.speed * s.speed;
  return {(force[2] * std::cos(alpha) - force[0] * std::sin(alpha)) / q,
          (force[0] * std::cos(alpha) + force[2] * std::sin(alpha)) / q};
}

/// What a march had cost per cell [us] when each of its pseudo-steps began.
struct History {
  std::vector<double> cost, by_volume, balance, drag;
  /// Cost and number of the step from which on `values` stay at or below `level`.
  std::pair<double, int> settled(const std::vector<double>& values, double level) const {
    std::size_t n = values.size();
    while (n > 0 && values[n - 1] <= level) --n;
    return n < values.size() ? std::pair{cost[n], int(n)} : std::pair{std::numeric_limits<double>::infinity(), int(n)};
  }
};

Case aerofoil_case(const MultiBlockGrid& grid, const FlowSetting& s) {
  Case c(grid, s, {{"wall", {Condition::no_slip, true}}, {"far", {Condition::far_field, false}}});
  const WallSurface wall = wall_surface(c.grid, std::array<std::string, 1>{"wall"});
  for (FlowTile& tile : c.solver->tiles()) fill_wall_distance(*tile.geometry, wall);
  c.prepare();
  return c;
}

/// From the undisturbed stream, or from the flow on every second node, whose cost counts (as a scene's coarse_steps does it).
/// Drops are those from the undisturbed stream on this grid in either case.
void march(perf::Group& group, const std::string& name, double mach, bool sequenced, double bar_2, double bar_6,
           const std::string& flux = "roe_low_mach") {
  FlowSetting s = aerofoil(mach, flux);
  s.march.drop = 1e-6;
  const MultiBlockGrid grid = tmr_c_grid(SPINDRIFT_SOURCE_DIR, "tmr_224x64");
  Case c = aerofoil_case(grid, s);
  const double cells = double(c.solver->cells());
  double start = 0.0, volume_start = 0.0;
  History h;
  const double begin = perf::user_seconds();
  if (sequenced) {
    c.solver->judgement().march.judge_only();
    c.run();
    start = c.solver->march().mass_residual, volume_start = c.solver->march().now.density;
    s.march.drop = 1e-5;
    Case coarse = aerofoil_case(halved(grid), s);
    coarse.run();
    transfer(*coarse.solver, *c.solver);
    c.solver->judgement().march.begin_after_judging();
  }
  c.solver->judgement().rows.watcher = [&](const PseudoRow& row) {
    h.cost.push_back((perf::user_seconds() - begin) / cells * 1e6);
    h.by_volume.push_back(row.density_residual), h.balance.push_back(row.mass_residual);
    h.drag.push_back(coefficients(s, row.force).drag);
  };
  c.run();
  volume_start = std::max(volume_start, *std::ranges::max_element(h.by_volume));
  start = std::max(start, *std::ranges::max_element(h.balance));
  const auto [us, steps] = h.settled(h.balance, 1e-2 * start);
  const auto held = [&](const char* what, double value, double bar, const char* note) {
    if (sequenced)
      group.at_most(name + what, value, "us/cell", bar, perf::Ceiling::fma_double, note);
    else
      group.figure(name + what, value, "us/cell", note);
  };
  held("_2_orders", us, bar_2, "RMS of the flux balance, as CFL3D's");
  group.figure(name + "_2_orders_steps", steps, "-");
  const auto [us_volume, steps_volume] = h.settled(h.by_volume, 1e-2 * volume_start);
  group.figure(name + "_2_orders_by_volume", us_volume, "us/cell", "RMS of R/V");
  group.figure(name + "_2_orders_by_volume_steps", steps_volume, "-");
  held("_6_orders", h.settled(h.by_volume, 1e-6 * volume_start).first, bar_6, "RMS of R/V");
  group.figure(name + "_6_orders_steps", h.settled(h.by_volume, 1e-6 * volume_start).second, "-");
  std::vector<double> error;
  for (const double d : h.drag) error.push_back(std::abs(d / h.drag.back() - 1.0));
  held("_drag", h.settled(error, 1e-3).first, 150.0, "within 0.1 % of its last value");
  const Coefficients k = coefficients(s, c.solver->rows().back().force);
  group.figure(name + "_CL", k.lift, "-", "CFL3D 1.0838");
  group.figure(name + "_CD", k.drag, "-", "CFL3D .014488");
  group.at_most(name + "_memory", double(c.solver->bytes() + c.store->bytes()) / cells, "B/cell", 2000.0);
}

/// A box of turbulent flow in three dimensions, cut into `blocks`.
std::unique_ptr<Case> box(int n, int blocks, int threads, int pseudo_steps) {
  FlowSetting s = air(0.2, {1.0, 0.3, 0.2});
  s.viscous = true, s.turbulence = "sa", s.gas.viscosity.mu0 = 1e-2;
  s.march.max_steps = pseudo_steps, s.march.drop = 0.0, s.march.krylov_drop = 0.0, s.march.krylov_steps = 10;
  const BoxOptions options{.ni = n, .nj = n, .nk = n};
  MultiBlockGrid grid = perturbed(cartesian_box(options), options, 0.2 / n);
  if (blocks > 1) grid = split(grid, blocks, {});
  auto c = std::make_unique<Case>(grid, s, std::vector<std::pair<std::string, PatchCondition>>{});
  for (FlowTile& tile : c->solver->tiles()) std::ranges::fill(tile.geometry->wall_distance_data.span(), 0.1);
  c->solver->start([&](const Eigen::Vector3d& x) {
    gas::Primitive<double> q = s.stream;
    q.v += 5.0 * std::sin(6.0 * x[0]);
    return q;
  });
  c->prepare(MPI_COMM_SELF, {.threads = threads});
  c->run();
  return c;
}
/// User CPU of a run per cell [us].
double once(Case& c) {
  const double begin = perf::user_seconds();
  c.run();
  return (perf::user_seconds() - begin) / double(c.solver->cells()) * 1e6;
}
/// Least of some: others on the machine only add.
double cost(Case& c, int samples) {
  double least = 1e300;
  for (int n = 0; n < samples; ++n) least = std::min(least, once(c));
  return least;
}
/// Of one case over another, in turn: least of each.
double cost_over(Case& a, Case& b, int samples) {
  double least_a = 1e300, least_b = 1e300;
  for (int n = 0; n < samples; ++n) least_a = std::min(least_a, once(a)), least_b = std::min(least_b, once(b));
  return least_a / least_b;
}

}  // namespace

int main(int argc, char** argv) {
  perf::Group group("air", argc, argv);
  march(group, "naca0012_m015", 0.15, true, 40.0, 250.0);
  march(group, "naca0012_m005", 0.05, true, 50.0, 250.0);
  march(group, "naca0012_m015_osher", 0.15, true, 40.0, 250.0, "osher");
  march(group, "naca0012_m015_from_stream", 0.15, false, 0.0, 0.0);

  const auto small = box(48, 1, 1, 0);
  group.at_most("residual", cost(*small, 12), "us/cell", 0.15, perf::Ceiling::fma_double,
                "MUSCL, low-Mach Roe, full viscous terms, SA; with gradients, ghosts, norms; 48^3");
  const auto pair = box(48, 1, 2, 0);
  group.at_least("pair_of_threads", perf::paired_ratio([&] { small->run(4); }, [&] { pair->run(4); }).median, "-", 1.85);

  const auto coarse = box(36, 1, 1, 2);
  {
    const auto fine = box(72, 1, 1, 2);
    group.at_most("step_373k_over_47k_cells", cost_over(*fine, *coarse, 3), "-", 1.15, perf::Ceiling::none,
                  "two pseudo-steps of 10 Krylov steps");
  }
  {
    const auto cut = box(48, 27, 1, 2), whole = box(48, 1, 1, 2);
    group.at_most("step_27_blocks_over_one", cost_over(*cut, *whole, 6), "-", 1.05, perf::Ceiling::none, "tiles unchanged");
  }
  const auto finest = box(128, 1, 1, 2);
  group.at_most("step_2M_over_47k_cells", cost_over(*finest, *coarse, 2), "-", 1.15);
  const auto cut = box(128, 256, 1, 2);
  group.at_most("step_256_blocks_over_one", cost_over(*cut, *finest, 3), "-", 1.05, perf::Ceiling::none,
                "256 tiles of 8192 cells, each a block of its own or all in one");
}
