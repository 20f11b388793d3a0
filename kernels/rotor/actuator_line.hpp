// Blades as lines of force in a resolved flow: Gaussian spreading of a force over cells, and what the spreading takes from the
// velocity that a blade meets. Gaussian kernel: Sorensen & Shen (2002), J. Fluids Eng. 124, 393. Correction: the filtered lifting
// line of Martinez-Tossas & Meneveau (2019), J. Fluid Mech. 863, 269, its straight wake replaced by helices from all blades as in
// Dag & Sorensen (2020), Wind Energy 23, 148. Equations: docs/theory/actuator.md. Used by src/aero/actuator.cpp; tested in
// tests/kernels/rotor/actuator_line_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"

namespace spindrift {

/// Widths beyond which the kernel is cut: 4e-4 of the force lies outside, and weights are normalised to one.
inline constexpr double kernel_reach = 3.0;

/// Gaussian in space, of integral one [1/m3]; distance and width [m]. `width` is the epsilon of the literature.
inline double gaussian_kernel(double distance_squared, double width) {
  return std::exp(-distance_squared / (width * width)) / (width * width * width * std::pow(pi, 1.5));
}

/// Share of a vortex element's Biot-Savart velocity that is left at `ratio` widths from it where its vorticity is spread by the
/// Gaussian kernel: erf(x) - 2 x exp(-x^2) / sqrt(pi).
inline double filtered_share(double ratio) { return std::erf(ratio) - 2.0 / std::sqrt(pi) * ratio * std::exp(-ratio * ratio); }

/// Width of two Gaussians one after the other: spread by one, sampled by the other.
inline double joint_width(double a, double b) { return std::sqrt(a * a + b * b); }

/// A trailing vortex that leaves a turning blade at a radius and lies on a helix of constant radius; blade coordinates: along the
/// rotor's axis downwind, out along the blade, ahead as the blade moves.
struct HelicalWake {
  double angle = 0.1;       ///< of the helix at the tip: atan(axial speed / tip speed), in (0, pi) [rad]; pi/2: straight downwind
  double tip_radius = 1.0;  ///< [m]
};

/// Velocity per circulation [1/m].
struct TrailedVelocity {
  double axial = 0.0, ahead = 0.0;
};

/// What a point at `radius` on the blade lacks of the velocity of a trailing vortex of unit circulation, which runs downstream
/// from `root` on the blade at azimuth `offset` from it [rad], where vorticity and sampling together have the width `wide`
/// instead of `narrow` [m].
inline TrailedVelocity missing_velocity(double radius, double root, double offset, const HelicalWake& wake, double narrow,
                                        double wide) {
  TrailedVelocity sum;
  if (!(wide > narrow)) return sum;
  // Speeds in units in which tip and wake move at 1 together.
  const double along = std::sin(wake.angle), turn = std::cos(wake.angle) / wake.tip_radius;
  const double speed = std::hypot(along, turn * root);
  const double least = std::max(std::hypot(radius - root * std::cos(offset), root * std::sin(offset)), 0.1 * narrow);
  const double longest = 0.2 * wide, end = kernel_reach * wide / along;
  constexpr double growth = 1.25;
  double step = std::min(0.2 * least, longest) / speed;
  for (double t = 0.0; t < end; t += step, step = std::min(growth * step, longest / speed)) {
    const double middle = t + 0.5 * step, azimuth = offset - turn * middle, c = std::cos(azimuth), s = std::sin(azimuth);
    // From the element to the point, and the element itself.
    const double rx = -along * middle, ry = radius - root * c, rz = -root * s;
    const double dx = along * step, dy = turn * root * s * step, dz = -turn * root * c * step;
    const double distance = std::sqrt(rx * rx + ry * ry + rz * rz);
    if (distance > kernel_reach * wide) continue;
    const double share = filtered_share(distance / narrow) - filtered_share(distance / wide);
    const double factor = share / (4.0 * pi * std::max(distance * distance * distance, 1e-300));
    sum.axial += factor * (dy * rz - dz * ry);
    sum.ahead += factor * (dx * ry - dy * rx);
  }
  return sum;
}

/// Mean over a Gaussian disc of `width` round a point at `radius` of a field that is one on the ring between two radii and zero
/// elsewhere; of an axial component (`turning` false), or of one along the azimuth, whose direction turns.
inline double ring_mean(double radius, double inner, double outer, double width, bool turning) {
  constexpr double node = 0.7745966692414834;  // Gauss, three points
  constexpr double nodes[3] = {-node, 0.0, node}, weights[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const double w2 = width * width, most = std::max(radius, outer);
  const int pieces = std::max(1, int(std::ceil((outer - inner) / (0.5 * width))));
  const int around = std::clamp(int(std::ceil(8.0 * pi * most / width)), 16, 4096);
  double sum = 0.0;
  for (int p = 0; p < pieces; ++p) {
    const double h = (outer - inner) / pieces, middle = inner + (p + 0.5) * h;
    for (int q = 0; q < 3; ++q) {
      const double r = middle + 0.5 * h * nodes[q];
      double ring = 0.0;
      for (int n = 0; n < around; ++n) {
        const double c = std::cos(2.0 * pi * n / around);
        ring += std::exp(-(radius * radius + r * r - 2.0 * radius * r * c) / w2) * (turning ? c : 1.0);
      }
      sum += weights[q] * h * r * ring * 2.0 * pi / around;
    }
  }
  return sum / (pi * w2);
}

}  // namespace spindrift
