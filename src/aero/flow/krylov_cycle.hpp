// One Krylov cycle over tiles: which vectors a method keeps, what it makes of them in each iteration, and its small dense part
// (kernels/linear/krylov.hpp). One reduction per iteration, all dot products of a tile from one pass over its vectors.
// GMRES keeps one set of vectors and preconditions once more at the end; flexible GMRES (Saad 1993) and GCG (Eisenstat, Elman &
// Schultz 1983) keep the directions too, so that the preconditioner may change from one iteration to the next. Called by the
// tasks of src/aero/flow; tested in tests/src/aero/flow/linear_solver_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "kernels/linear/krylov.hpp"
#include "src/aero/flow/flow_tile.hpp"

namespace spindrift::aero {

enum class KrylovMethod : unsigned char { gmres, fgmres, gcg };

class KrylovCycle {
 public:
  KrylovCycle(KrylovMethod method, int most_columns);
  int most_columns() const { return most_; }
  /// Room for the vectors; each is made when an iteration first comes to it, so that systems that need few hold few.
  void allocate(FlowTile& tile) const;
  /// GMRES: what combine() leaves is preconditioned once more to be the solution.
  bool precondition_at_end() const { return method_ == KrylovMethod::gmres; }

  // ---- by all ranks alike
  void start(double residual_norm);
  void append(std::span<const double> dots);
  int columns() const { return method_ == KrylovMethod::gcg ? gcg_.columns() : gmres_.columns(); }
  bool breakdown() const { return method_ == KrylovMethod::gcg ? gcg_.breakdown() : gmres_.breakdown(); }
  double residual_norm() const { return method_ == KrylovMethod::gcg ? norm_ * gcg_.residual_norm() : gmres_.residual_norm(); }
  double first_norm() const { return norm_; }
  /// After the last append and before combine().
  void finish();

  // ---- in a tile
  /// Where the first vector goes: the right-hand side of unit length.
  float* first(FlowTile& tile) const;
  /// Iteration j > 0: finishes the vectors of the one before.
  void advance(FlowTile& tile, int j) const;
  /// What iteration j preconditions, where that goes, and where the product with it goes.
  const float* source(const FlowTile& tile, int j) const;
  float* direction(FlowTile& tile, int j) const;
  float* product(FlowTile& tile, int j) const;
  /// j + 2 numbers for append().
  void dots(const FlowTile& tile, int j, std::span<double> to) const;
  /// The solution (GMRES: before its last preconditioning), in solution(tile).
  void combine(FlowTile& tile) const;
  float* solution(FlowTile& tile) const;

 private:
  static float* made(const FlowTile& tile, AlignedArray<float>& vector);
  KrylovMethod method_;
  int most_;
  double norm_ = 0.0;
  linear::Gmres gmres_;
  linear::Gcg gcg_;
  std::vector<double> factors_;  ///< of the solution; GCG: the steps so far
};

/// Numbers of a vector, padded for whole lanes.
constexpr std::size_t padded(std::size_t n) { return (n + 15) / 16 * 16; }

}  // namespace spindrift::aero
