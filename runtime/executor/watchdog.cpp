// SPDX-License-Identifier: Apache-2.0
#include "runtime/executor/watchdog.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>

#include "runtime/mpi/heartbeat.hpp"

#if defined(__SANITIZE_THREAD__)
#define SPINDRIFT_LOOKS_ON __attribute__((no_sanitize("thread")))
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define SPINDRIFT_LOOKS_ON __attribute__((no_sanitize("thread")))
#endif
#endif
#ifndef SPINDRIFT_LOOKS_ON
#define SPINDRIFT_LOOKS_ON
#endif

namespace spindrift::runtime {
namespace {

constexpr double most_patience_s = 60;  ///< for a run to end in order that has lost a rank
std::atomic<int> graphs_at_work = 0;    ///< of this process

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

Watchdog::Watchdog(Team& team) : team_(team), thread_([this] { watch(); }) {}

Watchdog::~Watchdog() {
  {
    const std::lock_guard lock(lock_);
    leaving_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void Watchdog::run_starts() {
  const std::lock_guard lock(lock_);
  running_ = true;
  ++graphs_at_work;
}

void Watchdog::run_ends() {
  const std::lock_guard lock(lock_);
  running_ = false;
  --graphs_at_work;
}

void Watchdog::watch() {
  using std::chrono::duration, std::chrono::steady_clock;
  const double limit = team_.options.watchdog_s;
  std::unique_lock lock(lock_);
  std::uint64_t seen = 0;
  auto since = steady_clock::now();
  Heartbeat* const heartbeat = Heartbeat::current();
  bool asking = false, was_running = false;
  while (!leaving_) {
    changed_.wait_for(lock, duration<double>(std::min(1.0, limit / 8)));
    const std::uint64_t now = beats(team_);
    // Between two graphs nothing completes: only a rank that does not answer ends that.
    const bool idle = !running_ && (!heartbeat || graphs_at_work > 0);
    if (idle || now != seen || running_ != was_running) {
      seen = now, was_running = running_;
      since = steady_clock::now();
      asking = false;
      continue;
    }
    const double quiet = duration<double>(steady_clock::now() - since).count();
    if (heartbeat && quiet > limit / 2) {
      if (!asking) heartbeat->forget();
      asking = true;
      heartbeat->ask();
    }
    if (quiet < limit) continue;
    since = steady_clock::now();
    const std::string silent = heartbeat ? heartbeat->silent() : std::string();
    if (running_ || !silent.empty()) ends_or_says(quiet, silent);
  }
}

void Watchdog::ends_or_says(double quiet, const std::string& silent) {
  const int rank = team_.graph.recorded().comm.rank();
  const std::string what = "nothing completed for " + std::to_string(int(quiet)) + " s on rank " + std::to_string(rank) +
                           (silent.empty() ? "" : "; " + silent) + (running_ ? ":\n" + dump(team_) : ", between two graphs\n");
  std::fputs(("watchdog: " + what).c_str(), team_.options.watchdog_file);
  std::fflush(team_.options.watchdog_file);
  // A thread inside MPI may never come back from a call that a silent rank has part in: in order first, then by force.
  if (!silent.empty()) Heartbeat::current()->end_within(std::min(team_.options.watchdog_s, most_patience_s));
  if (running_ && (!silent.empty() || !inside_a_task(team_))) team_.fail({rank, true, "", what});
}

}  // namespace spindrift::runtime
