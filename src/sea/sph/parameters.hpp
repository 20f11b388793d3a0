// The numbers of a sea of particles, in SI; scenes fill them (options), tests write them out.
// Called by every file of src/sea/sph. Tested through them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "kernels/sph/eos_tait.hpp"

namespace spindrift::sph {

enum class KernelChoice { wendland, cubic };
enum class DiffusionChoice { none, molteni, fourtakas };
enum class StepChoice { symplectic, verlet };
enum class FilterChoice { none, shepard, mls };

struct Parameters {
  double spacing = 0.0;     ///< d [m]
  double h_over_d = 1.732;  ///< smoothing length over spacing
  KernelChoice kernel = KernelChoice::wendland;
  EosTait eos{};
  double alpha = 0.1;        ///< artificial viscosity, water with water
  double alpha_solid = 0.1;  ///< with walls and bodies; the paper neglects it (0)
  DiffusionChoice diffusion = DiffusionChoice::none;
  double delta = 0.1;     ///< strength of the density diffusion
  double gravity = 9.81;  ///< m/s2, along the last axis downwards
  StepChoice step = StepChoice::symplectic;
  FilterChoice filter = FilterChoice::none;
  int filter_every = 30;  ///< steps between two density filters
  double shifting = 0.0;  ///< strength A of particle shifting, 0 for none, else 1 to 6
  double cfl = 0.2;
  int verlet_join_every = 40;
  std::size_t lost_at_most = 0;    ///< particles that may leave the domain before the run stops
  double drift_over_d = 0.5;       ///< distance a particle may go between two sorts, in spacings
  double column_over_reach = 1.0;  ///< width of a column of cells over the least possible

  double h() const { return h_over_d * spacing; }
  double reach() const { return 2.0 * h(); }  // both kernels end at 2 h
  double mass(int dim) const { return eos.rho0 * std::pow(spacing, dim); }
  double drift() const { return drift_over_d * spacing; }
  /// Anchors stand on multiples of this power of two, about a quarter of a spacing.
  double anchor_step() const { return std::exp2(std::round(std::log2(0.25 * spacing))); }
};

}  // namespace spindrift::sph
