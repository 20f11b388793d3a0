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

Points points_of_surface(std::span<const BodyShape> shapes, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                         double spacing, Cut cut) {
  // The outermost particles, each moved along the gradient of the distance to where that is zero.
  Points points;
  const double step = 1e-4 * spacing;
  for (Eigen::Vector3d x : fill_body(shapes, spacing, cut)) {
    if (signed_distance(shapes, x, cut) < -spacing) continue;
    double off = 0.0;
    for (int turn = 0; turn < 4; ++turn) {  // one is enough but at edges
      off = signed_distance(shapes, x, cut);
      Eigen::Vector3d slope = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k) {
        if (cut == Cut::plane && k == 1) continue;
        Eigen::Vector3d beside = x;
        beside[k] += step;
        slope[k] = (signed_distance(shapes, beside, cut) - off) / step;
      }
      if (slope.squaredNorm() > 0.0) x -= off * slope / slope.squaredNorm();
    }
    bool inside = std::abs(off) < 0.1 * spacing;
    for (int k = 0; k < 3; ++k) inside = inside && ((cut == Cut::plane && k == 1) || (x[k] >= low[k] && x[k] <= high[k]));
    if (inside) points.push_back(x);
  }
  return points;
}

}  // namespace spindrift::sph
