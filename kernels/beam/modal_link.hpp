// A flexible beam between two rigid bodies that bends in the first two modes of each plane: its deflection is what the end's
// displacement and slope say, seen from the start, so that the modes' coordinates are those of the bodies and no state is added.
// Inertia of the whole beam, weight, geometric stiffness by the shortening of the bent beam, elastic extension and twist.
// Modes and shortening as in ElastoDyn (Jonkman & Buhl 2005, FAST User's Guide, NREL/EL-500-38230); floating frame of reference:
// Shabana (2013), Dynamics of Multibody Systems, 4th ed., chapter 5. Used by src/bodies/beams.cpp; tested in tests/kernels/beam
// and tests/src/bodies/beams_test.cpp. Theory: docs/theory/structure.md. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "kernels/beam/euler_bernoulli.hpp"

namespace spindrift::beam {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

/// One plane of bending over (deflection, slope) of the end.
struct Plane {
  Eigen::Matrix2d stiffness, damping;
  Eigen::Matrix2d shortening;   ///< by which the end comes nearer: half of q^T shortening q [m]
  std::array<double, 2> omega;  ///< of the two modes, the start clamped [rad/s]
  Eigen::Matrix2d to_modes;     ///< amplitudes of the modes (generalised mass 1) of q
};

/// A share of the beam's mass, a point on its axis.
struct Station {
  double mass = 0.0, height = 0.0;  ///< [kg], from the start [m]
  double stretch = 0.0;             ///< its part of the beam's extension
  Eigen::Vector2d x, y;             ///< deflection for (deflection, slope) of the end
  Eigen::Matrix2d shortening_x, shortening_y;
};

struct ModalLink {
  double length = 0.0;
  Plane x, y;
  double axial_stiffness = 0.0, axial_damping = 0.0;      ///< [N/m], [N s/m]
  double torsion_stiffness = 0.0, torsion_damping = 0.0;  ///< [N m/rad], [N m s/rad]
  std::vector<Station> stations;
};

/// Along the beam: mass and the stiffness of both planes, of extension and of twist, at the same positions.
struct Properties {
  std::vector<double> position, mass, bending_x, bending_y;  ///< [m], [kg/m], [N m2]
  std::vector<double> axial, torsion;                        ///< E A [N], G J [N m2]

  Table plane_x() const { return {position, mass, bending_x}; }
  Table plane_y() const { return {position, mass, bending_y}; }
};

/// What the modes see at the end, and how they are damped.
struct LinkEnd {
  EndBody x, y;                         ///< of motions in the two planes
  double inertia_z = 0.0;               ///< about the beam's axis [kg m2]
  std::array<double, 2> damping{0, 0};  ///< ratio to critical of the first and of the second modes; extension and twist: second
};

ModalLink make_modal_link(const Properties& properties, const LinkEnd& end);

/// A body at one end: where its centre of mass is, where the beam's end on it is, and how it moves; earth axes.
struct End {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< the beam's end [m]
  Eigen::Matrix3d axes =
      Eigen::Matrix3d::Identity();  ///< of the beam there: x, y across, z from start to end; move with the body
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of the centre of mass [m/s]
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();      ///< [rad/s]
};

/// Displacement and rotation of the end seen from the start, and how they follow from the bodies' motion.
struct Deformation {
  Vector6 value, rate;              ///< [m], rotation vector [rad]; beam's axes at the start
  Eigen::Matrix<double, 6, 12> of;  ///< rate = of * (velocity and spin of the start's body, of the end's)
  Vector6 bias;                     ///< second derivative without accelerations of the bodies

  Eigen::Vector2d x() const { return {value[0], value[4]}; }  ///< deflection and slope along x
  Eigen::Vector2d y() const { return {value[1], -value[3]}; }
  Eigen::Vector2d x_rate() const { return {rate[0], rate[4]}; }
  Eigen::Vector2d y_rate() const { return {rate[1], -rate[3]}; }
};

Deformation deformation(const ModalLink& link, const End& start, const End& end);

/// Extension of the beam's axis: the end's way along it and what bending takes [m], and its derivative over the deformation.
struct Extension {
  double value;
  Vector6 of;
};
Extension extension(const ModalLink& link, const Deformation& d);

/// Energy of deformation [J].
double elastic_energy(const ModalLink& link, const Deformation& d);

/// Where a station is from the start, beam's axes, and how that follows from the deformation.
struct StationPlace {
  Eigen::Vector3d place;
  Eigen::Matrix<double, 3, 6> of;
  double bias;  ///< along the beam: second derivative for a constant rate of deformation [m/s2]
};
StationPlace station_place(const ModalLink& link, const Station& s, const Deformation& d, const Extension& e);

/// The beam's part in the motion of both bodies, rows (force, moment about its centre of mass) of the start's body, then of the
/// end's: loads - mass * (accelerations) acts on them.
struct LinkDynamics {
  Vector12 loads;  ///< elastic, damping, weight, and the inertia that needs no acceleration
  Matrix12 mass;
};

/// gravity: acceleration, earth axes [m/s2].
LinkDynamics dynamics(const ModalLink& link, const End& start, const End& end, const Eigen::Vector3d& gravity);

/// Kinetic energy of the beam and its height times weight [J].
double kinetic_energy(const ModalLink& link, const End& start, const End& end);

/// Energy of its weight against the earth's origin [J].
double potential_energy(const ModalLink& link, const End& start, const End& end, const Eigen::Vector3d& gravity);

}  // namespace spindrift::beam
