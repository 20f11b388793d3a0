// The ready tasks of one thread: a ring per priority level, first in first out, into which and from which any thread may move
// tasks without a lock. The ring is the bounded queue of D. Vyukov (1024cores.net, 2010): a cell's sequence number says whose
// turn it is. A ring has places for every task of its level, so it is never full and never grows. Used by executor/worker; tested
// in tests/runtime/ready_queue_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace spindrift::runtime {

inline constexpr int max_levels = 16;

class ReadyQueue {
 public:
  static constexpr std::uint32_t none = ~0u;

  /// Capacity by level; levels beyond its size stay unused. Only while no thread uses the queue. Keeps memory that suffices.
  void reserve(std::span<const std::uint32_t> capacity) {
    levels_ = int(capacity.size());
    std::uint32_t total = 0;
    for (int l = 0; l < levels_; ++l) {
      const std::uint32_t size = std::bit_ceil(std::max(2u, capacity[std::size_t(l)]));
      rings_[std::size_t(l)] = {total, size - 1};
      total += size;
    }
    if (cells_.size() < total) cells_ = std::vector<Cell>(total);
    for (int l = 0; l < levels_; ++l) {
      const Ring ring = rings_[std::size_t(l)];
      for (std::uint32_t n = 0; n <= ring.mask; ++n) cells_[ring.first + n].turn.store(n, std::memory_order_relaxed);
      in_[std::size_t(l)].store(0, std::memory_order_relaxed);
      out_[std::size_t(l)].store(0, std::memory_order_relaxed);
    }
  }

  void push(int level, std::uint32_t task) {
    const Ring ring = rings_[std::size_t(level)];
    std::atomic<std::uint32_t>& in = in_[std::size_t(level)];
    const std::uint32_t at = in.fetch_add(1, std::memory_order_relaxed);  // the cell is free: there are as many as tasks
    Cell& cell = cells_[ring.first + (at & ring.mask)];
    while (cell.turn.load(std::memory_order_acquire) != at) {}  // a taker that has it is between its two last instructions
    cell.task = task;
    cell.turn.store(at + 1, std::memory_order_release);
  }

  /// Highest level with a task, as seen now; -1: empty.
  int top() const {
    for (int l = levels_ - 1; l >= 0; --l)
      if (in_[std::size_t(l)].load(std::memory_order_relaxed) != out_[std::size_t(l)].load(std::memory_order_relaxed)) return l;
    return -1;
  }

  /// Oldest task of the level, or none.
  std::uint32_t pop(int level) {
    const Ring ring = rings_[std::size_t(level)];
    std::atomic<std::uint32_t>& out = out_[std::size_t(level)];
    std::uint32_t at = out.load(std::memory_order_relaxed);
    for (;;) {
      Cell& cell = cells_[ring.first + (at & ring.mask)];
      const auto ahead = std::int32_t(cell.turn.load(std::memory_order_acquire) - (at + 1));
      if (ahead < 0) return none;  // not filled yet
      if (ahead == 0 && out.compare_exchange_weak(at, at + 1, std::memory_order_relaxed)) {
        const std::uint32_t task = cell.task;
        cell.turn.store(at + ring.mask + 1, std::memory_order_release);
        return task;
      }
      if (ahead > 0) at = out.load(std::memory_order_relaxed);  // taken by another
    }
  }

 private:
  struct Cell {
    std::atomic<std::uint32_t> turn;  ///< n: free for the push number n; n + 1: holds it
    std::uint32_t task;
  };
  struct Ring {
    std::uint32_t first, mask;
  };
  alignas(64) std::array<std::atomic<std::uint32_t>, max_levels> in_{};   ///< pushes so far, by level
  alignas(64) std::array<std::atomic<std::uint32_t>, max_levels> out_{};  ///< pops so far
  alignas(64) std::array<Ring, max_levels> rings_{};
  int levels_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace spindrift::runtime
