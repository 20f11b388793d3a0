// Steady operation of a turbine: rotor speed, blade pitch and power against wind, as its maker publishes them.
// Read from the CSV file that a scene or its turbine file names; used by scenario.cpp (operating point), turbine_control.cpp and
// the Campbell table of src/coupling; tested in tests/src/aero/operation_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace spindrift::aero {

struct OperatingPoint {
  double speed = 0.0, pitch = 0.0;  ///< [rad/s], [rad]
};

struct Operation {
  std::vector<double> wind;   ///< at the hub, increasing [m/s]
  std::vector<double> speed;  ///< of the rotor [rad/s]
  std::vector<double> pitch;  ///< of the blades, nose into the wind positive [rad]; empty where the file gives none
  std::vector<double> power;  ///< mechanical [W]; empty where the file gives none

  /// Straight lines between the rows; beyond them the first and the last row hold.
  OperatingPoint at(double wind_m_s) const;

  /// K of the torque law Q = K omega^2 [N m s2/rad2] that holds the table's own tip-speed ratio: mean of P / omega^3 over the
  /// rows between the least and the rated speed; nothing where there are none.
  std::optional<double> torque_gain() const;
  /// The first row whose power is above this share of the largest, without powers whose speed is; the number of rows where none.
  std::size_t first_above(double share) const;
  /// The rows below rated power, without powers below rated speed: what the blades are pitched to where power is not limited.
  /// Of the last of them above it.
  Operation below_rated() const;
};

/// Throws scene::SceneError where the file is not such a table.
Operation read_operation(const std::string& path);

}  // namespace spindrift::aero
