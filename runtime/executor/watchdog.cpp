// SPDX-License-Identifier: Apache-2.0
#include "runtime/executor/watchdog.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>

#include "runtime/mpi/heartbeat.hpp"

#ifdef SPINDRIFT_SANITIZED
#define SPINDRIFT_LOOKS_ON __attribute__((no_sanitize("thread")))
#else
#define SPINDRIFT_LOOKS_ON
#endif

namespace spindrift::runtime {
namespace {

constexpr double most_patience_s = 60;  ///< for a run to end in order that has lost a rank
constexpr double least_reply_s = 2;     ///< for a living rank on a busy computer
std::atomic<int> graphs_at_work = 0;    ///< of this process
std::atomic<Watchdog*> of_process = nullptr;

std::uint64_t beats(const Team& team) {
  std::uint64_t sum = 0;
  for (const auto& worker : team.workers) sum += worker->beats.load(std::memory_order_relaxed);
  return sum;
}

bool inside_a_task(const Team& team) {
  return std::any_of(team.workers.begin(), team.workers.end(),
                     [](const auto& w) { return w->inside.load(std::memory_order_relaxed) != no_node; });
}

/// Whether the loop is being iterated now: all loops round it are, and it was entered but not left.
/// A loop not entered has its own slot waiting for tokens.
SPINDRIFT_LOOKS_ON bool entered(const Program& program, std::uint32_t loop) {
  const std::uint32_t slot = program.loops[loop].slot;
  if (slot == no_node) return true;
  const Slot& s = program.slots[slot];
  // Its counter for the current step was set again when it was entered, for the step after the next.
  const Loop& outer = program.loops[s.loop];
  return entered(program, s.loop) && s.step - outer.base < std::max(outer.limit, 1u) &&
         std::any_of(program.gates.begin() + program.loops[loop].first_gate,
                     program.gates.begin() + program.loops[loop].last_gate,
                     [&](std::uint32_t gate) { return program.slots[gate].step != program.loops[loop].base; });
}

}  // namespace

// Reads what workers write without synchronisation: it runs when they have been quiet for long, and a torn number in a dump is no
// harm.
SPINDRIFT_LOOKS_ON std::string dump(const Team& team, int lines) {
  const Program& program = team.program;
  const auto nodes = team.graph.nodes();
  std::string text;
  for (std::size_t t = 0; t < team.workers.size(); ++t)
    if (const std::uint32_t node = team.workers[t]->inside.load(std::memory_order_relaxed); node != no_node)
      text += "  thread " + std::to_string(t) + " is inside " + nodes[node].label + "\n";
  for (std::uint32_t n = 0; n < nodes.size() && lines > 0; ++n) {
    const Slot& slot = program.slots[n];
    const Loop& loop = program.loops[slot.loop];
    if (!entered(program, slot.loop) || slot.step - loop.base >= loop.limit) continue;
    std::string missing;
    for (const Edge& e : team.graph.edges())
      if (e.to == n && std::int32_t(program.slots[e.from].step - (slot.step - e.distance)) <= 0 &&
          (e.distance == 0 || slot.step != loop.base))
        missing += (missing.empty() ? " waits for " : ", ") + nodes[e.from].label;
    text += "  " + nodes[n].label + " (iteration " + std::to_string(slot.step - loop.base) + ")";
    if (missing.empty() && (slot.action == Action::message || slot.action == Action::collective)) {
      if (nodes[n].kind == NodeKind::reduce || nodes[n].kind == NodeKind::collective) {
        missing = " waits for the other ranks";
      } else {
        const Message& m = team.graph.recorded().messages[slot.payload];
        missing = std::string(nodes[n].kind == NodeKind::send ? " waits to reach" : " waits for") + " rank " +
                  std::to_string(m.peer) + ", tag " + std::to_string(m.tag);
      }
    }
    text += (missing.empty() ? " is ready or running" : missing) + "\n";
    --lines;
  }
  return text;
}

Watchdog::Watchdog(Of of, double limit_s, std::FILE* file) : of_(of), file_(file), limit_s_(limit_s) {
  if (of == Of::process) of_process = this;
  thread_ = std::thread([this] { watch(); });
}

Watchdog::~Watchdog() {
  if (of_ == Of::process) of_process = nullptr;
  {
    const std::lock_guard lock(lock_);
    leaving_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

Watchdog* Watchdog::current() {
  Watchdog* const one = of_process;
  if (!one) return nullptr;
  const std::lock_guard lock(one->lock_);
  return one->limit_s_ > 0 ? one : nullptr;
}

void Watchdog::set_limit(double limit_s) {
  Watchdog* const one = of_process;
  if (!one) return;
  {
    const std::lock_guard lock(one->lock_);
    one->limit_s_ = limit_s;
    ++one->changes_;
  }
  one->changed_.notify_one();
}

void Watchdog::run_starts(Team& team) {
  const std::lock_guard lock(lock_);
  at_work_.push_back(&team);
  ++changes_, ++graphs_at_work;
}

void Watchdog::run_ends(Team& team) {
  const std::lock_guard lock(lock_);
  std::erase(at_work_, &team);
  ++changes_, --graphs_at_work;
}

/// Changes wherever something completes.
std::uint64_t Watchdog::progress() const {
  std::uint64_t sum = changes_;
  for (const Team* team : at_work_) sum += beats(*team);
  return sum;
}

void Watchdog::watch() {
  using std::chrono::duration, std::chrono::steady_clock;
  std::unique_lock lock(lock_);
  std::uint64_t seen = 0;
  auto since = steady_clock::now();
  while (!leaving_) {
    if (limit_s_ <= 0) {
      changed_.wait(lock);
      continue;
    }
    changed_.wait_for(lock, duration<double>(std::min(1.0, limit_s_ / 8)));
    const std::uint64_t now = progress();
    const bool others_work = of_ == Of::executor && at_work_.empty() && graphs_at_work > 0;
    if (now != seen || others_work) {
      seen = now, since = steady_clock::now();
      said_s_ = 0.0, named_.clear();
      continue;
    }
    const double quiet_s = duration<double>(steady_clock::now() - since).count();
    ask_others(quiet_s);
    look_at_graphs(quiet_s);
  }
}

/// A rank that stands still is named within the limit of then: in half of it after the next question, of which the first comes
/// after a quarter, and others as long as nothing completes.
void Watchdog::ask_others(double quiet_s) {
  Heartbeat* const heartbeat = Heartbeat::current();
  if (!heartbeat || quiet_s < limit_s_ / 4) return;
  heartbeat->ask(std::max(limit_s_ / 2, least_reply_s));
  if (const std::string silent = heartbeat->silent(); !silent.empty() && silent != named_) {
    named_ = silent;
    end_without(silent, quiet_s);
  }
}

/// A thread inside MPI may never come back from a call that a silent rank has part in: in order first, then by force.
void Watchdog::end_without(const std::string& silent, double quiet_s) {
  const std::string what = report(quiet_s, silent);
  Heartbeat::current()->end_within(std::min(limit_s_, most_patience_s), sentence(quiet_s, silent));
  for (Team* team : at_work_) team->fail({team->graph.recorded().comm.rank(), true, "", what});
}

void Watchdog::look_at_graphs(double quiet_s) {
  if (at_work_.empty() || quiet_s - said_s_ < limit_s_) return;
  said_s_ = quiet_s;
  const std::string what = report(quiet_s, "");
  for (Team* team : at_work_)
    if (!inside_a_task(*team)) team->fail({team->graph.recorded().comm.rank(), true, "", what});
}

/// What is said, and written.
std::string Watchdog::sentence(double quiet_s, const std::string& silent) const {
  const Heartbeat* const heartbeat = Heartbeat::current();
  const int rank = heartbeat ? heartbeat->rank() : at_work_.empty() ? 0 : at_work_.back()->graph.recorded().comm.rank();
  return "nothing completed for " + std::to_string(int(quiet_s)) + " s on rank " + std::to_string(rank) +
         (silent.empty() ? "" : "; " + silent) + (at_work_.empty() ? ", where no graph runs" : "");
}

std::string Watchdog::report(double quiet_s, const std::string& silent) const {
  std::string what = sentence(quiet_s, silent) + (at_work_.empty() ? "\n" : ":\n");
  for (const Team* team : at_work_) what += dump(*team);
  std::fputs(("watchdog: " + what).c_str(), file_);
  std::fflush(file_);
  return what;
}

}  // namespace spindrift::runtime
