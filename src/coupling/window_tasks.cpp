// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/window_tasks.hpp"

#include <algorithm>

namespace spindrift::coupling {

namespace {

double core_seconds_in(const runtime::Executor& executor, std::string_view module) {
  double ns = 0.0;
  const std::span<const runtime::Node> nodes = executor.graph().nodes();
  for (std::uint32_t n = 0; n < nodes.size(); ++n)
    if (nodes[n].kind == runtime::NodeKind::task && nodes[n].module() == module) ns += double(executor.cost(n).total_ns);
  return 1e-9 * ns;
}

constexpr std::array<std::string_view, 2> modules{"aero", "sea"};

}  // namespace

WindowTasks::WindowTasks(AirSide& air, BodySide& bodies, MPI_Comm comm, const runtime::ExecutorOptions& options)
    : air_(air), bodies_(bodies), comm_(comm), options_(options) {}

void WindowTasks::run(Run sides) {
  if (has_bodies(sides) && bodies_.outdated()) drop();
  Program& program = programs_[std::size_t(sides)];
  if (!program.recorded) {
    runtime::Graph graph(comm_);
    Tasks tasks = Tasks::none;
    if (has_air(sides)) tasks = std::max(tasks, air_.record(graph));
    if (has_bodies(sides)) tasks = std::max(tasks, bodies_.record(graph));
    options_.threads = tasks == Tasks::many ? 0 : 1;
    if (tasks != Tasks::none) program.executor = std::make_unique<runtime::Executor>(std::move(graph), options_);
    program.recorded = true;
  }
  if (!program.executor) return;
  const std::int64_t begin = runtime::Clock::now_ns();
  program.executor->run();
  wall_ns_ += runtime::Clock::now_ns() - begin;
}

/// Sides keep what their tasks refer to until all executors are gone.
void WindowTasks::drop() {
  for (std::size_t m = 0; m < modules.size(); ++m) dropped_[m] = core_seconds(modules[m]);
  programs_ = {};
  air_.forget_tasks();
  bodies_.forget_tasks();
}

const runtime::Executor* WindowTasks::executor() const {
  for (const Run run : {Run::both, Run::air, Run::bodies})
    if (const auto& executor = programs_[std::size_t(run)].executor) return executor.get();
  return nullptr;
}

double WindowTasks::core_seconds(std::string_view module) const {
  double sum = 0.0;
  for (std::size_t m = 0; m < modules.size(); ++m)
    if (modules[m] == module) sum = dropped_[m];
  for (const Program& program : programs_)
    if (program.executor) sum += core_seconds_in(*program.executor, module);
  return sum;
}

}  // namespace spindrift::coupling
