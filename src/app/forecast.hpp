// What a run of a scene will cost and which columns it will write, before it is run: core-seconds and memory by part from counts,
// and from rates stated or measured in a moment. Called by `spindrift check` and `spindrift study`; tested in
// tests/coupled/program_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "runtime/trace/processor_share.hpp"
#include "src/aero/grid/multi_block.hpp"
#include "src/aero/resolved_rotor_setup.hpp"
#include "src/app/cost.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/start.hpp"
#include "src/scene/document.hpp"

namespace spindrift::app {

/// Bodies with the loads of engineering models: steps, exchanges with a rotor that is not evaluated in every step, rows of
/// history, by the processor's own clock.
struct StepCost {
  double steps = 0.0, exchanges = 0.0, rows = 0.0;
  double step_s = 0.0, exchange_s = 0.0, row_s = 0.0;  ///< of one, the fastest of a few: others on the computer only add
  std::string trouble;                                 ///< empty, or which of the steps that were tried failed and why
  double core_seconds() const { return steps * step_s + exchanges * exchange_s + rows * row_s; }
};
StepCost measured_steps(coupling::FloatingSystem& floating, const coupling::Start& start);

/// Of a sea of particles as its census counts it.
PartCost cost_of_particles(const coupling::FloatingSystem& floating, const sea::ParticleCensus& census, double steps_per_window);

/// Pseudo-steps of a run of air, or of the air in one, and what is said of them.
struct PseudoSteps {
  double per_second = 0.0;  ///< simulated
  std::string work;
};
/// `rotor`: the resolved one, as it is at the start; none of other flows.
PseudoSteps expected_pseudo_steps(const coupling::Scenario& scenario, const aero::ResolvedRotorSetup* rotor = nullptr);
/// The same of air with bodies, in all evaluations of a window.
PseudoSteps coupled_pseudo_steps(const coupling::Scenario& scenario, const aero::ResolvedRotorSetup* rotor = nullptr);
/// Of a resolved rotor on bodies: with its speed at the start and the air's physical step.
aero::ResolvedRotorSetup resolved_rotor_on(const coupling::FloatingSystem& floating, const coupling::Start& start);

/// Of a resolved rotor with these pseudo-steps, and so many before t = 0; notes: states kept.
PartCost cost_of_air(const aero::ResolvedRotorSetup& setup, const aero::ResolvedRotorSize& size, const PseudoSteps& steps,
                     double before, int notes, bool calibrate);

/// Substeps of a window beside particles.
double particle_steps(const coupling::FloatingSystem& floating, const sea::ParticleCensus& census);

struct Forecast {
  double core_seconds = 0.0, bytes = 0.0;
  std::vector<std::string> columns;  ///< of history.csv; empty where only the run itself knows
};
/// Those of bodies with all that acts on them; of air alone. Some scenes have fewer columns of the air.
std::vector<std::string> columns_of(coupling::FloatingSystem& floating);
std::vector<std::string> columns_of_air_alone();
/// Of a name that is none of the known columns, for an error: the column or columns that may be meant, else what columns begin
/// with.
std::string no_column(const std::string& name, const std::vector<std::string>& known);
/// Throws SceneError where [[output.expected]] names a column that the scene does not have.
void require_expected_columns(scene::Document& document, const coupling::OutputOptions& output,
                              const std::vector<std::string>& known);
Forecast forecast(coupling::FloatingSystem& floating, const coupling::Start& start);
/// Air without bodies: a resolved rotor, or the flow on a grid.
Forecast forecast_of_air(const coupling::Scenario& scenario);
/// Of the flow on a grid that stands, whatever is in it; a flow alone on few cells is tried for its rate and its steps.
PartCost cost_of_flow(const coupling::Scenario& scenario, const aero::MultiBlockGrid& grid);

/// Of a run's history, log and the libraries that write them, beside what a check takes [bytes]; measured.
inline constexpr double output_bytes = 4.5e6;
/// Processor time of the same: folder, log, scene, summary, checkpoint [s].
inline constexpr double output_seconds = 0.02;
/// Memory of this process at its largest so far [bytes].
double peak_memory();
/// The same now: what was given back is not in it [bytes].
double resident_memory();
/// Of a run that begins with what this check has done, in `start_s` of processor time and `resident` bytes: those before what a
/// census or a grid leaves behind.
inline BaseCost base_cost(double start_s, double resident) { return {resident + output_bytes, start_s + output_seconds}; }
using runtime::processor_seconds;

}  // namespace spindrift::app
