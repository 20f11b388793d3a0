// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/extent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernels/rigid/closed_surface.hpp"
#include "src/scene/document.hpp"

namespace spindrift::bodies {

std::vector<Eigen::AlignedBox3d> pieces(const BodyOptions& body) {
  std::vector<Eigen::AlignedBox3d> all;
  const auto add = [&](const Eigen::Vector3d& centre, const Eigen::Vector3d& half) {
    all.emplace_back(centre - half, centre + half);
  };
  for (const CylinderOptions& c : body.cylinders) {
    const Eigen::Vector3d axis = (c.end_m - c.start_m).normalized();
    const Eigen::Vector3d disc = (1.0 - axis.array().square()).max(0.0).sqrt();
    add(c.start_m, 0.5 * c.diameter_m * disc), add(c.end_m, 0.5 * c.end_diameter_m.value_or(c.diameter_m) * disc);
  }
  for (const BoxOptions& b : body.boxes) add(b.centre_m, 0.5 * b.size_m);
  for (const scene::MeshOptions& m : body.meshes)
    if (m.surface) all.push_back(m.surface->box());
  for (const SphereOptions& s : body.spheres) add(s.centre_m, Eigen::Vector3d::Constant(0.5 * s.diameter_m));
  return all;
}

Eigen::AlignedBox3d bounds(const BodyOptions& body) {
  Eigen::AlignedBox3d box;
  for (const Eigen::AlignedBox3d& piece : pieces(body)) box.extend(piece);
  return box;
}

double extent(const BodyOptions& body) {
  const Eigen::AlignedBox3d box = bounds(body);
  return box.isEmpty() ? 0.0 : 0.5 * box.diagonal().norm();
}

Reach reach(const BodyOptions& body, const Motion& now) {
  Reach result;
  const auto take = [&](const Eigen::Vector3d& point, double radius) {
    const double z = (now.position + now.attitude * point).z();
    result.low = result.any ? std::min(result.low, z - radius) : z - radius;
    result.high = result.any ? std::max(result.high, z + radius) : z + radius;
    result.any = true;
  };
  for (const CylinderOptions& c : body.cylinders) {
    const Cylinder shape = make_cylinder(c, body);
    const Eigen::Vector3d axis = now.attitude * shape.axis();
    const double lean = std::sqrt(std::max(0.0, 1.0 - axis.z() * axis.z()));  // ends are discs
    take(shape.start, shape.start_radius * lean), take(shape.end, shape.end_radius * lean);
  }
  for (const BoxOptions& b : body.boxes) {
    const Box shape = make_box(b, body);
    for (int corner = 0; corner < 8; ++corner)
      take(shape.centre +
               0.5 * Eigen::Vector3d(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1).cwiseProduct(shape.size),
           0.0);
  }
  for (const SphereOptions& s : body.spheres) {
    const Sphere shape = make_sphere(s, body);
    take(shape.centre, shape.radius);
  }
  for (const scene::MeshOptions& m : body.meshes)
    for (const Eigen::Vector3d& point : m.surface->points()) take(point - body.centre_m, 0.0);
  return result;
}

namespace {

/// Whether neither body of a joint can fall along it while the other stays: one that slides along what is not level lets it.
bool holds_height(const JointOptions& joint) {
  constexpr double level = 1e-6;
  if (joint.translation) return true;
  const double up = std::abs(joint.axis.normalized().z());
  switch (joint.type) {
    case JointType::translational:
    case JointType::cylindrical:
      return up < level;
    case JointType::planar:
      return up > 1.0 - level;
    case JointType::fixed:
    case JointType::revolute:
    case JointType::spherical:
    case JointType::universal:
      break;
  }
  return true;
}

/// How far each body falls until the lowest of those that fall with it meets the water [m]; those held by the earth do not.
std::vector<double> fall_heights(const NamedBodies& bodies, const NamedJoints& joints, const NamedBeams& beams,
                                 double water_level) {
  std::vector<std::size_t> group(bodies.size() + 1);  // the last is the earth's
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto place = [&](const std::string& name) {
    const int body = index_of(bodies, name);
    return body == earth ? bodies.size() : std::size_t(body);
  };
  const auto tie = [&](const std::vector<std::string>& both) {
    std::ranges::replace(group, std::size_t(group[place(both[0])]), std::size_t(group[place(both[1])]));
  };
  for (const auto& joint : joints)
    if (holds_height(joint.options)) tie(joint.options.bodies);
  for (const auto& beam : beams) tie(beam.options.bodies);
  constexpr double none = std::numeric_limits<double>::infinity();
  std::vector<double> lowest(group.size(), none), heights(bodies.size(), 0.0);
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (const Eigen::AlignedBox3d box = bounds(bodies[b].options); !box.isEmpty())
      lowest[group[b]] = std::min(lowest[group[b]], box.min().z() + bodies[b].options.displacement_m.z());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (group[b] != group.back() && lowest[group[b]] < none) heights[b] = std::max(0.0, lowest[group[b]] - water_level);
  return heights;
}

}  // namespace

double entry_speed(const NamedBodies& bodies, const NamedJoints& joints, const NamedBeams& beams, double gravity,
                   double water_level) {
  const std::vector<double> heights = fall_heights(bodies, joints, beams, water_level);
  double fastest = 0.0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const BodyOptions& body = bodies[b].options;
    if (bounds(body).isEmpty()) continue;
    const double speed = body.velocity_m_s.norm() + body.omega_rad_s.norm() * extent(body);
    fastest = std::max(fastest, std::sqrt(speed * speed + 2.0 * gravity * heights[b]));
  }
  for (const Joint& joint : make_joints(joints, bodies)) {
    if ((joint.i == earth) == (joint.j == earth)) continue;
    const BodyOptions& body = bodies[std::size_t(joint.i == earth ? joint.j : joint.i)].options;
    const Eigen::AlignedBox3d box = bounds(body);
    if (box.isEmpty()) continue;
    const double reach = (box.center() - joint.point).norm() + extent(body);
    const double along = joint.translation ? joint.translation->fastest() : 0.0;
    fastest = std::max(fastest, along + (joint.rotation ? joint.rotation->fastest() * reach : 0.0));
  }
  return fastest;
}

}  // namespace spindrift::bodies
