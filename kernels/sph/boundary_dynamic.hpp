// DBC, dynamic boundary: wall particles obey continuity and the equation of state like water and do not move. Crespo,
// Gomez-Gesteira & Dalrymple (2007), CMC 5, 173. Their density is kept at or above rho0, so that walls push and never pull
// (Dominguez et al. 2022, Comput. Part. Mech. 9, section 2.6).
// Called by src/sea/sph/step.hpp; tested in tests/kernels/sph/boundary_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace spindrift::sph {

/// Density deviation of a dynamic boundary particle [kg/m3].
template <class Real>
Real boundary_dynamic(Real deviation) {
  return std::max(deviation, Real(0));
}

}  // namespace spindrift::sph
