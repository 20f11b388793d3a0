// SPDX-License-Identifier: Apache-2.0
#include "runtime/mpi/stop_request.hpp"

#include <signal.h>
#include <time.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <utility>

namespace spindrift::runtime {

namespace {

constexpr int wall_limit = 1000, stop_file = 1001;  // beyond every signal number
constexpr std::array<std::pair<int, const char*>, 6> signals{{{SIGTERM, "SIGTERM"},
                                                              {SIGINT, "SIGINT"},
                                                              {SIGUSR1, "SIGUSR1"},
                                                              {SIGUSR2, "SIGUSR2"},
                                                              {SIGHUP, "SIGHUP"},
                                                              {SIGXCPU, "SIGXCPU"}}};
constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max(), second_ns = 1'000'000'000;

// Of the one request that lives; a signal handler can reach nothing else.
std::atomic<bool> lives = false, awaited = false;
std::atomic<int> cause = 0, later = 0;
std::atomic<std::int64_t> caught_ns = 0, limit_ns = never, margin_ns = 0, looked_ns = 0;
std::string watched;  // written before threads look
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free);

std::int64_t now_ns() {  // may be called by a signal handler
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * second_ns + t.tv_nsec;
}

extern "C" void note_signal(int signal) {
  const std::int64_t now = now_ns();
  int none = 0;
  cause.compare_exchange_strong(none, signal);
  if (caught_ns == 0) {  // the first signal, whatever asked before it
    caught_ns = now;
    return;
  }
  // The same request may come through the launcher and from the terminal; the kernel repeats XCPU every second.
  if (signal == SIGXCPU || now - caught_ns < second_ns) return;
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

extern "C" void too_late(int) {}

void handle_all(void (*handler)(int)) {
  for (const auto& [number, name] : signals) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    ::sigaction(number, &action, nullptr);
  }
}

std::string reason(int why) {
  for (const auto& [number, name] : signals)
    if (why == number) return std::string("stopped on request (") + name + ")";
  if (why == wall_limit) return "the limit on wall time is reached (runtime.wall_limit_s)";
  return why == stop_file ? "stopped on request (file)" : "";
}

}  // namespace

StopAsked::StopAsked() : std::runtime_error(cause.load() != 0 ? reason(cause.load()) : "stopped on request") {}

void StopRequest::catch_signals() {
  cause = 0, caught_ns = 0, awaited = true;
  handle_all(note_signal);
}

StopRequest::StopRequest() {
  if (!awaited.exchange(false)) cause = 0, caught_ns = 0;
  margin_ns = 0, looked_ns = 0, limit_ns = never;
  watched.clear();
  lives = true;
  handle_all(note_signal);
}

StopRequest::StopRequest(double wall_limit_s, std::filesystem::path file) : StopRequest() {
  watch(wall_limit_s, std::move(file));
}

void StopRequest::watch(double wall_limit_s, std::filesystem::path file) {
  file_ = std::move(file);
  limit_ns = wall_limit_s > 0.0 ? now_ns() + std::int64_t(wall_limit_s * 1e9) : never;
  watched = file_.string();
  std::error_code none;
  if (!watched.empty()) std::filesystem::remove(file_, none);  // of the run before
}

StopRequest::~StopRequest() {
  if (!over_) give_signals_back();
  lives = false, cause = 0, limit_ns = never;
  watched.clear();
}

void StopRequest::over() {
  over_ = true;
  handle_all(too_late);  // not SIG_IGN, which processes that are started would inherit
}

void StopRequest::give_signals_back() { handle_all(SIG_DFL); }

void StopRequest::keep_margin(double seconds) { margin_ns = std::int64_t(seconds * 1e9); }

StopRequest::Later::Later() { ++later; }
StopRequest::Later::~Later() { --later; }

bool StopRequest::asked() {
  if (later.load(std::memory_order_relaxed) > 0) return false;
  if (cause.load(std::memory_order_relaxed) != 0) return true;
  if (limit_ns.load(std::memory_order_relaxed) == never && watched.empty()) return false;
  const std::int64_t now = now_ns();
  int none = 0;
  if (now >= limit_ns - margin_ns) return cause.compare_exchange_strong(none, wall_limit), true;
  if (watched.empty()) return false;
  std::int64_t before = looked_ns.load(std::memory_order_relaxed);
  if (now - before < second_ns || !looked_ns.compare_exchange_strong(before, now)) return false;
  std::error_code error;
  if (!std::filesystem::exists(watched, error)) return false;
  return cause.compare_exchange_strong(none, stop_file), true;
}

void StopRequest::give_up_if_asked() {
  if (asked()) throw StopAsked();
}

int StopRequest::signal_caught() {
  const int why = cause.load(std::memory_order_relaxed);
  return why < wall_limit ? why : 0;
}

void StopRequest::hear(int signal) {
  int none = 0;
  if (lives) cause.compare_exchange_strong(none, signal);  // its own, which may come seconds later, is still the first
}

std::string StopRequest::agreed(MPI_Comm comm) const {
  int why = asked() ? cause.load() : 0;
  MPI_Allreduce(MPI_IN_PLACE, &why, 1, MPI_INT, MPI_MAX, comm);
  std::error_code none;
  if (why == stop_file && !file_.empty()) std::filesystem::remove(file_, none);
  return reason(why);
}

void give_up_together(MPI_Comm comm, const std::function<void()>& work) {
  int given_up = 0;
  try {
    work();
  } catch (const StopAsked&) { given_up = 1; }
  MPI_Allreduce(MPI_IN_PLACE, &given_up, 1, MPI_INT, MPI_MAX, comm);
  if (given_up != 0) throw StopAsked();
}

}  // namespace spindrift::runtime
