// A run of the air alone: a scene whose aero.model is "blade_resolved" and that has no rotor: wings, plates, cylinders at rest in
// the wind. Steady scenes write a row of history per pseudo-step (a window is one), unsteady ones a row per window. Called by
// src/app; tested in tests/coupled/flow_run_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/coupling/run.hpp"
#include "src/coupling/scenario.hpp"

namespace spindrift::coupling {

/// As run() of a machine: everything but report and summary.json. Collective.
io::Summary run_flow(const Scenario& scenario, const io::RunDirectory& directory, const runtime::World& world,
                     const RunSettings& settings);

}  // namespace spindrift::coupling
