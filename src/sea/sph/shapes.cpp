// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/shapes.hpp"

namespace spindrift::sph {

namespace {

/// Counts along the edges of a box (an edge of zero: one) whose product is nearest to its volume in cells, each within one of the
/// edge in spacings: particles that stand for more or less than their volume make the body larger or smaller.
std::array<int, 3> counts_in_box(const Eigen::Vector3d& edges, double spacing) {
  std::array<int, 3> best{1, 1, 1};
  double volume = 1.0, least = 1e300;
  for (int axis = 0; axis < 3; ++axis)
    if (edges[axis] > 0.0) volume *= edges[axis] / spacing;
  for (int choice = 0; choice < 8; ++choice) {
    std::array<int, 3> n{1, 1, 1};
    double product = 1.0, uneven = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(edges[axis] > 0.0)) continue;
      const double length = edges[axis] / spacing;
      n[std::size_t(axis)] = std::max(1, int(std::floor(length + 1e-9)) + (choice >> axis & 1));
      product *= n[std::size_t(axis)], uneven += std::pow(std::log(n[std::size_t(axis)] / length), 2);
    }
    const double off = std::abs(std::log(product / volume)) + 0.1 * uneven;
    if (off < least - 1e-12) least = off, best = n;
  }
  return best;
}

/// Distance of the centroid of one of n equal sectors of a ring from its axis; half a ring width more or less would crowd
/// particles towards the axis and leave the surface too far in.
double centroid_of_sector(double inner, double outer, int n) {
  const double half = pi / n;
  return 2.0 / 3.0 * (outer * outer + outer * inner + inner * inner) / (outer + inner) * std::sin(half) / half;
}

/// The same of a shell cut into n cones of equal solid angle, of cos 1 - 2/n from the axis to the rim of each.
double centroid_of_cone(double inner, double outer, int n) {
  const double square = outer * outer + inner * inner;
  return 0.75 * (outer + inner) * square / (square + outer * inner) * (1.0 - 1.0 / n);
}

}  // namespace

Points points_in_box(const Eigen::Vector3d& edges, double spacing) {
  const std::array<int, 3> counts = counts_in_box(edges, spacing);
  Points points;
  for (int i = 0; i < counts[0]; ++i)
    for (int j = 0; j < counts[1]; ++j)
      for (int k = 0; k < counts[2]; ++k)
        points.push_back({edges[0] * ((i + 0.5) / counts[0] - 0.5), edges[1] * ((j + 0.5) / counts[1] - 0.5),
                          edges[2] * ((k + 0.5) / counts[2] - 0.5)});
  return points;
}

namespace {

/// Rings as wide as the spacing, of a disc or of a `share` of one: place(points, ring, width, n) adds n points to each.
template <class Place>
std::vector<Eigen::Vector2d> points_by_rings(double radius, double spacing, double share, double& owed, Place&& place) {
  const int rings = whole_spacings(radius, spacing);
  const double width = radius / rings;
  std::vector<Eigen::Vector2d> points;
  double area = owed;  // in spacings^2; carried over, so that rounding does not add up
  for (int ring = 0; ring < rings; ++ring) {
    area += share * pi * (2 * ring + 1) * width * width / (spacing * spacing);
    place(points, ring, width, std::max(1, int(std::lround(area - double(points.size())))));
  }
  owed = area - double(points.size());
  return points;
}

/// The same of shells of a sphere.
template <class Place>
Points points_by_shells(double radius, double spacing, double share, Place&& place) {
  const int shells = whole_spacings(radius, spacing);
  const double width = radius / shells;
  Points points;
  for (int shell = 0; shell < shells; ++shell) {
    const double volume = share * 4.0 / 3.0 * pi * std::pow((shell + 1) * width / spacing, 3);
    place(points, shell, width, std::max(1, int(std::lround(volume - double(points.size())))));
  }
  return points;
}

}  // namespace

std::vector<Eigen::Vector2d> points_in_disc(double radius, double spacing, double& owed) {
  return points_by_rings(radius, spacing, 1.0, owed, [](auto& points, int ring, double width, int n) {
    const double r = n == 1 ? 0.0 : centroid_of_sector(width * ring, width * (ring + 1), n);
    for (int k = 0; k < n; ++k) {
      const double angle = 2.0 * pi * (k + 0.5 * (ring % 2)) / n;
      points.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
  });
}
std::vector<Eigen::Vector2d> points_in_disc(double radius, double spacing) {
  double owed = 0.0;
  return points_in_disc(radius, spacing, owed);
}

std::vector<Eigen::Vector2d> points_in_half_disc(double radius, double spacing, double& owed) {
  return points_by_rings(radius, spacing, 0.5, owed, [](auto& points, int ring, double width, int n) {
    const double r = centroid_of_sector(width * ring, width * (ring + 1), 2 * n);
    for (int k = 0; k < n; ++k) points.push_back({r * std::cos(pi * (k + 0.5) / n), r * std::sin(pi * (k + 0.5) / n)});
  });
}

Points points_in_cylinder(double radius, double length, int axis, double spacing) {
  const std::vector<double> layers = length > 0.0 ? cell_centres(length, spacing) : std::vector<double>{0.0};
  const double across = length > 0.0 ? spacing_across(length, spacing) : spacing;
  Points points;
  double owed = 0.0;
  for (double along : layers)
    for (const Eigen::Vector2d& p : points_in_disc(radius, across, owed)) {
      Eigen::Vector3d point;
      point[axis] = along, point[(axis + 1) % 3] = p[0], point[(axis + 2) % 3] = p[1];
      points.push_back(point);
    }
  return points;
}

Points points_in_sphere(double radius, double spacing) {
  const double golden = pi * (3.0 - std::sqrt(5.0));
  return points_by_shells(radius, spacing, 1.0, [golden](Points& points, int shell, double width, int n) {
    const double r = n == 1 ? 0.0 : centroid_of_cone(width * shell, width * (shell + 1), n);
    for (int k = 0; k < n; ++k) {
      const double z = 1.0 - (2.0 * k + 1.0) / n, ring = std::sqrt(1.0 - z * z);
      points.push_back(r * Eigen::Vector3d(ring * std::cos(golden * k), ring * std::sin(golden * k), z));
    }
  });
}

Points points_in_half_sphere(double radius, double spacing) {
  return points_by_shells(radius, spacing, 0.5, [](Points& points, int shell, double width, int n) {
    const double r = centroid_of_cone(width * shell, width * (shell + 1), 2 * n);
    // Belts as wide as points are apart, each with the area of a whole number of points; none comes near the plane.
    const int belts = std::max(1, int(std::lround(std::sqrt(0.5 * pi * n))));
    int placed = 0;
    for (int belt = 0; belt < belts; ++belt) {
      const int count = int(std::lround(0.5 * n * (1.0 - std::cos(pi * (belt + 1) / belts)))) - placed;
      const double z = 1.0 - (2.0 * placed + count) / n, ring = std::sqrt(1.0 - z * z);
      for (int k = 0; k < count; ++k) {
        const double angle = pi * (k + 0.5) / count;
        points.push_back(r * Eigen::Vector3d(ring * std::cos(angle), ring * std::sin(angle), z));
      }
      placed += count;
    }
  });
}

}  // namespace spindrift::sph
