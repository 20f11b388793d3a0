// log, exp and what follows from them (log1p, expm1, powers, tanh) for one number or the lanes of Wide, in plain arithmetic and
// the same for each lane; within 2 ulp of libm over normal numbers (arguments of exp between -700 and 700: outside they are cut
// there). Sources: fdlibm (Sun Microsystems 1993), e_log.c and s_log1p.c (reduction, polynomial); exp by its Taylor series on |r|
// < ln2/2. Called by kernels/gas (Osher's flux), kernels/turbulence; tested in tests/kernels/base/wide_math_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

#include "kernels/base/wide.hpp"

namespace spindrift {
namespace wide_math {

// V is double or a vector of doubles, I the integers beside it; both kinds know the same operators.
template <class V>
struct Integers {
  using type = std::int64_t;
};
template <class V>
requires requires(V v) { v[0]; }
struct Integers<V> {
  typedef std::int64_t type __attribute__((vector_size(sizeof(V))));
};
template <class V>
using integers = typename Integers<V>::type;

template <class To, class From>
SPINDRIFT_INLINE To bits_as(const From& from) {
  return __builtin_bit_cast(To, from);
}

inline constexpr double ln2_high = 6.93147180369123816490e-01, ln2_low = 1.90821492927058770002e-10;
// Adding 1.5 x 2^52 rounds to the nearest integer and leaves that integer in the low bits.
inline constexpr double round_shift = 6755399441055744.0;

/// a b + c, rounded once: of one number and of vectors, each factor a vector or one number for all lanes.
SPINDRIFT_INLINE double fma(double a, double b, double c) { return std::fma(a, b, c); }
template <class V, class B, class C>
requires requires(V v) { v[0]; }
SPINDRIFT_INLINE V fma(const V& a, const B& b, const C& c) {
  using W = Wide<double, int(sizeof(V) / sizeof(double))>;
  return spindrift::fma(W(a), W(b), W(c)).v;
}

/// x = 2^exponent m with m in [sqrt(1/2), sqrt(2)).
template <class V>
SPINDRIFT_INLINE V mantissa(const V& x, V& exponent) {
  using I = integers<V>;
  const I bits = bits_as<I>(x);
  const I k = (bits - 0x3fe6a09e667f3bcc) >> 52;
  exponent = bits_as<V>(k + bits_as<I>(V{} + round_shift)) - round_shift;
  return bits_as<V>(bits - (k << 52));
}

/// log(2^k (1 + f)) + c of a small correction c.
template <class V>
SPINDRIFT_INLINE V log_of_parts(const V& k, const V& f, const V& c) {
  const V s = f / (2.0 + f), z = s * s, half = 0.5 * f * f;
  const V z2 = z * z;  // even and odd powers apart: half the latency of one chain
  V odd = fma(z2, 1.479819860511658591e-01, 1.818357216161805012e-01);
  odd = fma(odd, z2, 2.857142874366239149e-01);
  odd = fma(odd, z2, 6.666666666666735130e-01);
  V even = fma(z2, 1.531383769920937332e-01, 2.222219843214978396e-01);
  even = fma(even, z2, 3.999999999940941908e-01);
  const V r = fma(even, z, odd) * z;
  const V rest = (half - fma(s, half + r, fma(k, ln2_low, c))) - f;
  return fma(k, ln2_high, -rest);
}

template <class V>
SPINDRIFT_INLINE V log_of(const V& x) {
  V k;
  const V m = mantissa(x, k);
  return log_of_parts(k, V(m - 1.0), V(V{} + 0.0));
}
template <class V>
SPINDRIFT_INLINE V log1p_of(const V& x) {
  V k;
  const V u = 1.0 + x, m = mantissa(u, k);
  const V lost = u > 2.0 ? 1.0 - (u - x) : x - (u - 1.0);  // what rounding took from 1 + x
  return log_of_parts(k, V(m - 1.0), V(lost / u));
}

/// exp(x) = power (1 + p), |p| < 0.42 and exact in a relative sense near x = 0.
template <class V>
SPINDRIFT_INLINE V exp_parts(const V& argument, V& power) {
  using I = integers<V>;
  V x = argument > 700.0 ? V(V{} + 700.0) : argument;
  x = x < -700.0 ? V(V{} - 700.0) : x;
  const V shifted = fma(x, 1.44269504088896338700, round_shift), n = shifted - round_shift;
  const V r = fma(n, -ln2_low, fma(n, -ln2_high, x));
  const V r2 = r * r;  // even and odd powers apart
  V odd = fma(r2, 1.0 / 6227020800.0, 1.0 / 39916800.0);
  odd = fma(odd, r2, 1.0 / 362880.0);
  odd = fma(odd, r2, 1.0 / 5040.0);
  odd = fma(odd, r2, 1.0 / 120.0);
  odd = fma(odd, r2, 1.0 / 6.0);
  V even = fma(r2, 1.0 / 479001600.0, 1.0 / 3628800.0);
  even = fma(even, r2, 1.0 / 40320.0);
  even = fma(even, r2, 1.0 / 720.0);
  even = fma(even, r2, 1.0 / 24.0);
  even = fma(even, r2, 0.5);
  const V p = fma(odd, r, even);
  const I exponent = bits_as<I>(shifted) - std::bit_cast<std::int64_t>(round_shift) + 1023;
  power = bits_as<V>(exponent << 52);
  return fma(r2, p, r);
}
template <class V>
SPINDRIFT_INLINE V exp_of(const V& x) {
  V power;
  const V p = exp_parts(x, power);
  return fma(power, p, power);
}
template <class V>
SPINDRIFT_INLINE V expm1_of(const V& x) {
  V power;
  const V p = exp_parts(x, power);
  return fma(power, p, power - 1.0);
}

}  // namespace wide_math

// One number: the same arithmetic, so that a test of one number is a test of a lane.
inline double log(double x) { return wide_math::log_of(x); }
inline double log1p(double x) { return wide_math::log1p_of(x); }
inline double exp(double x) { return wide_math::exp_of(x); }
inline double expm1(double x) { return wide_math::expm1_of(x); }
template <int n>
SPINDRIFT_INLINE Wide<double, n> log(Wide<double, n> x) {
  if constexpr (in_halves<double, n>)
    return {log(x.v.low), log(x.v.high)};
  else
    return wide_math::log_of(x.v);
}
template <int n>
SPINDRIFT_INLINE Wide<double, n> log1p(Wide<double, n> x) {
  if constexpr (in_halves<double, n>)
    return {log1p(x.v.low), log1p(x.v.high)};
  else
    return wide_math::log1p_of(x.v);
}
template <int n>
SPINDRIFT_INLINE Wide<double, n> exp(Wide<double, n> x) {
  if constexpr (in_halves<double, n>)
    return {exp(x.v.low), exp(x.v.high)};
  else
    return wide_math::exp_of(x.v);
}
template <int n>
SPINDRIFT_INLINE Wide<double, n> expm1(Wide<double, n> x) {
  if constexpr (in_halves<double, n>)
    return {expm1(x.v.low), expm1(x.v.high)};
  else
    return wide_math::expm1_of(x.v);
}

/// The number without derivatives (dual.hpp has the other half).
template <class Real>
const Real& value_of(const Real& x) {
  return x;
}

/// x^a of a positive x.
template <class Real>
SPINDRIFT_INLINE Real power(const Real& x, double a) {
  return exp(a * log(x));
}
/// (1 + x)^a - 1 for x > -1: every digit of it for small x.
template <class Real>
SPINDRIFT_INLINE Real power_minus_one(const Real& x, double a) {
  // 2 gamma / (gamma - 1) of air: a polynomial costs a sixth. The same branch for all lanes.
  if (a > 7.0 - 1e-12 && a < 7.0 + 1e-12) return x * (7.0 + x * (21.0 + x * (35.0 + x * (35.0 + x * (21.0 + x * (7.0 + x))))));
  return expm1(a * log1p(x));
}
template <class Real>
SPINDRIFT_INLINE Real tanh(const Real& x) {
  const Real e = expm1(2.0 * x);
  return e / (e + 2.0);
}
template <int n>
SPINDRIFT_INLINE Wide<double, n> tanh(const WideProduct<double, n>& x) {
  return tanh<Wide<double, n>>(x);
}

}  // namespace spindrift
