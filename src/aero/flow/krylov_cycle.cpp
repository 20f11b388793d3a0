// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/krylov_cycle.hpp"

#include <algorithm>
#include <array>

#include "src/aero/flow/krylov_vectors.hpp"

namespace spindrift::aero {

KrylovCycle::KrylovCycle(KrylovMethod method, int most_columns)
    : method_(method), most_(std::min(most_columns, linear::max_krylov)), factors_(std::size_t(most_)) {}

void KrylovCycle::allocate(FlowTile& tile) const {
  tile.vectors.resize(std::size_t(most_) + 1);
  if (method_ != KrylovMethod::gmres) tile.directions_kept.resize(std::size_t(most_));
}

float* KrylovCycle::made(const FlowTile& tile, AlignedArray<float>& vector) {
  if (vector.size() == 0) vector = AlignedArray<float>(padded(tile.vector_size()));
  return vector.data();
}

void KrylovCycle::start(double residual_norm) {
  norm_ = residual_norm;
  if (method_ == KrylovMethod::gcg)
    gcg_.start(1.0);  // its residual vector is of unit length at first: floats have room
  else
    gmres_.start(residual_norm);
}

void KrylovCycle::append(std::span<const double> dots) {
  if (method_ == KrylovMethod::gcg) {
    gcg_.append(dots);
    factors_[std::size_t(gcg_.columns()) - 1] = norm_ * gcg_.alpha();
  } else {
    gmres_.append(dots);
  }
}

void KrylovCycle::finish() {
  if (method_ != KrylovMethod::gcg) gmres_.solve(factors_);
}

float* KrylovCycle::first(FlowTile& tile) const {
  return made(tile, method_ == KrylovMethod::gcg ? tile.vectors.back() : tile.vectors[0]);
}

void KrylovCycle::advance(FlowTile& tile, int j) const {
  const std::size_t size = padded(tile.vector_size()), last = std::size_t(j) - 1;
  if (method_ == KrylovMethod::gcg) {
    float *p = tile.directions_kept[last].data(), *q = tile.vectors[last].data();
    orthogonalise(p, std::span(tile.directions_kept).first(last), gcg_.projections(), gcg_.scale(), size);
    orthogonalise(q, std::span(tile.vectors).first(last), gcg_.projections(), gcg_.scale(), size);
    add_scaled(tile.vectors.back().data(), -gcg_.alpha(), q, size);
  } else {
    orthogonalise(tile.vectors[std::size_t(j)].data(), std::span(tile.vectors).first(std::size_t(j)), gmres_.projections(),
                  gmres_.next_scale(), size);
  }
}

const float* KrylovCycle::source(const FlowTile& tile, int j) const {
  return method_ == KrylovMethod::gcg ? tile.vectors.back().data() : tile.vectors[std::size_t(j)].data();
}
float* KrylovCycle::direction(FlowTile& tile, int j) const {
  // GMRES keeps none: the place of the product is free until that comes.
  return made(tile, method_ == KrylovMethod::gmres ? tile.vectors[std::size_t(j) + 1] : tile.directions_kept[std::size_t(j)]);
}
float* KrylovCycle::product(FlowTile& tile, int j) const {
  return made(tile, tile.vectors[std::size_t(j) + (method_ == KrylovMethod::gcg ? 0 : 1)]);
}

void KrylovCycle::dots(const FlowTile& tile, int j, std::span<double> to) const {
  std::array<const float*, linear::max_krylov + 2> with{};
  const std::size_t count = std::size_t(j);
  for (std::size_t n = 0; n < count; ++n) with[n] = tile.vectors[n].data();
  const float* w = tile.vectors[count + (method_ == KrylovMethod::gcg ? 0 : 1)].data();
  if (method_ == KrylovMethod::gcg)
    with[count] = w, with[count + 1] = tile.vectors.back().data();
  else
    with[count] = tile.vectors[count].data(), with[count + 1] = w;
  dot_products(w, std::span(with).first(count + 2), padded(tile.vector_size()), to);
}

/// The last product, or GCG's residual: in no combination.
float* KrylovCycle::solution(FlowTile& tile) const {
  return method_ == KrylovMethod::gcg ? tile.vectors.back().data() : made(tile, tile.vectors[std::size_t(columns())]);
}

void KrylovCycle::combine(FlowTile& tile) const {
  const std::size_t size = padded(tile.vector_size()), columns_made = std::size_t(columns());
  if (method_ == KrylovMethod::gcg && columns_made > 0)
    orthogonalise(tile.directions_kept[columns_made - 1].data(), std::span(tile.directions_kept).first(columns_made - 1),
                  gcg_.projections(), gcg_.scale(), size);
  float* x = solution(tile);
  std::fill_n(x, size, 0.0f);
  const auto& basis = method_ == KrylovMethod::gmres ? tile.vectors : tile.directions_kept;
  for (std::size_t n = 0; n < columns_made; ++n) add_scaled(x, factors_[n], basis[n].data(), size);
}

}  // namespace spindrift::aero
