// One realisation of a sea state: harmonics with fixed amplitudes and random phases (Tucker, Challenor & Carter 1984,
// deterministic amplitudes). The same seed gives the same sea on every computer. The amplitudes are scaled so that sum a^2/2 =
// Hs^2/16 exactly, which makes up for the cut tail (0.2 % of the energy) and for DNV's approximate normalisation. Called by
// src/sea/wave_models.cpp; tested in tests/kernels/waves/spectra_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kernels/base/random.hpp"
#include "kernels/waves/components.hpp"
#include "kernels/waves/dispersion.hpp"
#include "kernels/waves/spectra.hpp"

namespace spindrift::waves {

/// Frequencies that are covered, in peaks: below 0.5 lies 2e-9 of the energy, above 5 some 0.2 %.
inline constexpr double lowest_in_peaks = 0.5, highest_in_peaks = 5.0;

/// Equal steps of frequency, amplitude from the spectrum at mid-step. Repeats after 2 pi / step.
inline void equal_frequency(const SeaState& sea, std::span<Component> components) {
  const double peak = 2.0 * pi / sea.peak_period, low = lowest_in_peaks * peak;
  const double step = (highest_in_peaks - lowest_in_peaks) * peak / double(components.size());
  for (std::size_t i = 0; i < components.size(); ++i) {
    components[i].angular_frequency = low + (double(i) + 0.5) * step;
    components[i].amplitude = std::sqrt(2.0 * spectral_density(sea, components[i].angular_frequency) * step);
  }
}

/// Equal shares of the energy, each at the frequency that halves its share: dense where the energy is, and no common period.
inline void equal_energy(const SeaState& sea, std::span<Component> components) {
  constexpr int cells = 20000;
  const double peak = 2.0 * pi / sea.peak_period, low = lowest_in_peaks * peak;
  const double step = (highest_in_peaks - lowest_in_peaks) * peak / cells;
  const auto cell_energy = [&](int cell) { return step * spectral_density(sea, low + (cell + 0.5) * step); };
  double total = 0.0;
  for (int cell = 0; cell < cells; ++cell) total += cell_energy(cell);
  const double share = total / double(components.size());
  double before = 0.0;
  int cell = 0;
  for (std::size_t i = 0; i < components.size(); ++i) {
    const double target = (double(i) + 0.5) * share;
    double here = cell_energy(cell);
    while (before + here < target && cell + 1 < cells) before += here, here = cell_energy(++cell);
    components[i].angular_frequency = low + (cell + (target - before) / here) * step;
    components[i].amplitude = std::sqrt(2.0 * share);
  }
}

/// Completes components whose frequency and amplitude are set: exact significant height, random phase, Airy kinematics.
inline void finish_realisation(const SeaState& sea, std::uint64_t seed, double direction, double depth, double gravity,
                               std::span<Component> components) {
  double variance = 0.0;
  for (const Component& c : components) variance += 0.5 * c.amplitude * c.amplitude;
  const double scale = 0.25 * sea.significant_height / std::sqrt(variance);
  Random random(seed);
  for (Component& c : components) {
    c.amplitude *= scale;
    c.speed_amplitude = c.amplitude * c.angular_frequency;
    c.wave_number = wave_number(c.angular_frequency, depth, gravity);
    c.phase = 2.0 * pi * random.uniform();
    c.direction = direction;
  }
}

}  // namespace spindrift::waves
