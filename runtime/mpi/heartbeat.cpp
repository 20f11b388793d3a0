// SPDX-License-Identifier: Apache-2.0
#include "runtime/mpi/heartbeat.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace spindrift::runtime {

namespace {
constexpr int question = 1, reply = 2;
constexpr std::size_t most_named = 16;
Heartbeat* of_process = nullptr;
}  // namespace

Heartbeat::Heartbeat(MPI_Comm world) {
  MPI_Comm_dup(world, &comm_);
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &size_);
  heard_.assign(rank_ == 0 ? std::size_t(size_) : 1, 0);
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

std::vector<int> Heartbeat::unheard() const {
  std::vector<int> ranks;
  for (int r = 1; r < size_ && ranks.size() < most_named; ++r)
    if (!heard_[std::size_t(r)]) ranks.push_back(r);
  return ranks;
}

void Heartbeat::live() {
  std::unique_lock guard(lock_);
  while (!leaving_) {
    attend();
    changed_.wait_for(guard, std::chrono::milliseconds(500));
    if (leaving_ || !end_ || std::chrono::steady_clock::now() < *end_) continue;
    std::fputs("watchdog: this process waits in MPI for a rank that does not answer and is ended\n", stderr);
    std::fflush(stderr);
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::_Exit(exit_code);
  }
}

void Heartbeat::end_within(double seconds) {
  const std::lock_guard guard(lock_);
  if (end_) return;
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
    if (status.MPI_TAG == question)
      send(status.MPI_SOURCE, reply, rank_ == 0 && asked_ > 1 ? unheard() : std::vector<int>{});
    else if (rank_ == 0)
      heard_[std::size_t(status.MPI_SOURCE)] = 1;
    else
      heard_[0] = 1, told_ = words;
    if (rank_ == 0 && status.MPI_TAG == question) heard_[std::size_t(status.MPI_SOURCE)] = 1;  // who asks is there
  }
  // Those that have arrived; the order of the others stays.
  for (std::size_t n = sent_.size(); n-- > 0;) {
    int done = 0;
    MPI_Test(&sent_[n], &done, MPI_STATUS_IGNORE);
    if (done) sent_.erase(sent_.begin() + std::ptrdiff_t(n)), buffers_.erase(buffers_.begin() + std::ptrdiff_t(n));
  }
}

void Heartbeat::forget() {
  const std::lock_guard guard(lock_);
  std::fill(heard_.begin(), heard_.end(), char(0)), told_.clear(), asked_ = 0;
}

void Heartbeat::ask() {
  const std::lock_guard guard(lock_);
  ++asked_;
  if (rank_ != 0) return send(0, question, {});  // again, for what rank 0 has heard meanwhile
  for (int r = 1; r < size_; ++r)
    if (!heard_[std::size_t(r)]) send(r, question, {});
}

std::string Heartbeat::silent() {
  const std::lock_guard guard(lock_);
  const std::vector<int> ranks = rank_ == 0 ? unheard() : heard_[0] ? told_ : std::vector<int>{0};
  std::string text;
  for (const int r : ranks)
    if (r != rank_) text += (text.empty() ? "" : ", ") + std::to_string(r);
  if (text.empty()) return text;
  return (text.find(',') == std::string::npos ? "rank " + text + " does not answer" : "ranks " + text + " do not answer") +
         ": stopped, or not to be reached";
}

}  // namespace spindrift::runtime
