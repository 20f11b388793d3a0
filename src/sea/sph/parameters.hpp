// The numbers of a sea of particles, in SI; scenes fill them (options), tests write them out.
// Called by every file of src/sea/sph. Tested through them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "kernels/sph/eos_tait.hpp"
#include "src/sea/sph/viscosity.hpp"

namespace spindrift::sph {

enum class KernelChoice { quintic, wendland, cubic };
enum class DiffusionChoice { none, molteni, fourtakas };
enum class StepChoice { symplectic, verlet };
enum class FilterChoice { none, shepard, mls };
/// Where wall particles have their density from: continuity, the water round them, or the water round their mirror images.
enum class BoundaryChoice { dynamic, extrapolated, modified };
/// What extrapolated and modified boundaries do to the velocity of their particles: leave the wall's own, or mirror the water's.
enum class WallChoice { still, no_slip, free_slip };

struct Parameters {
  double spacing = 0.0;     ///< d [m]
  double h_over_d = 1.732;  ///< smoothing length over spacing
  double mass_factor =
      1.0;  ///< mass of a particle over rho0 d^dim; EosTait::mean_density_ratio where a column is to fill its depth
  KernelChoice kernel = KernelChoice::wendland;
  EosTait eos{};
  ViscosityChoice viscosity = ViscosityChoice::artificial;
  double nu = 1e-6;          ///< kinematic viscosity of the laminar choices, water with water [m2/s]
  double nu_solid = 1e-6;    ///< with walls and bodies
  double alpha = 0.1;        ///< artificial viscosity, water with water
  double alpha_solid = 0.1;  ///< with walls and bodies; the paper neglects it (0)
  BoundaryChoice boundary = BoundaryChoice::dynamic;
  WallChoice wall = WallChoice::still;
  bool own_mass = false;  ///< of a body's particles: the body's over their number, not that of water's particles
  DiffusionChoice diffusion = DiffusionChoice::none;
  double delta = 0.1;     ///< strength of the density diffusion
  double gravity = 9.81;  ///< m/s2, along the last axis downwards
  double drive = 0.0;     ///< uniform acceleration along the first axis, for flows between walls [m/s2]
  StepChoice step = StepChoice::symplectic;
  FilterChoice filter = FilterChoice::none;
  int filter_every = 30;  ///< steps between two density filters
  double shifting = 0.0;  ///< strength A of particle shifting, 0 for none, else 1 to 6
  double cfl = 0.2;
  bool contact = true;             ///< of bodies with walls and with each other
  double contact_stiffness = 1.0;  ///< of a face against a face, over the water's own; contact.hpp says how
  double contact_damping = 0.2;    ///< share of critical for one layer of the weight of water
  double contact_friction = 0.0;   ///< Coulomb's coefficient
  int verlet_join_every = 10;
  std::size_t lost_at_most = 0;    ///< particles that may slip through walls before the run stops
  std::size_t left_at_most = 0;    ///< the same over the walls' upper edge
  double drift_over_d = 0.5;       ///< distance a particle may go between two sorts, in spacings
  double column_over_reach = 1.0;  ///< width of a column of cells over the least possible

  double h() const { return h_over_d * spacing; }
  double reach() const { return 2.0 * h(); }  // all kernels end at 2 h
  double mass(int dim) const { return mass_factor * eos.rho0 * std::pow(spacing, dim); }
  double drift() const { return drift_over_d * spacing; }
  /// Anchors stand on multiples of this power of two, about a quarter of a spacing.
  double anchor_step() const { return std::exp2(std::round(std::log2(0.25 * spacing))); }
};

}  // namespace spindrift::sph
