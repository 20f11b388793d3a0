// SPDX-License-Identifier: Apache-2.0
#include "src/run/first_cells.hpp"

#include <fmt/format.h>

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

std::string unresolved_walls(const aero::FirstCells& cells) {
  constexpr double log_layer = 30.0;
  double area = 0.0, off = 0.0;
  for (const aero::FirstCell& c : cells.resolved) area += c.area, off += c.y_plus > log_layer ? c.area : 0.0;
  if (!(off > 0.5 * area)) return {};
  return fmt::format(
      "y+ of first cells is {} at no_slip walls, above {:g} over {:.0f} % of their area: their friction is a fraction of what it "
      "should be, and the loads are no answer; take first cells of y+ up to 5, or condition = \"wall_function\"",
      describe(cells.resolved), log_layer, 100.0 * off / area);
}

}  // namespace spindrift::run
