// Wetted volume and centre of a circular cylinder with flat ends, cut by a plane at any draft and attitude, exactly.
// Method: the length of each axis-parallel chord under water, clamp((surface - point)/alpha, 0, L), integrated over the disc by
// the moments of circular segments (docs/theory/sea_engineering.md, section 1); no case distinction between cut ends and cut
// sides. Called by src/sea/strips; tested in tests/kernels/waves/wetted_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "kernels/waves/wetted.hpp"

namespace spindrift::waves {

/// Gauss-Legendre points and weights on [-1, 1], the positive half of eight points (Abramowitz & Stegun, table 25.4).
inline constexpr std::array<double, 4> gauss8_point = {0.183434642495649805, 0.525532409916328986, 0.796666477413626740,
                                                       0.960289856497536232};
inline constexpr std::array<double, 4> gauss8_weight = {0.362683783378361983, 0.313706645877887287, 0.222381034453374471,
                                                        0.101228536290376259};

/// Integrals over a strip of the unit disc of the wet chord length l(x) = (level - tilt x), of x l and of l^2 / 2.
struct ChordIntegrals {
  double length = 0.0, first = 0.0, half_square = 0.0;
};

/// From rim point a to b (a.angle < b.angle). A wide strip takes differences of closed forms; a narrow one, where these cancel
/// (a nearly horizontal cylinder cut along its side), eight Gauss points in the angle, in which the integrand is entire:
/// on an arc of half a radian the error is below 1e-16.
inline ChordIntegrals chord_integrals(const RimPoint& a, const RimPoint& b, double level, double tilt) {
  constexpr double narrow_rad = 0.5;
  ChordIntegrals sum;
  if (b.angle - a.angle >= narrow_rad) {
    const SegmentMoments from_a = segment_moments(a), from_b = segment_moments(b);
    const double m0 = from_a.area - from_b.area, m1 = from_a.first - from_b.first, m2 = from_a.second - from_b.second;
    sum.length = level * m0 - tilt * m1;
    sum.first = level * m1 - tilt * m2;
    sum.half_square = 0.5 * (level * level * m0 - 2.0 * level * tilt * m1 + tilt * tilt * m2);
    return sum;
  }
  const double middle = 0.5 * (a.angle + b.angle), half = 0.5 * (b.angle - a.angle);
  for (std::size_t i = 0; i < gauss8_point.size(); ++i) {
    for (const double side : {-1.0, 1.0}) {
      const double angle = middle + side * half * gauss8_point[i];
      const double x = std::cos(angle), s = std::sin(angle), l = level - tilt * x;
      const double weight = gauss8_weight[i] * half * 2.0 * s * s;
      sum.length += weight * l;
      sum.first += weight * x * l;
      sum.half_square += weight * 0.5 * l * l;
    }
  }
  return sum;
}

/// Start and end: centres of the end discs [m]. Continuous through every change of what is cut.
inline Wetted wetted_cylinder(const Eigen::Vector3d& start, const Eigen::Vector3d& end, double radius,
                              const WaterPlane& surface) {
  Eigen::Vector3d base = start, axis = end - start;
  const double length = axis.norm();
  axis /= length;
  double rise = surface.normal.dot(axis);                      // height gained per metre along the axis: alpha
  if (rise < 0.0) { base = end, axis = -axis, rise = -rise; }  // measured from the lower end
  const Eigen::Vector3d across = surface.normal - rise * axis;
  const double lean = across.norm();  // height gained per metre across the axis: beta
  const double low = surface.height(base), high = low + rise * length, reach = lean * radius;
  const double disc = radius * radius;
  if (low >= reach) return {};
  if (high <= -reach) {
    const double volume = pi * disc * length;
    return {volume, volume * (base + 0.5 * length * axis)};
  }
  const RimPoint dry_to_cut = rim_point(-low, reach), cut_to_wet = rim_point(-high, reach);
  const SegmentMoments wet = segment_moments(cut_to_wet);  // chords under water over their whole length
  ChordIntegrals chords{length * wet.area, length * wet.first, 0.5 * length * length * wet.area};
  if (cut_to_wet.angle > dry_to_cut.angle) {
    const ChordIntegrals cut = chord_integrals(dry_to_cut, cut_to_wet, -low / rise, reach / rise);
    chords.length += cut.length;
    chords.first += cut.first;
    chords.half_square += cut.half_square;
  }
  const double volume = disc * chords.length;
  Eigen::Vector3d moment = volume * base + disc * chords.half_square * axis;
  if (lean > 0.0) moment += disc * radius * chords.first / lean * across;
  return {volume, moment};
}

}  // namespace spindrift::waves
