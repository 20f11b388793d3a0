// Hydrodynamic coefficients of one body as WAMIT's files give them, made dimensional: added mass and damping (.1), wave exciting
// forces (.3), hydrostatic stiffness (.hst), loads of second order (.8, .9, .12d, .12s and their like). WAMIT user manual,
// chapter 4 (numeric output files, 1-based modes, exp(+i w t)). Read by potential.cpp; tested in tests/src/sea/wamit_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "kernels/waves/components.hpp"

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

/// Mean drift of second order.
struct WamitDrift {
  std::vector<double> omega, heading;  ///< as those of WamitExcitation
  /// Force per squared wave amplitude [N/m2], [N m/m2], by [frequency * headings + heading].
  std::vector<Eigen::Matrix<double, 6, 1>> force;

  /// Linear in both, in a straight line to none at no frequency, none beyond the last.
  Eigen::Matrix<double, 6, 1> at(double omega, double heading) const;
};

/// Loads of second order at differences or sums of two frequencies, of waves in one direction.
enum class FrequencyPair { difference, sum };
struct WamitQuadratic {
  std::vector<double> omega, heading;  ///< as those of WamitExcitation
  std::array<bool, 6> has_mode{};
  /// Force per product of amplitudes [N/m2], [N m/m2], by mode and [(first * frequencies + second) * headings + heading]; real
  /// part of a_1 a_2* T exp(i (w_1 - w_2) t), or of a_1 a_2 T exp(i (w_1 + w_2) t), summed over all ordered pairs.
  std::array<std::vector<std::complex<double>>, 6> transfer;

  /// Linear in all three; below the first frequency it holds, beyond the last there is none.
  std::complex<double> at(int mode, double first_omega, double second_omega, double heading) const;
};

/// Whether a direction of waves is among a file's headings, whole turns aside, or between the last and the first where they go
/// round the circle. The functions `at` take no other.
bool covers(const std::vector<double>& headings, double direction);
/// Throws scene::SceneError by key where the headings of a file do not cover a wave.
void require_headings(const std::string& path, const std::vector<double>& headings, const std::vector<waves::Component>& waves);

// They throw scene::SceneError naming file and line.
WamitRadiation read_radiation(const std::string& path, const WamitScale& scale);
WamitExcitation read_excitation(const std::string& path, const WamitScale& scale);
Matrix6 read_hydrostatics(const std::string& path, const WamitScale& scale);
/// Of the files .7, .8, .9 (headings of equal pairs), or the equal frequencies of .10d, .11d, .12d: told apart by their columns.
WamitDrift read_drift(const std::string& path, const WamitScale& scale);
/// Of .10d, .11d, .12d or .10s, .11s, .12s; every pair of the file's frequencies must be there in one order.
WamitQuadratic read_quadratic(const std::string& path, const WamitScale& scale, FrequencyPair kind);

}  // namespace spindrift::sea
