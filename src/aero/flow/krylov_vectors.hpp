// The vectors of a Krylov cycle in one tile: linear combinations and dot products over floats, summed in double. One pass over
// memory for all dot products of an iteration. Deterministic: the order of additions is that of the cells. Called by
// krylov_cycle.cpp; tested in tests/src/aero/flow/linear_solver_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>

#include "kernels/base/wide.hpp"
#include "src/aero/grid/aligned.hpp"

namespace spindrift::aero {

inline constexpr std::size_t vector_chunk = 1024;  ///< numbers whose products are summed in float lanes before they go to double

/// dots[n] = (w, vectors[n]) for all, of which w may be one. Vectors are padded with zeros to a multiple of 16.
inline void dot_products(const float* w, std::span<const float* const> vectors, std::size_t size, std::span<double> dots) {
  using Lanes = Wide<float, 16>;
  std::fill(dots.begin(), dots.end(), 0.0);
  for (std::size_t first = 0; first < size; first += vector_chunk) {
    const std::size_t last = std::min(size, first + vector_chunk);
    const auto product = [&](const float* v) {
      Lanes sum = 0.0f;
      for (std::size_t n = first; n < last; n += 16) sum += Lanes::load(w + n) * Lanes::load(v + n);
      return double(spindrift::sum(sum));
    };
    for (std::size_t m = 0; m < vectors.size(); ++m) dots[m] += product(vectors[m]);
  }
}

/// y = (y - sum factors[n] vectors[n]) scale.
inline void orthogonalise(float* y, std::span<const AlignedArray<float>> vectors, std::span<const double> factors, double scale,
                          std::size_t size) {
  using Lanes = Wide<float, 16>;
  for (std::size_t first = 0; first < size; first += vector_chunk) {
    const std::size_t last = std::min(size, first + vector_chunk);
    for (std::size_t m = 0; m < factors.size(); ++m) {
      const Lanes factor = float(factors[m]);
      const float* v = vectors[m].data();
      for (std::size_t n = first; n < last; n += 16) (Lanes::load(y + n) - factor * Lanes::load(v + n)).store(y + n);
    }
    for (std::size_t n = first; n < last; n += 16) (Lanes::load(y + n) * Lanes(float(scale))).store(y + n);
  }
}

/// x += factor y
inline void add_scaled(float* x, double factor, const float* y, std::size_t size) {
  using Lanes = Wide<float, 16>;
  for (std::size_t n = 0; n < size; n += 16) (Lanes::load(x + n) + Lanes(float(factor)) * Lanes::load(y + n)).store(x + n);
}

}  // namespace spindrift::aero
