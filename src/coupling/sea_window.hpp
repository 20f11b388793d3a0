// A window of a scene with a sea of particles: substeps in which water, bodies and moorings go on together (Leble & Barakos 2016,
// section 2.5). The bodies see the water's load of t over the first half of a substep, that of its middle over the whole of it: second
// order, with any of their integrators. A pure function of the state at the window's start, so windows can be repeated and restarted.
// Called by run.cpp; tested in tests/coupled/particle_sea_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "src/coupling/machine.hpp"

namespace spindrift::coupling {

/// Advances to `end_tick`. Before t = 0 the bodies are held where they start. Throws NumericalFailure; state and particles are then
/// those of the last good substep. Returns the substeps made.
std::int64_t advance_with_particles(Machine& machine, bodies::BodiesState& state, std::int64_t end_tick);

/// Evaluates the water's loads on the bodies as they stand.
void evaluate_particles(Machine& machine, const bodies::BodiesState& state);

/// Ticks of the next substep, even, so that what is left of a window is shared out evenly: `left` ticks (even), `limit` in ticks.
/// 0 where the limit is below two ticks.
std::int64_t substep_ticks(std::int64_t left, double limit);

}  // namespace spindrift::coupling
