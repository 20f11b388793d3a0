// Extrapolated boundary: the pressure of a wall particle is that of the water round it, carried on to its place by the balance of
// forces of water at rest: p_w = sum (p_f + rho_f g.(x_w - x_f)) W / sum W. Adami, Hu & Adams (2012), J. Comput. Phys. 231,
// eq. 27, without the acceleration of the wall (worth 0.02 diameters on the way of a dropped cylinder at 9 particles per radius);
// velocity by their eqs. 22-23. It asks for neither normals nor mirror images, so that it takes walls of any shape. A wall over
// the surface of the water neither pulls nor pushes: its tension grows to that which cancels the pressure of the water beside it.
// With none it presses the water at its waterline down, and floats displace 0.1 d^2 too much per length of it. Weight alone never
// makes a wall pull (a drop under a ceiling falls); water that is itself under tension does: without that the sides of a body
// that dives hold it back. For the walls of src/sea/sph; tested in tests/kernels/sph/boundary_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sph/eos_tait.hpp"
#include "kernels/sph/pair.hpp"

namespace spindrift::sph {

/// `sticks`: the water's velocity is wanted too.
template <int dim, bool sticks>
struct BoundaryExtrapolated {
  /// Sums of a wall particle over the water: W, p W, rho x W, and v W where it is wanted.
  static constexpr int planes = 2 + dim + (sticks ? dim : 0);
  /// How fast tension over the surface grows to that of the water beside it, over the slope of hydrostatics.
  static constexpr float over_surface = 4.0F;

  /// Adds one water particle: x = wall particle - water particle [m], its W, pressure, density, velocity.
  template <class Real>
  SPINDRIFT_INLINE static void add(Vec<Real, planes>& sums, const Vec<Real, dim>& x, Real w, Real pressure, Real rho,
                                   const Vec<Real, dim>& v) {
    sums[0] += w;
    sums[1] += pressure * w;
    const Real heavy = rho * w;
    for (int k = 0; k < dim; ++k) sums[2 + k] += heavy * x[k];
    if constexpr (sticks)
      for (int k = 0; k < dim; ++k) sums[2 + dim + k] += w * v[k];
  }

  /// Pressure [Pa] under a body force [m/s2]; zero without water.
  template <class Real>
  SPINDRIFT_INLINE static Real pressure(const Vec<Real, planes>& sums, const Vec<Real, dim>& body_force, Real least_sum) {
    Real total = sums[1];
    for (int k = 0; k < dim; ++k) total += body_force[k] * sums[2 + k];
    const Real least = min(sums[1], Real(0) - sums[1]);
    return max(select(total < Real(0), Real(over_surface) * total, total), least) *
           select(sums[0] > least_sum, reciprocal(max(sums[0], least_sum)), Real(0));
  }
  /// Velocity that makes water stick: the mirror of the water's in the wall's own.
  template <class Real>
  SPINDRIFT_INLINE static Real velocity(const Vec<Real, planes>& sums, int axis, Real wall, Real least_sum) {
    const Real mirrored = Real(2) * wall - sums[2 + dim + axis] * reciprocal(max(sums[0], least_sum));
    return select(sums[0] > least_sum, mirrored, wall);
  }
};

}  // namespace spindrift::sph
