// Stable step limits of the integrators of kernels/rigid/integrators.hpp from the eigenvalues of the linearised system.
// rk4, explicit_euler: |R(lambda h)| <= 1 with the stability polynomial R (Hairer & Wanner 1996, Solving ODEs II, chapter IV.2).
// symplectic: spectral radius of the step of the damped oscillator x'' = -|lambda|^2 x + 2 Re(lambda) x' <= 1; without damping
// omega h <= 2. Growth that the system itself has (Re lambda > 0) is not the integrator's: such a mode counts as undamped.
// Used by src/bodies/linearise.cpp; tested at 0.95 and 1.05 of the limit in tests/kernels/rigid/integrators_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <complex>
#include <limits>

#include "kernels/rigid/integrators.hpp"

namespace spindrift {

/// Damping ratios below this are round-off of the linearisation: the mode is undamped.
inline constexpr double undamped_ratio = 1e-6;

/// Amplification of one step of h on the mode lambda: |R(z)|, or the spectral radius of the symplectic step; z = lambda h.
inline double amplification(Integrator integrator, std::complex<double> z) {
  if (integrator == Integrator::explicit_euler) return std::abs(1.0 + z);
  if (integrator == Integrator::rk4) return std::abs(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0))));
  const double k = std::norm(z), c = -2.0 * z.real();  // x'' = -k x - c x', step 1; rows: x1, v1 from x, v
  const double xx = 1.0 - k / 2, xv = 1.0 - c / 2;
  const double vx = -k / 2 - k / 2 * xx + c * k / 2, vv = xv - k / 2 * xv - c / 2 * (1.0 - c);
  const std::complex<double> half_trace = (xx + vv) / 2, root = std::sqrt(half_trace * half_trace - (xx * vv - xv * vx));
  return std::max(std::abs(half_trace + root), std::abs(half_trace - root));
}

/// Largest step [s] that keeps the mode lambda [1/s] from growing; 0 where no step does, infinity where every step does.
/// A real eigenvalue under `symplectic` is taken as one of a critically damped pair, its worst partner: the limit is then at most
/// a factor of two on the safe side.
inline double stability_limit(Integrator integrator, std::complex<double> lambda) {
  const double size = std::abs(lambda);
  if (size == 0.0) return std::numeric_limits<double>::infinity();
  const bool oscillates = std::abs(lambda.imag()) > undamped_ratio * size;
  if (!oscillates && lambda.real() > 0.0) return std::numeric_limits<double>::infinity();
  if (!(-lambda.real() > undamped_ratio * size)) lambda = {0.0, size};
  const std::complex<double> direction = lambda / size;
  if (integrator == Integrator::explicit_euler) return lambda.real() < 0.0 ? -2.0 * direction.real() / size : 0.0;
  constexpr double grows = 1.0 + 1e-9,
                   scan = 1e-3;  // no crossing before |z| = scan: both schemes contain a disc-like region there
  double low = scan;
  while (amplification(integrator, (low + scan) * direction) <= grows) low += scan;
  double high = low + scan;
  for (int bisection = 0; bisection < 40; ++bisection) {
    const double middle = 0.5 * (low + high);
    (amplification(integrator, middle * direction) <= grows ? low : high) = middle;
  }
  return low / size;
}

}  // namespace spindrift
