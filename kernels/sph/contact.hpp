// Contact of two solid particles closer than a spacing: a spring as stiff as water, a damper that never pulls, and friction of
// Coulomb made smooth at low speed. Our own choice in the family of the distinct element method (Cundall & Strack 1979,
// Geotechnique 29, 47; with particles of SPH Canelas et al. 2016, Appl. Ocean Res. 58): since the outermost particles stand half
// a spacing inside a surface, surfaces touch where particles are one spacing apart.
//   stiffness k = s m c0^2/d^2: a face of particles pushed in by its spacing is pressed with s rho0 c0^2, so a body meets a wall
//   as it meets water, and the step that water allows (2 sqrt(w n) d/c0 for n layers of relative weight w) holds for s = 1;
//   damping c = 2 zeta sqrt(k m) along the line of centres; friction mu f_n against the sliding, c v_t where that is less.
// Called by src/sea/sph/contact.hpp; tested in tests/kernels/sph/contact_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/sph/pair.hpp"

namespace spindrift::sph {

struct Contact {
  double spacing;    ///< d [m]
  double stiffness;  ///< k [N/m] (per metre of width in 2-D)
  double damping;    ///< c [N s/m]
  double friction;   ///< mu [-]

  Contact(double spacing_m, double mass, double c0, double stiffness_ratio, double damping_ratio, double friction_coefficient)
      : spacing(spacing_m),
        stiffness(stiffness_ratio * mass * c0 * c0 / (spacing_m * spacing_m)),
        damping(2.0 * damping_ratio * std::sqrt(stiffness * mass)),
        friction(friction_coefficient) {}

  /// Force on i [N] of a partner at separation x_ij = x_i - x_j and relative velocity v_ij.
  template <int dim>
  Vec<double, dim> force(const Vec<double, dim>& x_ij, const Vec<double, dim>& v_ij) const {
    const double r2 = dot(x_ij, x_ij);
    if (r2 >= spacing * spacing) return {};
    const double r = std::sqrt(std::max(r2, 1e-30));
    const Vec<double, dim> normal = (1.0 / r) * x_ij;
    const double v_n = dot(v_ij, normal), f_n = std::max(0.0, stiffness * (spacing - r) - damping * v_n);
    const Vec<double, dim> sliding = v_ij - v_n * normal;
    const double speed = std::sqrt(dot(sliding, sliding));
    const double drag = speed > 0.0 ? std::min(friction * f_n / speed, friction > 0.0 ? damping : 0.0) : 0.0;
    return f_n * normal - drag * sliding;
  }
};

}  // namespace spindrift::sph
