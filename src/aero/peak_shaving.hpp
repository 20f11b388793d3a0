// Peak shaving: the least blade pitch against wind that keeps a rotor's steady thrust below a share of its largest. Thrust peaks
// at rated wind; blades that are pitched a little farther there trade some power for load. After the minimum-pitch schedule of
// ROSCO's PS_Mode, Abbas et al. (2022), Wind Energy Science 7, 53-73: docs/theory/rotor_engineering.md. Used by rotor_loads.cpp;
// tested in tests/src/aero/peak_shaving_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "kernels/rotor/controller_dtu.hpp"
#include "src/aero/operation.hpp"
#include "src/aero/prescribed.hpp"

namespace spindrift::aero {

/// Of a rotor in steady wind along its axis [m/s], at a rotor speed [rad/s] and a blade pitch [rad].
using SteadyLoad = std::function<AxialLoad(double wind, double speed, double pitch)>;

struct PeakShaving {
  double largest = 0.0, largest_at = 0.0;  ///< thrust without it [N], and the wind [m/s]
  double limit = 0.0;                      ///< of the thrust [N]
  std::vector<double> wind, pitch;         ///< least pitch [rad] against wind [m/s]
  double from = 0.0, to = 0.0;             ///< winds between which blades are pitched farther than without it [m/s]
  double farthest = 0.0;                   ///< by so much [rad]

  double least_pitch(double wind_m_s) const;
};

/// `law` and `operation`: of the controller, whose own least pitch stays. `share`: of the largest thrust.
PeakShaving shave_peak(const SteadyLoad& load, const ControllerDtu& law, const Operation& operation, double share);

}  // namespace spindrift::aero
