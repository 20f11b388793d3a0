// The linear system of a pseudo-step: its matrix, its preconditioner, the Krylov cycle's work in a tile, and the update that its
// solution gives. When each is done is said by tasks.cpp; tested in tests/src/aero/flow/linear_solver_test.cpp and
// solver_test.cpp there. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "src/aero/flow/flow_residual.hpp"
#include "src/aero/flow/krylov_cycle.hpp"
#include "src/aero/flow/preconditioner.hpp"
#include "src/aero/flow/sweep_jacobian.hpp"
#include "src/aero/flow/tile_arrays.hpp"
#include "src/aero/flow/tile_sums.hpp"

namespace spindrift::aero {

class ImplicitSystem {
 public:
  /// Both are to outlive it.
  ImplicitSystem(const FlowSetting& setting, TileArrays& arrays, const FlowResidual& residual);

  // ---- by all ranks alike
  /// From here on waves run at their own speeds in the pseudo-time, as without low-Mach preconditioning.
  void use_physical_pseudo_time() { setting_.preconditioned = setting_.preconditioned_waves = false; }
  void use(std::unique_ptr<Preconditioner> preconditioner);
  /// The rate of the physical step's own derivative [1/s].
  void set_physical_rate(double rate) { setting_.physical_rate = rate; }
  /// A pseudo-step is to be solved for, with these squared norms of the scaled residual; `anew`: with a fresh matrix.
  void begin(double mean, double model, bool anew);
  /// After dots() of an iteration have been summed.
  void append() { cycle_.append(dots.result); }
  /// Whether the linear residual has come down to this share of its start, or cannot come further.
  bool solved(double drop) const;
  double linear_drop() const { return cycle_.residual_norm() / linear_norm_; }

  // ---- in a tile
  /// Pseudo-time steps, and the matrix where it is made `anew`, with the preconditioner's part of the tile; where that is
  /// singular the update is refused.
  void build(FlowTile& tile, double cfl, bool anew);
  /// Krylov vector of iteration j.
  void make_vector(FlowTile& tile, int j) const;
  /// Its direction z = M^-1 v, put where neighbours read it; returns its largest component in the units of the unknowns.
  double make_direction(FlowTile& tile, int j);
  /// For matrix-free products: the state a little further along the direction.
  void perturb(FlowTile& tile) const;
  /// w = A z, and its products with all v so far and itself; by stored blocks, or by the residual of the perturbed state.
  void product(FlowTile& tile, int j, double cfl, bool matrix_free, std::span<double> to_sum);
  /// After the cycle has combined its vectors in all tiles: what they make is preconditioned where the method asks for it.
  void solve_for_update(FlowTile& tile);
  /// Of the change of the unknowns: the fraction that no cell finds too large; -1 where a matrix was singular.
  double update_fraction(FlowTile& tile) const;
  /// The state is changed by `fraction.result`; what it was is kept as the trial state.
  void apply_update(FlowTile& tile) const;

  const Scales& scales() const { return setting_.scales; }
  const std::array<double, 2>& model_unit() const { return model_unit_; }
  KrylovCycle& cycle() { return cycle_; }
  Preconditioner& preconditioner() { return *preconditioner_; }
  const Preconditioner& preconditioner() const { return *preconditioner_; }

  TileSums dots, direction_size, fraction;  ///< summed, of the largest, of the least over tiles

 private:
  void first_vector(FlowTile& tile) const;
  double spread_direction(FlowTile& tile, int j) const;
  void add_model_pseudo_time(const FlowTile& tile, double cfl, float* model) const;

  TileArrays& arrays_;
  const FlowResidual& residual_;
  gas::IdealGas gas_;
  double speed_;
  ImplicitSetting setting_;
  std::array<double, 2> model_unit_{1.0, 1.0};  ///< of the turbulence model's residuals where they are judged
  KrylovCycle cycle_;
  std::unique_ptr<Preconditioner> preconditioner_;
  double linear_norm_ = 0.0;  ///< of the right-hand side, in the units of the linear solver
};

}  // namespace spindrift::aero
