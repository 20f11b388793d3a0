// What a scene says about bodies and joints: [bodies.NAME] with its shapes and point loads, [joints.NAME] with its drivers.
// Declared in options.cpp, with the rules between them; turned into the plain values of model.hpp by make_model.
// Read by src/coupling; tested in tests/src/bodies/options_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "kernels/rigid/shapes.hpp"
#include "src/bodies/loads.hpp"
#include "src/bodies/model.hpp"
#include "src/scene/surface_file.hpp"

namespace spindrift::scene {
template <class Options>
class Section;
template <class Options>
struct Named;
class Document;
}  // namespace spindrift::scene

namespace spindrift::bodies {

/// [[bodies.NAME.cylinders]], initial earth coordinates.
struct CylinderOptions {
  std::string name;
  Eigen::Vector3d start_m = Eigen::Vector3d::Zero(), end_m = Eigen::Vector3d::Zero();
  double diameter_m = 0.0;
  std::optional<double> end_diameter_m;
};

/// [[bodies.NAME.boxes]], initial earth coordinates.
struct BoxOptions {
  std::string name;
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero(), size_m = Eigen::Vector3d::Zero();
};
/// [[bodies.NAME.spheres]]
struct SphereOptions {
  std::string name;
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  double diameter_m = 0.0;
};

/// [[bodies.NAME.forces]]
struct ForceOptions {
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< initial earth coordinates
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero(), moment_N_m = Eigen::Vector3d::Zero();
  bool follows_body = false;
};

/// [bodies.NAME]
struct BodyOptions {
  double mass_kg = 0.0;
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Zero();
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> reference_m;
  bool gyroscopic = true;
  // How it starts, relative to the position that the scene describes.
  Eigen::Vector3d displacement_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< roll, pitch, yaw about the reference point [rad]
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d omega_rad_s = Eigen::Vector3d::Zero();  ///< earth axes
  std::vector<CylinderOptions> cylinders;
  std::vector<BoxOptions> boxes;
  std::vector<SphereOptions> spheres;
  std::vector<scene::MeshOptions> meshes;
  std::vector<ForceOptions> forces;

  const Eigen::Vector3d& reference() const { return reference_m ? *reference_m : centre_m; }
};

/// [joints.NAME.rotation], [joints.NAME.translation]: the sum of a constant rate, a harmonic and a table.
struct DriverOptions {
  double rate = 0.0;       ///< [rad/s] or [m/s]
  double amplitude = 0.0;  ///< [rad] or [m]
  std::optional<double> period_s;
  double phase = 0.0;  ///< [rad]
  std::string table;   ///< path
};

/// [joints.NAME.rotation_law], [joints.NAME.translation_law]: as JointLaw.
struct JointLawOptions {
  double stiffness = 0.0, rest = 0.0, damping = 0.0, quadratic_damping = 0.0, friction = 0.0;
  std::string table;  ///< path
};

/// [joints.NAME]
struct JointOptions {
  JointType type = JointType::revolute;
  std::vector<std::string> bodies;
  std::optional<Eigen::Vector3d> point_m;  ///< initial earth coordinates
  Eigen::Vector3d axis = Eigen::Vector3d::Zero(), second_axis = Eigen::Vector3d::Zero();
  std::optional<DriverOptions> rotation, translation;
  std::optional<JointLawOptions> rotation_law, translation_law;
};

using NamedBodies = std::vector<scene::Named<BodyOptions>>;
using NamedJoints = std::vector<scene::Named<JointOptions>>;

const scene::Section<BodyOptions>& body_section();
const scene::Section<JointOptions>& joint_section();

/// Rules between sections: at least one body (unless water alone is what the scene is about), joints between bodies that exist,
/// readable tables, unique cylinder names.
void check_bodies(scene::Document& document, const NamedBodies& bodies, const NamedJoints& joints, bool water_alone = false);

/// `earth` where no body has the name.
int index_of(const NamedBodies& bodies, const std::string& name);
/// The position that the scene describes: axes parallel to the earth's, at rest.
Motion described_motion(const BodyOptions& body);
/// How the body starts (displacement, rotation about the reference point, velocities).
Motion start_motion(const BodyOptions& body);

/// The point of a joint in initial earth coordinates; where none is given the centre of mass of its last body.
Eigen::Vector3d point_of(const JointOptions& joint, const NamedBodies& bodies);
/// Options that passed check_bodies. Throws scene::SceneError where a driver's table cannot be read.
std::vector<Body> make_bodies(const NamedBodies& bodies);
std::vector<Joint> make_joints(const NamedJoints& joints, const NamedBodies& bodies);
std::vector<PointLoad> make_point_loads(const NamedBodies& bodies);
/// Throws as make_joints does.
std::vector<JointLaw> make_joint_laws(const NamedJoints& joints, const NamedBodies& bodies);
/// Body axes from the centre of mass.
Cylinder make_cylinder(const CylinderOptions& cylinder, const BodyOptions& body);
Box make_box(const BoxOptions& box, const BodyOptions& body);
Sphere make_sphere(const SphereOptions& sphere, const BodyOptions& body);
Mesh make_mesh(const scene::MeshOptions& mesh, const BodyOptions& body);

}  // namespace spindrift::bodies
