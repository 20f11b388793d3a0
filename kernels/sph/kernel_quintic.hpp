// Quintic B-spline kernel of support 2h, that is of knots 2h/3 apart: W = a [(3-s)^5 - 6 (2-s)^5 + 15 (1-s)^5], s = 3q/2, q =
// r/h, each bracket cut at zero; a = 7/(478 pi b^2) in 2-D, 1/(120 pi b^3) in 3-D, b = 2h/3. Morris, Fox & Zhu (1997), J. Comput.
// Phys. 136, 214. With knots one particle spacing apart (h/d 1.5) its transform has a zero of sixth order at the wave number of
// the lattice: water slides past water and walls of particles without feeling their rows. Written with cut powers, so that lanes
// need no branch. Called by the pair laws of src/sea/sph; tested in tests/kernels/sph/kernel_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include "kernels/base/constants.hpp"
#include "kernels/base/wide.hpp"
#include "kernels/sph/kernel.hpp"

namespace spindrift::sph {

template <int dim, class Scalar = double>
class KernelQuintic {
 public:
  static constexpr std::string_view name = "quintic";
  static constexpr int dimensions = dim;
  static constexpr double support = 2.0;

  explicit KernelQuintic(double h)
      : h_(Scalar(h)), inverse_knots_(Scalar(1.5 / h)), value_(Scalar(factor(h))), slope_(Scalar(-7.5 * factor(h) / h)) {}

  template <class Real>
  SPINDRIFT_INLINE Real value(Real r2) const {
    using std::max, std::sqrt;
    const Real s = sqrt(r2) * Real(inverse_knots_);
    const Real outer = max(Real(3) - s, Real(0)), middle = max(Real(2) - s, Real(0)), inner = max(Real(1) - s, Real(0));
    return Real(value_) * (fourth(outer) * outer - Real(6) * (fourth(middle) * middle) + Real(15) * (fourth(inner) * inner));
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
  static constexpr double factor(double h) {
    const double b = h / 1.5;
    return dim == 2 ? 7.0 / (478.0 * pi * b * b) : 1.0 / (120.0 * pi * b * b * b);
  }
  template <class Real>
  SPINDRIFT_INLINE static Real fourth(Real x) {
    const Real x2 = x * x;
    return x2 * x2;
  }
  template <class Real>
  SPINDRIFT_INLINE Real slope_times_r(Real r) const {
    using std::max;
    const Real s = r * Real(inverse_knots_);
    const Real outer = max(Real(3) - s, Real(0)), middle = max(Real(2) - s, Real(0)), inner = max(Real(1) - s, Real(0));
    return Real(slope_) * (fourth(outer) - Real(6) * fourth(middle) + Real(15) * fourth(inner));
  }

  Scalar h_, inverse_knots_, value_, slope_;
};
static_assert(SmoothingKernel<KernelQuintic<2>> && SmoothingKernel<KernelQuintic<3>>);

}  // namespace spindrift::sph
