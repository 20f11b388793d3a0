// Fits water round bodies before a run starts: particles that stand unevenly beside a surface are moved until each is equally far
// from its neighbours on all sides, down the gradient of the particles' concentration. Colagrossi, Bouscasse, Antuono & Marrone
// (2012), Comput. Phys. Commun. 183, 1641. Without it the force on a body jumps while water closes in on it.
// Called by tank.cpp; tested in tests/src/sea/sph/tank_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace spindrift::sph {

/// Sides beyond which all points have their images [m].
struct ImageSides {
  std::optional<double> plane;                                   ///< of symmetry: a value of the second coordinate
  std::array<std::optional<std::array<double, 2>>, 2> period{};  ///< lower and higher side of horizontal axes that repeat
};

/// Moves the points, on all threads; `fixed` ones stay. All stand for a cell of spacing^dim. No point goes farther than a
/// spacing, over a side that repeats too.
template <int dim>
void pack_evenly(std::vector<std::array<double, dim>>& points, std::span<const std::array<double, dim>> fixed, double spacing,
                 const ImageSides& sides = {});

}  // namespace spindrift::sph
