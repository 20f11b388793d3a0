// Cubic spline kernel of support 2h: W = (a/4) [(2-q)^3 - 4 (1-q)^3], each bracket cut at zero; a = 10/(7 pi h^2) in 2-D, 1/(pi
// h^3) in 3-D. Monaghan & Lattanzio (1985), Astron. Astrophys. 149, 135. The kernel of Leble & Barakos (2016), section 2.2.
// Written with cut powers, so that lanes need no branch.
// Called by the pair laws of src/sea/sph; tested in tests/kernels/sph/kernel_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/base/constants.hpp"
#include "kernels/base/wide.hpp"
#include "kernels/sph/kernel.hpp"

namespace spindrift::sph {

template <int dim, class Scalar = double>
class KernelCubic {
 public:
  static constexpr std::string_view name = "cubic";
  static constexpr int dimensions = dim;
  static constexpr double support = 2.0;

  explicit KernelCubic(double h)
      : h_(Scalar(h)),
        inverse_h_(Scalar(1.0 / h)),
        value_(Scalar(0.25 * (dim == 2 ? 10.0 / (7.0 * pi * h * h) : 1.0 / (pi * h * h * h)))),
        slope_(Scalar(-0.75 * (dim == 2 ? 10.0 / (7.0 * pi * h * h) : 1.0 / (pi * h * h * h)) / h)) {}

  template <class Real>
  SPINDRIFT_INLINE Real value(Real r2) const {
    using std::max, std::sqrt;
    const Real q = sqrt(r2) * Real(inverse_h_);
    const Real outer = max(Real(2) - q, Real(0)), inner = max(Real(1) - q, Real(0));
    return Real(value_) * (outer * outer * outer - Real(4) * (inner * inner * inner));
  }
  template <class Real>
  SPINDRIFT_INLINE Real slope(Real r2) const {
    using std::sqrt;
    const Real r = sqrt(r2);
    return slope_times_r(r) / r;
  }
  template <class Real>
  SPINDRIFT_INLINE SlopeAndReciprocal<Real> slope_and_reciprocal(Real r2, Real a) const {
    using std::sqrt;
    const Real r = sqrt(r2), both = Real(1) / (r * a);  // one division for two
    return {slope_times_r(r) * (a * both), r * both};
  }
  double h() const { return double(h_); }

 private:
  template <class Real>
  SPINDRIFT_INLINE Real slope_times_r(Real r) const {
    using std::max;
    const Real q = r * Real(inverse_h_);
    const Real outer = max(Real(2) - q, Real(0)), inner = max(Real(1) - q, Real(0));
    return Real(slope_) * (outer * outer - Real(4) * (inner * inner));
  }

  Scalar h_, inverse_h_, value_, slope_;
};
static_assert(SmoothingKernel<KernelCubic<2>> && SmoothingKernel<KernelCubic<3>>);

}  // namespace spindrift::sph
