// An elliptic problem on the tiles: -div grad phi = source, phi given on some patches, no flux through the others. Second order
// on curvilinear grids: two-point fluxes solved by multigrid, skewed faces corrected for (deferred correction, over-relaxed form
// of Jasak 1996) until the whole residual has fallen. With it a smooth distance from walls (Spalding 1994, as in Tucker 2003) for
// grids where the exact one is not wanted. Called where a solver is set up; tested in tests/src/aero/flow/poisson_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/mpi/exchange.hpp"

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "src/aero/grid/store.hpp"

namespace spindrift::aero {

struct PoissonOptions {
  double drop = 1e-8;  ///< of the residual, RMS over cells
  int most = 200;      ///< corrections; more are a failure
};

class Poisson {
 public:
  using Field = std::function<double(const Eigen::Vector3d&)>;
  /// `given` says by patch of the tiling whether phi is given there. The grid must outlive this and have been built.
  Poisson(GridStore& grid, std::vector<bool> given);
  ~Poisson();
  void set_source(const Field& source);  ///< per volume
  void set_boundary(const Field& phi);   ///< zero unless set
  /// Solves from phi as it is; throws std::runtime_error naming the residual where it does not fall. Collective over the
  /// processes of the grid.
  void solve(const PoissonOptions& options, MPI_Comm comm, int threads = 1);
  int corrections() const;
  double residual_drop() const;  ///< reached
  double phi(int tile, int k, int j, int i) const;
  Eigen::Vector3d gradient(int tile, int k, int j, int i) const;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

/// Wall distances of all owned tiles from a Poisson problem: sqrt(|grad phi|^2 + 2 phi) - |grad phi| with -div grad phi = 1 and
/// phi = 0 on the walls. Exact between parallel walls, larger than the distance where walls are convex. Collective.
/// Infinite where no patch is a wall.
void fill_wall_distance_by_poisson(GridStore& grid, std::span<const std::string> walls, MPI_Comm comm);

}  // namespace spindrift::aero
