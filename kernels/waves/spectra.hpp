// Spectra of wind seas: Pierson-Moskowitz and JONSWAP, one-sided in angular frequency.
// Hasselmann et al. (1973); form with significant height and peak period after DNV-RP-C205 (2010), section 3.5.5.
// Called by realisation.hpp and src/sea/wave_jonswap.cpp; tested in tests/kernels/waves/spectra_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "kernels/base/constants.hpp"

namespace spindrift::waves {

struct SeaState {
  double significant_height = 1.0;  ///< Hs [m], four times the standard deviation of the elevation
  double peak_period = 8.0;         ///< Tp [s]
  double peak_enhancement = 3.3;    ///< gamma [-]; 1 is Pierson-Moskowitz
};

/// S(omega) [m2 s/rad]. The Pierson-Moskowitz form integrates to Hs^2/16; gamma > 1 is brought back to that only within 1 %
/// by DNV's factor 1 - 0.287 ln gamma, so a realisation rescales (see sea_components).
inline double spectral_density(const SeaState& sea, double omega) {
  if (omega <= 0.0) return 0.0;
  const double peak = 2.0 * pi / sea.peak_period, ratio = peak / omega, r4 = ratio * ratio * ratio * ratio;
  const double hs = sea.significant_height;
  const double pierson_moskowitz = 5.0 / 16.0 * hs * hs * r4 / omega * std::exp(-1.25 * r4);
  const double width = omega <= peak ? 0.07 : 0.09, off = (omega - peak) / (width * peak);
  return (1.0 - 0.287 * std::log(sea.peak_enhancement)) * pierson_moskowitz *
         std::pow(sea.peak_enhancement, std::exp(-0.5 * off * off));
}

/// The peak enhancement DNV-RP-C205, 3.5.5.5 gives where nothing is known; Hs [m], Tp [s].
inline double peak_enhancement(double significant_height, double peak_period) {
  const double ratio = peak_period / std::sqrt(significant_height);
  return ratio <= 3.6 ? 5.0 : ratio >= 5.0 ? 1.0 : std::exp(5.75 - 1.15 * ratio);
}

}  // namespace spindrift::waves
