// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/clock.hpp"

#include <chrono>

namespace spindrift::runtime {

#if defined(__x86_64__)
Clock::Scale Clock::calibrate() {
  using std::chrono::steady_clock;
  const auto start = steady_clock::now();
  const std::uint64_t first = __rdtsc();
  auto now = start;
  while (now - start < std::chrono::milliseconds(10)) now = steady_clock::now();
  const std::uint64_t last = __rdtsc();
  const double ns = std::chrono::duration<double, std::nano>(now - start).count();
  return {last, std::uint64_t(ns / double(last - first) * 4294967296.0)};
}
#endif

}  // namespace spindrift::runtime
