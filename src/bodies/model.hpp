// What the bodies module is given: bodies, joints with their drivers, and sources of load. Plain values; the scene's options
// become these in options.cpp, tests write them down directly. Used by system.hpp and by whoever composes loads (src/coupling).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/rigid/joints.hpp"
#include "kernels/rigid/motion.hpp"
#include "kernels/rigid/prescribed_motion.hpp"
#include "kernels/rigid/wrench.hpp"

namespace spindrift::bodies {

inline constexpr int earth = Constraint::earth;  ///< body index of the fixed frame
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A rigid body. Inertia about the centre of mass in body axes; body axes are earth axes when initial.attitude is the identity.
struct Body {
  std::string name;
  double mass = 1.0;                                      ///< [kg]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity();  ///< [kg m2]
  /// False leaves out the gyroscopic moment: omega x (I omega) and, where the body spins on a revolute or cylindrical joint with
  /// a body that carries it, the part of its angular acceleration that is spin times the turning of that support
  /// (docs/theory/bodies.md).
  bool gyroscopic = true;
  bool on_beam = false;  ///< at an end of a beam
  Motion initial;
};

/// A joint as it stands in the initial configuration, earth axes. Angle and distance are those of body j relative to body i,
/// positive about and along `axis`, zero initially.
struct Joint {
  std::string name;
  JointType type = JointType::revolute;
  int i = earth, j = earth;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  Eigen::Vector3d second_axis = Eigen::Vector3d::Zero();  ///< universal: axis of the cross on body j, made perpendicular to axis
  std::optional<PrescribedMotion> rotation, translation;  ///< drivers [rad], [m]
};

/// What a source of load carries from one step to the next (a controller, the memory of waves, nodes of a line): plain values
/// that are part of the bodies' state, so that windows repeat and restarts go on with them, bit for bit.
struct Memory {
  std::size_t size = 0;  ///< values
  /// Fills the values at the start of a run, where the bodies are so.
  std::function<void(double t, std::span<const Motion>, std::span<double>)> begin;
  /// Loads evaluated after this are those with these values; with none they are the steady ones, as statics and modes want them.
  std::function<void(std::span<const double>)> recall;
  /// @pre `recall` was called with these values, which are those of t - h. @post they are those of t, where the bodies are so.
  std::function<void(double t, double h, std::span<const Motion>, std::span<double>)> remember;
};

/// Inertia of a source that ties the accelerations of two bodies together (a beam between them).
struct InertialCoupling {
  std::vector<std::array<int, 2>> pairs;  ///< of bodies i, j
  /// Adds for each pair the 6x6 matrix of the loads on i, [force; moment] about its centre of mass, per acceleration of j, earth
  /// axes; its transpose are the loads on j. Signs and what `loads` must not contain as for added mass.
  std::function<void(double t, std::span<const Motion>, std::span<Matrix6>)> blocks;
};

/// Loads on the bodies from one cause, kept apart in the output. `loads` ADDS to wrenches about each body's centre of mass (their
/// points are set); called in every right-hand-side evaluation, so it must not allocate. `added_mass`, where not empty, adds each
/// body's 6x6 matrix about its centre of mass, rows and columns [force; moment], earth axes: it goes on the left-hand side, so
/// `loads` must not contain -A a. What is neglected then: terms quadratic in the body's velocity from the change of A with
/// attitude.
struct LoadSource {
  std::string name;
  std::function<void(double t, std::span<const Motion>, std::span<Wrench>)> loads;
  std::function<void(double t, std::span<const Motion>, std::span<Matrix6>)> added_mass;
  std::optional<Memory> memory = std::nullopt;
  std::optional<InertialCoupling> coupling = std::nullopt;
};

/// A load that sets in at once and is stiff from there on: a line that snaps taut. A step that meets one is made in pieces short
/// enough to follow it (System::watch).
struct Onset {
  std::string name;
  std::function<bool(std::span<const Motion>)> acts;  ///< whether it does where the bodies are so; must not allocate
  double rate = 0.0;                                  ///< of the fastest motion while it acts, |eigenvalue| [1/s]
  /// It acts where the run begins, so the step has been chosen for it: only steps in which it sets in or ends are made in pieces.
  bool from_start = false;
};

}  // namespace spindrift::bodies
