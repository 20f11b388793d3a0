// What a density diffusion term is: it damps the acoustic noise of weakly compressible SPH by letting density flow between
// neighbours, d rho_i/dt += delta h c0 sum_j psi_ij . grad_i W_ij V_j. The volume of the partner is taken as m / ((rho_i +
// rho_j)/2), common to both, so that the term conserves the sum of densities pair by pair.
// Called by the pair laws of src/sea/sph; tested in tests/kernels/sph/pair_terms_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <string_view>

#include "kernels/sph/pair.hpp"

namespace spindrift::sph {

/// Density rate of i per unit mass of j; that of j is the opposite. `inverse` is 1 / ((rho_i + rho_j)(r^2 + 0.01 h^2)).
template <class D, class Real = double>
concept DensityDiffusion = requires(const D diffusion, const Pair<Real, 3>& pair, Real rho) {
  { diffusion(pair, rho, rho, rho) } -> std::same_as<Real>;
  { D::name } -> std::convertible_to<std::string_view>;
};

struct DensityDiffusionNone {
  static constexpr std::string_view name = "none";
  template <class Real, int dim>
  SPINDRIFT_INLINE Real operator()(const Pair<Real, dim>&, Real, Real, Real) const {
    return Real(0);
  }
};

static_assert(DensityDiffusion<DensityDiffusionNone>);

}  // namespace spindrift::sph
