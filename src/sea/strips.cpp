// Cylinders cut into strips: see strips.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/strips.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/waves/wetted_cylinder.hpp"
#include "kernels/waves/wetted_frustum.hpp"

namespace spindrift::sea {
namespace {

/// Share of a disc that is under water; height of its centre over the surface, lean: sine of its angle to the surface.
double wet_share(double height, double lean, double radius) {
  return waves::segment_moments(waves::rim_point(-height, lean * radius)).area / pi;
}

/// A piece of a strip in fractions of its length.
struct Interval {
  double from = 0.0, to = 0.0;
  bool empty() const { return to <= from; }
};

/// Where a height that runs linearly from `start` to `end` is negative.
Interval below_water(double start, double end) {
  if (start >= 0.0 && end >= 0.0) return {};
  const double crossing = start / (start - end);
  return {start >= 0.0 ? crossing : 0.0, end >= 0.0 ? crossing : 1.0};
}

}  // namespace

ExposedEnd exposed_end(std::span<const EndDisc> discs) {
  constexpr double covered = 1e-9;  // what is left of discs that cover each other but for round-off
  Eigen::Vector3d squares = Eigen::Vector3d::Zero(), cubes = Eigen::Vector3d::Zero();
  double square = 0.0, cube = 0.0, drag = 0.0, added_mass = 0.0;
  ExposedEnd end;
  for (const EndDisc& d : discs) {
    const double r2 = d.radius * d.radius, r3 = r2 * d.radius;
    squares += r2 * d.normal, cubes += r3 * d.normal;
    square += r2, cube += r3, drag += r2 * d.drag, added_mass += r3 * d.added_mass;
    end.radius = std::max(end.radius, d.radius);
  }
  if (const double n = squares.norm(); n > covered * square) end.area = pi * n, end.area_normal = squares / n;
  if (const double n = cubes.norm(); n > covered * cube) end.cube = n, end.cube_normal = cubes / n;
  if (square > 0.0) end.drag = drag / square, end.added_mass = added_mass / cube;
  return end;
}

void append_strips(const Cylinder& cylinder, const Coefficients& coefficients, const std::array<ExposedEnd, 2>& ends,
                   double longest, std::vector<Strip>& strips) {
  const int count = std::max(1, int(std::ceil(cylinder.length() / longest * (1.0 - 1e-12))));
  for (int i = 0; i < count; ++i) {
    const double from = double(i) / count, to = double(i + 1) / count;
    strips.push_back({{cylinder.at(from), cylinder.at(to), cylinder.radius(from), cylinder.radius(to)},
                      coefficients,
                      {i == 0 ? ends[0] : ExposedEnd{}, i + 1 == count ? ends[1] : ExposedEnd{}},
                      -1});
  }
}

waves::Wetted wetted_part(const Cylinder& shape, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                          const waves::WaterPlane& surface) {
  if (shape.tapered()) return waves::wetted_frustum(start, end, shape.start_radius, shape.end_radius, surface);
  return waves::wetted_cylinder(start, end, shape.start_radius, surface);
}

WettedStrip wetted_strip(const Strip& strip, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                         const waves::WaterPlane& surface) {
  WettedStrip out;
  out.axis = (end - start).normalized();
  out.wetted = wetted_part(strip.shape, start, end, surface);
  const double rise = surface.normal.dot(out.axis), lean = (surface.normal - rise * out.axis).norm();
  const double start_radius = strip.shape.start_radius, end_radius = strip.shape.end_radius;
  const double start_height = surface.height(start), end_height = surface.height(end);
  const auto share = [&](const ExposedEnd& e, double height) { return e.exposed() ? wet_share(height, lean, e.radius) : 0.0; };
  out.ends = {WettedEnd{start, share(strip.ends[0], start_height)}, WettedEnd{end, share(strip.ends[1], end_height)}};

  // Two Gauss points where cross-sections are wholly wet and two where they are partly wet share the exact volume in proportion
  // to their wet cross-sections. (Two over both together put the points of an upright float 0.15 m too high in the paper's wave.)
  const Interval wet = below_water(start_height - lean * start_radius, end_height - lean * end_radius);
  const Interval full = below_water(start_height + lean * start_radius, end_height + lean * end_radius);
  const Interval part = full.empty() ? wet : full.from > wet.from ? Interval{wet.from, full.from} : Interval{full.to, wet.to};
  double sum = 0.0;
  for (const Interval& piece : {full, part}) {
    if (piece.empty()) continue;
    for (const double gauss : {0.21132486540518711775, 0.78867513459481288225}) {
      const double fraction = piece.from + gauss * (piece.to - piece.from), radius = strip.shape.radius(fraction);
      const double height = start_height + fraction * (end_height - start_height);
      const double volume = (piece.to - piece.from) * radius * radius * wet_share(height, lean, radius);
      const Eigen::Vector3d arm = start + fraction * (end - start);
      out.stations[out.count++] = {arm, arm, volume, radius};
      sum += volume;
    }
  }
  Eigen::Vector3d beside = out.wetted.first_moment;
  for (Station& s : std::span(out.stations).first(out.count)) {
    s.volume *= sum > 0.0 ? out.wetted.volume / sum : 0.0;
    beside -= s.volume * s.arm;
  }
  if (part.empty()) return out;
  const std::span<Station> partly_wet = std::span(out.stations).subspan(out.count - 2, 2);
  if (const double volume = partly_wet[0].volume + partly_wet[1].volume; volume > 0.0)
    for (Station& s : partly_wet) s.water += beside / volume;
  return out;
}

}  // namespace spindrift::sea
