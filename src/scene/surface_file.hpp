// Closed surfaces from STL files, ASCII or binary, where a scene puts them: shapes of bodies, walls of a tank. Normals in the
// file are not read: the order of a facet's corners says what is outside. Used by the options of src/bodies and src/sea; tested
// in tests/src/scene/surface_file_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spindrift {
class ClosedSurface;
}

namespace spindrift::scene {

class Document;
template <class Options>
class Section;

/// [[bodies.NAME.meshes]], [[sea.tank.meshes]]
struct MeshOptions {
  std::string name;
  std::string file;
  double scale = 1.0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< of the file's origin, initial earth coordinates
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();    ///< roll, pitch, yaw about it [rad]
  std::string water = "outside";                         ///< of a tank's: outside, inside
  /// Of the file, where the scene puts it; null where it could not be read.
  std::shared_ptr<const ClosedSurface> surface;
  std::shared_ptr<const ClosedSurface> prism;  ///< in 2-D, of its outline in the plane; else null
};
/// The keys of both; a tank's has `water` beside them.
Section<MeshOptions> mesh_section(const std::string& help);

/// The facets of an STL file in its own units. Throws SceneError with file and line or byte.
std::vector<std::array<Eigen::Vector3d, 3>> read_stl(const std::string& path);
/// Sets `surface`, and `prism` where a 2-D scene's plane of this y is given. Throws SceneError, also where the surface is not
/// closed or does not reach the plane.
void load_surface(MeshOptions& mesh, std::optional<double> plane_y = std::nullopt);
/// The same of all that stand at a key of the scene; what is wrong with one goes to the document.
void load_surfaces(Document& document, const std::string& key, std::vector<MeshOptions>& meshes, std::optional<double> plane_y);

}  // namespace spindrift::scene
