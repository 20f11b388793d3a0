// Products and the inverse of small dense blocks, n x n floats stored column by column. For n = 5 a column is read as eight
// floats: the three lanes beyond it hold numbers of what follows, are multiplied along and never stored; no padding, 100 bytes
// per block. Measured (docs/developer/notes/air.md): this order against rows of many cells per register. Called by block_ilu.hpp,
// stencil_matrix.hpp; tested in tests/kernels/linear/small_block_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

#include "kernels/base/wide.hpp"
#include "kernels/linear/short_float.hpp"

namespace spindrift::linear {

/// Floats that may be read past the end of the last block or vector.
inline constexpr int block_overrun = 8;

/// A column of a block, or a vector of n numbers, on its way through registers.
template <int n>
struct Column {
  std::array<float, n> v;
  static Column load(const float* from) {
    Column c;
    std::memcpy(c.v.data(), from, sizeof c.v);
    return c;
  }
  static Column load_alone(const float* from) { return load(from); }
  void store(float* to) const { std::memcpy(to, v.data(), sizeof v); }
};
template <int n>
requires(n > 2 && n <= 8) struct Column<n> {
  Wide<float, 8> v;
  template <class Number>
  static Column load(const Number* from) {
    return {load_eight(from)};
  }
  /// Reads nothing beyond the n numbers.
  static Column load_alone(const float* from) {
#ifdef __AVX__
    if constexpr (n == 5)
      return {Wide<float, 8>(_mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(from)), _mm_load_ss(from + 4), 1))};
#endif
    alignas(32) float all[8] = {};
    std::memcpy(all, from, n * sizeof(float));
    return load(all);
  }
  void store(float* to) const {
#ifdef __AVX__
    if constexpr (n == 5) {  // from the register: what is read again at once would wait for a detour by the stack
      _mm_storeu_ps(to, _mm256_castps256_ps128(v.v));
      to[4] = _mm_cvtss_f32(_mm256_extractf128_ps(v.v, 1));
      return;
    }
#endif
    alignas(32) float all[8];
    v.store(all);
    std::memcpy(to, all, n * sizeof(float));
  }
};
template <int n>
SPINDRIFT_INLINE void add(Column<n>& y, float a, const Column<n>& x) {
  if constexpr (n > 2)
    y.v += Wide<float, 8>(a) * x.v;
  else
    for (int r = 0; r < n; ++r) y.v[r] += a * x.v[r];
}
template <int n>
SPINDRIFT_INLINE Column<n> difference(const Column<n>& a, const Column<n>& b) {
  if constexpr (n > 2) {
    return {a.v - b.v};
  } else {
    Column<n> d;
    for (std::size_t r = 0; r < n; ++r) d.v[r] = a.v[r] - b.v[r];
    return d;
  }
}
template <int n>
SPINDRIFT_INLINE Column<n> zero() {
  return Column<n>{};
}

/// y += A x, with y as two sums so that the additions of one do not wait for each other.
template <int n>
struct TwoSums {
  Column<n> even = zero<n>(), odd = zero<n>();
  /// Numbers of x are `stride` apart; those of the block are floats, or for n > 2 ShortFloats.
  template <class Number>
  SPINDRIFT_INLINE void multiply_add(const Number* block, const float* x, std::ptrdiff_t stride = 1) {
    for (int c = 0; c < n; ++c) add(c % 2 == 0 ? even : odd, x[c * stride], Column<n>::load(block + c * n));
  }
  SPINDRIFT_INLINE Column<n> total() const {
    Column<n> sum = even;
    add(sum, 1.0f, odd);
    return sum;
  }
};

/// y = A x.
template <int n>
SPINDRIFT_INLINE void multiply(const float* block, const float* x, float* y) {
  TwoSums<n> sums;
  sums.multiply_add(block, x);
  sums.total().store(y);
}

/// C = A B; C is neither.
template <int n>
SPINDRIFT_INLINE void multiply_blocks(const float* a, const float* b, float* c) {
  for (int column = 0; column < n; ++column) multiply<n>(a, b + column * n, c + column * n);
}
/// C -= A B.
template <int n>
SPINDRIFT_INLINE void subtract_product(const float* a, const float* b, float* c) {
  for (int column = 0; column < n; ++column) {
    float y[n];
    multiply<n>(a, b + column * n, y);
    for (int r = 0; r < n; ++r) c[column * n + r] -= y[r];
  }
}

/// D -= A P U, what a neighbour takes from a pivot; D may not be one of the others. Products stay in registers: through memory
/// the narrow stores of a column are read back as wide loads, which costs more than the arithmetic.
template <int n, class Number>
SPINDRIFT_INLINE void subtract_product(const Number* a, const float* p, const Number* u, float* d) {
  if constexpr (n > 2) {
    using Lanes = Wide<float, 8>;
    Lanes ac[n], pc[n];
    for (int c = 0; c < n; ++c) ac[c] = load_eight(a + c * n), pc[c] = Lanes::load(p + c * n);
    for (int c = 0; c < n; ++c) {
      alignas(32) float product[8];
      Lanes even = Lanes(float(u[c * n])) * pc[0], odd = Lanes(float(u[c * n + 1])) * pc[1];
      for (int k = 2; k < n; ++k) (k % 2 == 0 ? even : odd) += Lanes(float(u[c * n + k])) * pc[k];
      (even + odd).store(product);
      even = Lanes(product[0]) * ac[0], odd = Lanes(product[1]) * ac[1];
      for (int k = 2; k < n; ++k) (k % 2 == 0 ? even : odd) += Lanes(product[k]) * ac[k];
      alignas(32) float sum[8];
      (even + odd).store(sum);
      for (int r = 0; r < n; ++r) d[c * n + r] -= sum[r];
    }
  } else {
    float product[n * n];
    multiply_blocks<n>(p, u, product);
    subtract_product<n>(a, product, d);
  }
}

/// B = A^-1 by Gauss-Jordan in place with the largest pivot of each column, in double. False where A is singular or not finite (B
/// is then not set). Rows here are the block's columns, as the inverse of the transpose is the transpose of the inverse.
template <int n>
bool invert(const float* block, float* inverse) {
  constexpr int width = n > 4 ? 8 : n > 2 ? 4 : n;
  alignas(64) double a[n][width] = {};
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) a[r][c] = double(block[r * n + c]);
  int swapped[n];
  for (int p = 0; p < n; ++p) {
    int best = p;
    for (int r = p + 1; r < n; ++r)
      if (std::abs(a[r][p]) > std::abs(a[best][p])) best = r;
    if (!(std::abs(a[best][p]) > 0.0) || !std::isfinite(a[best][p])) return false;
    swapped[p] = best;
    if (best != p)
      for (int c = 0; c < width; ++c) std::swap(a[p][c], a[best][c]);
    const double scale = 1.0 / a[p][p];
    alignas(64) double unit[width] = {}, keep[width];
    for (int c = 0; c < width; ++c) unit[c] = c == p ? 1.0 : 0.0, keep[c] = 1.0 - unit[c];
    for (int c = 0; c < width; ++c) a[p][c] = (a[p][c] * keep[c] + unit[c]) * scale;
    for (int r = 0; r < n; ++r) {
      if (r == p) continue;
      const double factor = a[r][p];
      for (int c = 0; c < width; ++c) a[r][c] = a[r][c] * keep[c] - factor * a[p][c];
    }
  }
  for (int p = n - 1; p >= 0; --p)
    if (swapped[p] != p)
      for (int r = 0; r < n; ++r) std::swap(a[r][p], a[r][swapped[p]]);
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c)
      if (!std::isfinite(float(a[r][c]))) return false;
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) inverse[r * n + c] = float(a[r][c]);
  return true;
}

}  // namespace spindrift::linear
