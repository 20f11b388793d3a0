// Doubts about bodies and how they start. Called by src/coupling/doubts.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/bodies/options.hpp"
#include "src/scene/document.hpp"
#include "src/scene/doubt.hpp"

namespace spindrift::bodies {

scene::Doubts body_doubts(const NamedBodies& bodies);

}  // namespace spindrift::bodies
