// A mooring line as one linear spring and damper between its ends, after Savenije et al. (2010); the model of Leble & Barakos
// (2016), Table 3, whose lines both pull and push. The tension-only variant is ours. Equations: docs/theory/moorings.md. Called
// through src/moorings; tested in tests/kernels/mooring/line_spring_damper_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/mooring/line.hpp"

namespace spindrift {

/// T = k (l - l0) + c dl/dt along the chord. A tension-only line carries nothing below its rest length and never pushes.
struct LineSpringDamper {
  static constexpr std::string_view name = "spring_damper";
  double rest_length = 0.0;    ///< l0 [m]
  double stiffness_N_m = 0.0;  ///< k [N/m]; EA / l0 for a line given by its axial stiffness
  double damping = 0.0;        ///< c [N s/m]
  bool tension_only = false;

  double tension(double length, double rate) const {
    const double t = stiffness_N_m * (length - rest_length) + damping * rate;
    const bool slack = tension_only && (length <= rest_length || t < 0.0);
    return slack ? 0.0 : t;
  }

  LineForces forces(const Eigen::Vector3d& span, const Eigen::Vector3d& rate) const {
    const double length = span.norm();
    return chord_forces(span, tension(length, length > 0.0 ? span.dot(rate) / length : 0.0));
  }

  /// At the rest length of a tension-only line: that of the slack side, zero.
  Eigen::Matrix3d stiffness(const Eigen::Vector3d& span) const {
    const double length = span.norm();
    if (tension_only && length <= rest_length) return Eigen::Matrix3d::Zero();
    return chord_stiffness(span, stiffness_N_m * (length - rest_length), stiffness_N_m);
  }
};
static_assert(MooringLine<LineSpringDamper>);

}  // namespace spindrift
