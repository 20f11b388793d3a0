// The multi-block grid of a rotor: ten blocks a sector, blades as section tables. Recipe: docs/theory/rotor_grid.md.
// Used by `spindrift grid` and by aero.model = "blade_resolved"; tested in tests/src/aero/rotor_grid/rotor_grid_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>

#include "src/aero/grid/multi_block.hpp"
#include "src/aero/rotor_grid/layout.hpp"
#include "src/aero/rotor_grid/plane.hpp"
#include "src/aero/turbine.hpp"

namespace spindrift::aero {

/// Told now and then how far something long has come: what is being made, and the share of it that is. One call at a time, from
/// any thread (of wall distances).
using GridProgress = std::function<void(std::string_view what, double share)>;

/// Makes the grid of a rotor, or layers of it: the nodes of a coaxial surface do not depend on those of others.
class RotorGridMaker {
 public:
  /// Throws NumericalFailure where the surface folds or the sizes do not fit.
  RotorGridMaker(const Turbine& turbine, const RotorGridSpec& spec);
  RotorGridMaker(const RotorGridMaker&) = delete;
  RotorGridMaker& operator=(const RotorGridMaker&) = delete;

  int layers() const { return spec_.sizes.radial() >> spec_.coarsen; }  ///< of cells, from hub to outer radius
  const MultiBlockGrid& described() const { return described_; }        ///< the whole without nodes
  /// A surface of nodes by itself, from the hub on: as fine as before any were left out.
  Plane surface(int k) const { return make_plane(blade_, layout_, k << spec_.coarsen); }
  double radius(int k) const { return layout_.radii()[std::size_t(k << spec_.coarsen)]; }  ///< its own [m]
  /// Layers [first, last) of all blocks, and with `compared` one more where there is one. Patches and connections are those of
  /// the part; where it is cut off the patch is named "cut".
  GridLayers make(int first, int last, bool compared = false) const;

 private:
  MultiBlockGrid fine(int first, int last, bool nodes) const;

  RotorGridSpec spec_;
  int blades_;
  BladeSurface blade_;
  RotorLayout layout_;
  MultiBlockGrid described_;
};

/// Blocks of each blade's sector, in this order, their indices (i, j, k): O (outward, round from the trailing edge along the
/// pressure side, radially outward); plug (towards the leading edge, towards the suction side, radial); eight H blocks (along the
/// turning direction, axial, radial), named by the compass with upstream in the west and the turning direction in the north.
/// Patches: blade_1 ... blade_B (walls), hub, inflow, outflow, far. Same bits for any number of threads, and for the whole at
/// once and in layers. Throws NumericalFailure where the surface folds.
MultiBlockGrid make_rotor_grid(const Turbine& turbine, const RotorGridSpec& spec);

}  // namespace spindrift::aero
