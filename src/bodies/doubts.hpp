// Doubts about bodies and how they start, and about what beams are made of. Called by src/coupling/doubts.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

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

scene::Doubts beam_doubts(const NamedBeams& beams);

}  // namespace spindrift::bodies
