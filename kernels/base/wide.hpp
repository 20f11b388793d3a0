// Wide<T, n>: n numbers side by side in vector registers (its lanes) with the arithmetic of one number, so that a kernel
// templated on Real serves a test (Real = double) and a sweep (Real = Wide<float, 16>) with one source. Selections are min(),
// max() and select() on a comparison. Built on the compilers' vector extension; AVX-512 and AVX2 instructions where the portable
// form compiles badly (min, max, sqrt, comparisons, reciprocals). Called by src/sea/sph sweeps and by kernels/gas,
// kernels/turbulence; tested in tests/kernels/base/wide_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <type_traits>
#include <utility>

#ifdef __AVX__
#include <immintrin.h>
#endif

namespace spindrift {

#define SPINDRIFT_INLINE __attribute__((always_inline)) inline  // for functions of many registers: a call would spill them all

/// Of a vector register of the processor compiled for.
#if defined(__AVX512F__)
inline constexpr int register_bytes = 64;
#elif defined(__AVX__)
inline constexpr int register_bytes = 32;
#else
inline constexpr int register_bytes = 16;
#endif

// A comparison's answers: bits of a mask register where the processor has those, else a vector of integers all ones or zero.
template <class T, int n, bool in_bits>
struct MaskOf {
  using Integer = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;
  typedef Integer Bits __attribute__((vector_size(sizeof(T) * n)));
};
template <class T, int n>
struct MaskOf<T, n, true> {
  using Bits = std::conditional_t<n == 16, std::uint16_t, std::uint8_t>;
};

/// One yes or no for each lane.
template <class T, int n>
struct WideMask {
#ifdef __AVX512F__
  static constexpr bool in_bits = sizeof(T) * n == 64;
#else
  static constexpr bool in_bits = false;
#endif
  using Bits = typename MaskOf<T, n, in_bits>::Bits;

  Bits bits;

  friend WideMask operator&(WideMask a, WideMask b) { return {Bits(a.bits & b.bits)}; }
  friend WideMask operator|(WideMask a, WideMask b) { return {Bits(a.bits | b.bits)}; }
  WideMask operator!() const { return {Bits(~bits)}; }
  bool operator[](int lane) const {
    if constexpr (in_bits)
      return (bits >> lane & 1) != 0;
    else
      return bits[lane] != 0;
  }
};

template <class T, int n>
requires(sizeof(T) * n > register_bytes) struct WideMask<T, n> {
  WideMask<T, n / 2> low, high;

  friend WideMask operator&(WideMask a, WideMask b) { return {a.low & b.low, a.high & b.high}; }
  friend WideMask operator|(WideMask a, WideMask b) { return {a.low | b.low, a.high | b.high}; }
  WideMask operator!() const { return {!low, !high}; }
  bool operator[](int lane) const { return lane < n / 2 ? low[lane] : high[lane - n / 2]; }
};

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
  friend WideMask<T, n> operator<(Wide a, Wide b) {
#ifdef __AVX512F__
    if constexpr (std::same_as<T, float> && n == 16) return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ)};
    if constexpr (std::same_as<T, double> && n == 8) return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_LT_OQ)};
#endif
    if constexpr (!WideMask<T, n>::in_bits) return {a.v < b.v};
  }
  friend WideMask<T, n> operator<=(Wide a, Wide b) {
#ifdef __AVX512F__
    if constexpr (std::same_as<T, float> && n == 16) return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ)};
    if constexpr (std::same_as<T, double> && n == 8) return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_LE_OQ)};
#endif
    if constexpr (!WideMask<T, n>::in_bits) return {a.v <= b.v};
  }
  friend WideMask<T, n> operator>(Wide a, Wide b) { return b < a; }
  friend WideMask<T, n> operator>=(Wide a, Wide b) { return b <= a; }
  Wide operator-() const { return -v; }
  Wide& operator+=(Wide b) { return v += b.v, *this; }
  Wide& operator-=(Wide b) { return v -= b.v, *this; }
  Wide& operator*=(Wide b) { return v *= b.v, *this; }
};

/// Wider than a register: two halves. (The compiler would keep such a vector in memory and select lane by lane: MUSCL with van
/// Albada and low-Mach Roe took 74 ns a face in Wide<double, 8> on AVX2 where NativeWide takes 23.)
template <class T, int n>
requires(sizeof(T) * n > register_bytes) struct Wide<T, n> {
  using Half = Wide<T, n / 2>;
  using Scalar = T;
  static constexpr int size = n;

  /// Lane by lane as of the compiler's vectors: v[lane] reads and writes.
  struct Halves {
    Half low, high;
    struct Lane {
      Halves& of;
      int lane;
      operator T() const { return lane < n / 2 ? of.low.v[lane] : of.high.v[lane - n / 2]; }
      void operator=(T x) { lane < n / 2 ? void(of.low.v[lane] = x) : void(of.high.v[lane - n / 2] = x); }
    };
    Lane operator[](int lane) { return {*this, lane}; }
    T operator[](int lane) const { return lane < n / 2 ? low[lane] : high[lane - n / 2]; }
  };
  Halves v;

  Wide() = default;
  Wide(Half low, Half high) : v{low, high} {}
  template <class S>
  requires std::is_arithmetic_v<S> Wide(S scalar) : v{Half(scalar), Half(scalar)} {}

  static Wide load(const T* from) { return {Half::load(from), Half::load(from + n / 2)}; }
  void store(T* to) const { v.low.store(to), v.high.store(to + n / 2); }
  T operator[](int lane) const { return v[lane]; }

  friend Wide operator+(Wide a, Wide b) { return {a.v.low + b.v.low, a.v.high + b.v.high}; }
  friend Wide operator-(Wide a, Wide b) { return {a.v.low - b.v.low, a.v.high - b.v.high}; }
  friend Wide operator*(Wide a, Wide b) { return {a.v.low * b.v.low, a.v.high * b.v.high}; }
  friend Wide operator/(Wide a, Wide b) { return {a.v.low / b.v.low, a.v.high / b.v.high}; }
  friend WideMask<T, n> operator<(Wide a, Wide b) { return {a.v.low < b.v.low, a.v.high < b.v.high}; }
  friend WideMask<T, n> operator<=(Wide a, Wide b) { return {a.v.low <= b.v.low, a.v.high <= b.v.high}; }
  friend WideMask<T, n> operator>(Wide a, Wide b) { return b < a; }
  friend WideMask<T, n> operator>=(Wide a, Wide b) { return b <= a; }
  Wide operator-() const { return {-v.low, -v.high}; }
  Wide& operator+=(Wide b) { return *this = *this + b; }
  Wide& operator-=(Wide b) { return *this = *this - b; }
  Wide& operator*=(Wide b) { return *this = *this * b; }
};
template <class T, int n>
inline constexpr bool in_halves = sizeof(T) * n > register_bytes;

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
template <class T, int n, class S>
requires std::is_arithmetic_v<S> Wide<T, n> max(Wide<T, n> a, S b) { return max(a, Wide<T, n>(b)); }
template <class T, int n, class S>
requires std::is_arithmetic_v<S> Wide<T, n> min(Wide<T, n> a, S b) { return min(a, Wide<T, n>(b)); }
template <class T, int n>
Wide<T, n> sqrt(Wide<T, n> a) {
#ifdef __AVX512F__
  if constexpr (std::same_as<T, float> && n == 16) return _mm512_maskz_sqrt_ps(0xffff, a.v);
  if constexpr (std::same_as<T, double> && n == 8) return _mm512_maskz_sqrt_pd(0xff, a.v);
#endif
#ifdef __AVX__
  if constexpr (std::same_as<T, float> && n == 8) return _mm256_sqrt_ps(a.v);
  if constexpr (std::same_as<T, double> && n == 4) return _mm256_sqrt_pd(a.v);
#endif
  Wide<T, n> root;
  for (int lane = 0; lane < n; ++lane) root.v[lane] = std::sqrt(a.v[lane]);
  return root;
}
template <class T, int n>
Wide<T, n> abs(Wide<T, n> a) {
  return max(a, -a);
}

/// Lane by lane: `yes` where the mask says so, else `no`.
template <class T, int n>
Wide<T, n> select(WideMask<T, n> mask, std::type_identity_t<Wide<T, n>> yes, std::type_identity_t<Wide<T, n>> no) {
#ifdef __AVX512F__
  if constexpr (std::same_as<T, float> && n == 16) return _mm512_mask_blend_ps(mask.bits, no.v, yes.v);
  if constexpr (std::same_as<T, double> && n == 8) return _mm512_mask_blend_pd(mask.bits, no.v, yes.v);
#endif
  if constexpr (!WideMask<T, n>::in_bits) return mask.bits ? yes.v : no.v;
}
/// True if any lane says yes: the only way a kernel may branch, to leave out work whose result no lane selects.
template <class T, int n>
bool any(WideMask<T, n> mask) {
#ifdef __AVX2__
  if constexpr (sizeof(T) * n == 32) return !_mm256_testz_si256(__m256i(mask.bits), __m256i(mask.bits));
#endif
  if constexpr (WideMask<T, n>::in_bits) {
    return mask.bits != 0;
  } else {
    bool found = false;
    for (int lane = 0; lane < n; ++lane) found = found || mask[lane];
    return found;
  }
}

// In halves: the same of each.
template <class T, int n>
requires in_halves<T, n> Wide<T, n> max(Wide<T, n> a, Wide<T, n> b) { return {max(a.v.low, b.v.low), max(a.v.high, b.v.high)}; }
template <class T, int n>
requires in_halves<T, n> Wide<T, n> min(Wide<T, n> a, Wide<T, n> b) { return {min(a.v.low, b.v.low), min(a.v.high, b.v.high)}; }
template <class T, int n>
requires in_halves<T, n> Wide<T, n> sqrt(Wide<T, n> a) { return {sqrt(a.v.low), sqrt(a.v.high)}; }
template <class T, int n>
requires in_halves<T, n> Wide<T, n> select(WideMask<T, n> mask, std::type_identity_t<Wide<T, n>> yes,
                                           std::type_identity_t<Wide<T, n>> no) {
  return {select(mask.low, yes.v.low, no.v.low), select(mask.high, yes.v.high, no.v.high)};
}
template <class T, int n>
requires in_halves<T, n>
bool any(WideMask<T, n> mask) { return any(mask.low | mask.high); }

// One number under the same names, so that kernels write them unqualified.
template <std::floating_point T>
T select(bool mask, T yes, std::type_identity_t<T> no) {
  return mask ? yes : no;
}
inline bool any(bool mask) { return mask; }
template <std::floating_point T>
T max(T a, std::type_identity_t<T> b) {
  return a > b ? a : b;
}
template <std::floating_point T>
T min(T a, std::type_identity_t<T> b) {
  return a < b ? a : b;
}
template <std::floating_point T>
T sqrt(T a) {
  return std::sqrt(a);
}
template <std::floating_point T>
T abs(T a) {
  return std::abs(a);
}

/// 1/a of a positive number, and 1/sqrt(a): correctly rounded operations for one number; for a register of floats an estimate of
/// 12 (AVX2) or 14 bits and a Newton step, within 3 units in the last place, at a third of the cost of the divider (perf/sea,
/// docs/developer/notes/sea.md).
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
  } else if constexpr (in_halves<T, n>) {
    return sum(a.v.low + a.v.high);
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
template <class T>
using NativeWide = Wide<T, register_bytes / int(sizeof(T))>;

}  // namespace spindrift
