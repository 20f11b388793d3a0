// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/bodies/extent.hpp"
#include "src/scene/columns.hpp"

namespace spindrift::bodies {

namespace {

/// Mass spread over a shape gives radii of gyration of its own size; a tower on top adds to them.
void doubt_inertia(scene::Doubts& doubts, const std::string& at, const BodyOptions& body, double size) {
  const Eigen::Vector3d radii = (body.inertia_kg_m2.diagonal() / body.mass_kg).cwiseMax(0.0).cwiseSqrt();
  const double least = radii.minCoeff(), most = radii.maxCoeff();
  const std::string what = fmt::format("radii of gyration of {:.3g} to {:.3g} m", least, most);
  const std::string advice = "look at the units of mass and inertia: kg and kg m2, not t";
  if (size > 0.0 && (most > 4.0 * size || most < 0.05 * size))
    doubts.push_back({at + ".inertia_kg_m2", fmt::format("{} in a body of {:.3g} m", what, size),
                      "0.05 to 4 times its half diagonal", advice});
  else if (size == 0.0 && most > 300.0)
    doubts.push_back({at + ".inertia_kg_m2", what, "up to 300 m", advice});
  // A ball of a thousandth of a kg/m3, of which air has 1.2; blades with their hub are as thin as one of air.
  if (const double thin = std::sqrt(0.4) * std::cbrt(3.0 * body.mass_kg / (4.0 * pi * 1e-3)); size == 0.0 && most > thin)
    doubts.push_back({at + ".inertia_kg_m2", fmt::format("{} with a mass of {:.4g} kg", what, body.mass_kg),
                      fmt::format("up to {:.3g} m, that of a ball of 0.001 kg/m3", thin), advice});
  // A solid ball of steel, 7850 kg/m3, has the least inertia that steel can have; blades and nacelles have a hundred times that.
  const double ball = std::sqrt(0.4) * std::cbrt(3.0 * body.mass_kg / (4.0 * pi * 7850.0));
  if (size == 0.0 && most > 0.0 && most < 0.5 * ball)
    doubts.push_back({at + ".inertia_kg_m2", fmt::format("{} with a mass of {:.4g} kg", what, body.mass_kg),
                      fmt::format("above {:.3g} m, half that of a solid ball of steel", 0.5 * ball), advice});
}

/// Axis by axis, against a homogeneous block of the shapes' size: an inertia that belongs to another axis or another unit stands
/// out. A tower on top gives a float up to four times its block's radius about level axes; ballast or a thin hull change it by
/// less than two.
void doubt_axes_of_inertia(scene::Doubts& doubts, const std::string& at, const BodyOptions& body, const Eigen::AlignedBox3d& box,
                           bool planar) {
  constexpr double least = 0.4, most = 8.0;
  const Eigen::Vector3d squares = box.sizes().cwiseAbs2();
  for (int axis = 0; axis < 3; ++axis) {
    if (planar && axis != 1) continue;
    const double block = std::sqrt((squares.sum() - squares[axis]) / 12.0);
    const double radius = std::sqrt(std::max(0.0, body.inertia_kg_m2(axis, axis) / body.mass_kg));
    if (block == 0.0 || (radius >= least * block && radius <= most * block)) continue;
    doubts.push_back({at + ".inertia_kg_m2",
                      fmt::format("a radius of gyration of {:.3g} m about {}, where a block of its size has {:.3g} m", radius,
                                  "xyz"[axis], block),
                      fmt::format("{:g} to {:g} times that", least, most),
                      "look at the order of the axes, x, y, z, and at the unit: kg m2"});
    return;
  }
}

/// "about the keel it would be m 42^2 = 1.42e+10 kg m2 larger".
std::string about_the_keel(const BodyOptions& body, const Eigen::AlignedBox3d& box) {
  const double arm = body.centre_m.z() - box.min().z();
  return fmt::format("it is about the centre of mass; about the keel it would be m {:.3g}^2, {:.3g} kg m2, larger", arm,
                     body.mass_kg * arm * arm);
}

/// Mass that lies between two planes at distances a and b of its centre has a mean square of the distance of a b at most: an
/// inertia about the keel or the water's surface is larger. `reach`: round the body's mass, as the scene shows it.
void doubt_point_of_inertia(scene::Doubts& doubts, const std::string& at, const BodyOptions& body,
                            const Eigen::AlignedBox3d& reach, double most, const std::string& keel, bool planar) {
  const Eigen::Vector3d squares = (reach.max() - body.centre_m).cwiseProduct(body.centre_m - reach.min());
  for (int axis = 0; axis < 3; ++axis) {
    if (planar && axis != 1) continue;
    const double limit = std::sqrt(squares.sum() - squares[axis]);
    const double radius = std::sqrt(std::max(0.0, body.inertia_kg_m2(axis, axis) / body.mass_kg));
    if (radius <= most * limit) continue;
    doubts.push_back({at + ".inertia_kg_m2",
                      fmt::format("a radius of gyration of {:.3g} m about {}, where mass that lies within its shapes and up to "
                                  "{:.4g} m has {:.3g} m at most",
                                  radius, "xyz"[axis], reach.max().z(), limit),
                      fmt::format("up to {:g} times that", most), keel + "; look at the unit, kg m2, too"});
    return;
  }
}

/// Where the scene shows how high a body reaches, none of its mass is beyond: hulls with their towers have .4 to .8 of the
/// greatest radius, the platform of Leble & Barakos (2016) 1.23. Where it does not, a spar may carry a turbine that is part of
/// its mass: .2 of it, with which it hardly floats upright, 150 m over a hull of 130 m makes 1.03, the OC3 spar has .8. Of wider
/// floats no such bound holds.
void doubt_reach_of_inertia(scene::Doubts& doubts, const std::string& at, const BodyOptions& body,
                            const BodySurroundings& around) {
  constexpr double most_wide = 1.3, most_spar = 1.03, slender = 4.0;
  const Eigen::AlignedBox3d shapes = bounds(body);
  const bool spar = shapes.contains(body.centre_m) && shapes.sizes().z() > slender * shapes.sizes().head<2>().maxCoeff();
  if (!spar && !around.top) return;
  Eigen::AlignedBox3d reach = shapes;
  if (around.top) reach.extend(Eigen::Vector3d(reach.center().x(), reach.center().y(), *around.top)).extend(body.centre_m);
  doubt_point_of_inertia(doubts, at, body, reach, spar ? most_spar : most_wide, about_the_keel(body, shapes), around.planar);
}

}  // namespace

scene::Doubts body_doubts(const NamedBodies& bodies, const BodySurroundings& around) {
  scene::Doubts doubts;
  for (const auto& [name, body] : bodies) {
    const std::string at = "bodies." + name;
    const double size = extent(body);
    const std::size_t before = doubts.size();
    doubt_inertia(doubts, at, body, size);
    if (size > 0.0 && doubts.size() == before) doubt_axes_of_inertia(doubts, at, body, bounds(body), around.planar);
    if (size > 0.0 && doubts.size() == before) doubt_reach_of_inertia(doubts, at, body, around);
    if (const double off = body.displacement_m.norm(); size > 0.0 && off > 5.0 * size)
      doubts.push_back({at + ".displacement_m", fmt::format("starts {:.4g} m from where it is described", off),
                        fmt::format("up to five times half its diagonal, {:.3g} m", 5.0 * size), "look at its unit: m"});
    if (const Eigen::AlignedBox3d box = bounds(body); !box.isEmpty())
      if (const double off = std::sqrt(box.squaredExteriorDistance(body.centre_m)); off > 2.0 * size)
        doubts.push_back({at + ".centre_m", fmt::format("{:.4g} m away from its shapes", off),
                          fmt::format("within {:.3g} m of them", 2.0 * size),
                          "look at the place of the centre of mass and of the shapes: both in earth coordinates"});
    if (body.reference_m && size > 0.0)
      if (const double over = std::abs(body.reference_m->z() - body.centre_m.z()); over > 5.0 * size)
        doubts.push_back({at + ".reference_m", fmt::format("{:.4g} m over or under the centre of mass", over),
                          fmt::format("up to five times half the body's diagonal, {:.3g} m", 5.0 * size), "look at its unit: m"});
    if (const double turned = body.rotation.cwiseAbs().maxCoeff() / radians_per_degree; turned > 60.0)
      doubts.push_back(
          {at, fmt::format("starts turned by {:.4g} degrees", turned), "up to 60 degrees", "look at rotation_deg, in degrees"});
    if (const double speed = body.velocity_m_s.norm(); speed > 30.0)
      doubts.push_back({at + ".velocity_m_s", fmt::format("{:.4g} m/s", speed), "up to 30 m/s", "look at its unit"});
    if (const double turn = body.omega_rad_s.norm(); size > 5.0 && turn * size > 60.0)
      doubts.push_back({at, fmt::format("starts turning at {:.4g} rad/s, its ends at {:.4g} m/s", turn, turn * size),
                        "ends up to 60 m/s", "look at the unit of its rates"});
  }
  return doubts;
}

namespace {

bool is_inside(const Cylinder& c, const Eigen::Vector3d& x) {
  const Eigen::Vector3d way = c.end - c.start, from = x - c.start;
  const double along = from.dot(way) / way.squaredNorm(), radius = c.radius(along);
  return along > 0.0 && along < 1.0 && (from - along * way).squaredNorm() < radius * radius;
}

/// Share of a cylinder's volume that lies in another, by points that stand for equal parts of each cross-section, on a golden
/// spiral: right within a per cent.
double share_inside(const Cylinder& c, const Cylinder& other) {
  constexpr int slices = 40, points = 200;
  const double golden = pi * (3.0 - std::sqrt(5.0));
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), c.axis());
  double all = 0.0, inside = 0.0;
  for (int slice = 0; slice < slices; ++slice) {
    const double along = (slice + 0.5) / slices, radius = c.radius(along);
    for (int n = 0; n < points; ++n) {
      const double off = radius * std::sqrt((n + 0.5) / points);
      const Eigen::Vector3d aside(off * std::cos(golden * n), off * std::sin(golden * n), 0.0);
      all += radius * radius;
      if (is_inside(other, c.at(along) + turn * aside)) inside += radius * radius;
    }
  }
  return inside / all;
}

bool may_meet(const Cylinder& one, const Cylinder& two) {
  const auto reach = [](const Cylinder& c) { return 0.5 * c.length() + std::max(c.start_radius, c.end_radius); };
  return (one.at(0.5) - two.at(0.5)).norm() < reach(one) + reach(two);
}

}  // namespace

scene::Doubts overlap_doubts(const NamedBodies& bodies, std::string_view but_for) {
  constexpr double most = 0.1;  // braces end on the axes of columns, not on their sides
  scene::Doubts doubts;
  for (const auto& [name, body] : bodies) {
    if (name == but_for) continue;
    double largest = 0.0;
    int pairs = 0;
    std::string what;
    std::vector<Cylinder> made;
    for (const CylinderOptions& cylinder : body.cylinders) made.push_back(make_cylinder(cylinder, body));
    for (std::size_t n = 0; n < made.size(); ++n)
      for (std::size_t m = 0; m < n; ++m) {
        const Cylinder &one = made[m], &two = made[n];
        if (!may_meet(one, two)) continue;
        const bool first = one.volume() < two.volume();
        const Cylinder &less = first ? one : two, &more = first ? two : one;
        const double share = share_inside(less, more), common = share * less.volume();
        if (share <= most) continue;
        ++pairs;
        if (common <= largest) continue;
        largest = common;
        what = fmt::format("cylinders {} and {} lie in each other: {:.3g} m3, {:.3g} % of {}, displace and add mass twice",
                           body.cylinders[m].name, body.cylinders[n].name, common, 100.0 * share,
                           body.cylinders[first ? m : n].name);
      }
    if (pairs > 1) what += fmt::format(" (so do {} more pairs)", pairs - 1);
    if (pairs > 0)
      doubts.push_back({"bodies." + name + ".cylinders", what,
                        fmt::format("up to {:.0f} % of the smaller, as at joints", 100.0 * most),
                        "let one end where the other begins"});
  }
  return doubts;
}

namespace {

/// Tubes of towers and monopiles are 50 to 300 times as wide as their walls are thick, thick pipes 10 times, rods twice.
void doubt_walls(scene::Doubts& doubts, const std::string& at, const BeamOptions& beam) {
  constexpr double least = 6.0, most = 1000.0, solid = 2.0;
  const scene::Columns file = scene::read_columns(beam.properties);
  if (!file.has("diameter_m") || !file.has("thickness_m")) return;
  const auto wide = file["diameter_m"], thick = file["thickness_m"];
  for (std::size_t n = 0; n < wide.size(); ++n) {
    if (const double ratio = wide[n] / thick[n]; (ratio >= least && ratio <= most) || ratio < 1.001 * solid) continue;
    doubts.push_back({at + ".properties", fmt::format("a wall of {:.4g} m round {:.4g} m", thick[n], wide[n]),
                      fmt::format("a diameter of {:g} to {:g} times the wall: towers have 50 to 300", least, most),
                      "look at the units of diameter_m and thickness_m: m, not cm or mm"});
    return;
  }
}

}  // namespace

/// Wood has 1e10 Pa and 500 kg/m3, concrete 3e10 and 2400, glass fibre 4e10 and 1900, steel 2.1e11 and 7850. Moduli of what is
/// alike in all directions stand in a ratio of 2 to 3 (2 (1 + nu)), those of wood and fibres along and across in one of up to 20.
scene::Doubts beam_doubts(const NamedBeams& beams) {
  scene::Doubts doubts;
  for (const auto& [name, beam] : beams) {
    const std::string at = "beams." + name;
    const double ratio = beam.youngs_modulus_Pa / beam.shear_modulus_Pa;
    if (beam.youngs_modulus_Pa < 1e9 || beam.youngs_modulus_Pa > 1e12)
      doubts.push_back({at + ".youngs_modulus_Pa", fmt::format("{:.4g} Pa", beam.youngs_modulus_Pa),
                        "1e9 to 1e12 Pa: steel has 2.1e11", "look at its unit: Pa, not MPa or GPa"});
    else if (ratio < 1.5 || ratio > 30.0)
      doubts.push_back({at + ".shear_modulus_Pa",
                        fmt::format("{:.4g} Pa, {:.3g} of Young's modulus", beam.shear_modulus_Pa, 1.0 / ratio),
                        "0.03 to 0.7 of it: steel has 0.38", "look at its unit: Pa, not MPa or GPa"});
    if (beam.density_kg_m3 < 300.0 || beam.density_kg_m3 > 25e3)
      doubts.push_back({at + ".density_kg_m3", fmt::format("{:.4g} kg/m3", beam.density_kg_m3),
                        "300 to 25000 kg/m3: steel has 7850", "look at its unit: kg/m3, not g/cm3 or t/m3"});
    if (const double most = *std::ranges::max_element(beam.damping); most > 0.1)
      doubts.push_back({at + ".damping", fmt::format("{:.4g} of critical", most), "up to 0.1: steel towers have 0.002 to 0.02",
                        "it is a share, not per cent"});
    doubt_walls(doubts, at, beam);
  }
  return doubts;
}

}  // namespace spindrift::bodies
