// Flexible beams between bodies, such as a tower between platform and nacelle: a source of load with inertia of its own, no
// state. The mathematics is in kernels/beam/modal_link.hpp. Made from [beams.NAME] in beam_options.cpp, composed by src/coupling;
// tested in tests/src/bodies/beams_test.cpp. Theory: docs/theory/structure.md. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kernels/beam/modal_link.hpp"
#include "src/bodies/model.hpp"

namespace spindrift::bodies {

/// Points and axes are in body axes from the centre of mass; those of the earth where i is earth.
struct Beam {
  std::string name;
  int i = earth, j = 0;  ///< body at its start (or earth), body at its end
  Eigen::Vector3d start = Eigen::Vector3d::Zero(), end = Eigen::Vector3d::Zero();
  Eigen::Matrix3d start_axes = Eigen::Matrix3d::Identity(), end_axes = Eigen::Matrix3d::Identity();  ///< of the beam, z along it
  beam::ModalLink link;
};

/// A beam as the bodies stand initially, earth coordinates.
struct BeamPlan {
  std::string name;
  int i = earth, j = 0;                                              ///< as in Beam
  Eigen::Vector3d start = Eigen::Vector3d::Zero(), end = {0, 0, 1};  ///< [m]
  Eigen::Vector3d across = Eigen::Vector3d::UnitX();                 ///< along its x, as far as square to the beam
  beam::Properties properties;
  std::array<double, 2> damping{0, 0};  ///< as in beam::LinkEnd
};

/// All beams of a system. The modes of each see one body at its end: all that joints and other beams tie to it, in the order of
/// `plans`.
std::vector<Beam> make_beams(const std::vector<BeamPlan>& plans, std::span<const Body> bodies, std::span<const Joint> joints);

/// Loads of all beams, their weight by the acceleration `gravity` included.
LoadSource beam_source(std::vector<Beam> beams, const Eigen::Vector3d& gravity_m_s2);

/// How a beam is bent and what it carries. Loads are those of the side of the end on the side of the start, in the beam's axes
/// there, about its two ends.
struct BeamReading {
  Eigen::Vector3d displacement, rotation;  ///< of the end relative to the start, its axes [m], rotation vector [rad]
  Eigen::Vector3d start_force, start_moment, end_force, end_moment;
};
/// Accelerations of centres of mass and of rotation in earth axes, as System::evaluate gives them.
BeamReading read_beam(const Beam& beam, std::span<const Motion> motions, std::span<const Eigen::Vector3d> acceleration,
                      std::span<const Eigen::Vector3d> angular_acceleration, const Eigen::Vector3d& gravity_m_s2);

/// Elastic, kinetic and potential energy of a beam [J].
double beam_energy(const Beam& beam, std::span<const Motion> motions, const Eigen::Vector3d& gravity_m_s2);

}  // namespace spindrift::bodies
