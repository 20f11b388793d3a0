// Wide<T, n>: n numbers side by side in vector registers (its lanes) with the arithmetic of one number, so that a kernel
// templated on Real serves a test (Real = double) and a sweep (Real = Wide<float, 16>) with one source. Selections are min() and
// max(). Built on the compilers' vector extension; AVX-512 and AVX2 instructions where the portable form compiles badly (min,
// max, reciprocals).
// Called by src/sea/sph sweeps; tested in tests/kernels/base/wide_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <concepts>
#include <type_traits>
#include <utility>

#if defined(__AVX512F__) || defined(__AVX2__)
#include <immintrin.h>
#endif

namespace spindrift {

#define SPINDRIFT_INLINE [[gnu::always_inline]] inline  // for functions of many registers: a call would spill them all

template <class T, int n>
struct Wide {
  typedef T Vector __attribute__((vector_size(sizeof(T) * n)));
  typedef T Unaligned __attribute__((vector_size(sizeof(T) * n), aligned(alignof(T)), may_alias));
  using Scalar = T;
  static constexpr int size = n;

  Vector v;

  Wide() = default;
  Wide(Vector vector) : v(vector) {}
  template <class S>
  requires std::is_arithmetic_v<S> Wide(S scalar)
      : v(T(scalar) - Vector{}) {}  // minus zero is the identity that compilers drop; plus zero is not

  static Wide load(const T* from) { return Wide(Vector(*reinterpret_cast<const Unaligned*>(from))); }
  void store(T* to) const { *reinterpret_cast<Unaligned*>(to) = v; }
  T operator[](int lane) const { return v[lane]; }

  friend Wide operator+(Wide a, Wide b) { return a.v + b.v; }
  friend Wide operator-(Wide a, Wide b) { return a.v - b.v; }
  friend Wide operator*(Wide a, Wide b) { return a.v * b.v; }
  friend Wide operator/(Wide a, Wide b) { return a.v / b.v; }
  Wide operator-() const { return -v; }
  Wide& operator+=(Wide b) { return v += b.v, *this; }
  Wide& operator-=(Wide b) { return v -= b.v, *this; }
  Wide& operator*=(Wide b) { return v *= b.v, *this; }
};

template <class T, int n>
Wide<T, n> max(Wide<T, n> a, Wide<T, n> b) {
#ifdef __AVX512F__
  if constexpr (std::same_as<T, float> && n == 16) return _mm512_maskz_max_ps(0xffff, a.v, b.v);
  if constexpr (std::same_as<T, double> && n == 8) return _mm512_maskz_max_pd(0xff, a.v, b.v);
#endif
#ifdef __AVX2__
  if constexpr (std::same_as<T, float> && n == 8) return _mm256_max_ps(a.v, b.v);
  if constexpr (std::same_as<T, double> && n == 4) return _mm256_max_pd(a.v, b.v);
#endif
  return a.v > b.v ? a.v : b.v;
}
template <class T, int n>
Wide<T, n> min(Wide<T, n> a, Wide<T, n> b) {
#ifdef __AVX512F__
  if constexpr (std::same_as<T, float> && n == 16) return _mm512_maskz_min_ps(0xffff, a.v, b.v);
  if constexpr (std::same_as<T, double> && n == 8) return _mm512_maskz_min_pd(0xff, a.v, b.v);
#endif
#ifdef __AVX2__
  if constexpr (std::same_as<T, float> && n == 8) return _mm256_min_ps(a.v, b.v);
  if constexpr (std::same_as<T, double> && n == 4) return _mm256_min_pd(a.v, b.v);
#endif
  return a.v < b.v ? a.v : b.v;
}
template <class T, int n>
Wide<T, n> sqrt(Wide<T, n> a) {
  Wide<T, n> root;
  for (int lane = 0; lane < n; ++lane) root.v[lane] = std::sqrt(a.v[lane]);
  return root;
}

/// 1/a of a positive number, and 1/sqrt(a): correctly rounded operations for one number; for a register of floats an estimate of 12
/// (AVX2) or 14 bits and a Newton step, within 3 units in the last place, at a third of the cost of the divider (perf/sea, docs/developer/sea.md).
template <class Real>
Real reciprocal(Real a) {
#ifdef __AVX512F__
  if constexpr (std::same_as<Real, Wide<float, 16>>) {
    const Real y = Real(_mm512_maskz_rcp14_ps(0xffff, a.v));
    return y + y * (Real(1.0f) - a * y);
  }
#endif
#ifdef __AVX2__
  if constexpr (std::same_as<Real, Wide<float, 8>>) {
    const Real y = Real(_mm256_rcp_ps(a.v));
    return y + y * (Real(1.0f) - a * y);
  }
#endif
  return Real(1) / a;
}
template <class Real>
Real inverse_sqrt(Real a) {
  using std::sqrt;
#ifdef __AVX512F__
  if constexpr (std::same_as<Real, Wide<float, 16>>) {
    const Real y = Real(_mm512_maskz_rsqrt14_ps(0xffff, a.v));
    return y + (Real(0.5f) * y) * (Real(1.0f) - (a * y) * y);
  }
#endif
#ifdef __AVX2__
  if constexpr (std::same_as<Real, Wide<float, 8>>) {
    const Real y = Real(_mm256_rsqrt_ps(a.v));
    return y + (Real(0.5f) * y) * (Real(1.0f) - (a * y) * y);
  }
#endif
  return Real(1) / sqrt(a);
}

/// Sum of all lanes by halves: a fixed order of additions.
template <class T, int n>
SPINDRIFT_INLINE T sum(Wide<T, n> a) {
  if constexpr (n == 2) {
    return a[0] + a[1];
  } else {
    return [&]<int... lane>(std::integer_sequence<int, lane...>) {
      return sum(Wide<T, n / 2>(__builtin_shufflevector(a.v, a.v, lane...)) +
                 Wide<T, n / 2>(__builtin_shufflevector(a.v, a.v, (lane + n / 2)...)));
    }
    (std::make_integer_sequence<int, n / 2>{});
  }
}

/// The scalar type under Real: float of Wide<float, 16>, double of double.
template <class Real>
struct ScalarOf {
  using type = Real;
};
template <class T, int n>
struct ScalarOf<Wide<T, n>> {
  using type = T;
};
template <class Real>
using scalar_of = typename ScalarOf<Real>::type;

/// Wide of one vector register of the processor compiled for.
#if defined(__AVX512F__)
inline constexpr int register_bytes = 64;
#elif defined(__AVX__)
inline constexpr int register_bytes = 32;
#else
inline constexpr int register_bytes = 16;
#endif
template <class T>
using NativeWide = Wide<T, register_bytes / int(sizeof(T))>;

}  // namespace spindrift
