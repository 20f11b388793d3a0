// What a run of a scene will cost and which columns it will write, before it is run: core-seconds and memory by part from counts,
// and from rates stated or measured in a moment. Called by `spindrift check` and `spindrift study`; tested in
// tests/coupled/program_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "src/aero/resolved_rotor_setup.hpp"
#include "src/app/cost.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/start.hpp"

namespace spindrift::app {

/// Bodies with the loads of engineering models: steps and rows of history, by the processor's own clock.
struct StepCost {
  double steps = 0.0, rows = 0.0;
  double step_s = 0.0, row_s = 0.0;  ///< of one, the fastest of a few: others on the computer only add
  double core_seconds() const { return steps * step_s + rows * row_s; }
};
StepCost measured_steps(coupling::FloatingSystem& floating, const coupling::Start& start);

/// Of a sea of particles as its census counts it.
PartCost cost_of_particles(const coupling::FloatingSystem& floating, const sea::ParticleCensus& census, double steps_per_window);

/// Of a resolved rotor with so many pseudo-steps at most per simulated second and before t = 0; notes: states kept.
PartCost cost_of_air(const aero::ResolvedRotorSetup& setup, const aero::ResolvedRotorSize& size, double per_second, double before,
                     int notes, bool calibrate);

/// Substeps of a window beside particles.
double particle_steps(const coupling::FloatingSystem& floating, const sea::ParticleCensus& census);

struct Forecast {
  double core_seconds = 0.0, bytes = 0.0;
  std::vector<std::string> columns;  ///< of history.csv; empty where only the run itself knows
};
Forecast forecast(coupling::FloatingSystem& floating, const coupling::Start& start);
/// A resolved rotor without bodies.
Forecast forecast_of_air(const coupling::Scenario& scenario);

/// Memory of this process at its largest so far [bytes].
double peak_memory();
/// Processor time of all threads of this process so far [s].
double processor_seconds();

}  // namespace spindrift::app
