// Where the points of sensors are: see sensors.hpp. SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/sensors.hpp"

namespace spindrift::sph {

Points points_of_rectangle(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double spacing, Cut cut) {
  std::array<int, 3> count;
  for (int k = 0; k < 3; ++k)
    count[std::size_t(k)] = cut == Cut::plane && k == 1 ? 1 : std::max(1, int(std::ceil((high[k] - low[k]) / spacing - 1e-9)));
  Points points;
  for (int i = 0; i < count[0]; ++i)
    for (int j = 0; j < count[1]; ++j)
      for (int k = 0; k < count[2]; ++k)
        points.push_back(
            low + (high - low).cwiseProduct(Eigen::Vector3d((i + 0.5) / count[0], (j + 0.5) / count[1], (k + 0.5) / count[2])));
  return points;
}

TankPlan::Block particles_of_rectangle(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double reach) {
  TankPlan::Block box{low, high};
  for (int k = 0; k < 3; ++k)
    if (low[k] == high[k]) box.low[k] -= reach, box.high[k] += reach;
  return box;
}

namespace {

/// Where the gradient of the distance leads to from a point: on the surface, but from some places amid a body.
Eigen::Vector3d nearest_of_surface(std::span<const BodyShape> shapes, Eigen::Vector3d x, double spacing, Cut cut) {
  const double step = 1e-4 * spacing;
  constexpr double level = 0.1;           // of a gradient that is 1 but where several faces are equally near
  for (int turn = 0; turn < 4; ++turn) {  // one is enough but at edges
    const double off = signed_distance(shapes, x, cut);
    if (std::abs(off) < 1e-6 * spacing) break;
    const auto slope_between = [&](double behind, double ahead) {
      Eigen::Vector3d slope = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k) {
        if (cut == Cut::plane && k == 1) continue;
        Eigen::Vector3d low = x, high = x;
        low[k] += behind, high[k] += ahead;
        slope[k] = (signed_distance(shapes, high, cut) - signed_distance(shapes, low, cut)) / (ahead - behind);
      }
      return slope;
    };
    Eigen::Vector3d slope = slope_between(-step, step);
    if (slope.norm() < level) slope = slope_between(0.0, step);  // midway between two faces: to either
    if (slope.norm() < level) break;
    x -= off * slope / slope.squaredNorm();
  }
  return x;
}

/// visit(n, nearest point, whether it is one of the surface under an outermost particle) for the particles that are not deeper in
/// the body than this [m].
template <class Visit>
void for_nearest(const Points& particles, std::span<const BodyShape> shapes, double deepest, double spacing, Cut cut,
                 Visit&& visit) {
  for (std::size_t n = 0; n < particles.size(); ++n) {
    const double distance = signed_distance(shapes, particles[n], cut);
    if (distance < -deepest) continue;
    const Eigen::Vector3d point = nearest_of_surface(shapes, particles[n], spacing, cut);
    visit(n, point, distance >= -spacing && std::abs(signed_distance(shapes, point, cut)) < 0.1 * spacing);
  }
}

}  // namespace

Points points_of_surface(const Points& particles, std::span<const BodyShape> shapes, const Eigen::Vector3d& low,
                         const Eigen::Vector3d& high, double spacing, Cut cut) {
  Points points;
  for_nearest(particles, shapes, spacing, spacing, cut, [&](std::size_t, const Eigen::Vector3d& point, bool on_surface) {
    if (on_surface && in_box(point, low, high, cut == Cut::plane)) points.push_back(point);
  });
  return points;
}

Patch patch_of_body(const Solid& solid, std::span<const BodyShape> shapes, const Eigen::Vector3d& low,
                    const Eigen::Vector3d& high, const Parameters& p, Cut cut) {
  Patch patch{.owner = solid.owner, .low = low, .high = high};
  patch.counted.assign(solid.local.size(), false);  // of those deeper than water reaches too
  for_nearest(solid.local, shapes, p.reach(), p.spacing, cut, [&](std::size_t n, const Eigen::Vector3d& point, bool on_surface) {
    patch.counted[n] = in_box(point, low, high, cut == Cut::plane);
    if (on_surface && patch.counted[n]) patch.points.push_back(point);
  });
  return patch;
}

void put_on_paddle(Patch& patch, const Solid& paddle, const Eigen::Vector3d& origin, Cut cut) {
  patch.owner = paddle.owner;
  patch.low -= origin, patch.high -= origin;
  for (Eigen::Vector3d& point : patch.points) point -= origin;
  for (const Eigen::Vector3d& x : paddle.local) patch.counted.push_back(in_box(x, patch.low, patch.high, cut == Cut::plane));
}

}  // namespace spindrift::sph
