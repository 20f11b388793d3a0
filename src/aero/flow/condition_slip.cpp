// Wall without friction. SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/boundary.hpp"

namespace spindrift::aero {

namespace {

/// Behind a slip wall along which the flow turns, pressure and what moves along the wall vary across it: ghosts are the straight
/// line through the two cells inside. Mirror images have a kink at the wall, which the reconstruction of the next face answers
/// with a jump.
Ghosts slip_ghosts(const BoundaryFace& at) {
  const gas::Primitive<double>&inside = at.inside, next = at.next();
  const gas::Face<double>& f = at.face;
  Ghosts g{gas::mirrored(inside, f), gas::mirrored(next, f)};
  if (!at.deep) return g;
  const double slope = 2.0 * at.weight();  // from the cell to its ghost, over the difference of both cells
  g.first.p = inside.p + slope * (inside.p - next.p), g.second.p = g.first.p + (inside.p - next.p);
  if (!at.setting.inviscid) return g;
  const double un = gas::normal_velocity(inside, f), un_next = gas::normal_velocity(next, f), du = un - un_next;
  const gas::Primitive<double> d{0.0, inside.u - next.u - du * f.nx, inside.v - next.v - du * f.ny, inside.w - next.w - du * f.nz,
                                 inside.T - next.T};
  const double ghost = 2.0 * f.speed - un, ghost_next = 2.0 * f.speed - un_next;
  const auto along = [&](double share, double normal) {
    const double shift = normal - un;
    return gas::Primitive<double>{0.0, inside.u + share * d.u + shift * f.nx, inside.v + share * d.v + shift * f.ny,
                                  inside.w + share * d.w + shift * f.nz, inside.T + share * d.T};
  };
  const double p = g.first.p, p_next = g.second.p;
  g.first = along(slope, ghost), g.second = along(slope + 1.0, ghost_next);
  g.first.p = p, g.second.p = p_next;
  return g;
}

}  // namespace

extern const BoundaryCondition slip_condition{
    .name = "slip", .help = "wall without friction", .surface = Surface::slip, .ghosts = slip_ghosts, .fold = fold_mirror};

}  // namespace spindrift::aero
