// Parts of an OpenFAST deck as plain values: masses, blades with polars, lines. Used by the files openfast_*; tested in
// tests/src/import/openfast_test.cpp. SPDX-License-Identifier: Apache-2.0
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

struct WrittenTurbine {
  std::vector<std::string> left_out;
  bool by_reynolds = false;     ///< some polar depends on the Reynolds number
  double separation_lag = 3.0;  ///< in half chords, of the outermost aerofoil file with stall (T_f0)
  bool lags_differ = false;     ///< between files
};
/// Writes planform, polars and turbine.toml.
WrittenTurbine write_turbine(const Deck& aerodyn, const RotorFrame& rotor, const std::filesystem::path& folder);

struct ImportedLine {
  Eigen::Vector3d anchor, fairlead;
  double length = 0.0, diameter = 0.0, mass_per_m = 0.0, axial_stiffness = 0.0, bed_friction = 0.0;
  bool meets_bed = true;  ///< at the level of its anchor, if it has one; false: MAP++'s OMIT_CONTACT
  /// Of MoorDyn's lines, which are dynamic: keys beyond those above, as a scene has them.
  struct Dynamics {
    int segments = 20;
    double damping_ratio = 1.0, drag = 0.0, axial_drag = 0.0, added_mass = 0.0, axial_added_mass = 0.0;
    double bed_stiffness = 3e6, bed_damping = 3e5;
  };
  std::optional<Dynamics> dynamics{};
  std::string at_anchor{}, at_fairlead{};  ///< names of junctions; empty: the bed, the platform
};
/// A point free in the water at which lines end.
struct ImportedJunction {
  std::string name;
  Eigen::Vector3d at;
  double mass = 0.0, volume = 0.0, drag_area = 0.0, added_mass = 0.0;
};
struct ImportedMoorings {
  std::vector<ImportedLine> lines;
  std::vector<ImportedJunction> junctions;
};
/// Lines of MAP++ are in rest at all times.
ImportedMoorings read_map(const Deck& file, double water_depth, std::vector<std::string>& left_out);
/// A file without its comments.
ImportedMoorings read_moordyn(const Deck& file, double water_depth, std::vector<std::string>& left_out);

/// Lines from the bed to the platform without a branch, and the points between them, as indices; a line alone is one.
struct ImportedRow {
  std::vector<std::size_t> lines, points;  ///< from the anchor up
};
/// In the order of their first lines. Lines that are in none meet at a point with others, or hang on the bed or the platform at
/// both ends.
std::vector<ImportedRow> rows_of(const ImportedMoorings& moorings);

}  // namespace spindrift::decks
