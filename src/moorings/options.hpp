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
};

const scene::Section<LineOptions>& line_section();

/// Rules between sections: the bodies named exist, ends differ, tables are readable. Problems go to the document.
void check_lines(scene::Document& doc, const std::vector<scene::Named<LineOptions>>& lines, std::span<const std::string> bodies);

}  // namespace spindrift::moorings
