// Forces inside the air that follow from the flow itself, as those of blades that the grid does not show: the flow is sampled
// tile by tile, the sums of all tiles make the forces, and each tile takes its part as a source. A pure function of the state and
// of where the bodies are, so that nothing of it is saved. Called by tasks.cpp before each residual; implemented by
// src/aero/actuator.cpp; tested in tests/src/aero/actuator_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "src/aero/flow/flow_tile.hpp"

namespace spindrift::aero {

class BodyForce {
 public:
  virtual ~BodyForce() = default;
  /// Once, for so many owned tiles.
  virtual void attach(std::size_t owned) = 0;
  /// How many numbers are summed over the tiles.
  virtual std::size_t sums() const = 0;
  /// Part of a tile (of owned index n) in them. Tiles may be sampled side by side.
  virtual void sample(std::size_t n, const FlowTile& tile, std::span<double> part) = 0;
  /// The forces, from the sums over all tiles: on every rank alike.
  virtual void act(std::span<const double> sums) = 0;
  /// Writes FlowTile::source: momentum and the power of the force at the cell's own velocity.
  /// @pre act() has followed sample() of the tile's state.
  virtual void spread(std::size_t n, FlowTile& tile) const = 0;
  /// Loads on the bodies for the march's rows; the first three are the force [N].
  virtual std::vector<double> loads() const = 0;
};

}  // namespace spindrift::aero
