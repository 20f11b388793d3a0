// Eight doubles at once, and their sine, cosine and exponential in plain arithmetic: within 2 ulp of libm over the stated ranges.
// Needed because the C library's versions are scalar calls under our compile flags (no -ffast-math). Lanes is the compiler's
// vector type (gcc, clang): each lane is rounded by itself, so results do not depend on how wide the processor's registers are.
// (The same over std::array was vectorised only in part: 40 ns for eight waves at a point where this takes 15.)
// Reduction and polynomials after Cody & Waite (1980) and fdlibm (Sun Microsystems 1993, k_sin.c, k_cos.c); exp by its Taylor
// series. Used by kernels/waves/components.hpp; tested in tests/kernels/base/lane_math_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <initializer_list>

namespace spindrift {

inline constexpr int lanes = 8;
using Lanes = double __attribute__((vector_size(lanes * sizeof(double))));
using IntegerLanes = std::int64_t __attribute__((vector_size(lanes * sizeof(std::int64_t))));

/// Sum in a fixed order: pairs, then pairs of pairs.
inline double lane_sum(const Lanes& v) { return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7])); }

// Adding and subtracting 1.5 x 2^52 rounds to the nearest integer and leaves that integer in the low bits.
inline constexpr double round_shift = 6755399441055744.0;

/// For |x| < 1e6 [rad]; either result may be x itself.
inline void lane_sincos(const Lanes& x, Lanes& sine, Lanes& cosine) {
  const Lanes shifted = x * 0.63661977236758134308 + round_shift, n = shifted - round_shift;  // quarter turns
  const auto quarter = reinterpret_cast<IntegerLanes>(shifted);                               // of vector types: the same bits
  Lanes r = x - n * 1.57079632673412561417e+00;  // pi/2 in three parts of 33, 33 and 53 bits
  r -= n * 6.07710050630396597660e-11;
  r -= n * 2.02226624879595063154e-21;
  const Lanes q = r * r;
  Lanes s = q * 1.58969099521155010221e-10 - 2.50507602534068634195e-08;
  s = s * q + 2.75573137070700676789e-06;
  s = s * q - 1.98412698298579493134e-04;
  s = s * q + 8.33333333332248946124e-03;
  s = s * q - 1.66666666666666324348e-01;
  s = s * q * r + r;
  Lanes c = q * -1.13596475577881948265e-11 + 2.08757232129817482790e-09;
  c = c * q - 2.75573143513906633035e-07;
  c = c * q + 2.48015872894767294178e-05;
  c = c * q - 1.38888888888741095749e-03;
  c = c * q + 4.16666666666666019037e-02;
  c = c * q * q + (1.0 - 0.5 * q);
  const auto swapped = (quarter & 1) != 0;
  const Lanes a = swapped ? c : s, b = swapped ? s : c;
  sine = (quarter & 2) != 0 ? -a : a;
  cosine = ((quarter + 1) & 2) != 0 ? -b : b;
}

/// For x <= 700; below -700 the result is that of -700 (1e-304). The result may be x itself.
inline void lane_exp(const Lanes& x, Lanes& result) {
  const Lanes bounded = x < -700.0 ? Lanes{} - 700.0 : x;
  const Lanes shifted = bounded * 1.44269504088896338700 + round_shift, n = shifted - round_shift;
  Lanes r = bounded - n * 6.93147180369123816490e-01;  // ln 2 in two parts
  r -= n * 1.90821492927058770002e-10;
  Lanes p = r * (1.0 / 6227020800.0) + 1.0 / 479001600.0;  // 1/13!, 1/12! ...; |r| <= 0.347, next term 4e-18
  for (const double coefficient : {1.0 / 39916800.0, 1.0 / 3628800.0, 1.0 / 362880.0, 1.0 / 40320.0, 1.0 / 5040.0, 1.0 / 720.0,
                                   1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0})
    p = p * r + coefficient;
  const IntegerLanes exponent = reinterpret_cast<IntegerLanes>(shifted) - std::bit_cast<std::int64_t>(round_shift);
  result = p * reinterpret_cast<Lanes>((exponent + 1023) << 52);
}

}  // namespace spindrift
