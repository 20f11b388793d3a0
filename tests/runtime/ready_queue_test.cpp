// The ready queue: order within a level, highest level first, nothing lost or doubled between threads.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/executor/ready_queue.hpp"

#include <catch2/catch.hpp>
#include <thread>

using namespace spindrift::runtime;

TEST_CASE("the oldest task of a level comes first, through many turns of the ring", "[runtime][fast]") {
  ReadyQueue queue;
  const std::vector<std::uint32_t> capacity = {2, 3};
  queue.reserve(capacity);
  CHECK(queue.top() == -1);
  CHECK(queue.pop(0) == ReadyQueue::none);
  for (std::uint32_t n = 0; n < 20; ++n) {
    queue.push(0, 2 * n), queue.push(1, 100 + n), queue.push(0, 2 * n + 1);
    CHECK(queue.top() == 1);
    CHECK(queue.pop(1) == 100 + n);
    CHECK(queue.top() == 0);
    CHECK(queue.pop(0) == 2 * n);
    CHECK(queue.pop(0) == 2 * n + 1);
    CHECK(queue.top() == -1);
  }
}

TEST_CASE("tasks passed round by four threads are neither lost nor doubled", "[runtime][fast]") {
  constexpr std::uint32_t tasks = 8, rounds = 20000;
  ReadyQueue queue;
  const std::vector<std::uint32_t> capacity = {tasks};
  queue.reserve(capacity);
  for (std::uint32_t t = 0; t < tasks; ++t) queue.push(0, t);
  std::vector<std::uint32_t> taken(tasks, 0);  // each task belongs to one thread at a time: no data race unless the queue errs
  std::atomic<std::uint32_t> total{0};
  std::vector<std::thread> threads;
  for (int n = 0; n < 4; ++n)
    threads.emplace_back([&] {
      while (total.load(std::memory_order_relaxed) < tasks * rounds)
        if (const auto task = queue.pop(0); task != ReadyQueue::none) {
          ++taken[task];
          total.fetch_add(1, std::memory_order_relaxed);
          queue.push(0, task);
        } else {
          std::this_thread::yield();
        }
    });
  for (auto& t : threads) t.join();
  std::uint32_t sum = 0;
  for (const auto n : taken) sum += n;
  CHECK(sum == total);
  for (std::uint32_t left = 0; left < tasks; ++left) CHECK(queue.pop(0) != ReadyQueue::none);
  CHECK(queue.pop(0) == ReadyQueue::none);
}
