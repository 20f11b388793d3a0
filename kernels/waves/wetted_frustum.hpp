// Wetted volume and centre of a cone frustum (also a full cone, also a cylinder) cut by a plane at any draft and attitude.
// Method: divergence theorem about a point O of the surface plane, V = 1/3 sum of (x . n) dA and int x dV = 1/4 sum of x (x . n)
// dA, to which the water plane itself adds nothing. End discs: moments of circular segments, closed form. Cone: exact along each
// generator, sixteen Gauss points over each arc of generators that are cut alike (docs/theory/sea_engineering.md, section 1).
// Near the tip of a pointed cone that converges slowly, so there it is cut into pieces of at most fourfold taper: 3e-5 before,
// 1e-10 of the whole after. Called by src/sea/strips for tapered members; tested in tests/kernels/waves/wetted_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <utility>

#include "kernels/waves/wetted.hpp"

namespace spindrift::waves {

/// Gauss-Legendre, sixteen points, positive half (Abramowitz & Stegun, table 25.4).
inline constexpr std::array<double, 8> gauss16_point = {0.095012509837637440, 0.281603550779258913, 0.458016777657227386,
                                                        0.617876244402643748, 0.755404408355003034, 0.865631202387831744,
                                                        0.944575023073232576, 0.989400934991649933};
inline constexpr std::array<double, 8> gauss16_weight = {0.189450610455068496, 0.182603415044923589, 0.169156519395002538,
                                                         0.149595988816576732, 0.124628971255533872, 0.095158511682492785,
                                                         0.062253523938647893, 0.027152459411754095};

/// In the frame of the frustum: s along the axis from the start, x across it up the surface normal, both from the start centre.
struct FrustumFrame {
  double length, start_radius, taper;  ///< radius(s) = start_radius + taper s
  double height, rise, lean;           ///< height over the surface = height + rise s + lean x
};
/// Volume and first moments along s and x, about the start centre.
struct FrustumSums {
  double volume = 0.0, along = 0.0, across = 0.0;
};

/// The wet part of one end disc at s, outward normal `sign` along the axis. O lies at (s, x) = -height (rise, lean).
inline void add_end(const FrustumFrame& f, double s, double sign, FrustumSums& sum) {
  const double r = f.start_radius + f.taper * s;
  const SegmentMoments wet = segment_moments(rim_point(-(f.height + f.rise * s), f.lean * r));
  const double area = r * r * wet.area, first = r * r * r * wet.first;
  const double along_o = s + f.height * f.rise, across_o = f.height * f.lean;  // of the disc's centre from O
  const double out = sign * along_o;
  sum.volume += out * area / 3.0;
  sum.along += 0.25 * out * along_o * area;
  sum.across += 0.25 * out * (first + across_o * area);
}

/// The wet part of the cone over generators at angle a ... b from x and their mirror images, with one kind of cut throughout.
inline void add_cone_arc(const FrustumFrame& f, double a, double b, FrustumSums& sum) {
  const double middle = 0.5 * (a + b), half = 0.5 * (b - a), end_radius = f.start_radius + f.taper * f.length;
  for (std::size_t i = 0; i < gauss16_point.size(); ++i) {
    for (const double side : {-1.0, 1.0}) {
      const double c = std::cos(middle + side * half * gauss16_point[i]);
      const double start_height = f.height + f.lean * f.start_radius * c;
      const double end_height = f.height + f.rise * f.length + f.lean * end_radius * c;
      if (start_height >= 0.0 && end_height >= 0.0) continue;
      double from = 0.0, to = f.length;
      const double crossing = f.length * start_height / (start_height - end_height);
      if (start_height > 0.0) from = crossing;
      if (end_height > 0.0) to = crossing;
      // With r = r0 + t s: x . n dA = (r + c across_o - t along_o) r ds d(angle) is quadratic in s, x (x . n) dA cubic:
      // two Gauss points are exact.
      const double mid = 0.5 * (from + to), h = 0.5 * (to - from);
      for (const double point : {-0.57735026918962576451, 0.57735026918962576451}) {
        const double s = mid + h * point, r = f.start_radius + f.taper * s;
        const double along_o = s + f.height * f.rise, across_o = f.height * f.lean;
        const double weight = 2.0 * gauss16_weight[i] * half * h * r * (r + c * across_o - f.taper * along_o);
        sum.volume += weight / 3.0;
        sum.along += 0.25 * weight * along_o;
        sum.across += 0.25 * weight * (r * c + across_o);
      }
    }
  }
}

/// Start and end: centres of the end discs [m]; the radii differ at most fourfold for full accuracy.
inline Wetted wetted_frustum_piece(const Eigen::Vector3d& start, const Eigen::Vector3d& end, double start_radius,
                                   double end_radius, const WaterPlane& surface) {
  Eigen::Vector3d axis = end - start;
  const double length = axis.norm();
  axis /= length;
  const double rise = surface.normal.dot(axis);
  const Eigen::Vector3d across = surface.normal - rise * axis;
  const FrustumFrame f{length, start_radius, (end_radius - start_radius) / length, surface.height(start), rise, across.norm()};
  const double end_height = f.height + rise * length;
  if (f.height >= f.lean * start_radius && end_height >= f.lean * end_radius) return {};
  FrustumSums sum;
  if (f.height <= -f.lean * start_radius && end_height <= -f.lean * end_radius) {
    const double a = start_radius, b = end_radius;
    sum.volume = pi / 3.0 * length * (a * a + a * b + b * b);
    sum.along = pi / 12.0 * length * length * (a * a + 2.0 * a * b + 3.0 * b * b);
  } else {
    add_end(f, 0.0, -1.0, sum);
    add_end(f, length, 1.0, sum);
    const double first = rim_point(-f.height, f.lean * start_radius).angle;
    const double second = rim_point(-end_height, f.lean * end_radius).angle;
    const std::array<double, 4> arc = {0.0, std::min(first, second), std::max(first, second), pi};
    for (std::size_t i = 0; i + 1 < arc.size(); ++i)
      if (arc[i + 1] > arc[i]) add_cone_arc(f, arc[i], arc[i + 1], sum);
    sum.along -= sum.volume * f.height * rise;  // from O to the start centre
    sum.across -= sum.volume * f.height * f.lean;
  }
  Eigen::Vector3d moment = sum.volume * start + sum.along * axis;
  if (f.lean > 0.0) moment += sum.across / f.lean * across;
  return {sum.volume, moment};
}

/// Start and end: centres of the end discs [m]; either radius may be zero.
inline Wetted wetted_frustum(Eigen::Vector3d start, Eigen::Vector3d end, double start_radius, double end_radius,
                             const WaterPlane& surface) {
  if (start_radius < end_radius) std::swap(start, end), std::swap(start_radius, end_radius);
  Wetted sum;
  const double tip = 1e-4 * start_radius;  // beyond this the rest holds less than 1e-12 of the volume
  while (end_radius < 0.25 * start_radius && start_radius > tip) {
    const Eigen::Vector3d cut = start + 0.75 * start_radius / (start_radius - end_radius) * (end - start);
    const Wetted piece = wetted_frustum_piece(start, cut, start_radius, 0.25 * start_radius, surface);
    sum.volume += piece.volume;
    sum.first_moment += piece.first_moment;
    start = cut;
    start_radius *= 0.25;
  }
  const Wetted last = wetted_frustum_piece(start, end, start_radius, end_radius, surface);
  return {sum.volume + last.volume, sum.first_moment + last.first_moment};
}

}  // namespace spindrift::waves
