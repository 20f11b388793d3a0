// SPDX-License-Identifier: Apache-2.0
#include "src/run/first_cells.hpp"

#include "runtime/mpi/exchange.hpp"

namespace spindrift::run {

aero::FirstCells first_cells(const aero::FlowSolver& solver, const runtime::World& world) {
  if (solver.setting().turbulence == "none") return {};
  aero::FirstCells mine, all;
  for (const aero::FlowTile& tile : solver.tiles())
    for (const aero::WallPoint& p : solver.wall_points(tile)) {
      const aero::BoundaryCondition& c = of(solver.judgement().conditions()[std::size_t(p.patch)].condition);
      if (sticks(c)) (c.wall_law ? mine.by_law : mine.resolved).push_back({p.area, p.y_plus});
    }
  runtime::Packer packer;
  packer.put(std::span<const aero::FirstCell>(mine.resolved));
  packer.put(std::span<const aero::FirstCell>(mine.by_law));
  for (const runtime::Bytes& bytes : runtime::exchange_all(world.comm, packer.take())) {
    runtime::Unpacker from(bytes);
    for (auto* to : {&all.resolved, &all.by_law}) {
      const auto cells = from.many<aero::FirstCell>();
      to->insert(to->end(), cells.begin(), cells.end());
    }
  }
  return all;
}

}  // namespace spindrift::run
