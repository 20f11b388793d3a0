// All that a scene may choose of the air, in SI units: conditions of patches, schemes, march. Plain values, made by
// src/aero/flow_options.cpp or by a test and read by the parts of the solver. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>

#include "src/aero/flow/boundary.hpp"
#include "src/aero/flow/control.hpp"
#include "src/aero/flow/krylov_cycle.hpp"
#include "src/aero/flow/preconditioner.hpp"

namespace spindrift::aero {

/// What acts on a patch of the grid.
struct PatchCondition {
  Condition condition = Condition::far_field;
  bool loads = false;                      ///< its force is summed and reported
  std::optional<double> temperature = {};  ///< that a no-slip wall is held at [K]; unset: adiabatic
};

/// All that a scene may choose, in SI units; from FlowOptions or written by a test.
struct FlowSetting {
  gas::IdealGas gas;                ///< with the references of the undisturbed flow
  gas::Primitive<double> stream{};  ///< undisturbed flow above those references; at the reference height of
  WindProfile profile{};            ///< its velocity over the height z
  double speed = 0.0;               ///< scale of velocity [m/s]: that of the stream, or of what moves
  std::string flux = "roe_low_mach", limiter = "none", turbulence = "none";
  bool first_order_model =
      false;  ///< turbulence is carried by first-order upwind differences, as in CFL3D and FUN3D; else second order, limited
  std::optional<double> wind_eddy_viscosity;  ///< of the undisturbed flow over its laminar one; unset: the closure's
  std::optional<double> wind_intensity;       ///< of its turbulence, of two equations: k = 3/2 (intensity times wind)^2
  double upwinding = 1.0;                     ///< share of the jump between reconstructed states in the flux
  bool viscous = false, thin_layer = false;
  bool preconditioned = true;
  bool physical_far_field = false;  ///< its waves at their own speeds also where the pseudo-time is preconditioned
  /// Dissipation in the matrix where the flux is low-Mach Roe. Empty: that of the preconditioned equations, good at any Mach
  /// number; else Rieper's with at least this scaling, 1 being Roe's.
  std::optional<double> matrix_mach_floor;
  MarchOptions march;
  KrylovMethod krylov = KrylovMethod::gmres;
  std::string preconditioner = "block_ilu";
  PreconditionerOptions coarse;          ///< of preconditioners that have a coarse level
  int time_order = 0;                    ///< 0 steady, 1 BDF1, 2 BDF2, 3 BDF3
  double dt = 0.0;                       ///< physical step [s]
  std::optional<double> time_tolerance;  ///< TimeControl holds the error in time of a step to it; unset: no estimate is made
  double held_rate = 0.0;  ///< steady flow: added to the matrix as a physical step of this rate would [1/s]; trials (choice.hpp)
  /// Steady flow in a frame that turns about an axis through `centre` along the stream: velocities stay those in space,
  /// their components turn with the frame. Blades are at rest in the grid.
  Eigen::Vector3d frame_omega = Eigen::Vector3d::Zero(), frame_centre = Eigen::Vector3d::Zero();  ///< [rad/s], [m]

  /// Past levels of the flow that a physical step needs.
  int past_levels() const { return time_order + (time_tolerance ? 1 : 0); }
};

}  // namespace spindrift::aero
