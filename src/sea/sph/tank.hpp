// The particles a scene starts with: water on a lattice, walls and bed, obstacles, a paddle, bodies. The lattice fills the depth
// and the sides of the tank in whole cells, each nearly a cube of the spacing; water is compressed by its own weight as at rest.
// Slopes are stairs of lattice cells, rounded to half a cell. Called by particle_sea.cpp and `spindrift check`; tested in
// tests/src/sea/sph/tank_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kernels/rigid/motion.hpp"
#include "kernels/waves/components.hpp"
#include "src/sea/sph/body_shapes.hpp"
#include "src/sea/sph/parameters.hpp"
#include "src/sea/sph/seeds.hpp"
#include "src/sea/sph/store.hpp"
#include "src/sea/sph/wavemaker.hpp"

namespace spindrift::sph {

/// What a scene's tank is made of, in plain numbers.
struct TankPlan {
  std::array<double, 2> x{}, y{};
  double depth = 0.0;                      ///< bed at -depth, still water at 0 [m]
  double top = 0.0;                        ///< of the walls [m]
  std::array<bool, 2> periodic{}, open{};  ///< sides along x, along y
  bool mirrored = false;                   ///< in 3-D: no wall at the lower y, which is a plane of symmetry
  bool over_edge_open = false;             ///< any particle may leave over the walls' upper edge
  std::vector<std::array<double, 2>> bed;  ///< (x, z), x increasing; empty: flat
  struct Block {
    Eigen::Vector3d low, high;
  };
  std::vector<Block> water, obstacles;  ///< water empty: the tank up to z = 0
  struct Walls {
    std::shared_ptr<const ClosedSurface> surface;
    bool water_inside = false;
  };
  std::vector<Walls> walls;  ///< beside the tank's own, as stairs of the lattice
  std::optional<Paddle> paddle;
  double paddle_reach = 0.0;  ///< largest displacement of the paddle's upper edge [m]
  struct Body {
    std::string name;
    std::vector<BodyShape> shapes;
    Motion motion;  ///< at the start
  };
  std::vector<Body> bodies;             ///< those with shapes
  bool modified_walls = false;          ///< wall particles have ghost nodes; the bed must be flat
  std::vector<waves::Component> waves;  ///< the start is in their motion at their t = 0; empty: still
  double jitter = 0.0;                  ///< of the water's particles along each axis, in spacings
  std::uint64_t jitter_seed = 1;

  double bed_at(double at) const;  ///< height of the bed [m]
};

inline constexpr std::uint16_t water_owner = 0, wall_owner = 1;

/// What came out of it.
template <int dim>
struct TankParticles {
  SeedStream<dim> seeds;  ///< water, walls, paddle, bodies; made anew at each visit
  Domain<dim> domain;
  std::size_t water = 0, walls = 0;
  std::optional<std::uint16_t> paddle;  ///< owner
  std::vector<std::uint16_t> bodies;    ///< owners, in the plan's order
  std::vector<Points> body_points;      ///< in body axes
  double cell_volume = 0.0;             ///< of the lattice over spacing^dim: the share of a particle's mass it stands for
};

/// p.mass_factor is set from the lattice; everything else of p is given.
template <int dim>
TankParticles<dim> lay_out(const TankPlan& plan, Parameters& p);

}  // namespace spindrift::sph
