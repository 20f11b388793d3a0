// What the airs that march in pseudo-time share as sides of a coupled window: how they settle, how a step is judged, and how
// preconditioner = "auto" is chosen, written and found again. Used by resolved_air.cpp and actuator_air.cpp; tested in
// tests/coupled. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "src/aero/flow/flow_solver.hpp"
#include "src/coupling/air_file.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/saved_array.hpp"
#include "src/coupling/settling_file.hpp"

namespace spindrift::coupling {

/// Throws NumericalFailure where the step to `t` failed or too many steps have not converged, runtime::StopAsked where it was
/// given up; a first step that was spent goes to `log_lines`.
void require_good_step(const aero::FlowSolver& solver, const FloatingSystem& floating, double t,
                       std::vector<std::string>& log_lines);

/// Steady flow before the run (start.air_steps): runs the march, a piece of its steps at a time, until `steps` are made; a line
/// of progress every few seconds. Throws NumericalFailure where it fails, runtime::StopAsked.
struct Settling {
  aero::FlowSolver& solver;
  const AirFile& state;                                  ///< of the solver
  std::optional<SettlingFile> file;                      ///< where it is saved between pieces, and goes on from
  bool first_try = true;                                 ///< later ones are not saved: they begin anew
  std::function<void()> run;                             ///< makes a piece
  std::function<double(const aero::PseudoRow&)> thrust;  ///< [N] of a row of the march
};
void settle(Settling settling, int steps, std::vector<std::string>& log_lines);
/// Pseudo-steps of a piece, by the size of the grid alone, as the bits go by it.
int settling_piece(double cells, int steps);

/// The load with the factor that start.ramp_s gives at `t`.
aero::RotorLoad ramped(aero::RotorLoad load, const FloatingSystem& floating, double t);

/// By trial on the flow as it is, into solver and `flow`. Collective.
void choose_preconditioner(aero::FlowSolver& solver, aero::FlowOptions& flow, MPI_Comm comm, std::vector<std::string>& log_lines);
/// The choice made, into checkpoints and out of them; nothing where the file has none.
SavedArray choice_array(const std::string& preconditioner, int rank);
std::optional<std::string> choice_in(const io::CheckpointReader& file);

}  // namespace spindrift::coupling
