// What ElastoDyn, and BeamDyn for its blades, say of the turbine as plain values: masses, tower, blades. Tested in
// tests/src/import. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "src/import/deck.hpp"

namespace spindrift::decks {

/// Mass, its centre and inertia, gathered part by part in earth axes of the deck's position at rest.
class MassSum {
 public:
  /// A part with its own inertia about its centre of mass.
  void add(double mass, const Eigen::Vector3d& at, const Eigen::Matrix3d& inertia = Eigen::Matrix3d::Zero());
  void add(const MassSum& part) { add(part.mass(), part.centre(), part.inertia()); }
  double mass() const { return mass_; }
  Eigen::Vector3d centre() const { return mass_ > 0.0 ? Eigen::Vector3d(first_ / mass_) : Eigen::Vector3d::Zero(); }
  /// About the centre of mass.
  Eigen::Matrix3d inertia() const;

 private:
  double mass_ = 0.0;
  Eigen::Vector3d first_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d about_origin_ = Eigen::Matrix3d::Zero();
};

/// Where ElastoDyn puts the rotor.
struct RotorFrame {
  Eigen::Vector3d hub, axis;  ///< [m]; unit, downwind
  int blades = 3;
  double hub_radius = 0.0, tip_radius = 0.0, precone = 0.0;  ///< [m], [m], [rad] positive downwind as in the deck
  double yaw = 0.0;                                          ///< of the nacelle, from x to y [rad]
  std::vector<std::filesystem::path> beamdyn_blades{};       ///< where blades are BeamDyn's: a file of properties each
};
RotorFrame rotor_frame(const Deck& elastodyn);

/// Platform, tower, nacelle, hub, blades, as ElastoDyn has them. The generator turns with the shaft alone and is not in it, nor
/// is the rotor's inertia about the shaft where [control] turns it.
MassSum all_masses(const Deck& elastodyn, const RotorFrame& rotor, bool controlled);
/// The parts of all_masses below the tower, and on top of it.
MassSum platform_masses(const Deck& elastodyn);
MassSum top_masses(const Deck& elastodyn, const RotorFrame& rotor, bool controlled);

/// The tower as a beam: file of its properties, heights of its ends, damping of its first and second modes under the mass on its
/// top [kg] (the mean of both planes).
struct ImportedBeam {
  std::string properties;  ///< CSV
  double base = 0.0, top = 0.0, damping[2] = {0.0, 0.0};
};
ImportedBeam tower_beam(const Deck& elastodyn, double top_mass, std::vector<std::string>& left_out);

/// Blades that bend: the table that a scene takes as rotor.blade_structure, and damping of the modes.
struct ImportedBending {
  std::string structure;                ///< CSV
  double damping[3] = {0.0, 0.0, 0.0};  ///< ratio to the critical one: first flapwise, first edgewise, second flapwise
  double fastest = 0.0;                 ///< of these modes at rest [rad/s]
  bool alike = true;                    ///< all blades have one file; else it is that of blade 1
};
ImportedBending blade_bending(const Deck& elastodyn, const RotorFrame& rotor, std::vector<std::string>& left_out);

/// About the shaft [kg m2]: blades and hub; the generator.
double rotor_inertia(const Deck& elastodyn, const RotorFrame& rotor);
double generator_inertia(const Deck& elastodyn);

}  // namespace spindrift::decks
