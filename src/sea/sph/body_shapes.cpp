// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/body_shapes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernels/rigid/closed_surface.hpp"
#include "src/sea/sph/mesh_fill.hpp"

namespace spindrift::sph {

double signed_distance(const BodyShape& shape, Eigen::Vector3d x, Cut cut) {
  if (cut == Cut::plane) x[1] = 0.0;
  if (const auto* c = std::get_if<Cylinder>(&shape)) {
    const Eigen::Vector3d axis = c->axis();
    Eigen::Vector3d from = x - 0.5 * (c->start + c->end);
    if (cut == Cut::plane) from[1] = 0.0;
    const double along = from.dot(axis), across = (from - along * axis).norm();
    const double radius = c->radius(std::clamp(0.5 + along / c->length(), 0.0, 1.0));
    if (cut == Cut::plane && std::abs(axis[1]) > 0.5) return across - radius;
    const Eigen::Vector2d out(std::abs(along) - 0.5 * c->length(), across - radius);
    return out.cwiseMax(0.0).norm() + std::min(out.maxCoeff(), 0.0);
  }
  if (const auto* b = std::get_if<Box>(&shape)) {
    Eigen::Vector3d out = (x - b->centre).cwiseAbs() - 0.5 * b->size;
    if (cut == Cut::plane) out[1] = -1e300;
    return out.cwiseMax(0.0).norm() + std::min(out.maxCoeff(), 0.0);
  }
  if (const auto* m = std::get_if<Mesh>(&shape)) return m->surface->signed_distance(x + m->origin);
  const Sphere& s = std::get<Sphere>(shape);
  Eigen::Vector3d from = x - s.centre;
  if (cut == Cut::plane) from[1] = 0.0;
  return from.norm() - s.radius;
}

double volume_of(const BodyShape& shape, Cut cut) {
  if (cut != Cut::plane) return (cut == Cut::half ? 0.5 : 1.0) * std::visit([](const auto& s) { return s.volume(); }, shape);
  if (const auto* c = std::get_if<Cylinder>(&shape))
    return std::abs(c->axis()[1]) > 0.5 ? pi * c->start_radius * c->start_radius
                                        : (c->start_radius + c->end_radius) * c->length();
  if (const auto* b = std::get_if<Box>(&shape)) return b->size[0] * b->size[2];
  if (const auto* m = std::get_if<Mesh>(&shape)) return m->section();
  const double r = std::get<Sphere>(shape).radius;
  return pi * r * r;
}

namespace {

Points fill_cylinder(const Cylinder& c, double spacing, Cut cut) {
  Points points;
  const Eigen::Vector3d middle = 0.5 * (c.start + c.end), axis = c.axis();
  if (cut == Cut::plane && std::abs(axis[1]) > 0.5) {
    for (const Eigen::Vector2d& p : points_in_disc(c.start_radius, spacing))
      points.push_back(middle + Eigen::Vector3d(p[0], 0.0, p[1]));
    return points;
  }
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis);
  double owed = 0.0;
  for (double along : cell_centres(c.length(), spacing)) {
    const double radius = c.radius(0.5 + along / c.length());
    if (cut == Cut::plane) {
      const Eigen::Vector3d across = axis.cross(Eigen::Vector3d::UnitY());
      for (double offset : cell_centres(2.0 * radius, spacing)) points.push_back(middle + along * axis + offset * across);
    } else {
      for (const Eigen::Vector2d& p : points_in_disc(radius, spacing_across(c.length(), spacing), owed))
        points.push_back(middle + turn * Eigen::Vector3d(p[0], p[1], along));
    }
  }
  return points;
}

/// What is at y > 0 of a shape. Those that are symmetrical themselves are filled as halves, so that these have half the volume.
Points fill_half(const BodyShape& shape, double spacing) {
  constexpr double tiny = 1e-5;
  Points points;
  if (const auto* c = std::get_if<Cylinder>(&shape)) {
    const Eigen::Vector3d middle = 0.5 * (c->start + c->end), axis = c->axis();
    const bool central = std::abs(middle[1]) < tiny * c->length();
    if (central && std::abs(axis[1]) > 1.0 - tiny && c->start_radius == c->end_radius) {
      const Eigen::Vector3d& end = c->end[1] > middle[1] ? c->end : c->start;
      return fill_cylinder({middle, end, c->start_radius, c->end_radius}, spacing, Cut::space);
    }
    if (central && std::abs(axis[1]) < tiny) {
      const Eigen::Vector3d across = axis.cross(Eigen::Vector3d::UnitY());
      double owed = 0.0;
      for (double along : cell_centres(c->length(), spacing))
        for (const Eigen::Vector2d& p :
             points_in_half_disc(c->radius(0.5 + along / c->length()), spacing_across(c->length(), spacing), owed))
          points.push_back(middle + along * axis + p[0] * across + p[1] * Eigen::Vector3d::UnitY());
      return points;
    }
  } else if (const auto* b = std::get_if<Box>(&shape); b && std::abs(b->centre[1]) < tiny * b->size[1]) {
    const Eigen::Vector3d size(b->size[0], 0.5 * b->size[1], b->size[2]);
    points = points_in_box(size, spacing);
    for (Eigen::Vector3d& p : points) p += b->centre + 0.5 * size[1] * Eigen::Vector3d::UnitY();
    return points;
  } else if (const auto* s = std::get_if<Sphere>(&shape); s && std::abs(s->centre[1]) < tiny * s->radius) {
    points = points_in_half_sphere(s->radius, spacing);
    for (Eigen::Vector3d& p : points) p += s->centre;
    return points;
  }
  points = fill_shape(shape, spacing, Cut::space);
  std::erase_if(points, [](const Eigen::Vector3d& p) { return p[1] <= 0.0; });
  return points;
}

}  // namespace

Points fill_shape(const BodyShape& shape, double spacing, Cut cut) {
  if (cut == Cut::half) return fill_half(shape, spacing);
  if (const auto* c = std::get_if<Cylinder>(&shape)) return fill_cylinder(*c, spacing, cut);
  if (const auto* m = std::get_if<Mesh>(&shape)) return cut == Cut::plane ? fill_mesh<2>(*m, spacing) : fill_mesh<3>(*m, spacing);
  Points points;
  Eigen::Vector3d centre;
  if (const auto* b = std::get_if<Box>(&shape)) {
    centre = b->centre;
    points = points_in_box(cut == Cut::plane ? Eigen::Vector3d(b->size[0], 0.0, b->size[2]) : b->size, spacing);
  } else {
    const Sphere& s = std::get<Sphere>(shape);
    centre = s.centre;
    points = cut == Cut::plane ? points_in_cylinder(s.radius, 0.0, 1, spacing) : points_in_sphere(s.radius, spacing);
  }
  for (Eigen::Vector3d& p : points) p += centre;
  return points;
}

namespace {

/// Of a shape's particles as many as the room outside `earlier` has, in cells that those hold in part where they reach into it:
/// the farthest out, of equally far ones those nearest the surface of the whole body, which stays closed.
Points outside(const Points& points, std::span<const BodyShape> earlier, std::span<const BodyShape> all, double spacing,
               Cut cut) {
  constexpr double reach = 0.9;  // of a spacing: cells of shapes that touch are a few per cent smaller and are whole
  struct Cell {
    long out;        ///< of the earlier shapes, in millionths of a spacing
    double surface;  ///< signed distance from the whole body's
    std::size_t n;
  };
  std::vector<std::size_t> kept;
  std::vector<Cell> cut_cells;
  double room = 0.0;  // in them
  for (std::size_t n = 0; n < points.size(); ++n) {
    const double out = signed_distance(earlier, points[n], cut) / spacing, part = 0.5 + out / reach;
    if (part >= 1.0) kept.push_back(n);
    if (part <= 0.0 || part >= 1.0) continue;
    room += part;
    cut_cells.push_back({std::lround(1e6 * out), signed_distance(all, points[n], cut), n});
  }
  std::ranges::sort(cut_cells, [](const Cell& a, const Cell& b) {
    return a.out != b.out ? a.out > b.out : a.surface != b.surface ? a.surface > b.surface : a.n < b.n;
  });
  for (std::size_t n = 0; n < std::size_t(std::lround(room)); ++n) kept.push_back(cut_cells[n].n);
  std::ranges::sort(kept);
  Points left;
  for (const std::size_t n : kept) left.push_back(points[n]);
  return left;
}

}  // namespace

Points fill_body(std::span<const BodyShape> shapes, double spacing, Cut cut) {
  Points all;
  for (std::size_t n = 0; n < shapes.size(); ++n) {
    Points points = fill_shape(shapes[n], spacing, cut);
    if (n > 0) points = outside(points, shapes.first(n), shapes, spacing, cut);
    all.insert(all.end(), points.begin(), points.end());
  }
  return all;
}

double wetted_volume(const Points& points, const Motion& motion, double cell, double edge) {
  double wetted = 0.0;
  for (const Eigen::Vector3d& x : points) wetted += cell * std::clamp(0.5 - motion.point(x)[2] / edge, 0.0, 1.0);
  return wetted;
}

std::optional<double> rise_to_float(const Points& points, const Motion& motion, double cell, double edge, double volume) {
  if (double(points.size()) * cell < volume) return std::nullopt;
  double lowest = 1e300, highest = -1e300;
  for (const Eigen::Vector3d& x : points)
    lowest = std::min(lowest, motion.point(x)[2]), highest = std::max(highest, motion.point(x)[2]);
  double under = -highest - edge, over = edge - lowest;  // all of it in the water; none
  for (int halving = 0; halving < 60; ++halving) {
    Motion moved = motion;
    moved.position[2] += 0.5 * (under + over);
    (wetted_volume(points, moved, cell, edge) > volume ? under : over) = 0.5 * (under + over);
  }
  return 0.5 * (under + over);
}

double signed_distance(std::span<const BodyShape> shapes, const Eigen::Vector3d& x, Cut cut) {
  double nearest = 1e300;
  for (const BodyShape& shape : shapes) nearest = std::min(nearest, signed_distance(shape, x, cut));
  return nearest;
}

}  // namespace spindrift::sph
