// Largest ratio r = fluid's added mass / structural mass at which loose coupling is stable, at any step: the added mass acts as
// the load y = -r a that F finds from the velocities it was given, backward Euler both. Growth per window is the largest root of
// the scheme's characteristic polynomial, which does not know the step once stiffness and damping are small against m / dt^2.
// Causin, Gerbeau & Nobile (2005); Foerster, Wall & Ramm (2007): extrapolation of order 0, 1, 2 gives 1, 1/3, 1/7 (derived in
// docs/theory/coupling.md). Used by src/coupling/campbell.cpp; tested against marched windows in tests/verification/coupling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kernels/coupling/staggered.hpp"

namespace spindrift::coupling {

/// Modulus of the largest root of c[0] + c[1] z + ... + c[n] z^n, by the companion matrix; leading zeros are dropped.
double largest_root(std::vector<double> c);

// Characteristic polynomials of the acceleration under loads of ratio r, by rising power of the growth z; stable when every root
// is within 1. S gives a_{n+1} = the load it is given (per mass), F gives y_{n+1} = -r (given velocity_{n+1} - given
// velocity_n) / dt.

/// css: S takes y extrapolated to the order, F the new velocity: y_n = -r a_n.
inline std::vector<double> css_polynomial(int order, double r) {
  if (order == 0) return {r, 1.0};
  if (order == 1) return {-r, 2.0 * r, 1.0};
  return {r, -3.0 * r, 3.0 * r, 1.0};
}
/// cps: F is given v_n for the window n to n+1, so y_{n+1} = -r a_n; a_{n+1} = y_n.
inline std::vector<double> cps_polynomial(double r) { return {r, 0.0, 1.0}; }
/// cps2: F is given 2 v_n - v_{n-1}, so y_{n+1} = -r (2 a_n - a_{n-1}); a_{n+1} = 2 y_n - y_{n-1}: z^4 + r (2 z - 1)^2.
inline std::vector<double> cps2_polynomial(double r) { return {r, -4.0 * r, 4.0 * r, 0.0, 1.0}; }
/// css0 with positions predicted by x_n + dt (3/2 v_n - 1/2 v_{n-1}) and F differencing those: y_{n+1} is
/// -r (5/2 a_n - 2 a_{n-1} + 1/2 a_{n-2}), and S takes it in the same window.
inline std::vector<double> predicted_position_polynomial(double r) { return {0.5 * r, -2.0 * r, 2.5 * r, 1.0}; }

/// Largest r whose polynomial has all roots within the unit circle, by bisection.
template <class Polynomial>
double stability_ratio(Polynomial polynomial) {
  double low = 0.0, high = 1e3;
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (largest_root(polynomial(middle)) <= 1.0 + 1e-12 ? low : high) = middle;
  }
  return low;
}

/// S, linear: x' = matrix x + input y over a window; F: y = output x at the motion that it is given. What S has of its own,
/// springs and rigid motions of all bodies, decides with the scheme's history when the load makes it grow.
struct LooseLoop {
  Eigen::MatrixXd matrix;  ///< under a load that does not change
  Eigen::MatrixXd input;
  Eigen::MatrixXd output;
};

/// Modulus of the largest eigenvalue of what a window makes of (x, y at the motion before, the last three loads).
double growth(const LooseLoop& loop, const Staggering& scheme, double window);

/// The least window, from `shortest` on, in which the loop grows faster than exp(`rate` t); infinite where none up to `longest`
/// does.
double window_limit(const LooseLoop& loop, const Staggering& scheme, double rate, double shortest, double longest);

}  // namespace spindrift::coupling
