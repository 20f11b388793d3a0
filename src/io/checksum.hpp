// A checksum of a distributed array that does not depend on how it is distributed: a sum over elements of a mix of index and
// bits, so that ranks add up their parts. Any one changed element changes it for certain (the mix is a bijection of the bits);
// several, but for 2^-64. The mix is splitmix64's finaliser (Steele, Lea & Flood 2014). Called by checkpoint.cpp; tested in
// tests/src/io/checkpoint_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace spindrift::io {

constexpr std::uint64_t mix64(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// Part of the checksum of the elements [offset, offset + values.size()) of an array.
template <class T>
std::uint64_t checksum(std::int64_t offset, std::span<const T> values) {
  std::uint64_t sum = 0, key = static_cast<std::uint64_t>(offset) * 0x9e3779b97f4a7c15ULL;
  for (const T& value : values) {
    std::uint64_t bits;
    if constexpr (std::is_same_v<T, std::byte>) {
      bits = std::to_integer<std::uint64_t>(value);
    } else {
      bits = std::bit_cast<std::uint64_t>(value);
    }
    key += 0x9e3779b97f4a7c15ULL;
    sum += mix64(bits ^ key);
  }
  return sum;
}

}  // namespace spindrift::io
