// Eight doubles at once, and their sine and cosine in plain arithmetic: within 2 ulp of libm over the stated range.
// Needed because the C library's versions are scalar calls under our compile flags (no -ffast-math). Each lane is rounded by
// itself, so results do not depend on how wide the processor's registers are. (The same over std::array was vectorised only in
// part: 40 ns for eight waves at a point where this takes 15.)
// Reduction and polynomials after Cody & Waite (1980) and fdlibm (Sun Microsystems 1993, k_sin.c, k_cos.c). Used by
// kernels/waves/components.hpp; tested in tests/kernels/base/lane_math_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/base/wide_math.hpp"

namespace spindrift {

inline constexpr int lanes = 8;
using Lanes = Wide<double, lanes>;

/// For |x| < 1e6 [rad]; either result may be x itself.
template <int n>
SPINDRIFT_INLINE void lane_sincos(const Wide<double, n>& x, Wide<double, n>& sine, Wide<double, n>& cosine) {
  if constexpr (in_halves<double, n>) {
    const Wide<double, n> of = x;
    lane_sincos(of.v.low, sine.v.low, cosine.v.low);
    lane_sincos(of.v.high, sine.v.high, cosine.v.high);
  } else {
    using W = Wide<double, n>;
    using V = typename W::Vector;
    using I = wide_math::integers<V>;
    const W shifted = x * 0.63661977236758134308 + wide_math::round_shift, count = shifted - wide_math::round_shift;
    const I quarter = __builtin_bit_cast(I, shifted.v);  // turns
    W r = x - count * 1.57079632673412561417e+00;        // pi/2 in three parts of 33, 33 and 53 bits
    r -= count * 6.07710050630396597660e-11;
    r -= count * 2.02226624879595063154e-21;
    const W q = r * r;
    W s = q * 1.58969099521155010221e-10 - 2.50507602534068634195e-08;
    s = s * q + 2.75573137070700676789e-06;
    s = s * q - 1.98412698298579493134e-04;
    s = s * q + 8.33333333332248946124e-03;
    s = s * q - 1.66666666666666324348e-01;
    s = s * q * r + r;
    W c = q * -1.13596475577881948265e-11 + 2.08757232129817482790e-09;
    c = c * q - 2.75573143513906633035e-07;
    c = c * q + 2.48015872894767294178e-05;
    c = c * q - 1.38888888888741095749e-03;
    c = c * q + 4.16666666666666019037e-02;
    c = c * q * q + (1.0 - 0.5 * q);
    const auto swapped = (quarter & 1) != 0;
    const V a = swapped ? c.v : s.v, b = swapped ? s.v : c.v;
    sine = W(V((quarter & 2) != 0 ? -a : a));
    cosine = W(V(((quarter + 1) & 2) != 0 ? -b : b));
  }
}

}  // namespace spindrift
