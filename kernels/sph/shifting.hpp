// Particle shifting: particles move a little against the gradient of their concentration, dx = -A h |v| dt grad C, grad C =
// sum_j V_j grad W_ij. Lind et al. (2012), J. Comput. Phys. 231, eq. 22, with the strength of Skillen et al. (2013), CMAME 265.
// Near a free surface, found by div x = sum_j V_j (x_j - x_i).grad W_ij falling from dim (Lee et al. 2008, J. Comput. Phys.
// 227), the gradient points out of the water: there the shift fades to nothing. (The linear fade is ours; the sources switch.)
// Called by src/sea/sph/filters.hpp; tested in tests/kernels/sph/filter_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/sph/pair.hpp"

namespace spindrift::sph {

template <int dim>
struct Shifting {
  static constexpr int planes = dim + 1;   ///< gradient of concentration, divergence of position; both without the volume
  double strength = 2.0;                   ///< A, 1 to 6
  double surface = dim == 2 ? 1.5 : 2.75;  ///< div x at and below which a particle counts as the surface
  double most_over_h = 0.1;                ///< no shift is longer

  /// Terms of particle i; the partner's are the opposite gradient and the same divergence.
  template <class Real>
  SPINDRIFT_INLINE static Vec<Real, planes> pair_terms(const Pair<Real, dim>& pair) {
    Vec<Real, planes> terms;
    for (int k = 0; k < dim; ++k) terms[k] = pair.slope * pair.x[k];
    terms[dim] = -(pair.slope * pair.r2);
    return terms;
  }

  /// How far inside the water a particle is: 0 at the surface, 1 in the bulk.
  double depth(double divergence) const { return std::clamp((divergence - surface) / (dim - surface), 0.0, 1.0); }

  Vec<double, dim> shift(const Vec<double, dim>& gradient, double divergence, double speed, double h, double dt) const {
    Vec<double, dim> dx = (-strength * h * speed * dt * depth(divergence)) * gradient;
    const double length = std::sqrt(dot(dx, dx)), most = most_over_h * h;
    return length > most ? (most / length) * dx : dx;
  }
};

}  // namespace spindrift::sph
