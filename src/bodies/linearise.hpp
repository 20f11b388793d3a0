// The loaded system linearised about a state: modes with their names, and the largest stable step of each integrator.
// d/dt (x, u) = A (x, u) in the chart of the state, in axes that do not turn with the bodies, by central differences of the
// system's own rates: added mass, drivers, joints and every source of load are in it. Theory: docs/theory/bodies.md, "Stability".
// Used by `spindrift check` through src/coupling; tested in tests/src/bodies/linearise_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <span>
#include <string>
#include <vector>

#include "src/bodies/system.hpp"

namespace spindrift::bodies {

/// Of a body: translations and turns about x, y, z.
inline constexpr std::array freedom_names{"surge", "sway", "heave", "roll", "pitch", "yaw"};

/// One eigenvalue; of a conjugate pair the one with positive imaginary part.
struct Mode {
  std::complex<double> eigenvalue;  ///< [1/s]
  std::string name;                 ///< "heave of platform": the direction with the largest share of kinetic energy
  double period_s() const;          ///< of the damped oscillation; infinite for a real eigenvalue
  double damping_ratio() const;
};

struct Linearisation {
  Eigen::MatrixXd matrix;                           ///< A, 2n x 2n: chart positions, then velocities
  std::vector<Mode> modes;                          ///< fastest first; free directions have eigenvalue 0
  StepReport report;                                ///< not ok(): the state could not be evaluated, no modes
  Eigen::Index freedoms_without_stiffness() const;  ///< n less the rank of A's stiffness
};

Linearisation linearise(System& system, const BodiesState& state, double t_s);

/// Largest stable step and the mode that sets it ("" where nothing limits the step).
struct StepLimit {
  double step_s;
  std::string mode;
  std::complex<double> eigenvalue;
};
StepLimit step_limit(Integrator integrator, const Linearisation& linearisation);

/// A unit force along `direction` at a point of a body, earth axes.
struct Pull {
  std::size_t body;
  Eigen::Vector3d point, direction;
};
/// By what unit forces together accelerate their points along themselves [1/kg]: joints and added mass are in it. 0 where nothing
/// can move or the state cannot be evaluated.
double mobility(System& system, const BodiesState& state, std::span<const Pull> pulls);

/// "heave of platform" for the direction, in the chart of the last open_chart, with the largest share of kinetic energy.
std::string direction_name(const System& system, const BodiesState& state, const Eigen::VectorXd& chart_direction);

}  // namespace spindrift::bodies
