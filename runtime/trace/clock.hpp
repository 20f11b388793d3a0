// A clock cheap enough to be read twice per task: the processor's time stamp counter, scaled to nanoseconds (8 ns a reading here
// against 25 for clock_gettime). Where there is no such counter, std::chrono::steady_clock.
// Used by runtime/executor and perf/runtime; tested in tests/runtime/record_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#if defined(__x86_64__)
#include <x86intrin.h>
#else
#include <chrono>
#endif

namespace spindrift::runtime {

class Clock {
 public:
  /// Nanoseconds since the first call in this process of any member; the same origin and rate for all its threads.
  static std::int64_t now_ns() {
#if defined(__x86_64__)
    const Scale& s = scale();
    return std::int64_t((static_cast<unsigned __int128>(__rdtsc() - s.origin) * s.ns_per_tick_2_32) >> 32);
#else
    static const auto origin = std::chrono::steady_clock::now();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - origin).count();
#endif
  }
  static double seconds_since(std::int64_t begin_ns) { return 1e-9 * double(now_ns() - begin_ns); }

 private:
  struct Scale {
    std::uint64_t origin, ns_per_tick_2_32;  ///< first tick; nanoseconds per tick times 2^32
  };
  static Scale calibrate();  ///< takes 10 ms, once
  static const Scale& scale() {
    static const Scale s = calibrate();
    return s;
  }
};

}  // namespace spindrift::runtime
