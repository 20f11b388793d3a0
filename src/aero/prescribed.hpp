// Thrust and torque that do not depend on the air: constant, Fourier series in azimuth, or a table in time.
// Used by rotor_loads.cpp; tested in tests/src/aero/prescribed_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "src/aero/options.hpp"

namespace spindrift::aero {

struct AxialLoad {
  double thrust = 0.0;  ///< [N]
  double torque = 0.0;  ///< [N m]
};

class Prescribed {
 public:
  explicit Prescribed(const AeroOptions& options);  ///< throws scene::SceneError where the table cannot be read
  AxialLoad operator()(double t, double azimuth) const;

 private:
  struct Series {
    double mean = 0.0;
    std::vector<double> cosine, sine;
  };
  Series thrust_, torque_;
  int harmonic_step_ = 1;
  // A table takes the place of the series. Slopes are empty for linear interpolation.
  std::vector<double> time_, table_thrust_, table_torque_, thrust_slope_, torque_slope_;
};

}  // namespace spindrift::aero
