// Options of one mooring line, [moorings.NAME], and of points at which lines meet, [junctions.NAME]; the rules between them and
// the rest of the scene. Declared in options.cpp; read by src/app; tested in tests/src/moorings/options_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spindrift::scene {
template <class Options>
class Section;
template <class Options>
struct Named;
class Document;
}  // namespace spindrift::scene

namespace spindrift {
class Bed;
}  // namespace spindrift

namespace spindrift::moorings {

/// [[moorings.NAME.sections]]
struct SectionOptions {
  double rest_length_m = 0.0, weight_N_m = 0.0, axial_stiffness_N = 0.0;
};

/// [[moorings.NAME.clumps]]
struct ClumpOptions {
  double distance_m = 0.0;
  double mass_kg = 0.0, volume_m3 = 0.0;
  double drag_area_m2 = 0.0, added_mass_coefficient = 0.5;  ///< a sphere's
};

/// [junctions.NAME]
struct JunctionOptions {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< where the search for its rest begins
  double mass_kg = 0.0, volume_m3 = 0.0;
  double drag_area_m2 = 0.0, added_mass_coefficient = 0.5;  ///< a sphere's
};

struct LineOptions {
  std::string model = "spring_damper";
  std::string body;                           ///< carries the fairlead; or a junction
  std::optional<Eigen::Vector3d> fairlead_m;  ///< initial earth coordinates; of a junction place_at_junctions gives it
  std::string anchor_body = "earth";
  std::optional<Eigen::Vector3d> anchor_m;  ///< initial earth coordinates
  double rest_length_m = 0.0;
  std::optional<double> axial_stiffness_N, stiffness_N_m;  ///< exactly one for a spring
  double damping_N_s_m = 0.0;
  bool tension_only = true;
  double weight_N_m = 0.0;
  bool bed_contact = true;
  double bed_friction = 0.0;
  std::string table;  ///< path
  // composite_catenary
  std::vector<SectionOptions> sections;  ///< from the anchor to the fairlead
  // lumped_mass
  int segments = 20;
  double diameter_m = 0.0, mass_kg_m = 0.0;
  double damping_ratio = 1.0;
  double drag_coefficient = 1.33, axial_drag_coefficient = 0.2;             ///< chain on the diameter of its volume
  double added_mass_coefficient = 1.0, axial_added_mass_coefficient = 0.0;  ///< on the displaced mass
  double bed_stiffness_Pa_m = 3e6, bed_damping_Pa_s_m = 3e5;                ///< MoorDyn's
  std::vector<ClumpOptions> clumps;
  std::optional<double> bed_level_m;  ///< no key: of lines at junctions, place_at_junctions gives it

  /// Of a line whose ends are placed.
  Eigen::Vector3d span() const { return *fairlead_m - *anchor_m; }
  /// Of the whole line, 0 where the model has none [m].
  double length_m() const;
  /// Of the whole line, its sections in a row [N/m].
  double series_stiffness_N_m() const;
};

const scene::Section<LineOptions>& line_section();
const scene::Section<JunctionOptions>& junction_section();

/// Gives ends that name a junction its place, and lines that end at one the level of the bed: that of their anchor, without one
/// the depth of the water.
void place_at_junctions(std::vector<scene::Named<LineOptions>>& lines,
                        const std::vector<scene::Named<JunctionOptions>>& junctions, double water_depth_m);

/// What a line given by its dry mass weighs in water [N/m]; of others what the scene says.
double weight_in_water(const LineOptions& line, double water_density_kg_m3, double gravity_m_s2);

/// Has nodes that meet the bed.
bool lies_on_bed(const LineOptions& line);

/// Rules of a bed that is given as a table: lines without nodes lie on flat ground. Ends are placed.
void check_bed(scene::Document& doc, const std::vector<scene::Named<LineOptions>>& lines, const Bed& bed);

/// Rules between sections: bodies and junctions named exist, ends differ, junctions are held, tables are readable. Problems go to
/// the document. Ends are as read, not yet placed.
void check_lines(scene::Document& doc, const std::vector<scene::Named<LineOptions>>& lines,
                 const std::vector<scene::Named<JunctionOptions>>& junctions, std::span<const std::string> bodies,
                 double water_density_kg_m3 = 1025.0);

}  // namespace spindrift::moorings
