// SPDX-License-Identifier: Apache-2.0
#include "src/sea/still_water.hpp"

#include <algorithm>
#include <cmath>

#include "src/sea/strips.hpp"

namespace spindrift::sea {

namespace {

waves::Wetted wetted_sphere(const Eigen::Vector3d& centre, double radius, double level) {
  const double deep = std::clamp(level - (centre.z() - radius), 0.0, 2.0 * radius);
  if (deep == 0.0) return {};
  const double volume = pi / 3.0 * deep * deep * (3.0 * radius - deep);
  const double below = 0.75 * (2.0 * radius - deep) * (2.0 * radius - deep) / (3.0 * radius - deep);
  return {volume, volume * (centre - below * Eigen::Vector3d::UnitZ())};
}

/// The surface's points with y from its middle times `share`.
std::shared_ptr<const ClosedSurface> narrowed(const ClosedSurface& surface, double share) {
  Triangulation narrow;
  const double middle = surface.box().center()[1];
  for (const Eigen::Vector3d& x : surface.points()) narrow.points.emplace_back(x[0], share * (x[1] - middle), x[2]);
  narrow.triangles.assign(surface.triangles().begin(), surface.triangles().end());
  return std::make_shared<const ClosedSurface>(std::move(narrow));
}

std::vector<Eigen::Vector3d> rectangle(const Box& b) {
  const double x = 0.5 * b.size[0], z = 0.5 * b.size[2];
  const Eigen::Vector3d& c = b.centre;
  return {{c[0] - x, 0.0, c[2] - z}, {c[0] + x, 0.0, c[2] - z}, {c[0] + x, 0.0, c[2] + z}, {c[0] - x, 0.0, c[2] + z}};
}

}  // namespace

StillWater::StillWater(std::span<const std::vector<sph::BodyShape>> bodies, double weight, sph::Cut cut, double width)
    : weight_(weight), width_(width), cut_(cut) {
  for (const std::vector<sph::BodyShape>& shapes : bodies) {
    Body& body = bodies_.emplace_back();
    for (std::size_t n = 0; n < shapes.size(); ++n) {
      body.solids.push_back(solid_of(shapes[n]));
      if (n == 0) continue;
      Shared shared = shared_by(shapes[n], std::span(shapes).first(n));
      if (!shared.cells.empty()) body.shared.push_back(std::move(shared));
    }
  }
}

StillWater::Solid StillWater::drawn_out(const std::vector<Eigen::Vector3d>& corners) const {
  Outline outline{corners, {}};
  for (int k = 0; k < int(corners.size()); ++k) outline.segments.push_back({k, (k + 1) % int(corners.size())});
  const ClosedSurface prism = prism_of(outline);
  return Surface{narrowed(prism, width_ / prism.box().sizes()[1])};
}

StillWater::Solid StillWater::solid_of(const sph::BodyShape& shape) const {
  const bool planar = cut_ == sph::Cut::plane;
  const auto disc = [this](const Eigen::Vector3d& middle, double radius) {
    const Eigen::Vector3d centre(middle[0], 0.0, middle[2]), half = 0.5 * width_ * Eigen::Vector3d::UnitY();
    return Cylinder{.start = centre - half, .end = centre + half, .start_radius = radius, .end_radius = radius};
  };
  if (const auto* c = std::get_if<Cylinder>(&shape)) {
    if (!planar) return *c;
    const Eigen::Vector3d axis = c->axis();
    if (std::abs(axis[1]) > 0.5) return disc(0.5 * (c->start + c->end), c->start_radius);
    const Eigen::Vector3d across = axis.cross(Eigen::Vector3d::UnitY());
    return drawn_out({c->start - c->start_radius * across, c->end - c->end_radius * across, c->end + c->end_radius * across,
                      c->start + c->start_radius * across});
  }
  if (const auto* b = std::get_if<Box>(&shape)) {
    if (planar) return drawn_out(rectangle(*b));
    const Eigen::Vector3d low = b->centre - 0.5 * b->size;
    Triangulation box;
    for (int k = 0; k < 8; ++k) box.points.emplace_back(low + Eigen::Vector3d(k & 1, k >> 1 & 1, k >> 2).cwiseProduct(b->size));
    box.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return Surface{std::make_shared<const ClosedSurface>(std::move(box))};
  }
  if (const auto* m = std::get_if<Mesh>(&shape)) {
    if (!planar) return Surface{m->surface, m->origin};
    return Surface{narrowed(*m->surface, width_ / m->surface->box().sizes()[1]), {m->origin[0], 0.0, m->origin[2]}};
  }
  const Sphere& s = std::get<Sphere>(shape);
  if (planar) return disc(s.centre, s.radius);
  return s;
}

StillWater::Shared StillWater::shared_by(const sph::BodyShape& shape, std::span<const sph::BodyShape> earlier) const {
  constexpr double cells = 8e3;  // to a shape: 20 along each side of a cube
  const bool planar = cut_ == sph::Cut::plane;
  const double size = sph::volume_of(shape, cut_), edge = std::pow(size / cells, planar ? 1.0 / 2.0 : 1.0 / 3.0);
  const sph::Points all = sph::fill_shape(shape, edge, cut_);
  const double cell = size * (planar ? width_ : 1.0) / double(all.size());
  Shared shared{.cells = {}, .edge = edge};
  for (const Eigen::Vector3d& x : all) {  // a cell on the surface of another shape is shared in part
    const double share = std::clamp(0.5 - sph::signed_distance(earlier, x, cut_) / edge, 0.0, 1.0);
    if (share > 0.0) shared.cells.push_back({x, share * cell});
  }
  return shared;
}

waves::Wetted StillWater::wetted(std::size_t b, const Motion& motion) const {
  const Eigen::Matrix3d turn = motion.attitude.toRotationMatrix();
  const double level = -motion.position.z();  // of the water over the centre of mass
  waves::Wetted sum;
  const auto add = [&sum](const waves::Wetted& part) { sum.volume += part.volume, sum.first_moment += part.first_moment; };
  for (const Solid& solid : bodies_[b].solids)
    if (const auto* c = std::get_if<Cylinder>(&solid))
      add(wetted_part(*c, turn * c->start, turn * c->end, {Eigen::Vector3d::UnitZ(), level}));
    else if (const auto* s = std::get_if<Sphere>(&solid))
      add(wetted_sphere(turn * s->centre, s->radius, level));
    else {
      const Surface& of = std::get<Surface>(solid);
      const Submerged under = submerged(*of.surface, turn, -level * Eigen::Vector3d::UnitZ() - turn * of.origin);
      add({under.volume, under.volume * (under.centre + level * Eigen::Vector3d::UnitZ())});
    }
  for (const Shared& shared : bodies_[b].shared)
    for (const Shared::Cell& cell : shared.cells) {
      const Eigen::Vector3d at = turn * cell.place;
      const double volume = cell.volume * std::clamp(0.5 + (level - at.z()) / shared.edge, 0.0, 1.0);
      add({-volume, -volume * at});
    }
  return sum;
}

void StillWater::add_loads(std::span<const Motion> bodies, std::span<Wrench> wrenches) const {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (bodies_[b].solids.empty()) continue;
    const waves::Wetted under = wetted(b, bodies[b]);
    Eigen::Vector3d moment = weight_ * under.first_moment.cross(Eigen::Vector3d::UnitZ());
    if (cut_ == sph::Cut::plane) moment[0] = moment[2] = 0.0;
    wrenches[b].force[2] += weight_ * under.volume;
    wrenches[b].moment += moment;
  }
}

}  // namespace spindrift::sea
