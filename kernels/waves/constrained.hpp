// A random sea that has a crest of given height at a given time and place: the most likely sea of this spectrum that has it.
// Taylor, Jonathan & Harland (1997), J. Vibration and Acoustics 119, 442-447; without the random part the wave of Tromans,
// Anaturk & Hagemeijer (1991), NewWave. Called by src/sea/wave_field; tested in tests/kernels/waves/sea_states_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <complex>
#include <span>

#include "kernels/waves/components.hpp"

namespace spindrift::waves {

struct Crest {
  double height = 0.0;      ///< over still water [m]
  double time = 0.0;        ///< [s]
  double x = 0.0, y = 0.0;  ///< [m]
  bool background = true;   ///< false: the crest and what belongs to it alone
};

/// Changes amplitudes and phases so that elevation and its rate are crest.height and 0 there. With eta the random elevation, its
/// autocorrelation r, and the moments of the spectrum, eta + r (A - eta_0) + r' / lambda^2 eta'_0 is what is put in, harmonic by
/// harmonic.
inline void raise_crest(std::span<Component> components, const Crest& crest) {
  double energy = 0.0, rates = 0.0, level = 0.0, rate = 0.0;
  const auto phase_there = [&](const Component& c) {
    const double along = std::cos(c.direction) * crest.x + std::sin(c.direction) * crest.y;
    return c.wave_number * along - c.angular_frequency * crest.time + c.phase;
  };
  for (const Component& c : components) {
    const double a2 = c.amplitude * c.amplitude, psi = phase_there(c);
    energy += a2, rates += a2 * c.angular_frequency * c.angular_frequency;
    if (crest.background) level += c.amplitude * std::cos(psi), rate += c.amplitude * c.angular_frequency * std::sin(psi);
  }
  for (Component& c : components) {
    const double a = c.amplitude, psi = phase_there(c);
    const std::complex<double> random = crest.background ? std::polar(a, psi) : std::complex<double>(0.0);
    const std::complex<double> there =
        random + std::complex<double>((crest.height - level) * a * a / energy, -rate * a * a * c.angular_frequency / rates);
    const double changed = std::abs(there);
    c.speed_amplitude *= changed / a;
    c.amplitude = changed;
    c.phase += std::arg(there) - psi;
  }
}

}  // namespace spindrift::waves
