// How many particles a tank starts with, counted by columns, faces and volumes without making any: for seas that take long to lay
// out. Within some per cent of lay_out(), nearer the finer the lattice. Called by particle_sea.cpp and particle_plan.cpp; tested
// in tests/src/sea/sph/tank_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "src/sea/sph/tank.hpp"

namespace spindrift::sph {

struct TankCount {
  double water = 0.0, walls = 0.0;  ///< particles; walls: with paddle, without bodies
  struct Body {
    double particles = 0.0;
    Points points;      ///< some hundreds in its place, body axes
    double cell = 0.0;  ///< what one of those stands for [m3], [m2]
  };
  std::vector<Body> bodies;  ///< in the plan's order
  double mass_factor = 0.0;  ///< Parameters::mass_factor
};

template <int dim>
TankCount count_tank(const TankPlan& plan, const Parameters& p);
/// Of the lattice: how much there is to lay out.
template <int dim>
double lattice_places(const TankPlan& plan, const Parameters& p);
/// Of the lattice over the bed in a block, as of water or an obstacle.
template <int dim>
double places_in(const TankPlan& plan, const Parameters& p, const TankPlan::Block& block);
/// Whether a box holds a particle of walls, bed, obstacles or surfaces, those of a paddle aside. Few places are looked at where
/// it does.
template <int dim>
bool holds_wall(const TankPlan& plan, const Parameters& p, const TankPlan::Block& box);

}  // namespace spindrift::sph
