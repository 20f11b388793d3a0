// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/first_cells.hpp"

#include <fmt/format.h>

#include "runtime/mpi/exchange.hpp"
#include "src/aero/first_cells.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/io/collective.hpp"

namespace spindrift::coupling {

namespace {

/// Of all ranks on the first one, of a flow with a turbulence model, as its last residual left it; else none. Collective.
aero::FirstCells first_cells(const aero::FlowSolver& solver, const runtime::World& world) {
  if (solver.setting().turbulence == "none") return {};
  aero::FirstCells mine;
  for (const aero::FlowTile& tile : solver.tiles())
    for (const aero::WallPoint& p : solver.wall_points(tile)) {
      const aero::BoundaryCondition& c = of(solver.judgement().conditions()[std::size_t(p.patch)].condition);
      if (sticks(c)) (c.wall_law ? mine.by_law : mine.resolved).push_back({p.area, p.y_plus, p.growth});
    }
  runtime::Packer packer;
  packer.put(std::span<const aero::FirstCell>(mine.resolved));
  packer.put(std::span<const aero::FirstCell>(mine.by_law));
  std::vector<runtime::Bytes> parcels{std::size_t(world.size)};
  parcels[0] = packer.take();
  aero::FirstCells all;
  for (const runtime::Bytes& bytes : runtime::exchange(world.comm, parcels)) {
    if (bytes.empty()) continue;  // all but the first rank have no parcels
    runtime::Unpacker from(bytes);
    for (auto* to : {&all.resolved, &all.by_law}) {
      const auto cells = from.many<aero::FirstCell>();
      to->insert(to->end(), cells.begin(), cells.end());
    }
  }
  return all;
}

/// What growth does was measured on sections: of a rotor it is doubted and ends no run.
std::string why_unresolved(const aero::FirstCells& cells, const Scenario& scenario) {
  constexpr double log_layer = 30.0;
  if (const double off = share_outside(cells.resolved, 0.0, log_layer); off > 0.5)
    return fmt::format(
        "y+ of first cells is {} at no_slip walls, above {:g} over {:.0f} % of their area: their friction is a fraction of what "
        "it should be, and the loads are no answer; take first cells of y+ up to 5, or condition = \"wall_function\"",
        describe(cells.resolved), log_layer, 100.0 * off);
  if (const double off = share_growing(cells.resolved, aero::useless_growth); off > 0.5 && !has_resolved_rotor(scenario))
    return fmt::format(
        "cells grow from layer to layer off no_slip walls by {}, above {:g} over {:.0f} % of their area: few are left to the "
        "boundary layer, and the loads are no answer; {}",
        describe_growth(cells.resolved), aero::useless_growth, 100.0 * off, more_layers(scenario));
  return {};
}

}  // namespace

std::string more_layers(const Scenario& s) {
  return has_resolved_rotor(s) ? "raise aero.grid.cells_layers" : aero::more_layers(*s.aero.flow);
}

std::string unresolved_walls(const aero::FlowSolver& solver, const Scenario& scenario, const runtime::World& world) {
  const aero::FirstCells cells = first_cells(solver, world);
  return io::from_root(world.comm, world.rank == 0 ? why_unresolved(cells, scenario) : "");
}

std::vector<std::string> doubts_of_walls(const aero::FlowSolver& solver, const Scenario& scenario, const runtime::World& world) {
  const aero::FirstCells cells = first_cells(solver, world);
  return world.rank == 0 ? doubts_of(cells, more_layers(scenario)) : std::vector<std::string>();
}

}  // namespace spindrift::coupling
