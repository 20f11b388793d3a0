// SPDX-License-Identifier: Apache-2.0
#include "runtime/executor/executor.hpp"

#include <omp.h>

#include <bit>

#include "runtime/executor/priority.hpp"
#include "runtime/executor/watchdog.hpp"
#include "runtime/executor/worker.hpp"
#include "runtime/trace/clock.hpp"
#include "runtime/trace/ledger.hpp"

namespace spindrift::runtime {

struct Executor::State {
  State(Graph graph, ExecutorOptions options) : team(std::move(graph), options) {
    if (Ledger* ledger = Ledger::current()) ledger->opened(team);
  }
  ~State() {
    if (Ledger* ledger = Ledger::current()) ledger->closed(team);
  }
  Team team;
  std::unique_ptr<Watchdog> own_watchdog;  ///< where the process has none
  std::uint64_t runs = 0;
};

namespace {

/// Priorities and the capacity that the queues need for them. Between runs only: costs are measured by then, queues are empty.
void set_levels(Team& team) {
  const auto n_nodes = std::uint32_t(team.graph.nodes().size());
  std::vector<std::uint32_t> capacity(1, n_nodes);
  if (team.options.random_schedule)
    capacity.assign(8, n_nodes);
  else if (team.options.priorities)
    capacity = assign_levels(team.program, team.graph);
  team.levels = int(capacity.size());
  for (auto& worker : team.workers) worker->queue.reserve(capacity);
}

void set_homes(Team& team) {
  const auto nodes = team.graph.nodes();
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (nodes[n].place < 0) continue;
    team.program.slots[n].home = std::uint16_t(nodes[n].place * float(team.workers.size()));
    team.program.slots[n].placed = true;
  }
}

[[noreturn]] void throw_failure(const Notice& notice) {
  if (notice.hang) throw HangError(notice.what);
  throw TaskError(notice.label, notice.rank, notice.what);
}

}  // namespace

Executor::Executor(Graph graph, ExecutorOptions options) {
  if (options.threads <= 0) options.threads = omp_get_max_threads();
  state_ = std::make_unique<State>(std::move(graph), options);
  Team& team = state_->team;
  for (int t = 0; t < options.threads; ++t) team.workers.push_back(std::make_unique<Worker>(team, t));
  team.spins = !oversubscribed(options.threads, team.graph.recorded().comm.ranks_on_node());
  set_homes(team);
  set_levels(team);
}

Executor::~Executor() = default;
Executor::Executor(Executor&&) noexcept = default;

void Executor::run(std::uint32_t n) {
  Team& team = state_->team;
  if (team.failure)
    throw GraphError("the graph was cancelled and cannot run again: " + team.failure->label + ": " + team.failure->what);
  if (n == 0) return;
  // Costs are known after the first run; they drift slowly afterwards.
  if (team.options.priorities && !team.options.random_schedule && state_->runs > 0 &&
      (std::has_single_bit(state_->runs) || state_->runs % 64 == 0))
    set_levels(team);
  ++state_->runs;
  Ledger* const ledger = Ledger::current();
  team.recording = team.options.records > 0 && (!ledger || ledger->keeps_records());
  if (ledger) ledger->starts(team);
  Watchdog* watchdog = Watchdog::current();
  if (std::unique_ptr<Watchdog>& own = state_->own_watchdog; !watchdog && team.options.watchdog_s > 0) {
    if (!own) own = std::make_unique<Watchdog>(Watchdog::Of::executor, team.options.watchdog_s, team.options.watchdog_file);
    watchdog = own.get();
  }
  if (watchdog) watchdog->run_starts(team);
  team.ended.store(false, std::memory_order_relaxed);
  const std::int64_t begin_ns = Clock::now_ns();
#pragma omp parallel num_threads(team.options.threads)
  {
    Worker& worker = *team.workers[std::size_t(omp_get_thread_num())];
    // The runtime needs no thread but the first: if OpenMP gives fewer, these do the work of all.
    if (omp_get_thread_num() == 0) worker.enter(0, n);
    worker.work();
  }
  if (ledger) ledger->ran(team, begin_ns, Clock::now_ns() - begin_ns);
  if (watchdog) watchdog->run_ends(team);
  if (!team.failure) return;
  const bool ours = team.failure->rank == team.graph.recorded().comm.rank();
  team.messages.abandon(ours ? &*team.failure : nullptr);
  throw_failure(*team.failure);
}

const Team& Executor::team() const { return state_->team; }
int Executor::threads() const { return state_->team.options.threads; }
const Graph& Executor::graph() const { return state_->team.graph; }
std::span<const Record> Executor::records(int thread) const {
  return state_->team.workers.at(std::size_t(thread))->records.records();
}
void Executor::clear_records() {
  for (auto& worker : state_->team.workers) worker->records.clear();
}
const ThreadTimes& Executor::times(int thread) const { return state_->team.workers.at(std::size_t(thread))->times; }
TaskCost Executor::cost(std::uint32_t node) const {
  const Slot& slot = state_->team.program.slots.at(node);
  return {slot.cost_ns, slot.step};
}
std::uint64_t Executor::bytes(std::uint32_t node) const { return state_->team.graph.recorded().message_bytes.at(node); }

}  // namespace spindrift::runtime
