// A float of 16 bits (bfloat16): sign, exponent and 8 significant bits, rounded by at most 2^-9 of the number. The range
// is that of floats, so nothing needs scaling. For the blocks of neighbours in a matrix that is read from
// memory for every product (stencil_matrix.hpp). Integer arithmetic only: the same bits on every processor.
// Tested in tests/kernels/linear/short_float_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

#include "kernels/base/wide.hpp"

namespace spindrift::linear {

struct ShortFloat {
  std::uint16_t bits = 0;

  ShortFloat() = default;
  /// To nearest, ties to even; infinity and what is no number stay so.
  explicit ShortFloat(float value) {
    const auto word = std::bit_cast<std::uint32_t>(value);
    if ((word & 0x7fffffffu) > 0x7f800000u)
      bits = std::uint16_t(word >> 16 | 0x40u);  // not a number: rounding could carry it into infinity
    else
      bits = std::uint16_t((word + 0x7fffu + (word >> 16 & 1u)) >> 16);
  }
  operator float() const { return std::bit_cast<float>(std::uint32_t(bits) << 16); }
};

/// Eight from consecutive places.
inline Wide<float, 8> load_eight(const ShortFloat* from) {
#ifdef __AVX2__
  const __m128i shorts = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
  return _mm256_castsi256_ps(_mm256_slli_epi32(_mm256_cvtepu16_epi32(shorts), 16));
#else
  float all[8];
  for (int n = 0; n < 8; ++n) all[n] = float(from[n]);
  return Wide<float, 8>::load(all);
#endif
}
inline Wide<float, 8> load_eight(const float* from) { return Wide<float, 8>::load(from); }

}  // namespace spindrift::linear
