// The matrix of the mean flow: first-order linearisation of a tile's residual plus what the (pseudo-)time step adds, as blocks
// for ILU and for products with stored operators. Convection by Roe's dissipation of the mean states held fixed, viscosity in
// thin-layer form, walls and open boundaries folded into the diagonal (docs/theory/air.md, "Linear systems"). Rows and columns
// are scaled (Scales) so that floats hold them. Called by the tasks of src/aero/flow; tested in
// tests/src/aero/flow/solver_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/gas/preconditioner.hpp"
#include "src/aero/flow/flow_tile.hpp"
#include "src/aero/flow/sweep.hpp"

namespace spindrift::aero {

/// Units of unknowns and residuals (per area): rho U^2, U, U^2/cp, and rho U, rho U^2, rho U^3.
struct Scales {
  std::array<double, 5> unknown{1, 1, 1, 1, 1}, residual{1, 1, 1, 1, 1};
  std::array<double, 2> model_unknown{1, 1}, model_residual{1, 1};
};

struct ImplicitSetting {
  gas::IdealGas gas;
  Scales scales;
  bool viscous = false;
  double mach_floor = 1.0;  ///< least scaling of RoeLowMach's dissipation; 1: that of Roe
  bool rusanov = false;     ///< dissipation of Rusanov's flux, whose shear waves are as fast as sound
  bool preconditioned_waves =
      false;  ///< dissipation of the preconditioned equations instead, with this many times floor_speed at least:
  static constexpr double wave_speeds_of_floor = 7.0;
  bool preconditioned = true;      ///< pseudo-time of Weiss & Smith
  double floor_speed = 0.0;        ///< least reference speed of the preconditioner [m/s]
  std::array<double, 3> inflow{};  ///< direction of what enters from a reservoir
  double physical_rate = 0.0;      ///< a0 / dt of the physical step [1/s]; 0 steady
  std::array<double, 3> omega{};   ///< of a frame that turns steadily [rad/s]
};

/// FlowTile::rate: sum of the (preconditioned) spectral radii of a cell's faces, halved, viscous ones added: V / pseudo-step at
/// CFL 1.
void sweep_rates(FlowTile& tile, const double* state, const ImplicitSetting& setting);

/// Square of the preconditioner's reference speed in a cell, from its state alone.
template <class Real>
SPINDRIFT_INLINE Real reference_squared(const ImplicitSetting& s, const gas::Primitive<Real>& q) {
  const Real c2 = (s.gas.gamma * s.gas.gas_constant) * gas::absolute_temperature(s.gas, q);
  if (!s.preconditioned) return c2;
  return gas::reference_speed_squared(Real(2.0 * gas::kinetic(q)), Real(s.floor_speed * s.floor_speed), c2);
}

/// Fills the blocks of the mean flow (not the pivots). `eddy` [Pa s] with one ghost in gradient_box, or null.
void sweep_jacobian(FlowTile& tile, const double* state, const double* eddy, double cfl, const ImplicitSetting& setting);

/// w += (pseudo-time matrix) z, in scaled unknowns and rows: what a matrix-free product of the residual lacks.
void add_pseudo_time(const FlowTile& tile, const double* state, double cfl, const ImplicitSetting& setting, const float* z,
                     float* w);

}  // namespace spindrift::aero
