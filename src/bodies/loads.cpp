// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/loads.hpp"

namespace spindrift::bodies {

LoadSource gravity_source(std::span<const Body> bodies, double gravity_m_s2, const Eigen::Vector3d& down) {
  std::vector<Eigen::Vector3d> weight;
  for (const Body& body : bodies) weight.push_back(body.mass * gravity_m_s2 * down.normalized());
  return {"gravity",
          [weight](double, std::span<const Motion>, std::span<Wrench> wrenches) {
            for (std::size_t b = 0; b < wrenches.size(); ++b) wrenches[b].force += weight[b];
          },
          {}};
}

LoadSource point_load_source(std::string name, std::vector<PointLoad> loads) {
  return {std::move(name),
          [loads = std::move(loads)](double, std::span<const Motion> bodies, std::span<Wrench> wrenches) {
            for (const PointLoad& load : loads) {
              const Motion& m = bodies[std::size_t(load.body)];
              Wrench& w = wrenches[std::size_t(load.body)];
              w.add_force(load.follows_body ? Eigen::Vector3d(m.attitude * load.force) : load.force, m.point(load.point));
              w.add_moment(load.follows_body ? Eigen::Vector3d(m.attitude * load.moment) : load.moment);
            }
          },
          {}};
}

}  // namespace spindrift::bodies
