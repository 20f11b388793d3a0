// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/symmetry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kernels/base/constants.hpp"
#include "src/bodies/extent.hpp"

namespace spindrift::coupling {

namespace {

constexpr double close = 1e-6;    // of a body's size: what is written with six digits
constexpr double leaning = 1e-3;  // sine of an angle
const char* const key_of_plane = "sea.tank.sides_y";

bool meets_particles(const bodies::BodyOptions& o) {
  return !o.cylinders.empty() || !o.boxes.empty() || !o.spheres.empty() || !o.meshes.empty();
}
// What begins the names of the joints that hold bodies in the plane.
constexpr const char *of_symmetry = "symmetry_", *of_two_dimensions = "plane_";

/// What moves bodies out of the plane, which `key` asks for.
class InPlane {
 public:
  InPlane(std::string key, std::string plane, std::vector<sea::OptionProblem>& problems)
      : key_(std::move(key)), plane_(std::move(plane)), problems_(problems) {}

  void require_start(const std::string& name, const bodies::BodyOptions& o) {
    const std::string section = "bodies." + name + ".";
    if (o.displacement_m.y() != 0.0) out_of_plane(section + "displacement_m", "along y");
    if (o.rotation.x() != 0.0 || o.rotation.z() != 0.0) out_of_plane(section + "rotation_deg", "in roll or yaw");
    if (o.velocity_m_s.y() != 0.0) out_of_plane(section + "velocity_m_s", "along y");
    if (o.omega_rad_s.x() != 0.0 || o.omega_rad_s.z() != 0.0) out_of_plane(section + "omega_rad_s", "in roll or yaw");
  }
  /// In a plane a cylinder is a disc or a rectangle.
  void require_shapes(const std::string& name, const bodies::BodyOptions& o) {
    for (std::size_t n = 0; n < o.cylinders.size(); ++n) {
      const Eigen::Vector3d axis = (o.cylinders[n].end_m - o.cylinders[n].start_m).normalized();
      const double out = std::abs(axis.y()), in = std::hypot(axis.x(), axis.z());
      if (std::min(out, in) > leaning)
        wrong(
            fmt::format("bodies.{}.cylinders[{}]", name, n),
            fmt::format("has an axis (start_m to end_m) that leans by {:.3g} degrees out of {}: it must lie in it (a rectangle) "
                        "or be along y (a disc)",
                        std::atan2(out, in) / radians_per_degree, plane_));
    }
  }
  void require_drivers(const Scenario& s, const std::string& prefix) {
    std::set<std::string> held{"earth"};
    for (const auto& [name, body] : s.bodies)
      if (meets_particles(body)) held.insert(name);
    for (const auto& [name, joint] : s.joints) {
      if (name.starts_with(prefix) && held.contains(name.substr(prefix.size())))
        wrong("joints." + name, fmt::format("has the name of what holds a body in {}: choose another", plane_));
      if (!std::ranges::all_of(joint.bodies, [&](const std::string& body) { return held.contains(body); })) continue;
      const double along = std::abs(joint.axis.normalized().y());
      if (joint.rotation && along < 1.0 - close)
        wrong("joints." + name + ".rotation", fmt::format("turns a body out of {}: its axis is not y", plane_));
      if (joint.translation && along > close)
        wrong("joints." + name + ".translation", fmt::format("drives a body out of {}: along y", plane_));
    }
  }

 private:
  void wrong(std::string key, std::string what) { problems_.push_back({std::move(key), std::move(what), key_}); }
  void out_of_plane(std::string key, const std::string& how) {
    wrong(std::move(key), fmt::format("is {}: bodies stay in {} ({})", how, plane_, key_));
  }

  const std::string key_, plane_;
  std::vector<sea::OptionProblem>& problems_;
};

/// Of one body with shapes.
class Symmetry {
 public:
  Symmetry(const std::string& name, const bodies::BodyOptions& body, double plane, std::vector<sea::OptionProblem>& problems)
      : key_("bodies." + name), o_(body), plane_(plane), near_(close * bodies::extent(body)), problems_(problems) {}

  void require() {
    if (std::abs(o_.centre_m.y() - plane_) > near_)
      return wrong("centre_m", fmt::format("is {:.4g} m off the plane of symmetry y = {:g} m ({}), which cuts each body in its "
                                           "middle",
                                           o_.centre_m.y() - plane_, plane_, key_of_plane));
    require_shapes();
    const Eigen::Matrix3d& i = o_.inertia_kg_m2;
    if (std::max(std::abs(i(0, 1)), std::abs(i(1, 2))) > close * i.diagonal().maxCoeff())
      wrong("inertia_kg_m2", fmt::format("has Ixy {:.4g}, Iyz {:.4g}: {} wants none", i(0, 1), i(1, 2), key_of_plane));
  }

 private:
  void wrong(const std::string& key, std::string what) { problems_.push_back({key_ + "." + key, std::move(what), key_of_plane}); }
  Eigen::Vector3d image(const Eigen::Vector3d& x) const { return image_across(plane_, x); }
  bool same(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const { return (a - b).norm() <= near_; }
  bool same(double a, double b) const { return std::abs(a - b) <= near_; }

  bool are_images(const bodies::CylinderOptions& a, const bodies::CylinderOptions& b) const {
    const double a_end = a.end_diameter_m.value_or(a.diameter_m), b_end = b.end_diameter_m.value_or(b.diameter_m);
    const Eigen::Vector3d start = image(a.start_m), end = image(a.end_m);
    return (same(start, b.start_m) && same(end, b.end_m) && same(a.diameter_m, b.diameter_m) && same(a_end, b_end)) ||
           (same(start, b.end_m) && same(end, b.start_m) && same(a.diameter_m, b_end) && same(a_end, b.diameter_m));
  }
  bool are_images(const bodies::BoxOptions& a, const bodies::BoxOptions& b) const {
    return same(image(a.centre_m), b.centre_m) && same(a.size_m, b.size_m);
  }
  bool are_images(const bodies::SphereOptions& a, const bodies::SphereOptions& b) const {
    return same(image(a.centre_m), b.centre_m) && same(a.diameter_m, b.diameter_m);
  }
  template <class Shape>
  void require_images(const char* list, const std::vector<Shape>& shapes) {
    for (std::size_t n = 0; n < shapes.size(); ++n)
      if (std::ranges::none_of(shapes, [&](const Shape& other) { return are_images(shapes[n], other); }))
        wrong(fmt::format("{}[{}]", list, n),
              fmt::format("is not cut in its middle by the plane of symmetry y = {:g} m ({}), nor has it an image beyond", plane_,
                          key_of_plane));
  }
  void require_shapes() {
    require_images("cylinders", o_.cylinders);
    require_images("boxes", o_.boxes);
    require_images("spheres", o_.spheres);
    if (!o_.meshes.empty())
      wrong("meshes", fmt::format("must not be given with {} = \"symmetric\": whether triangles are symmetrical is not known",
                                  key_of_plane));
  }

  const std::string key_;
  const bodies::BodyOptions& o_;
  const double plane_, near_;
  std::vector<sea::OptionProblem>& problems_;
};

/// By a joint to the earth: another one would repeat what that does.
bool is_kept_in_plane(const bodies::NamedJoints& joints, const std::string& body) {
  return std::ranges::any_of(joints, [&](const auto& named) {
    const bodies::JointOptions& joint = named.options;
    const auto ties = [&](const std::string& name) { return std::ranges::find(joint.bodies, name) != joint.bodies.end(); };
    const double along = std::abs(joint.axis.normalized().y());
    return ties("earth") && ties(body) &&
           (joint.type == JointType::fixed ||
            (along > 1.0 - close && (joint.type == JointType::revolute || joint.type == JointType::planar)) ||
            (along < close && joint.type == JointType::translational));
  });
}

}  // namespace

std::vector<sea::OptionProblem> symmetry_problems(const Scenario& s, double plane) {
  std::vector<sea::OptionProblem> problems;
  const auto wrong = [&](std::string key, std::string what) {
    problems.push_back({std::move(key), std::move(what), key_of_plane});
  };
  InPlane in_plane(key_of_plane, "the plane of symmetry", problems);
  for (const auto& [name, body] : s.bodies) {
    if (!meets_particles(body)) continue;
    Symmetry(name, body, plane, problems).require();
    in_plane.require_start(name, body);
  }
  in_plane.require_drivers(s, of_symmetry);
  if (s.has_waves() && std::abs(std::sin(s.waves.direction)) > 1e-9)
    wrong("waves.direction_deg", fmt::format("must be 0 or 180 with {} = \"symmetric\": waves travel along x", key_of_plane));
  if (s.has_waves() && s.waves.spreading_exponent)
    wrong("waves.spreading_exponent",
          fmt::format("must not be given with {} = \"symmetric\": waves travel along x", key_of_plane));
  if (s.sea.particles->modified_walls())
    wrong("sea.particles.walls",
          fmt::format("must not be modified ones with {} = \"symmetric\": ghost nodes have no images", key_of_plane));
  return problems;
}

std::vector<sea::OptionProblem> out_of_plane_problems(const Scenario& s) {
  std::vector<sea::OptionProblem> problems;
  InPlane in_plane("sea.particles.dimensions", "the plane of a sea of two dimensions", problems);
  for (const auto& [name, body] : s.bodies)
    if (meets_particles(body)) in_plane.require_start(name, body), in_plane.require_shapes(name, body);
  in_plane.require_drivers(s, of_two_dimensions);
  return problems;
}

std::vector<bodies::Joint> joints_in_plane(const Scenario& s) {
  std::vector<bodies::Joint> joints;
  if (!s.has_particles() || !(s.sea.particles->planar() || s.sea.tank->symmetric())) return joints;
  const std::string prefix = s.sea.particles->planar() ? of_two_dimensions : of_symmetry;
  for (std::size_t b = 0; b < s.bodies.size(); ++b)
    if (const auto& [name, body] = s.bodies[b]; meets_particles(body) && !is_kept_in_plane(s.joints, name))
      joints.push_back({.name = prefix + name,
                        .type = JointType::planar,
                        .i = bodies::earth,
                        .j = int(b),
                        .point = body.centre_m,
                        .axis = Eigen::Vector3d::UnitY()});
  return joints;
}

}  // namespace spindrift::coupling
