// Options of one mooring line, [moorings.NAME], and the rules between them and the rest of the scene.
// Declared in options.cpp; read by src/app; tested in tests/src/moorings/options_test.cpp.
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

namespace spindrift::moorings {

/// [[moorings.NAME.clumps]]
struct ClumpOptions {
  double distance_m = 0.0;
  double mass_kg = 0.0, volume_m3 = 0.0;
  double drag_area_m2 = 0.0, added_mass_coefficient = 0.5;  ///< a sphere's
};

struct LineOptions {
  std::string model = "spring_damper";
  std::string body;                                      ///< carries the fairlead
  Eigen::Vector3d fairlead_m = Eigen::Vector3d::Zero();  ///< initial earth coordinates
  std::string anchor_body = "earth";
  Eigen::Vector3d anchor_m = Eigen::Vector3d::Zero();  ///< initial earth coordinates
  double rest_length_m = 0.0;
  std::optional<double> axial_stiffness_N, stiffness_N_m;  ///< exactly one for a spring
  double damping_N_s_m = 0.0;
  bool tension_only = false;
  double weight_N_m = 0.0;
  bool bed_contact = true;
  double bed_friction = 0.0;
  std::string table;  ///< path
  // lumped_mass
  int segments = 20;
  double diameter_m = 0.0, mass_kg_m = 0.0;
  double damping_ratio = 1.0;
  double drag_coefficient = 1.33, axial_drag_coefficient = 0.2;             ///< chain on the diameter of its volume
  double added_mass_coefficient = 1.0, axial_added_mass_coefficient = 0.0;  ///< on the displaced mass
  double bed_stiffness_Pa_m = 3e6, bed_damping_Pa_s_m = 3e5;                ///< MoorDyn's
  std::vector<ClumpOptions> clumps;
};

const scene::Section<LineOptions>& line_section();

/// What a line given by its dry mass weighs in water [N/m]; of others what the scene says.
double weight_in_water(const LineOptions& line, double water_density_kg_m3, double gravity_m_s2);

/// Rules between sections: the bodies named exist, ends differ, tables are readable. Problems go to the document.
void check_lines(scene::Document& doc, const std::vector<scene::Named<LineOptions>>& lines, std::span<const std::string> bodies,
                 double water_density_kg_m3 = 1025.0);

}  // namespace spindrift::moorings
