// Algebraic multigrid of a sparse matrix whose rows are spread over processes: hypre's BoomerAMG (Henson & Yang 2002), for any
// elliptic problem. The one place that hands a communicator to hypre; nothing of hypre is in this header.
// hypre keeps global state: one call at a time in a process, from collective tasks or between runs. Its coarse grids depend on
// the number of processes, so results are equal across ranks to tolerance, and to the bit across threads and reruns. Called by
// src/aero/flow; tested in tests/src/aero/flow (poisson_test, coarse_correction_test). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <memory>
#include <span>
#include <vector>

namespace spindrift::aero {

/// Rows [first, first + count()) of a matrix, compressed; columns are global numbers, the diagonal is each row's first entry.
struct SparseRows {
  int first = 0;
  std::vector<int> begin{0};  ///< of each row in columns and values; one more than rows
  std::vector<int> columns;
  std::vector<double> values;
  int count() const { return int(begin.size()) - 1; }
};

struct MultigridOptions {
  enum class Smoother : unsigned char {
    gauss_seidel,  ///< hybrid symmetric: Gauss-Seidel within a process, Jacobi between
    ilu            ///< ILU(0) of each process's rows: for systems that are no M-matrices
  };
  int functions = 1;  ///< unknowns of a point, one after the other in the rows; above 1 each is coarsened for itself
  Smoother smoother = Smoother::gauss_seidel;  ///< once before and once after each coarser level
};

class Multigrid {
 public:
  /// Collective. Rows of all processes follow each other in the order of ranks; every process has at least none.
  Multigrid(const SparseRows& rows, const MultigridOptions& options, MPI_Comm comm);
  Multigrid(Multigrid&&) noexcept;
  Multigrid& operator=(Multigrid&&) noexcept;
  ~Multigrid();

  /// x = a V-cycle on b, begun at zero. Collective.
  void cycle(std::span<const double> b, std::span<double> x);
  /// V-cycles from x on until the residual has fallen by `drop`; returns how many, or -1 where `most` were not enough.
  /// Collective.
  int solve(std::span<const double> b, std::span<double> x, double drop, int most);

 private:
  struct Hypre;
  std::unique_ptr<Hypre> hypre_;
};

}  // namespace spindrift::aero
