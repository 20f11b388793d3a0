// The Verlet step of SPH, one evaluation of the rates:
//   v' = v(n-1) + 2 dt a,  rho' = rho(n-1) + 2 dt R,  x' = x + dt v + dt^2/2 a;
// every so many steps (40 is usual) v' = v + dt a, rho' = rho + dt R instead, since the odd and even chains drift apart.
// Verlet (1967), Phys. Rev. 159; for SPH Gomez-Gesteira et al. (2012), Comput. Geosci. 48, 289, section 2.7.
// Called by src/sea/sph/step.hpp; tested in tests/kernels/sph/step_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace spindrift::sph {

struct StepVerlet {
  template <class Real>
  static Real leap(Real value_before, Real rate, Real dt) {
    return value_before + Real(2) * dt * rate;
  }
  template <class Real>
  static Real join(Real value, Real rate, Real dt) {
    return value + dt * rate;
  }
  template <class Real>
  static Real position(Real x, Real v, Real acceleration, Real dt) {
    return x + dt * (v + Real(0.5) * dt * acceleration);
  }
};

}  // namespace spindrift::sph
