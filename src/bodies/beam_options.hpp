// What a scene says about flexible beams: [beams.NAME], and the file of their properties. Declared in beam_options.cpp, with the
// rules between sections; turned into the values of beams.hpp by make_beams. Read by src/coupling; tested in
// tests/src/bodies/beam_options_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "src/bodies/beams.hpp"
#include "src/bodies/options.hpp"

namespace spindrift::bodies {

/// [beams.NAME]
struct BeamOptions {
  std::vector<std::string> bodies;
  Eigen::Vector3d start_m = Eigen::Vector3d::Zero(), end_m = Eigen::Vector3d::Zero();  ///< initial earth coordinates
  Eigen::Vector3d across = Eigen::Vector3d::UnitX();
  std::string properties;  ///< path
  double youngs_modulus_Pa = 210e9, shear_modulus_Pa = 80.8e9, density_kg_m3 = 8500.0;
  std::vector<double> damping{0.0, 0.0};
};

using NamedBeams = std::vector<scene::Named<BeamOptions>>;

const scene::Section<BeamOptions>& beam_section();

/// Rules between sections: bodies that exist, a file that can be read and is as long as the beam.
void check_beams(scene::Document& document, const NamedBeams& beams, const NamedBodies& bodies);

/// Properties along the beam; throws scene::SceneError where the file is not such a table.
beam::Properties read_properties(const BeamOptions& beam);

/// Options that passed check_beams.
std::vector<Beam> make_beams(const NamedBeams& beams, const NamedBodies& named, std::span<const Body> bodies,
                             std::span<const Joint> joints);

}  // namespace spindrift::bodies
