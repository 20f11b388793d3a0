// SPDX-License-Identifier: Apache-2.0
#include "runtime/mpi/heartbeat.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "runtime/mpi/stop_request.hpp"

namespace spindrift::runtime {

namespace {
constexpr int question_tag = 1, reply_tag = 2, stop_tag = 3;
constexpr std::size_t most_named = 16;
Heartbeat* of_process = nullptr;
}  // namespace

Heartbeat::Heartbeat(MPI_Comm world) {
  MPI_Comm_dup(world, &comm_);
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &size_);
  open_.resize(std::size_t(size_));
  of_process = this;
  thread_ = std::thread([this] { live(); });
}

Heartbeat::~Heartbeat() {
  of_process = nullptr;
  {
    const std::lock_guard guard(lock_);
    leaving_ = true;
  }
  changed_.notify_one();
  thread_.join();
  for (MPI_Request& request : sent_) MPI_Request_free(&request);
  MPI_Comm_free(&comm_);
}

Heartbeat* Heartbeat::current() { return of_process; }

void Heartbeat::send(int rank, int tag, const std::vector<int>& words) {
  buffers_.push_back(words);
  MPI_Isend(buffers_.back().data(), int(buffers_.back().size()), MPI_INT, rank, tag, comm_, &sent_.emplace_back());
}

void Heartbeat::question(int rank) {
  std::optional<Time>& open = open_[std::size_t(rank)];
  if (open) return;
  open = std::chrono::steady_clock::now();
  told_.clear();
  send(rank, question_tag, {});
}

/// Those that this rank asks by itself.
std::vector<int> Heartbeat::unheard() const {
  const Time long_ago = std::chrono::steady_clock::now() - std::chrono::milliseconds(std::int64_t(1e3 * patience_s_));
  std::vector<int> ranks;
  for (int r = 0; r < size_ && ranks.size() < most_named; ++r)
    if (const std::optional<Time>& open = open_[std::size_t(r)]; open && *open < long_ago) ranks.push_back(r);
  return ranks;
}

void Heartbeat::live() {
  std::unique_lock guard(lock_);
  while (!leaving_) {
    attend();
    pass_on_stop();
    changed_.wait_for(guard, std::chrono::milliseconds(500));
    if (leaving_ || !end_ || std::chrono::steady_clock::now() < *end_) continue;
    std::fputs("watchdog: this process waits in MPI for a rank that does not answer and is ended\n", stderr);
    std::fflush(stderr);
    if (last_words_) last_words_(why_);
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::_Exit(exit_code);
  }
}

void Heartbeat::end_within(double seconds, std::string why) {
  const std::lock_guard guard(lock_);
  if (end_) return;
  why_ = std::move(why);
  end_ = std::chrono::steady_clock::now() + std::chrono::milliseconds(std::int64_t(1e3 * seconds));
}

void Heartbeat::attend() {
  for (int there = 1; there;) {
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, comm_, &there, &status);
    if (!there) break;
    int count = 0;
    MPI_Get_count(&status, MPI_INT, &count);
    std::vector<int> words(static_cast<std::size_t>(count));
    MPI_Recv(words.data(), count, MPI_INT, status.MPI_SOURCE, status.MPI_TAG, comm_, MPI_STATUS_IGNORE);
    if (status.MPI_TAG == stop_tag)
      StopRequest::hear(words.at(0)), stop_passed_on_ = stop_passed_on_ || rank_ != 0;
    else if (status.MPI_TAG == question_tag)
      send(status.MPI_SOURCE, reply_tag, unheard());
    else
      told_ = words;
    if (status.MPI_TAG != stop_tag) open_[std::size_t(status.MPI_SOURCE)].reset();  // who asks is there, too
  }
  // Those that have arrived; the order of the others stays.
  for (std::size_t n = sent_.size(); n-- > 0;) {
    int done = 0;
    MPI_Test(&sent_[n], &done, MPI_STATUS_IGNORE);
    if (done) sent_.erase(sent_.begin() + std::ptrdiff_t(n)), buffers_.erase(buffers_.begin() + std::ptrdiff_t(n));
  }
}

/// By way of rank 0.
void Heartbeat::pass_on_stop() {
  const int signal = StopRequest::signal_caught();
  if (signal != 0 && !stop_passed_on_)
    for (int r = 0; r < (rank_ == 0 ? size_ : 1); ++r)
      if (r != rank_) send(r, stop_tag, {signal});
  stop_passed_on_ = signal != 0;
}

void Heartbeat::ask(double patience_s) {
  const std::lock_guard guard(lock_);
  const Time now = std::chrono::steady_clock::now();
  patience_s_ = patience_s;
  if (std::chrono::duration<double>(now - last_asked_).count() < patience_s / 4) return;
  last_asked_ = now;
  for (int r = 0; r < (rank_ == 0 ? size_ : 1); ++r)
    if (r != rank_) question(r);
}

std::string Heartbeat::silent() {
  const std::lock_guard guard(lock_);
  std::vector<int> ranks = unheard();
  if (rank_ != 0 && ranks.empty()) ranks = told_;
  std::string text;
  for (const int r : ranks)
    if (r != rank_) text += (text.empty() ? "" : ", ") + std::to_string(r);
  if (text.empty()) return text;
  return (text.find(',') == std::string::npos ? "rank " + text + " does not answer" : "ranks " + text + " do not answer") +
         ": stopped, or not to be reached";
}

Heartbeat::LastWords::LastWords(std::function<void(const std::string& why)> words) {
  if (!of_process) return;
  const std::lock_guard guard(of_process->lock_);
  of_process->last_words_ = std::move(words);
}

Heartbeat::LastWords::~LastWords() {
  if (!of_process) return;
  const std::lock_guard guard(of_process->lock_);
  of_process->last_words_ = nullptr;
}

}  // namespace spindrift::runtime
