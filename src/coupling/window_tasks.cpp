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

void carry_out(const std::function<void()>& part) {
  if (part) part();
}

}  // namespace

WindowTasks::WindowTasks(AirSide& air, BodySide& bodies, OutputTask& output, MPI_Comm comm,
                         const runtime::ExecutorOptions& options)
    : air_(air), bodies_(bodies), output_(output), comm_(comm), options_(options) {}

void WindowTasks::run(Run sides, const Exchange& exchange) {
  if (has_bodies(sides) && bodies_.outdated()) drop(), begin_window();
  Program& program = programs_[std::size_t(sides)];
  if (!program) program = record(sides);
  exchange_ = &exchange;
  const bool outside = air_.asks_ranks();
  if (outside) carry_out(exchange.give);
  const std::int64_t begin = runtime::Clock::now_ns();
  program->run();
  wall_ns_ += runtime::Clock::now_ns() - begin;
  if (outside) carry_out(exchange.take_motion), carry_out(exchange.take_load);
}

WindowTasks::Program WindowTasks::record(Run sides) {
  runtime::Graph graph(comm_);
  output_.record(graph);
  const runtime::Datum hub_motion = graph.datum(), rotor_load = graph.datum();
  const bool exchanges = !air_.asks_ranks();
  std::uint32_t given = runtime::no_node;
  if (exchanges)
    given = graph.task("exchange/extrapolate", {runtime::reads(hub_motion), runtime::reads(rotor_load)},
                       [this] { carry_out(exchange_->give); });
  // All of a side stands between what it is given and its result.
  const auto record_side = [&](auto& side, const char* label, runtime::Datum result, std::function<void()> Exchange::*take) {
    const auto first = std::uint32_t(graph.nodes().size());
    const Tasks tasks = side.record(graph);
    const auto end = std::uint32_t(graph.nodes().size());
    if (!exchanges) return tasks;
    const std::uint32_t taken = graph.task(label, {runtime::updates(result)}, [this, take] { carry_out(exchange_->*take); });
    for (std::uint32_t n = first; n < end; ++n)
      if (graph.nodes()[n].loop == runtime::no_node) graph.order(given, n), graph.order(n, taken);
    return tasks;
  };
  Tasks tasks = Tasks::single;
  if (has_air(sides)) tasks = std::max(tasks, record_side(air_, "exchange/rotor_load", rotor_load, &Exchange::take_load));
  if (has_bodies(sides)) tasks = std::max(tasks, record_side(bodies_, "exchange/hub_motion", hub_motion, &Exchange::take_motion));
  options_.threads = tasks == Tasks::many ? 0 : 1;
  return std::make_unique<runtime::Executor>(std::move(graph), options_);
}

void WindowTasks::drop() {
  for (std::size_t m = 0; m < modules.size(); ++m) dropped_[m] = core_seconds(modules[m]);
  programs_ = {}, windows_ = 0;
  air_.forget_tasks();
  bodies_.forget_tasks();
}

std::vector<const runtime::Executor*> WindowTasks::executors() const {
  std::vector<const runtime::Executor*> all;
  for (const Program& program : programs_)
    if (program) all.push_back(program.get());
  return all;
}

const runtime::Executor* WindowTasks::executor() const {
  for (const Run run : {Run::both, Run::air, Run::bodies})
    if (const Program& program = programs_[std::size_t(run)]) return program.get();
  return nullptr;
}

double WindowTasks::core_seconds(std::string_view module) const {
  double sum = 0.0;
  for (std::size_t m = 0; m < modules.size(); ++m)
    if (modules[m] == module) sum = dropped_[m];
  for (const Program& program : programs_)
    if (program) sum += core_seconds_in(*program, module);
  return sum;
}

}  // namespace spindrift::coupling
