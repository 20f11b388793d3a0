// Wendland C2 kernel of support 2h: W = a (1 - q/2)^4 (1 + 2q), q = r/h; a = 7/(4 pi h^2) in 2-D, 21/(16 pi h^3) in 3-D.
// Wendland (1995), Adv. Comput. Math. 4, 389; in this form Dehnen & Aly (2012), MNRAS 425, 1068. Its slope is -5 a (1 - q/2)^3 /
// h^2.
// Called by the pair laws of src/sea/sph; tested in tests/kernels/sph/kernel_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/base/constants.hpp"
#include "kernels/base/wide.hpp"
#include "kernels/sph/kernel.hpp"

namespace spindrift::sph {

template <int dim, class Scalar = double>
class KernelWendland {
 public:
  static constexpr std::string_view name = "wendland";
  static constexpr int dimensions = dim;
  static constexpr double support = 2.0;

  explicit KernelWendland(double h)
      : h_(Scalar(h)),
        inverse_h_(Scalar(1.0 / h)),
        value_(Scalar(dim == 2 ? 7.0 / (4.0 * pi * h * h) : 21.0 / (16.0 * pi * h * h * h))),
        slope_(Scalar(-5.0 * (dim == 2 ? 7.0 / (4.0 * pi * h * h) : 21.0 / (16.0 * pi * h * h * h)) / (h * h))) {}

  template <class Real>
  SPINDRIFT_INLINE Real value(Real r2) const {
    using std::max, std::sqrt;
    const Real q = sqrt(r2) * Real(inverse_h_);
    const Real t = max(Real(1) - Real(0.5) * q, Real(0));
    return Real(value_) * (t * t) * (t * t) * (Real(1) + Real(2) * q);
  }
  template <class Real>
  SPINDRIFT_INLINE Real slope(Real r2) const {
    using std::max, std::sqrt;
    const Real t = max(Real(1) - sqrt(r2) * Real(Scalar(0.5) * inverse_h_), Real(0));
    return (Real(slope_) * t) * (t * t);
  }
  template <class Real>
  SPINDRIFT_INLINE SlopeAndReciprocal<Real> slope_and_reciprocal(Real r2, Real a) const {
    return {slope(r2), Real(1) / a};
  }
  double h() const { return double(h_); }

 private:
  Scalar h_, inverse_h_, value_, slope_;
};
static_assert(SmoothingKernel<KernelWendland<2>> && SmoothingKernel<KernelWendland<3>>);

}  // namespace spindrift::sph
