// In which order several ranks make the collective calls of different modules. A rank inside such a call waits there for the
// others, with the only thread it may have: two ranks that take two calls in different orders would wait for ever. So a call has
// its turn once every rank is ready for it (MPI_Ibarrier), in the order in which rank 0 saw that (MPI_Ibcast), and a rank makes
// one call at a time. Each rank waits for one announcement per call that it is ready for: it has as many as will ever come. O(log
// ranks) messages a call. Used by messages.cpp, one thread at a time; tested in tests/runtime/messages_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/graph/recorded.hpp"

namespace spindrift::runtime {

class Turns {
 public:
  explicit Turns(const Graph::Recorded& graph) : graph_(graph) {}
  /// Completes what is under way, which needs the other ranks, unless a run failed.
  ~Turns();
  Turns(const Turns&) = delete;
  Turns& operator=(const Turns&) = delete;

  /// This rank is ready for the call (index in Recorded::collectives).
  void come(std::uint32_t call);
  /// The call whose turn it is, once; none while another is being made.
  std::optional<std::uint32_t> next();
  void made() { making_.store(false, std::memory_order_release); }  ///< any thread: the call of the last turn is over
  void abandon();                                                   ///< others may never come

 private:
  struct Arrival {
    std::uint32_t call;
    MPI_Request all_ready;
  };
  struct Announcement {
    std::uint32_t call;
    MPI_Request sent;
  };
  bool announces() const { return graph_.comm.rank() == 0; }
  void announce(std::uint32_t call);

  const Graph::Recorded& graph_;
  std::vector<Arrival> arrivals_;
  std::deque<std::unique_ptr<Announcement>> announcements_;  ///< in order; MPI holds their addresses
  std::deque<std::uint32_t> in_turn_;
  std::atomic<bool> making_{false};
};

}  // namespace spindrift::runtime
