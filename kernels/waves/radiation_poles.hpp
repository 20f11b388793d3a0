// Radiation memory as decaying oscillations, K(t) = sum Re{c exp(p t)}, so that its convolution with a velocity is a state for
// each pole. Poles by the singular values of the Hankel matrix of K's samples (Kung 1978, 12th Asilomar conference, 705; for
// floating bodies Kristiansen, Hjulstad & Egeland 2005, Ocean Eng. 32, 2195), c by least squares. Theory:
// docs/theory/sea_engineering.md. Used by src/sea/radiation.cpp; tested in tests/kernels/waves/radiation_poles_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <complex>
#include <span>
#include <vector>

namespace spindrift::waves {

/// Sum of Re{c exp(p t)}, one of each pair of complex poles.
struct RadiationPoles {
  std::vector<std::complex<double>> pole, weight;  ///< p [1/s], Re p < 0; c
  double error = 0.0;                              ///< root mean square, of the samples [their unit]

  double at(double t) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < pole.size(); ++k) sum += (weight[k] * std::exp(pole[k] * t)).real();
    return sum;
  }
};

/// int_0^s exp(p (s - x)) v(x) dx for v straight from v0 at 0 to v1 at s; exact.
inline std::complex<double> pole_response(std::complex<double> p, double s, double v0, double v1) {
  const std::complex<double> z = p * s;
  std::complex<double> first, second;  // (e^z - 1) / z, (e^z - 1 - z) / z^2
  if (std::abs(z) < 0.1) {
    std::complex<double> term = 1.0;
    for (int n = 1; n <= 8; ++n) first += term / double(n), second += term / double(n * (n + 1)), term *= z / double(n);
  } else {
    first = (std::exp(z) - 1.0) / z, second = (first - 1.0) / z;
  }
  return s * (v0 * first + (v1 - v0) * second);
}

/// The fewest poles (`most_poles` at most, pairs counted twice) that reproduce K at 0, h, 2h ... to a root mean square of
/// `tolerance`; the best found where none does. At least nine samples.
RadiationPoles fit_radiation_poles(std::span<const double> samples, double h, double tolerance, int most_poles = 24);

}  // namespace spindrift::waves
