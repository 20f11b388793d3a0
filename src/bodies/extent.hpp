// How large the shapes of a body are, and how fast it meets the water. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "src/bodies/beam_options.hpp"
#include "src/bodies/options.hpp"

namespace spindrift::bodies {

/// As near as can be round each end of a cylinder, each box, sphere and surface, where the scene describes them, earth axes [m].
std::vector<Eigen::AlignedBox3d> pieces(const BodyOptions& body);

/// Round the body's shapes where the scene describes them, earth axes [m]; empty where it has none.
Eigen::AlignedBox3d bounds(const BodyOptions& body);

/// Half of the diagonal of `bounds` [m]; 0 where there are none.
double extent(const BodyOptions& body);

/// Lowest and highest point of the body's shapes at its present place [m]; whether it has any.
struct Reach {
  double low = 0.0, high = 0.0;
  bool any = false;
};
Reach reach(const BodyOptions& body, const Motion& now);

/// A bound of the speed at which shapes meet still water at z = `water_level` [m/s]: their speed at the start, and what a fall
/// from above the water adds to it; the speed of joints that drive a body from the earth. Bodies that joints or beams tie
/// together fall as one, until the lowest meets the water. They do not fall where such ties lead to the earth. A joint that
/// slides up and down, and is not driven, ties no heights together.
double entry_speed(const NamedBodies& bodies, const NamedJoints& joints, const NamedBeams& beams, double gravity,
                   double water_level = 0.0);

}  // namespace spindrift::bodies
