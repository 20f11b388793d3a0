// Which ranks are alive. A thread of each process replies to others on a communicator of its own, whatever tasks do. A watchdog
// that has seen nothing complete for long asks: rank 0 all others; these rank 0, which says whom it has not heard. Nothing is
// sent as long as work goes on. Where a rank stands still no call of MPI may return on the others, so the thread also ends the
// processes that have not ended by themselves in time. And a signal that asks one rank to stop becomes known to all, for work in
// which they do not meet. Owned by MpiEnvironment; asked by executor/watchdog.cpp; tested in tests/faults/faults.py
// (stopped_rank, signals_at_start) and tests/runtime/stuck_rank.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace spindrift::runtime {

class Heartbeat {
 public:
  /// Collective, as is its end.
  explicit Heartbeat(MPI_Comm world);
  ~Heartbeat();
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;
  /// That of the process; null where there is one rank.
  static Heartbeat* current();

  int rank() const { return rank_; }
  /// Asks whoever has no question of this rank still to answer. Who leaves one open for longer than `patience_s` is silent; a
  /// living rank takes a second. Called again and again: four times in the patience are enough, more do nothing.
  void ask(double patience_s);
  /// "rank 3 does not answer", empty where all have answered as far as this rank can tell.
  std::string silent();
  /// All ranks end with `exit_code` in so many seconds, unless this process has left MPI before. The first call counts. `why`:
  /// for LastWords.
  void end_within(double seconds, std::string why);
  static constexpr int exit_code = 4;  ///< a system failure (docs: exit codes)

  /// What the thread does before it ends this process; nothing where there is one rank. One at a time.
  class LastWords {
   public:
    explicit LastWords(std::function<void(const std::string& why)> words);
    ~LastWords();
    LastWords(const LastWords&) = delete;
    LastWords& operator=(const LastWords&) = delete;
  };

 private:
  using Time = std::chrono::steady_clock::time_point;
  void attend();        // answers who has asked, hears who has answered; about twice a second
  void pass_on_stop();  // as often
  void live();
  void question(int rank);
  void send(int rank, int tag, const std::vector<int>& words);
  std::vector<int> unheard() const;

  std::mutex lock_;  // this thread and watchdogs of several executors
  std::condition_variable changed_;
  bool leaving_ = false;
  std::optional<Time> end_;
  std::string why_;
  std::function<void(const std::string& why)> last_words_;
  MPI_Comm comm_ = MPI_COMM_NULL;
  int rank_ = 0, size_ = 1;
  double patience_s_ = 0;
  Time last_asked_ = {};
  std::vector<std::optional<Time>> open_;  // since when a question is, by rank
  std::vector<int> told_;                  // but on rank 0: whom that has not heard
  bool stop_passed_on_ = false;
  std::vector<MPI_Request> sent_;  // to ranks that may never receive
  std::vector<std::vector<int>> buffers_;
  std::thread thread_;
};

}  // namespace spindrift::runtime
