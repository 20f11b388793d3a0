// Doubts about bodies and how they start, and about what beams are made of. Called by src/coupling/doubts.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/bodies/beam_options.hpp"
#include "src/bodies/options.hpp"
#include "src/scene/document.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::bodies {

scene::Doubts body_doubts(const NamedBodies& bodies);

scene::Doubts beam_doubts(const NamedBeams& beams);

}  // namespace spindrift::bodies
