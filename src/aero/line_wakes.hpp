// What actuator lines miss of the velocity of their own helical wake, since their forces are spread over a width, as matrices
// from the circulations of a blade's elements to the winds there. Method: docs/theory/actuator.md; kernel:
// kernels/rotor/actuator_line.hpp. Used by actuator.cpp; tested in tests/src/aero/actuator_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <map>
#include <span>
#include <vector>

#include "src/aero/bem.hpp"

namespace spindrift::aero {

class LineWakes {
 public:
  /// `width`: of the force's kernel, by element [m].
  LineWakes(const BladeElementMomentum& sections, std::span<const double> width, int blades);

  /// By helix angle at the tip [rad]: what the winds lack at the elements of a blade per circulation of the elements of the blade
  /// `later` places ahead [1/m].
  struct Matrix {
    std::vector<double> normal, tangential;  ///< [later][at][of]
  };
  /// Linear between angles that are a step apart; what was made for those is kept. @pre the angle is in the open range below.
  Matrix at(double angle);
  static constexpr double step = 0.01, least_angle = 0.02;  ///< [rad]; angles up to pi - least_angle - step

 private:
  const Matrix& of_level(int level);

  std::vector<BladeElementMomentum::BladeSection> sections_;
  std::vector<double> width_;
  double tip_radius_;
  int blades_;
  std::map<int, Matrix> made_;  ///< by angle over the step
};

}  // namespace spindrift::aero
