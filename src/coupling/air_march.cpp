// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/air_march.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "kernels/base/failure.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "src/aero/flow/choice.hpp"
#include "src/io/progress.hpp"

namespace spindrift::coupling {

namespace {

/// What preconditioner = "auto" may become, by number in checkpoints.
constexpr std::array<const char*, 2> choices{"block_ilu", "coarse"};
constexpr const char* choice_name = "air/preconditioner";

}  // namespace

void require_good_step(const aero::FlowSolver& solver, const FloatingSystem& floating, double t,
                       std::vector<std::string>& log_lines) {
  const aero::FlowOptions& flow = *floating.scenario().aero.flow;
  const aero::MarchState& march = solver.march();
  if (march.verdict == aero::Verdict::stopped) throw runtime::StopAsked();
  if (march.verdict == aero::Verdict::failed)
    throw NumericalFailure(fmt::format("t = {:g} s: aero: {} (pseudo-step {}, CFL {:.3g}){}; try aero.flow.cfl_max below {:g}", t,
                                       march.why, march.steps, march.cfl, solver.judgement().trouble(), flow.cfl_max),
                           "aero/rotor", long(solver.time_steps()), t);
  const long windows = floating.timeline().windows(), unconverged = march.unconverged;
  if (march.spent && unconverged == 1)
    log_lines.push_back(
        fmt::format("warning: air: the step to t = {:g} s spent its {} pseudo-steps; the flux balance is at {:.2g} of "
                    "that at its start, {:.2g} is asked for",
                    t, march.steps - 1, march.balance_drop(), flow.drop));
  if (double(unconverged) > flow.unconverged_share * double(std::max(windows, march.ended)))
    throw NumericalFailure(
        fmt::format("t = {:g} s: aero: {} of {} steps spent their {} pseudo-steps without the drop of {:.2g}, more than "
                    "aero.flow.unconverged_share = {:g} of the run's; the last ended at {:.2g}; try more "
                    "aero.flow.max_pseudo_steps or a shorter window",
                    t, unconverged, march.ended, flow.max_pseudo_steps, flow.drop, flow.unconverged_share, march.balance_drop()),
        "aero/rotor", long(solver.time_steps()), t);
}

int settling_piece(double cells, int steps) {
  constexpr double cells_of_a_piece = 2.5e6;  // half a minute of a core
  return std::clamp(int(cells_of_a_piece / cells), std::min(10, steps), steps);
}

void settle(Settling settling, int steps, std::vector<std::string>& log_lines) {
  aero::FlowSolver& solver = settling.solver;
  const auto& thrust = settling.thrust;
  const aero::MarchState& march = solver.march();
  const std::optional<io::CheckpointReader> saved = settling.file && settling.first_try ? settling.file->newest() : std::nullopt;
  if (saved) {
    settling.state.read(*saved);
    log_lines.push_back(
        fmt::format("the air goes on settling after {} pseudo-steps, from {}", march.steps - 1, saved->path().string()));
  }
  const int before = saved ? march.steps - 1 : 0;
  const auto begin = std::chrono::steady_clock::now();
  double said_s = 0.0;
  for (int done = before; done == before || (march.spent && done < steps);) {
    if (done > before) solver.judgement().rows.keep_last();
    settling.run();
    done = march.steps - 1;
    if (march.verdict == aero::Verdict::stopped) throw runtime::StopAsked();
    if (settling.file && settling.first_try && march.spent && done < steps) settling.file->offer(done, settling.state.arrays());
    const double spent_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (spent_s - said_s < 10.0 || done >= steps) continue;
    said_s = spent_s;
    spdlog::info("air settles: {} of {} pseudo-steps, thrust {:.4g} kN, about {} left", done, steps,
                 1e-3 * thrust(solver.rows().back()), io::duration_text(spent_s / (done - before) * (steps - done)));
  }
  if (march.verdict == aero::Verdict::failed)
    throw NumericalFailure(
        fmt::format("aero: while the air settles (start.air_steps): {} (pseudo-step {}, CFL {:.3g}){}{}", march.why, march.steps,
                    march.cfl, solver.judgement().trouble(),
                    settling.file ? settling.file->save_failed(march.steps, settling.state.arrays()) : std::string()),
        "aero/rotor", march.steps, 0.0);
  const auto& rows = solver.rows();
  constexpr std::size_t look_back = 20;
  const double end = thrust(rows.back());
  const std::string change =
      rows.size() > look_back + 1
          ? fmt::format(", {:+.2g} % in the last {}", 100.0 * (end / thrust(rows[rows.size() - 1 - look_back]) - 1.0), look_back)
          : std::string();
  log_lines.push_back(fmt::format("air settled by {} pseudo-steps: thrust {:.4g} kN{}, density residual fallen by {:.2g}",
                                  march.steps - 1, 1e-3 * end, change, march.density_drop()));
}

aero::RotorLoad ramped(aero::RotorLoad load, const FloatingSystem& floating, double t) {
  const double ramp = floating.ramp(t);
  load.thrust *= ramp, load.torque *= ramp, load.power *= ramp, load.force *= ramp, load.moment *= ramp;
  return load;
}

void choose_preconditioner(aero::FlowSolver& solver, aero::FlowOptions& flow, MPI_Comm comm,
                           std::vector<std::string>& log_lines) {
  const aero::Choice choice = aero::choose_preconditioner(solver, comm);
  flow.preconditioner = choice.preconditioner;
  solver.use(aero::make_preconditioner(choice.preconditioner, solver.setting().common));
  log_lines.push_back(fmt::format("air: preconditioner \"{}\" ({})", choice.preconditioner, choice.reason));
}

SavedArray choice_array(const std::string& preconditioner, int rank) {
  SavedArray array{choice_name, 1, {}};
  if (rank == 0) array.pieces.push_back({0, {double(std::ranges::find(choices, preconditioner) - choices.begin())}});
  return array;
}

std::optional<std::string> choice_in(const io::CheckpointReader& file) {
  if (!file.has(choice_name)) return {};
  return choices.at(std::size_t(file.read<double>(choice_name).at(0)));
}

}  // namespace spindrift::coupling
