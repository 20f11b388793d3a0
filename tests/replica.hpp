// Replicas of a test on chaotic flow, where last bits grow until they move a figure. SPINDRIFT_REPLICA=1, 2, ... in the
// environment runs it from starts that differ by chance alone: each particle of the water is displaced by up to a hundredth of
// the spacing along each axis, by that seed (turbulence: other phases of its modes). Without it the start is the test's own. The
// test states the scatter over some of them, and its bar lies beyond (CONTRIBUTING.md). For Python: tests/coupled/running.py.
// A hundredth is far more than last bits, so in a short run what is stated is more than they do. The force on a wedge that enters
// water changes by 0.04 with it, by 0.02 with 1e-4 spacings, by less than 0.001 with 1e-8.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdlib>

namespace spindrift::testing {

struct Replica {
  std::uint64_t seed;  ///< 0: the test's own start
  double jitter;       ///< largest displacement, in spacings
};

/// The n-th of `count` starts, where the figure is a mean over so many.
inline Replica replica(int n = 0, int count = 1) {
  const char* number = std::getenv("SPINDRIFT_REPLICA");
  const int seed = (number ? std::atoi(number) : 0) * count + n;
  return {std::uint64_t(seed), seed > 0 ? 0.01 : 0.0};
}

}  // namespace spindrift::testing
