// Fields on the nodes of a multi-block grid that are given on some patches and without extremes between: how a grid follows walls
// that move.
//   sum over the edges of a node of  w (f - f_across) = 0,   w = sum over the cells at the edge of k V / (edges of the cell that
//   way x length^2),
// which is -div(k grad f) = 0 where cells are boxes (second order), and has a maximum principle on any grid. k =
// distance^-stiffness from chosen patches, so that what lies near them goes with them. Solved by algebraic multigrid to
// round-off. Called by src/aero/grid_motion.cpp; tested in tests/src/aero/grid/node_field_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/mpi/exchange.hpp"
#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

struct NodeFieldOptions {
  double stiffness = 1.0;    ///< power of the inverse distance; 0: the same everywhere
  double tolerance = 1e-12;  ///< of what is given: largest step that any node would still take towards its neighbours
  int most = 100;            ///< cycles of multigrid
};

class NodeField {
 public:
  /// Values by block and node.
  using Values = std::vector<std::vector<double>>;

  /// Given on the patches of `given`, no flux through others; stiff near those of `stiff`. Every process has the whole grid and
  /// the whole field; those of `comm` share the work, and agree to the tolerance with any other number of them. Collective.
  NodeField(const MultiBlockGrid& grid, std::vector<std::string> given, std::span<const std::string> stiff,
            const NodeFieldOptions& options = {}, MPI_Comm comm = MPI_COMM_SELF);
  ~NodeField();

  /// `value` of a node on a given patch (its number in `given`; of two patches that meet, the first). Nodes that are one have one
  /// value, to the bit. Throws std::runtime_error where the cycles are not enough. Collective.
  Values solve(const std::function<double(int patch, const Eigen::Vector3d& at)>& value);
  int unknowns() const;
  int cycles() const;  ///< of the last solution

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace spindrift::aero
