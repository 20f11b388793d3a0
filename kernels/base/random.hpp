// Random numbers that are the same on every computer and compiler for the same seed (the distributions of <random> are not).
// SplitMix64: Steele, Lea & Flood (2014), OOPSLA; reference code by Vigna (public domain). Period 2^64, passes BigCrush.
// Used for phases of waves and jitter of particles; tested in tests/kernels/base/lane_math_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace spindrift {

class Random {
 public:
  explicit constexpr Random(std::uint64_t seed) : state_(seed) {}
  constexpr std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// Uniform in [0, 1), a multiple of 2^-53.
  constexpr double uniform() { return double(bits() >> 11) * 0x1p-53; }

 private:
  std::uint64_t state_;
};

}  // namespace spindrift
