// Work of a set length for synthetic tasks: a chain of fused multiply-adds, so that its time depends on nothing but the clock
// rate. Used by perf/runtime. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "perf/harness.hpp"

namespace spindrift::perf {

inline void grain(long n) {
  double x = 1.0;
  for (long i = 0; i < n; ++i) {
    x = x * 0.999 + 0.001;
    asm volatile("" : "+x"(x));
  }
}

/// Iterations that take `ns`, measured now.
inline long grain_of(double ns) {
  const double per_iteration = measure([] { grain(100000); }, {.samples = 5, .warm_ups = 2, .sample_s = 0.002}).min / 1e5 * 1e9;
  return long(ns / per_iteration + 0.5);
}

}  // namespace spindrift::perf
