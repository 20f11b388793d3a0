// The list of conditions, and what several of them are made of: see condition.hpp. SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/boundary.hpp"
#include "src/scene/models.hpp"

namespace spindrift::aero {

#define CONDITION(name) extern const BoundaryCondition name##_condition;
#include "src/aero/flow/conditions.inc"
#undef CONDITION

namespace {

#define CONDITION(name) &name##_condition,
const std::array listed_conditions{
#include "src/aero/flow/conditions.inc"
};
#undef CONDITION

}  // namespace

scene::Models<BoundaryCondition> conditions() { return scene::Models<BoundaryCondition>(listed_conditions); }
const BoundaryCondition& of(Condition condition) { return *listed_conditions[std::size_t(condition)]; }

Ghosts no_slip_ghosts(const BoundaryFace& at) {
  const gas::Vector<double> wall = at.wall_velocity();
  const auto ghost = [&](const gas::Primitive<double>& inside) {
    gas::Primitive<double> q = gas::no_slip_ghost(inside, wall);
    if (at.boundary.temperature) q.T = gas::isothermal_ghost(at.setting.gas, inside.T, *at.boundary.temperature);
    return q;
  };
  return {ghost(at.inside), ghost(at.next())};
}

void fold_no_slip(const FoldedFace& at) {
  at.follow(0, 1.0f, 0), at.follow(4, at.held ? -1.0f : 1.0f, 4);
  for (int c = 1; c < 4; ++c) at.follow(c, -1.0f, c);
}

void fold_mirror(const FoldedFace& at) {
  at.follow(0, 1.0f, 0), at.follow(4, 1.0f, 4);
  const double n[3] = {at.face.nx, at.face.ny, at.face.nz};
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) at.follow(r + 1, float((r == c ? 1.0 : 0.0) - 2.0 * n[r] * n[c]), c + 1);
}

}  // namespace spindrift::aero
