// Doubts about bodies and how they start, and about what beams are made of. Called by src/coupling/doubts.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "src/bodies/beam_options.hpp"
#include "src/bodies/options.hpp"
#include "src/scene/document.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::bodies {

/// What the scene has round its bodies.
struct BodySurroundings {
  std::optional<double> top;  ///< how high towers on them reach, where hubs or beams show it [m, earth axes]
  bool planar = false;        ///< the sea is one of the plane of x and z: bodies turn about y alone
};

scene::Doubts body_doubts(const NamedBodies& bodies, const BodySurroundings& around = {});

/// Cylinders of a body that lie in each other, in a sea that sums their loads; but for the body that another method carries.
scene::Doubts overlap_doubts(const NamedBodies& bodies, std::string_view but_for = {});

scene::Doubts beam_doubts(const NamedBeams& beams);

}  // namespace spindrift::bodies
