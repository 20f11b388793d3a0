// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "kernels/base/constants.hpp"
#include "kernels/base/smooth_step.hpp"
#include "kernels/grid/ray.hpp"
#include "kernels/grid/stretching.hpp"

namespace spindrift::aero {

namespace {

using Eigen::Vector2d;
using Nodes = std::vector<Vector2d>;

// ---- H lines
// -------------------------------------------------------------------------------------------------------------------

/// Axial sizes from the box outward, to the distance `length`; far away they are those of the radius `reach` on every surface.
std::vector<double> axial_sizes(const RotorLayout& layout, double r, int cells, double edge, double sign) {
  const auto sizes = [&](double at) {
    const RotorLayout::Box box = layout.box(at);
    std::vector<double> size(static_cast<std::size_t>(cells));
    geometric_sizes(2.0 * box.half_x / layout.spec().sizes.box, sign * edge - (sign * box.x + box.half_x), size);
    return size;
  };
  std::vector<double> here = sizes(r);
  const std::vector<double> there = sizes(layout.reach());
  const double length = std::accumulate(here.begin(), here.end(), 0.0);
  double total = 0.0;
  for (int m = 0; m < cells; ++m) {
    const double w = smooth_step(double(m) / (0.5 * cells));
    double& size = here[std::size_t(m)];
    size = std::exp((1.0 - w) * std::log(size) + w * std::log(there[std::size_t(m)]));
    total += size;
  }
  for (double& size : here) size *= length / total;
  return here;
}

/// Lines of one direction: `low` sizes outward from the box's low side, equal ones across the box, `high` sizes.
std::vector<double> lines(const std::vector<double>& low, double begin, double end, int cells, const std::vector<double>& high) {
  std::vector<double> at;
  double x = begin;
  for (const double s : low) at.push_back(x -= s);
  std::reverse(at.begin(), at.end());
  for (int m = 0; m <= cells; ++m) at.push_back(begin + (end - begin) * m / cells);
  x = end;
  for (const double s : high) at.push_back(x += s);
  return at;
}

void fill_h(const RotorLayout& layout, Plane& plane) {
  const RotorGridSizes& n = layout.spec().sizes;
  const RotorLayout::Box box = layout.box(plane.r);
  const double tip_extent = layout.radii().back() / layout.spec().radial_extent;
  const double front = -layout.spec().upstream_extent * tip_extent, back = layout.spec().downstream_extent * tip_extent;
  std::vector<double> x = lines(axial_sizes(layout, plane.r, n.upstream, front, -1.0), box.x - box.half_x, box.x + box.half_x,
                                n.box, axial_sizes(layout, plane.r, n.downstream, back, 1.0));
  x.front() = front, x.back() = back;
  const double side = layout.sector(plane.r), cell = 2.0 * box.half_s / n.box_chordwise();
  const auto beside = [&](double length) {
    std::vector<double> size(std::size_t(n.beside));
    geometric_sizes(std::min(cell, length / n.beside), length, size);
    return size;
  };
  std::vector<double> s = lines(beside(side + box.s - box.half_s), box.s - box.half_s, box.s + box.half_s, n.box_chordwise(),
                                beside(side - box.s - box.half_s));
  s.front() = -side, s.back() = side;
  plane.across = n.across(), plane.axial = n.axial();
  plane.h_nodes.reserve(s.size() * x.size());
  constexpr double fan = 0.7;  // far up- and downstream the lines are this near to equal spacing
  for (int I = 0; I <= plane.axial; ++I) {
    const double at = x[std::size_t(I)];
    const double w = fan * (at < box.x ? smooth_step((box.x - box.half_x - at) / (box.x - box.half_x - front))
                                       : smooth_step((at - box.x - box.half_x) / (back - box.x - box.half_x)));
    for (int J = 0; J <= plane.across; ++J) {
      const double equal = -side + 2.0 * side * J / plane.across, near = s[std::size_t(J)];
      const bool edge = J == 0 || J == plane.across;  // exact on the sector's sides, which meet other sectors
      plane.h_nodes.emplace_back(edge ? near : near + w * (equal - near), at);
    }
  }
}

// ---- the inner side of the O
// -----------------------------------------------------------------------------------------------------

/// The plug's boundary beyond the tip: the tip's plate, growing thicker and longer, its nodes turning to equal spacing.
void fill_plug_boundary(const BladeSurface& blade, const RotorLayout& layout, std::span<const SurfacePoint> tip, Plane& plane) {
  const RotorGridSizes& n = layout.spec().sizes;
  const double R = blade.tip_radius(), beyond = plane.r - R, chord = blade.tip_chord();
  const Vector2d along = blade.tip_chord_direction(), up(-along.y(), along.x());
  const auto point = [&](int i) {
    const SurfacePoint& p = tip[std::size_t((i + n.round) % n.round)];
    return Vector2d(p.s * plane.r / R, p.x);
  };
  const int half = n.round / 2, end = n.edge / 2;
  const Vector2d tail = 0.5 * (point(end) + point(-end)), nose = 0.5 * (point(half - end) + point(half + end));
  const Vector2d middle = 0.5 * (tail + nose);
  const double reach = 0.225 * R, plate = 0.5 * (point(end) - point(-end)).norm(), length0 = (nose - tail).norm();
  const double length = length0 * (3.0 - 2.0 * std::exp(-beyond / reach));
  const double most = std::max(1.01 * plate, n.edge * length / n.chordwise());  // cells of the plug as thick as two long
  const double thick = plate + 0.12 * beyond / (1.0 + 0.12 * beyond / (most - plate));
  const double even = 1.0 - std::exp(-beyond / (4.0 * chord));
  for (int i = 0; i < n.round; ++i) {
    // Place along and across the plate at the tip, each scaled.
    const Vector2d p = point(i) - middle;
    const int from_tail = std::clamp(i <= half ? i - end : n.round - i - end, 0, n.chordwise());
    const double equal = (double(from_tail) / n.chordwise() - 0.5) * length0;
    const Vector2d q = point(n.round - i) - middle;
    const double mean = 0.5 * (p + q).dot(up), side = 0.5 * (p - q).dot(up), ahead = p.dot(along);
    plane.ring_nodes[plane.ring.at(i, 0)] = middle + along * ((1.0 - even) * ahead + even * equal) * (length / length0) +
                                            up * (mean * (1.0 - even) + side * thick / plate);
  }
}

// ---- rays of the O
// ---------------------------------------------------------------------------------------------------------------

/// Outward normals of the inner side as angles, smoothed over about two nodes of 120.
std::vector<double> normals(const Plane& plane) {
  const std::size_t round = std::size_t(plane.ring.round);
  std::vector<double> angle(round), work(round);
  const int sweeps = std::max(2, int(std::lround(2.0 * std::pow(plane.ring.round / 60.0, 2))));
  smoothed_normals(std::span(plane.ring_nodes).first(round), sweeps, angle, work);
  return angle;
}

/// Directions out of the box at its nodes, turning evenly from diagonal to diagonal.
double arrival(const RotorGridSizes& n, int roll, int i) {
  int m = i - n.box / 2 - roll;
  m = ((m % n.round) + n.round) % n.round;
  const std::array<int, 4> length{n.box_chordwise(), n.box, n.box_chordwise(), n.box};
  double corner = -0.75 * pi;
  for (const int l : length) {
    if (m <= l) return corner + 0.5 * pi * m / l;
    m -= l, corner += 0.5 * pi;
  }
  return corner;
}

/// Lengths that the rays' sizes are made for: those of the rays, smoothed over a sixteenth of the way round. Rays to the box's
/// corners are longer than their neighbours; in proportion to its own length the layers of each would leave the wall in spikes,
/// which next to the nose, where nodes stand closer than layers, lie along the layers themselves.
std::vector<double> smoothed_lengths(const std::vector<double>& length) {
  const std::size_t n = length.size();
  std::vector<double> smooth(length), last(n);
  const int sweeps = std::max(2, int(std::lround(2.0 * std::pow(double(n) / 16.0, 2))));
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    smooth.swap(last);
    for (std::size_t i = 0; i < n; ++i) smooth[i] = 0.5 * last[i] + 0.25 * (last[(i + 1) % n] + last[(i + n - 1) % n]);
  }
  return smooth;
}

void fill_rays(const RotorLayout& layout, int k, Plane& plane) {
  const RotorGridSizes& n = layout.spec().sizes;
  const std::vector<double> angle = normals(plane);
  const double first = layout.first_cell(k);
  constexpr double handle = 0.12;  // of the ray's length; long handles make rays cross
  std::vector<double> size(std::size_t(n.layers));
  // Sizes that the H lines begin with, on the four sides of the box.
  const auto h = [&](int J, int I) { return plane.h(J, I); };
  const int J0 = n.beside, J1 = n.beside + n.box_chordwise(), I0 = n.upstream, I1 = n.upstream + n.box;
  const double h_cell = 0.25 * ((h(J0, I0) - h(J0 - 1, I0)).norm() + (h(J1 + 1, I0) - h(J1, I0)).norm() +
                                (h(J0, I0) - h(J0, I0 - 1)).norm() + (h(J0, I1 + 1) - h(J0, I1)).norm());
  std::vector<Ray> rays;
  std::vector<double> length;
  for (int i = 0; i < n.round; ++i) {
    const Vector2d wall = plane.ring_nodes[plane.ring.at(i, 0)];
    const BoxNode b = box_node(n, layout.roll(), i);
    const Vector2d out = plane.h(b.J, b.I);
    const double apart = (out - wall).norm(), arrive = arrival(n, layout.roll(), i), leave = angle[std::size_t(i)];
    rays.emplace_back(std::array<Vector2d, 4>{wall, wall + handle * apart * Vector2d(std::cos(leave), std::sin(leave)),
                                              out - handle * apart * Vector2d(std::cos(arrive), std::sin(arrive)), out});
    length.push_back(rays.back().length());
    plane.ring_nodes[plane.ring.at(i, n.layers)] = out;
  }
  // On few layers what is missing would show in their growth, and there nodes do not stand closer than layers.
  const std::vector<double> even = n.round < 64 ? length : smoothed_lengths(length);
  for (int i = 0; i < n.round; ++i) {
    const double made = even[std::size_t(i)], more = length[std::size_t(i)] / made - 1.0;
    if (n.round < 64)
      geometric_sizes(first, made, size);
    else
      limited_sizes(first, std::max(3.0 * h_cell, 1.8 * made / n.layers), made, size);
    double s = 0.0;
    for (int j = 1; j < n.layers; ++j) {
      s += size[std::size_t(j) - 1];
      plane.ring_nodes[plane.ring.at(i, j)] =
          rays[std::size_t(i)].at_length(s * (1.0 + more * s / made));  // what is missing comes far off the wall
    }
  }
}

void smooth(double chord, Plane& plane) {
  const RingShape ring = plane.ring;
  std::vector<double> phi(ring.size()), psi(ring.size()), share(ring.size());
  middlecoff_controls(ring, plane.ring_nodes, phi, psi);
  constexpr double damping = 0.6;
  for (int i = 0; i < ring.round; ++i) {
    const auto size = [&](int j) { return (plane.ring_nodes[ring.at(i, j + 1)] - plane.ring_nodes[ring.at(i, j)]).norm(); };
    double stretch = 1.0, distance = 0.0;
    for (int j = 1; j < ring.layers; ++j) stretch = std::max(stretch, size(j) / size(j - 1));
    // Where sizes jump, the equations as differenced here fold convex corners.
    const double most = damping * smooth_step((3.1 - stretch) / 0.8);
    for (int j = 0; j < ring.layers; distance += size(j++))
      share[ring.at(i, j)] =
          most * smooth_step((distance / chord - 0.05) / 0.30) * smooth_step(4.0 * (1.0 - double(j) / ring.layers));
  }
  Nodes next(plane.ring_nodes);
  constexpr int sweeps = 15;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    winslow_sweep(ring, plane.ring_nodes, phi, psi, share, next);
    plane.ring_nodes.swap(next);
  }
}

/// Inside of the plug from its four sides: transfinite interpolation, Gordon & Hall (1973).
void fill_plug(const RotorGridSizes& n, Plane& plane) {
  const int ni = n.chordwise(), nj = n.edge, end = n.edge / 2;
  plane.chordwise = ni, plane.edge = nj;
  const auto inner = [&](int i) { return plane.ring_nodes[plane.ring.at(i, 0)]; };
  const auto low = [&](int i) { return inner(end + i); };
  const auto high = [&](int i) { return inner(n.round - end - i); };
  const auto tail = [&](int j) { return inner(end - j); };
  const auto nose = [&](int j) { return inner(n.round / 2 - end + j); };
  plane.plug_nodes.resize(std::size_t(ni + 1) * std::size_t(nj + 1));
  for (int j = 0; j <= nj; ++j)
    for (int i = 0; i <= ni; ++i) {
      const double u = double(i) / ni, v = double(j) / nj;
      Vector2d p = (1.0 - v) * low(i) + v * high(i) + (1.0 - u) * tail(j) + u * nose(j) -
                   ((1.0 - u) * ((1.0 - v) * low(0) + v * high(0)) + u * ((1.0 - v) * low(ni) + v * high(ni)));
      if (j == 0) p = low(i);
      if (j == nj) p = high(i);
      if (i == 0) p = tail(j);
      if (i == ni) p = nose(j);
      plane.plug_nodes[std::size_t(j) * std::size_t(ni + 1) + std::size_t(i)] = p;
    }
}

}  // namespace

BoxNode box_node(const RotorGridSizes& n, int roll, int i) {
  const int na = n.box_chordwise(), nb = n.box, J0 = n.beside, I0 = n.upstream;
  int m = (((i - nb / 2 - roll) % n.round) + n.round) % n.round;
  if (m <= na) return {J0 + m, I0};
  m -= na;
  if (m <= nb) return {J0 + na, I0 + m};
  m -= nb;
  if (m <= na) return {J0 + na - m, I0 + nb};
  return {J0, I0 + nb - (m - na)};
}

Plane make_plane(const BladeSurface& blade, const RotorLayout& layout, int k) {
  const RotorGridSizes& n = layout.spec().sizes;
  Plane plane;
  plane.r = layout.radii()[std::size_t(k)];
  plane.ring = {n.round, n.layers};
  plane.ring_nodes.resize(plane.ring.size());
  fill_h(layout, plane);
  std::vector<SurfacePoint> section(std::size_t(n.round));
  blade.cut(std::min(plane.r, blade.tip_radius()), section);
  if (k <= n.span)
    for (int i = 0; i < n.round; ++i)
      plane.ring_nodes[plane.ring.at(i, 0)] = {section[std::size_t(i)].s, section[std::size_t(i)].x};
  else
    fill_plug_boundary(blade, layout, section, plane);
  fill_rays(layout, k, plane);
  if (n.round >= 64) smooth(blade.chord(plane.r), plane);
  if (k >= n.span) fill_plug(n, plane);
  return plane;
}

}  // namespace spindrift::aero
