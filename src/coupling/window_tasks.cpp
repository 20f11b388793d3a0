// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/window_tasks.hpp"

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

WindowTasks::WindowTasks(AirSide* air, BodySide& bodies, MPI_Comm comm, std::size_t records)
    : air_(air), bodies_(bodies), comm_(comm), records_(records) {}

void WindowTasks::run(bool air, bool bodies) {
  if (bodies && bodies_.outdated()) drop();
  Program& program = programs_[std::size_t(air) + 2 * std::size_t(bodies)];
  if (!program.recorded) {
    runtime::Graph graph(comm_);
    const bool of_air = air && air_->record(graph), of_bodies = bodies && bodies_.record(graph);
    if (of_air || of_bodies)
      program.executor = std::make_unique<runtime::Executor>(std::move(graph), runtime::ExecutorOptions{.records = records_});
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
  if (air_) air_->forget_tasks();
  bodies_.forget_tasks();
}

const runtime::Executor* WindowTasks::executor() const {
  for (const std::size_t n : {3, 1, 2})
    if (programs_[n].executor) return programs_[n].executor.get();
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
