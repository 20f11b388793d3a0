// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/air_settling.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>

#include "kernels/base/failure.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "src/coupling/air_file.hpp"
#include "src/coupling/retries.hpp"
#include "src/io/progress.hpp"

namespace spindrift::coupling {

int settling_piece(double cells, int steps) {
  constexpr double cells_of_a_piece = 2.5e6;  // half a minute of a core
  return std::clamp(int(cells_of_a_piece / cells), std::min(10, steps), steps);
}

void settle(const SteadyMarch& steady, int steps, int retry, std::optional<SettlingFile> file, const runtime::World& world,
            std::vector<std::string>& log_lines) {
  aero::FlowSolver& solver = steady.solver;
  const aero::MarchState& march = solver.march();
  const AirFile state(solver, world);
  solver.judgement().march.ease(share_of_cfl(retry));
  const std::optional<io::CheckpointReader> saved = file && retry == 0 ? file->newest() : std::nullopt;
  if (saved) {
    state.read(*saved);
    log_lines.push_back(
        fmt::format("the air goes on settling after {} pseudo-steps, from {}", march.steps - 1, saved->path().string()));
  }
  const int before = saved ? march.steps - 1 : 0;
  const auto begin = std::chrono::steady_clock::now();
  double said_s = 0.0;
  for (int done = before; done == before || (march.spent && done < steps);) {
    if (done > before) solver.judgement().rows.keep_last();
    steady.run();
    done = march.steps - 1;
    if (march.verdict == aero::Verdict::stopped) throw runtime::StopAsked();
    if (file && retry == 0 && march.spent && done < steps) file->offer(done, state.arrays());
    const double spent_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (spent_s - said_s < 10.0 || done >= steps) continue;
    said_s = spent_s;
    spdlog::info("air settles: {} of {} pseudo-steps, thrust {:.4g} kN, about {} left", done, steps,
                 1e-3 * steady.thrust(solver.rows().back()), io::duration_text(spent_s / (done - before) * (steps - done)));
  }
  if (march.verdict == aero::Verdict::failed)
    throw NumericalFailure(fmt::format("aero: while the air settles (start.air_steps): {} (pseudo-step {}, CFL {:.3g}){}{}",
                                       march.why, march.steps, march.cfl, solver.judgement().trouble(),
                                       file ? file->save_failed(march.steps, state.arrays()) : std::string()),
                           "aero/rotor", march.steps, 0.0);
  const auto& rows = solver.rows();
  constexpr std::size_t look_back = 20;
  const double end = steady.thrust(rows.back());
  const std::string change = rows.size() > look_back + 1
                                 ? fmt::format(", {:+.2g} % in the last {}",
                                               100.0 * (end / steady.thrust(rows[rows.size() - 1 - look_back]) - 1.0), look_back)
                                 : std::string();
  log_lines.push_back(fmt::format("air settled by {} pseudo-steps: thrust {:.4g} kN{}, density residual fallen by {:.2g}",
                                  march.steps - 1, 1e-3 * end, change, march.density_drop()));
}

aero::TileStates settled(const std::function<aero::TileStates(int retry)>& attempt) {
  for (int retry = 0;; ++retry) try {
      return attempt(retry);
    } catch (const NumericalFailure& failure) {
      if (retry == most_retries) throw;
      spdlog::warn("{}; retry {} of {} from a CFL number {:g} as large", failure.what(), retry + 1, most_retries,
                   share_of_cfl(retry + 1));
    }
}

}  // namespace spindrift::coupling
