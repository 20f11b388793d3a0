// Sine, cosine and exponential of eight doubles at once in plain arithmetic that the compiler vectorises; within 2 ulp of libm over the
// stated ranges. Needed because the C library's versions are scalar calls under our compile flags (no -ffast-math).
// Reduction and polynomials after Cody & Waite (1980) and fdlibm (Sun Microsystems 1993, k_sin.c, k_cos.c); exp by its Taylor series.
// Used by kernels/waves/components.hpp; tested in tests/kernels/base/lane_math_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace spindrift {

inline constexpr int lanes = 8;
using Lanes = std::array<double, lanes>;

/// Sum in a fixed order: pairs, then pairs of pairs.
inline double lane_sum(const Lanes& v) { return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7])); }

// Adding and subtracting 1.5 x 2^52 rounds to the nearest integer and leaves that integer in the low bits.
inline constexpr double round_shift = 6755399441055744.0;

/// For |x| < 1e6 [rad]; either result may be x itself.
inline void lane_sincos(const Lanes& x, Lanes& sine, Lanes& cosine) {
  Lanes s, c;
  for (int i = 0; i < lanes; ++i) {
    const double shifted = x[i] * 0.63661977236758134308 + round_shift, n = shifted - round_shift;   // quarter turns
    const auto quarter = std::bit_cast<std::int64_t>(shifted);
    double r = x[i] - n * 1.57079632673412561417e+00;      // pi/2 in three parts of 33, 33 and 53 bits
    r -= n * 6.07710050630396597660e-11;
    r -= n * 2.02226624879595063154e-21;
    const double q = r * r;
    const double rs = r + r * q * (-1.66666666666666324348e-01 + q * (8.33333333332248946124e-03 +
        q * (-1.98412698298579493134e-04 + q * (2.75573137070700676789e-06 +
        q * (-2.50507602534068634195e-08 + q * 1.58969099521155010221e-10)))));
    const double rc = 1.0 - 0.5 * q + q * q * (4.16666666666666019037e-02 + q * (-1.38888888888741095749e-03 +
        q * (2.48015872894767294178e-05 + q * (-2.75573143513906633035e-07 +
        q * (2.08757232129817482790e-09 + q * -1.13596475577881948265e-11)))));
    const bool swap = (quarter & 1) != 0;
    const double a = swap ? rc : rs, b = swap ? rs : rc;
    s[i] = (quarter & 2) != 0 ? -a : a;
    c[i] = ((quarter + 1) & 2) != 0 ? -b : b;
  }
  sine = s;
  cosine = c;
}

/// For |x| <= 700; the result may be x itself.
inline void lane_exp(const Lanes& x, Lanes& result) {
  Lanes e;
  for (int i = 0; i < lanes; ++i) {
    const double shifted = x[i] * 1.44269504088896338700 + round_shift, n = shifted - round_shift;
    double r = x[i] - n * 6.93147180369123816490e-01;      // ln 2 in two parts
    r -= n * 1.90821492927058770002e-10;
    double p = 1.0 / 6227020800.0;                         // 1/13!; |r| <= 0.347, next term 4e-18
    p = p * r + 1.0 / 479001600.0, p = p * r + 1.0 / 39916800.0, p = p * r + 1.0 / 3628800.0, p = p * r + 1.0 / 362880.0;
    p = p * r + 1.0 / 40320.0, p = p * r + 1.0 / 5040.0, p = p * r + 1.0 / 720.0, p = p * r + 1.0 / 120.0;
    p = p * r + 1.0 / 24.0, p = p * r + 1.0 / 6.0, p = p * r + 0.5, p = p * r + 1.0, p = p * r + 1.0;
    const std::int64_t exponent = std::bit_cast<std::int64_t>(shifted) - std::bit_cast<std::int64_t>(round_shift);
    e[i] = p * std::bit_cast<double>((exponent + 1023) << 52);
  }
  result = e;
}

}  // namespace spindrift
