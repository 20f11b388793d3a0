// Speed and memory of the compressible solver: the residual, the implicit march to given drops on NACA 0012 (TMR grid 225 x 65, SA, 10
// degrees), what a cell costs. User CPU seconds of one thread, per cell.
// Run by perf/run; bars and what was tried: docs/developer/air.md. SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>

#include <cmath>
#include <numbers>

#include "perf/harness.hpp"
#include "src/aero/grid/wall_distance.hpp"
#include "tests/src/aero/flow/flows.hpp"
#include "tests/verification/air/tmr_grids.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

double user_seconds() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_utime.tv_sec) + 1e-6 * double(usage.ru_utime.tv_usec);
}

constexpr double alpha = 10.0 * std::numbers::pi / 180.0;

FlowSetting aerofoil(double mach) {
  FlowSetting s = air(mach, {std::cos(alpha), 0.0, std::sin(alpha)});
  const double rho = gas::density(s.gas, s.stream);
  s.gas.viscosity = {.mu0 = rho * s.speed / 6e6, .T0 = 288.15, .S = 110.33 * 288.15 / 300.0};  // Re 6e6 on a chord of 1 m
  s.viscous = true;
  s.turbulence = "sa";
  s.flux = "roe_low_mach";
  s.limiter = "none";
  s.march.max_steps = 400;
  return s;
}

struct Coefficients {
  double lift, drag;
};
Coefficients coefficients(const FlowSetting& s, const std::array<double, 3>& force) {
  const double q = 0.5 * gas::density(s.gas, s.stream) * s.speed * s.speed;
  return {(force[2] * std::cos(alpha) - force[0] * std::sin(alpha)) / q, (force[0] * std::cos(alpha) + force[2] * std::sin(alpha)) / q};
}

/// Steps the march one pseudo-step at a time? No: runs it whole, and reads the rows it left.
void march(perf::Group& group, const std::string& name, double mach, double bar_2, double bar_6) {
  FlowSetting s = aerofoil(mach);
  s.march.drop = 1e-2;
  const std::string path = std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/validation/naca0012/n0012_225-65.p2dfmt";
  Case c(tmr_c_grid(path, 48), s, {{"wall", {Condition::no_slip, true}}, {"far", {Condition::far_field, false}}});
  const WallSurface wall = wall_surface(c.grid, std::array<std::string, 1>{"wall"});
  for (FlowTile& tile : c.solver->tiles()) fill_wall_distance(*tile.geometry, wall);
  c.prepare();
  const double cells = double(c.solver->cells());
  double begin = user_seconds();
  c.run();
  group.at_most(name + "_2_orders", (user_seconds() - begin) / cells * 1e6, "us/cell", bar_2, perf::Ceiling::fma_double);
  group.figure(name + "_2_orders_steps", c.solver->march().steps(), "-");
  if (bar_6 <= 0.0) return;
  c.solver->march().set_drop(1e-6);
  c.run();
  group.at_most(name + "_6_orders", (user_seconds() - begin) / cells * 1e6, "us/cell", bar_6, perf::Ceiling::fma_double);
  const PseudoRow& last = c.solver->rows().back();
  const Coefficients k = coefficients(s, last.force);
  group.figure(name + "_CL", k.lift, "-", "CFL3D 1.0838");
  group.figure(name + "_CD", k.drag, "-", "CFL3D .014488");
  group.at_most(name + "_memory", double(c.solver->bytes() + c.store->bytes()) / cells, "B/cell", 2000.0);
}

}  // namespace

int main(int argc, char** argv) {
  perf::Group group("air", argc, argv);
  march(group, "naca0012_m015", 0.15, 40.0, 250.0);
  march(group, "naca0012_m005", 0.05, 50.0, 0.0);
}
