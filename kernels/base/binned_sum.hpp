// A sum of doubles that has the same bits in any order and any grouping of its terms. Numbers are cut at fixed places of 32 bits
// ("bins") and the pieces of each bin added up as integers, which no order can change. Of all bins the four from that of the
// largest term on down are kept, so a sum is a few words, and terms are cut at 2^-96 of the largest or below: the sum of n terms
// is within n 2^-96 of the largest one, rounded once to double. Idea: Demmel & Nguyen (2015), IEEE Trans. Comput. 64, 2060
// (ReproBLAS), there with floating-point bins; integers for accumulation: Kulisch & Miranker (1986), SIAM Rev. 28, 1.
// Called by src/sea/particle_sea.cpp and runtime/mpi (which copies sums as bytes); tested in
// tests/kernels/base/binned_sum_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace spindrift {

/// Up to 2^31 terms. Not-a-number and infinities give what adding them would give.
class BinnedSum {
 public:
  void add(double x) {
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
    const int exponent = int(bits >> 52 & 0x7ff);
    std::uint64_t digits = bits & 0x000fffffffffffff;
    const bool negative = (bits >> 63) != 0;
    if (exponent == 0x7ff) {
      special_ |= digits != 0 ? not_a_number : negative ? minus_infinity : plus_infinity;
      return;
    }
    if (exponent > 0) digits |= 0x0010000000000000;
    if (digits == 0) return;
    const int place = std::max(exponent, 1) - 1;  // of the last digit above 2^-1074
    const int low = place / bits_per_bin;
    const auto cut = static_cast<unsigned __int128>(digits) << (place % bits_per_bin);
    const std::uint64_t pieces[3] = {std::uint64_t(cut) & mask, std::uint64_t(cut >> 32) & mask, std::uint64_t(cut >> 64)};
    raise(low + (pieces[2] != 0 ? 2 : pieces[1] != 0 ? 1 : 0));
    for (int n = 0; n < 3; ++n) {
      const int at = low + n - (top_ - (bins - 1));
      if (at >= 0 && at < bins) bin_[at] += negative ? -std::int64_t(pieces[n]) : std::int64_t(pieces[n]);
    }
  }
  void add(const BinnedSum& other) {
    special_ |= other.special_;
    if (other.top_ == empty) return;
    raise(other.top_);
    const int down = top_ - other.top_;
    for (int n = down; n < bins; ++n) bin_[n - down] += other.bin_[n];
  }

  double value() const {
    if ((special_ & not_a_number) != 0 || special_ == (plus_infinity | minus_infinity))
      return std::numeric_limits<double>::quiet_NaN();
    if (special_ != 0) return (special_ == plus_infinity ? 1.0 : -1.0) * std::numeric_limits<double>::infinity();
    if (top_ == empty) return 0.0;
    std::int64_t b[bins];
    std::copy(bin_, bin_ + bins, b);
    carry(b);
    const bool negative = b[bins - 1] < 0;
    if (negative) {  // of a positive number, so that a sum and that of all opposites are opposite
      for (std::int64_t& x : b) x = -x;
      carry(b);
    }
    const auto joined = [&](int n) {
      return (static_cast<unsigned __int128>(b[n + 2]) << 64) | (static_cast<unsigned __int128>(b[n + 1]) << 32) |
             static_cast<unsigned __int128>(b[n]);
    };
    // Of four bins the last one only says on which side of a tie the others are.
    const int from = b[3] != 0 ? 1 : 0;
    const unsigned __int128 digits = from == 1 ? (joined(1) | (b[0] != 0 ? 1 : 0)) : joined(0);
    const double size = std::ldexp(double(digits), bits_per_bin * (top_ - (bins - 1) + from) - 1074);
    return negative ? -size : size;
  }

 private:
  static constexpr int bins = 4, bits_per_bin = 32;
  static constexpr std::uint64_t mask = 0xffffffff;
  static constexpr std::int32_t empty = std::numeric_limits<std::int32_t>::min();
  static constexpr std::uint32_t plus_infinity = 1, minus_infinity = 2, not_a_number = 4;

  /// Makes `top` the highest bin if it is above those kept.
  void raise(int top) {
    if (top <= top_) return;
    const std::int64_t down = top_ == empty ? bins : std::min<std::int64_t>(bins, std::int64_t(top) - top_);
    for (int n = 0; n < bins; ++n) bin_[n] = n + down < bins ? bin_[n + down] : 0;
    top_ = top;
  }
  /// The same number with all bins but the highest in [0, 2^32).
  static void carry(std::int64_t (&b)[bins]) {
    for (int n = 0; n + 1 < bins; ++n) {
      const std::int64_t over = b[n] >> bits_per_bin;
      b[n] -= over * (std::int64_t(1) << bits_per_bin), b[n + 1] += over;
    }
  }

  std::int64_t bin_[bins] = {};  ///< bin_[bins - 1] counts units of 2^(32 top - 1074)
  std::int32_t top_ = empty;
  std::uint32_t special_ = 0;
};
static_assert(std::is_trivially_copyable_v<BinnedSum> && sizeof(BinnedSum) == 40);

}  // namespace spindrift
