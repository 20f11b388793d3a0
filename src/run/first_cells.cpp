// SPDX-License-Identifier: Apache-2.0
#include "src/run/first_cells.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <vector>

#include "runtime/mpi/exchange.hpp"

namespace spindrift::run {

void tell_first_cells(const aero::FlowSolver& solver, const runtime::World& world) {
  struct Face {
    double area, y_plus;
  };
  std::array<std::vector<Face>, 2> walls;  // resolved, by the law of the wall
  for (const aero::FlowTile& tile : solver.tiles())
    for (const aero::WallPoint& p : solver.wall_points(tile)) {
      const aero::Condition c = solver.conditions()[std::size_t(p.patch)].condition;
      if (aero::sticks(c)) walls[c == aero::Condition::wall_law].push_back({p.area, p.y_plus});
    }
  constexpr std::array<double, 2> least{0.0, 15.0}, most{5.0, 1000.0};
  constexpr double share = 0.9;
  for (std::size_t kind = 0; kind < 2; ++kind) {
    runtime::Packer mine;
    mine.put(std::span<const Face>(walls[kind]));
    std::vector<Face> all;
    for (const runtime::Bytes& bytes : runtime::exchange_all(world.comm, mine.take()))
      for (const Face& face : runtime::Unpacker(bytes).many<Face>()) all.push_back(face);
    if (all.empty()) continue;
    std::ranges::sort(all, {}, &Face::y_plus);
    double area = 0.0, off = 0.0;
    for (const Face& f : all) area += f.area, off += f.y_plus < least[kind] || f.y_plus > most[kind] ? f.area : 0.0;
    if (off <= (1.0 - share) * area) continue;
    spdlog::warn(
        "air: y+ of first cells is {:.3g} in the middle, {:.3g} at most; {} walls want {:g} to {:g}, which {:.0f} % of their "
        "area does not have: friction is not to be trusted",
        all[all.size() / 2].y_plus, all.back().y_plus, kind == 0 ? "resolved" : "wall-function", least[kind], most[kind],
        100.0 * off / area);
  }
}

}  // namespace spindrift::run
