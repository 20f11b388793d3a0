// Where threads without work wait: first spinning for as long as a wake-up would cost, then asleep in the kernel until a task is
// pushed or a time is over. With more threads than processors they do not spin at all: somebody else needs the processor.
// A wake-up may be missed (the check is not ordered with the push, to keep pushing cheap); the time limit makes up for it.
// Used by executor/worker; tested through tests/runtime/oversubscription_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace spindrift::runtime {

class Sleepers {
 public:
  /// Sleeps until woken or for `microseconds`.
  void sleep(int microseconds);
  /// Wakes one sleeper, if there is any that nobody woke yet.
  void wake_one() {
    if (asleep_.load(std::memory_order_relaxed) > 0) wake(1);
  }
  void wake_all() { wake(1 << 30); }

 private:
  void wake(int count);
  alignas(64) std::atomic<int> asleep_{0};  ///< sleepers that were not woken yet
  alignas(64) std::atomic<std::uint32_t> epoch_{0};
};

/// Whether this process's threads, together with those of the other ranks of the computer, outnumber the processors they may use.
bool oversubscribed(int threads, int ranks_on_node);

}  // namespace spindrift::runtime
