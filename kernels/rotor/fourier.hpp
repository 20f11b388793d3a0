// A load as a Fourier series in the rotor's azimuth, as the paper gives its thrust with the tower behind the blades
// (Leble & Barakos 2016, fig. 13). Used by src/aero/prescribed.cpp; tested in tests/kernels/rotor/fourier_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace spindrift {

/// mean + sum over k = 1 ... of cosine[k-1] cos(k angle) + sine[k-1] sin(k angle). The lists may differ in length.
/// By the recurrence of the rotation, one sine and cosine for all harmonics; its error grows by one rounding per harmonic.
inline double fourier(double mean, std::span<const double> cosine, std::span<const double> sine, double angle) {
  const double c1 = std::cos(angle), s1 = std::sin(angle);
  double sum = mean, c = 1.0, s = 0.0;
  for (std::size_t k = 0; k < std::max(cosine.size(), sine.size()); ++k) {
    const double next = c * c1 - s * s1;
    s = s * c1 + c * s1, c = next;
    if (k < cosine.size()) sum += cosine[k] * c;
    if (k < sine.size()) sum += sine[k] * s;
  }
  return sum;
}

}  // namespace spindrift
