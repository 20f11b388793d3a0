// A free body in a 2-D sea: surge, heave and pitch by the same symplectic step as the water, and seeds for it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "src/sea/sph/shapes.hpp"
#include "tests/verification/sea_sph/tank.hpp"

namespace spindrift::sph {

/// Takes the water out of a place and puts the body's particles there, with the pressure of rest at their depth.
template <class Inside>
void insert_body(std::vector<Seed<2>>& seeds, const Tank& tank, const Points& points, const Motion& motion, std::uint16_t owner,
                 Inside&& inside) {
  std::erase_if(seeds, [&](const Seed<2>& seed) {
    return seed.owner == 0 && inside(seed.position[0] - motion.position[0], seed.position[1] - motion.position[2]);
  });
  for (const Eigen::Vector3d& point : points) {
    const auto x = from_earth<2>(motion.point(point));
    seeds.push_back({.position = x,
                     .deviation = tank.p.eos.hydrostatic_deviation(std::max(0.0, tank.surface() - x[1]), tank.p.gravity),
                     .owner = owner});
  }
}

struct Floater {
  std::uint16_t owner;
  Motion motion;
  double mass, inertia;  ///< per metre of width; no inertia: it does not turn
  bool surges = false;
  double damping = 0.0;  ///< of heave, over the mass [1/s]: fades a start
};

/// One step of the sea and of free bodies in it; returns its length.
template <class Sea>
double step_with(Sea& sea, std::vector<Floater>& bodies, double dt_max) {
  struct Start {
    Eigen::Vector3d position, velocity;
    double angle, rate;
  };
  const auto angle_of = [](const Motion& m) { return 2.0 * std::atan2(m.attitude.y(), m.attitude.w()); };
  const double dt = sea.begin_step(dt_max);
  std::vector<Start> starts;
  for (const Floater& body : bodies)
    starts.push_back({body.motion.position, body.motion.velocity, angle_of(body.motion), body.motion.omega[1]});
  const auto advance = [&](double way_dt, double speed_dt, bool last) {
    for (std::size_t n = 0; n < bodies.size(); ++n) {
      Floater& body = bodies[n];
      const Start& start = starts[n];
      const Wrench load = sea.load_on(body.owner, body.motion.position) +=
          contact_on(sea.contacts(), body.owner, body.motion.position);
      Eigen::Vector3d velocity = start.velocity;
      velocity[0] += body.surges ? speed_dt * load.force[0] / body.mass : 0.0;
      velocity[2] += speed_dt * (load.force[2] / body.mass - sea.parameters().gravity - body.damping * body.motion.velocity[2]);
      const double rate = start.rate + (body.inertia > 0.0 ? speed_dt * load.moment[1] / body.inertia : 0.0);
      // Half a step goes with the speed at its start, a whole one with the mean of both ends.
      const Eigen::Vector3d way = last ? Eigen::Vector3d(0.5 * (start.velocity + velocity)) : start.velocity;
      body.motion.position = start.position + way_dt * way, body.motion.velocity = velocity;
      const double angle = start.angle + way_dt * (last ? 0.5 * (start.rate + rate) : start.rate);
      body.motion.attitude = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY());
      body.motion.omega = {0.0, rate, 0.0};
      place_body(sea.state(), body.owner, body.motion);
    }
  };
  advance(0.5 * dt, 0.5 * dt, false);
  sea.half_step();
  advance(dt, dt, true);
  sea.end_step();
  return dt;
}

}  // namespace spindrift::sph
