// What a smoothing kernel is, so that one may stand for another.
// Called by every sweep of src/sea/sph through its pair laws; the laws every kernel obeys are tested in
// tests/kernels/sph/kernel_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <string_view>

namespace spindrift::sph {

/// slope(r2) and 1/a: for a kernel that itself divides by r both take one division.
template <class Real>
struct SlopeAndReciprocal {
  Real slope, reciprocal;
};

/// W(r) with unit integral over R^dim and compact support; both functions take r^2 > 0 [m2] and return exactly zero beyond the
/// support: value = W [1/m^dim], slope = W'(r)/r [1/m^(dim+2)], so that grad W = slope * x.
template <class K, class Real = double>
concept SmoothingKernel = requires(const K kernel, Real r2) {
  { kernel.value(r2) } -> std::same_as<Real>;
  { kernel.slope(r2) } -> std::same_as<Real>;
  { kernel.slope_and_reciprocal(r2, r2) } -> std::same_as<SlopeAndReciprocal<Real>>;
  { kernel.h() } -> std::convertible_to<double>;
  { K::dimensions } -> std::convertible_to<int>;
  { K::support } -> std::convertible_to<double>;  // radius of the support in units of h
  { K::name } -> std::convertible_to<std::string_view>;
};

}  // namespace spindrift::sph
