// The residual of a tile's state: fluxes, sources, the physical time derivative, and the gradients and ghosts that they need.
// Reads the grid where it is; decides nothing. Called by tasks.cpp and by matrix-free products; tested in
// tests/src/aero/flow/solver_test.cpp and tests/verification/air. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "src/aero/flow/boundary.hpp"
#include "src/aero/flow/flow_setting.hpp"
#include "src/aero/flow/flow_tile.hpp"
#include "src/aero/flow/loads.hpp"
#include "src/aero/flow/mass_balance.hpp"
#include "src/aero/flow/physical_time.hpp"
#include "src/aero/flow/sweep_convective.hpp"
#include "src/aero/flow/sweep_model.hpp"
#include "src/aero/flow/sweep_viscous.hpp"

namespace spindrift::aero {

class FlowResidual {
 public:
  /// `time` is to outlive it. Throws std::invalid_argument where the setting does not go together.
  FlowResidual(const FlowSetting& setting, const ModelSweeps& model, const PhysicalTime& time);

  /// A physical step begins: its length and weights as the time has them.
  void begin_step();
  void set_dt(double dt) { boundary_.dt = dt; }
  void set_wind(UndisturbedWind wind) { boundary_.wind = std::move(wind); }
  /// The state as it is becomes the past. @pre the grid has not moved yet.
  void keep_past(FlowTile& tile) const;
  /// How the undisturbed wind drives the air in the step that has begun, where a moving grid now is.
  void drive_moved(FlowTile& tile) const { store_driving(tile, time_); }

  void fill_ghosts(FlowTile& tile, double* state) const { fill_boundaries(tile, state, boundary_); }
  void fill_gradient_ghosts(FlowTile& tile, const double* state) const;
  /// Gradients, and what the turbulence model makes of them. @pre ghosts are filled
  void gradients(FlowTile& tile, const double* state) const;
  /// @pre ghosts, gradients and their ghosts are those of `state`
  void evaluate(FlowTile& tile, double* state, double* residual) const;

  /// Of one tile, after evaluate() of its state.
  MassBalance mass_balance(const FlowTile& tile) const { return aero::mass_balance(tile, gas_, time_); }
  const ModelSweeps& model() const { return model_; }
  const BoundarySetting& boundary() const { return boundary_; }
  const ViscousSetting& viscous() const { return viscous_; }
  bool has_friction() const { return viscous_.active; }
  /// As FlowSolver::use_limiter.
  void use_limiter(std::string_view limiter);
  /// Velocity of the undisturbed wind at a place, so long before the end of the step.
  Eigen::Vector3d undisturbed(const Eigen::Vector3d& place, double ago) const;
  /// Values on the walls of a tile.
  std::vector<WallPoint> wall_points(const FlowTile& tile) const;

 private:
  void store_driving(FlowTile& tile, const PhysicalTime& step) const;
  void add_driving(const FlowTile& tile, const double* state, double* residual) const;
  void add_turning(const FlowTile& tile, const double* state, double* residual) const;
  void add_time_derivative(const FlowTile& tile, const double* state, double* residual) const;

  gas::IdealGas gas_;
  const ModelSweeps& model_;
  const PhysicalTime& time_;
  ConvectiveSetting convective_;
  ViscousSetting viscous_;
  BoundarySetting boundary_;
  std::array<double, 3> omega_{};  ///< of a frame that turns steadily [rad/s]
};

}  // namespace spindrift::aero
