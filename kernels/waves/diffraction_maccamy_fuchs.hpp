// Inertia load of linear waves on an upright round column that scatters them: MacCamy & Fuchs (1954), Beach Erosion Board Tech.
// Memo. 69. Called by src/sea/wave_field; tested in tests/kernels/waves/sea_states_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <complex>

#include "kernels/base/constants.hpp"

namespace spindrift::waves {

/// The inertia coefficient 1 + C_a of a section, as a complex number: the load per length is its real part times e^(i psi), of
/// the mass of the displaced water times the undisturbed acceleration at the axis. ka: wave number times radius. Tends to 2 in
/// long waves. 4 i / (pi (ka)^2 H_1'(ka)), with Hankel's function of the first kind.
inline std::complex<double> maccamy_fuchs(double ka) {
  if (ka < 1e-6) return 2.0;
  const double j = std::cyl_bessel_j(0.0, ka) - std::cyl_bessel_j(1.0, ka) / ka;
  const double y = std::cyl_neumann(0.0, ka) - std::cyl_neumann(1.0, ka) / ka;
  return std::complex<double>(0.0, 4.0 / (pi * ka * ka)) / std::complex<double>(j, y);
}

}  // namespace spindrift::waves
