// SPDX-License-Identifier: Apache-2.0
#include "runtime/mpi/turns.hpp"

#include <algorithm>
#include <iterator>

namespace spindrift::runtime {

Turns::~Turns() {
  int finalized = 0;
  MPI_Finalized(&finalized);
  if (finalized) return;
  for (Arrival& arrival : arrivals_) MPI_Wait(&arrival.all_ready, MPI_STATUS_IGNORE);
  for (auto& announcement : announcements_) MPI_Wait(&announcement->sent, MPI_STATUS_IGNORE);
}

/// MPI may still write to what was to be announced: it stays until the program ends.
void Turns::abandon() {
  static std::deque<std::unique_ptr<Announcement>> left_behind;
  std::ranges::move(announcements_, std::back_inserter(left_behind));
  announcements_.clear(), arrivals_.clear();
}

void Turns::come(std::uint32_t call) {
  arrivals_.push_back({call, MPI_REQUEST_NULL});
  MPI_Ibarrier(graph_.collectives[call].comm, &arrivals_.back().all_ready);
  if (!announces()) announce(0);
}

void Turns::announce(std::uint32_t call) {
  Announcement& to = *announcements_.emplace_back(std::make_unique<Announcement>(Announcement{call, MPI_REQUEST_NULL}));
  MPI_Ibcast(&to.call, 1, MPI_UINT32_T, 0, graph_.turns.get(), &to.sent);
}

std::optional<std::uint32_t> Turns::next() {
  const auto over = [](MPI_Request& request) {
    int flag = 0;
    MPI_Test(&request, &flag, MPI_STATUS_IGNORE);
    return flag != 0;
  };
  for (std::size_t n = 0; n < arrivals_.size();) {
    if (!over(arrivals_[n].all_ready)) {
      ++n;
      continue;
    }
    if (announces()) announce(arrivals_[n].call), in_turn_.push_back(arrivals_[n].call);
    arrivals_.erase(arrivals_.begin() + std::ptrdiff_t(n));
  }
  for (; !announcements_.empty() && over(announcements_.front()->sent); announcements_.pop_front())
    if (!announces()) in_turn_.push_back(announcements_.front()->call);
  if (in_turn_.empty() || making_.load(std::memory_order_acquire)) return {};
  making_.store(true, std::memory_order_relaxed);
  const std::uint32_t call = in_turn_.front();
  in_turn_.pop_front();
  return call;
}

}  // namespace spindrift::runtime
