// Short-crested seas: each harmonic travels in a direction of its own, drawn from D(b) ~ |cos(pi (b - mean) / range)|^2s over
// mean +- range/2. With a range of 360 degrees this is the cosine-2s of Longuet-Higgins, Cartwright & Smith (1963), with 180
// degrees cos^2s of DNV-RP-C205 (2010), 3.5.8. One direction to a frequency keeps the sea homogeneous, as Jefferys (1987),
// Applied Ocean Research 9, 74-83, has it. Called by src/sea/wave_field; tested in tests/kernels/waves/sea_states_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/base/random.hpp"
#include "kernels/waves/components.hpp"

namespace spindrift::waves {

/// Cumulative share of D over mean - range/2 to mean + range/2, at equal steps.
inline std::vector<double> spreading_shares(double exponent, int cells) {
  std::vector<double> share(std::size_t(cells) + 1, 0.0);
  for (int i = 0; i < cells; ++i)
    share[std::size_t(i) + 1] = share[std::size_t(i)] + std::pow(std::cos(pi * ((i + 0.5) / cells - 0.5)), 2.0 * exponent);
  for (double& s : share) s /= share.back();
  return share;
}

/// Turns the harmonics from the direction that they share. Shares are drawn by the golden ratio's sequence from a random start,
/// so that every band of neighbouring frequencies has all directions in proportion.
inline void spread(std::span<Component> components, double exponent, double range, std::uint64_t seed) {
  constexpr int cells = 4096;
  const std::vector<double> shares = spreading_shares(exponent, cells);
  Random random(seed ^ 0x5eedd12ec7104eadu);  // other numbers than those of the phases
  double drawn = random.uniform();
  for (Component& c : components) {
    const auto above = std::upper_bound(shares.begin() + 1, shares.end() - 1, drawn);
    const double low = *(above - 1), inside = *above > low ? (drawn - low) / (*above - low) : 0.5;
    c.direction += range * ((double(above - 1 - shares.begin()) + inside) / cells - 0.5);
    drawn += 0.61803398874989484820;
    if (drawn >= 1.0) drawn -= 1.0;
  }
}

}  // namespace spindrift::waves
