// Hydrodynamic coefficients of one body as WAMIT's files give them, made dimensional: added mass and damping (.1), wave exciting
// forces (.3), hydrostatic stiffness (.hst). WAMIT user manual, chapter 4 (numeric output files, 1-based modes, exp(+i w t)).
// Read by potential.cpp; tested in tests/src/sea/wamit_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <string>
#include <vector>

namespace spindrift::sea {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// What the numbers of a file are made dimensional with.
struct WamitScale {
  double length = 1.0;       ///< ULEN [m]
  double density = 1025.0;   ///< [kg/m3]
  double gravity = 9.80665;  ///< [m/s2]
};

struct WamitRadiation {
  std::vector<double> omega;  ///< increasing [rad/s]
  std::vector<Matrix6> added_mass, damping;
  std::optional<Matrix6> zero, infinite;  ///< added mass at these frequencies, where the file has them
};

struct WamitExcitation {
  std::vector<double> omega;    ///< increasing [rad/s]
  std::vector<double> heading;  ///< towards which the waves travel, increasing [rad]
  /// Force per wave amplitude [N/m], [N m/m], by [frequency * headings + heading]; real part of X exp(i w t) for a wave with a
  /// crest at the origin at t = 0.
  std::vector<Eigen::Matrix<std::complex<double>, 6, 1>> force;

  /// Linear in both; below the first frequency it holds, beyond the last there is none.
  Eigen::Matrix<std::complex<double>, 6, 1> at(double omega, double heading) const;
};

// They throw scene::SceneError naming file and line.
WamitRadiation read_radiation(const std::string& path, const WamitScale& scale);
WamitExcitation read_excitation(const std::string& path, const WamitScale& scale);
Matrix6 read_hydrostatics(const std::string& path, const WamitScale& scale);

}  // namespace spindrift::sea
