// SPDX-License-Identifier: Apache-2.0
#include "runtime/executor/sleepers.hpp"

#include <linux/futex.h>
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <ctime>

namespace spindrift::runtime {
namespace {

long futex(std::atomic<std::uint32_t>& word, int operation, std::uint32_t value, const timespec* limit) {
  static_assert(sizeof(word) == sizeof(std::uint32_t));
  return syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&word), operation, value, limit, nullptr, 0);
}

}  // namespace

void Sleepers::sleep(int microseconds) {
  const std::uint32_t epoch = epoch_.load(std::memory_order_acquire);
  asleep_.fetch_add(1, std::memory_order_relaxed);
  const timespec limit{0, microseconds * 1000L};
  const bool woken = futex(epoch_, FUTEX_WAIT_PRIVATE, epoch, &limit) == 0;
  if (!woken) asleep_.fetch_sub(1, std::memory_order_relaxed);
}

void Sleepers::wake(int count) {
  epoch_.fetch_add(1, std::memory_order_release);
  const long woken = futex(epoch_, FUTEX_WAKE_PRIVATE, std::uint32_t(count), nullptr);
  if (woken > 0) asleep_.fetch_sub(int(woken), std::memory_order_relaxed);
}

bool oversubscribed(int threads, int ranks_on_node) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  const int mine = sched_getaffinity(0, sizeof allowed, &allowed) == 0 ? CPU_COUNT(&allowed) : 1;
  const bool bound = mine < sysconf(_SC_NPROCESSORS_ONLN);  // then the other ranks have processors of their own
  return threads * (bound ? 1 : ranks_on_node) > mine;
}

}  // namespace spindrift::runtime
