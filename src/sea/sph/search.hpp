// Which clusters a cluster, and then a single particle, can reach: tests on bounding boxes, a register at a time, made anew in
// every sweep. Boxes follow the particles, so nothing is kept between sweeps and the order of particles may be old; a pair that
// slips in beyond the support contributes exactly zero (the kernel is cut), so results do not depend on the tests.
// Called by sweep_pairs.hpp; tested in tests/src/sea/sph/sweep_test.cpp against all pairs.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "kernels/base/wide.hpp"
#include "src/sea/sph/store.hpp"

namespace spindrift::sph {

#if defined(__AVX2__) && !defined(__AVX512F__)
/// For each pattern of 8 bits the places of its ones, first ones first: what AVX-512 does by compressing.
inline constexpr auto places_of_ones = [] {
  std::array<std::uint64_t, 256> table{};
  for (unsigned pattern = 0; pattern < 256; ++pattern)
    for (unsigned place = 0, count = 0; place < 8; ++place)
      if ((pattern >> place) & 1u) table[pattern] |= std::uint64_t(place) << (8 * count++);
  return table;
}();
#endif

/// A register of boxes is tested at once: how many changes neither the boxes found nor their order.
using Boxes = NativeWide<float>;

/// Writes first + lane to `to` for every lane with value < bound among the first `valid`; returns how many. Writes up to a
/// register of numbers.
SPINDRIFT_INLINE int append_where_below(std::uint32_t* to, Boxes value, float bound, std::uint32_t first, int valid) {
#if defined(__AVX512F__)
  const __mmask16 lanes = valid >= 16 ? __mmask16(0xffff) : __mmask16((1u << valid) - 1u);
  const __mmask16 below = _mm512_mask_cmp_ps_mask(lanes, value.v, _mm512_set1_ps(bound), _CMP_LT_OQ);
  const __m512i places =
      _mm512_add_epi32(_mm512_set1_epi32(int(first)), _mm512_set_epi32(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0));
  _mm512_storeu_si512(
      to, _mm512_maskz_compress_epi32(below, places));  // compressing to memory directly is microcoded on some processors
  return __builtin_popcount(below);
#elif defined(__AVX2__)
  const unsigned lanes = valid >= 8 ? 0xffu : (1u << valid) - 1u;
  const unsigned below = unsigned(_mm256_movemask_ps(_mm256_cmp_ps(value.v, _mm256_set1_ps(bound), _CMP_LT_OQ))) & lanes;
  const __m256i places = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128((long long)places_of_ones[below]));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_add_epi32(places, _mm256_set1_epi32(int(first))));
  return __builtin_popcount(below);
#else
  int count = 0;
  for (int lane = 0; lane < Boxes::size && lane < valid; ++lane) {
    to[count] = first + std::uint32_t(lane);
    count += value[lane] < bound;
  }
  return count;
#endif
}

/// Squared gap between a register of boxes and one box (a point when its corners coincide); from the corner of the domain [m].
template <int dim>
SPINDRIFT_INLINE Boxes gap2(const std::array<const float*, dim>& low, const std::array<const float*, dim>& high, std::uint32_t at,
                            const std::array<float, dim>& box_low, const std::array<float, dim>& box_high) {
  Boxes total(0.0f);
  for (int k = 0; k < dim; ++k) {
    const Boxes gap =
        max(max(Boxes::load(low[k] + at) - Boxes(box_high[k]), Boxes(box_low[k]) - Boxes::load(high[k] + at)), Boxes(0.0f));
    total += gap * gap;
  }
  return total;
}

/// The clusters near one cluster, copied together: boxes as that cluster sees them, and shifts between the anchors. One per
/// thread.
template <int dim, class Real>
class Candidates {
 public:
  void reserve(std::size_t clusters) {
    const std::size_t room = clusters + 2 * cluster_size;
    if (room <= cluster_.size()) return;
    cluster_.resize(room), chosen_.resize(room), sums_.resize(room);
    for (int k = 0; k < dim; ++k) low_[k].resize(room), high_[k].resize(room), shift_[k].resize(room);
  }
  void clear() { count_ = 0; }
  int size() const { return count_; }

  /// Adds the clusters [first, end) of a group that come within `reach` of cluster `mine`; `shift` from periodic sides; `sums`:
  /// of cluster `first`, `size` numbers a cluster, where a sweep adds to those of the clusters.
  void add(const Store<dim, Real>& store, std::uint32_t mine, std::uint32_t first, std::uint32_t end,
           const std::array<double, dim>& shift, float reach, Real* sums = nullptr, std::size_t size = 0) {
    std::array<float, dim> box_low, box_high;
    std::array<double, dim> anchor;
    for (int k = 0; k < dim; ++k)
      box_low[k] = store.low[k][mine], box_high[k] = store.high[k][mine], anchor[k] = store.anchor[k][mine];
    add(store, box_low, box_high, anchor, first, end, shift, reach, sums, size);
  }
  /// The same for any box (from the corner of the domain) whose points are told relative to `anchor`.
  void add(const Store<dim, Real>& store, std::array<float, dim> box_low, std::array<float, dim> box_high,
           const std::array<double, dim>& anchor, std::uint32_t first, std::uint32_t end, const std::array<double, dim>& shift,
           float reach, Real* sums = nullptr, std::size_t size = 0) {
    for (int k = 0; k < dim; ++k) box_low[k] -= float(shift[k]), box_high[k] -= float(shift[k]);
    const int before = count_;
    std::array<const float*, dim> low, high;
    for (int k = 0; k < dim; ++k) low[k] = store.low[k].data(), high[k] = store.high[k].data();
    std::uint32_t* const to = cluster_.data();
    int found = count_;
    for (std::uint32_t from = first; from < end; from += Boxes::size)
      found +=
          append_where_below(to + found, gap2<dim>(low, high, from, box_low, box_high), reach * reach, from, int(end - from));
    count_ = found;
    for (int n = before; n < count_; ++n) {
      const std::uint32_t other = cluster_[n];
      sums_[n] = sums + (other - first) * size;
      for (int k = 0; k < dim; ++k) {
        low_[k][n] = store.low[k][other] + float(shift[k]);
        high_[k][n] = store.high[k][other] + float(shift[k]);
        // Particle i sees that cluster's offsets when this is added to its own: anchor_i - (anchor_j + shift).
        shift_[k][n] = Real(anchor[k] - store.anchor[k][other] - shift[k]);
      }
    }
  }
  /// Chooses those within `reach` of a point; returns how many.
  int choose(const std::array<float, dim>& point, float reach) {
    std::array<const float*, dim> low, high;
    for (int k = 0; k < dim; ++k) low[k] = low_[k].data(), high[k] = high_[k].data();
    std::uint32_t* const to = chosen_.data();
    int found = 0;
    for (int from = 0; from < count_; from += Boxes::size)
      found += append_where_below(to + found, gap2<dim>(low, high, std::uint32_t(from), point, point), reach * reach,
                                  std::uint32_t(from), count_ - from);
    return found;
  }
  /// The clusters themselves and their shifts, all of them.
  struct All {
    const std::uint32_t* cluster;
    std::array<const Real*, dim> shift;
  };
  All all() const {
    All a{cluster_.data(), {}};
    for (int k = 0; k < dim; ++k) a.shift[k] = shift_[k].data();
    return a;
  }
  /// Plain pointers for the inner loop.
  struct View {
    const std::uint32_t *chosen, *cluster;
    Real* const* sums;
    std::array<const Real*, dim> shift;
  };
  View view() const {
    View v{chosen_.data(), cluster_.data(), sums_.data(), {}};
    for (int k = 0; k < dim; ++k) v.shift[k] = shift_[k].data();
    return v;
  }

 private:
  int count_ = 0;
  Array<std::uint32_t> cluster_, chosen_;
  Array<Real*> sums_;
  std::array<Array<float>, dim> low_, high_;
  std::array<Array<Real>, dim> shift_;
};

}  // namespace spindrift::sph
