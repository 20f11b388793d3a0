// A column of water, 0.6 m wide and 0.3 m high, breaks and runs 1.01 m along a dry bed to a wall: when it arrives and how hard it
// presses on the lowest 6 mm. Lobovsky et al. (2014), J. Fluids Struct. 48, 407, sensor 1 (4.2 mm across, 3 mm above the bed): arrival at
// t sqrt(g/H) = 2.43, peak 2.84 rho g H. Pressure is the force on that strip of wall over its area: what single particles say depends
// on the speed of sound (rho c0 u is 39 rho g H). Figures: docs/developer/sea_physics.md. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <deque>

#include "tests/verification/sea_sph/tank.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

struct Impact {
  double arrival;               ///< t sqrt(g/H) when the mean over 1 ms first exceeds 0.3 rho g H
  std::array<double, 3> peaks;  ///< greatest means over 1, 3 and 5 ms [rho g H]
  double after;                 ///< mean from 2.6 to 2.8 t sqrt(g/H)
};

Impact impact(double spacing, double friction) {
  constexpr double depth = 0.3, strip = 0.006, end = 2.85;
  Tank tank(spacing, 0.6, depth, 20.0);
  tank.p.alpha = 0.02, tank.p.alpha_solid = friction;
  std::vector<Seed<2>> seeds;
  tank.add_water_to(seeds);
  const int length = int(std::lround(1.61 / spacing));
  add_tank<2>(seeds, {0, 0}, spacing, {0, 0}, {length, 2 * tank.rows}, Tank::wall_layers, tank.p.eos, tank.p.gravity, 0.0);
  for (Seed<2>& seed : seeds)
    if (seed.owner == 1 && seed.position[0] > (length - 0.5) * spacing && seed.position[1] > tank.bottom() &&
        seed.position[1] < tank.bottom() + strip)
      seed.owner = 2;
  SeaSph<2> sea(tank.p, {{-1, -1}, {3, 3}}, seeds);
  const double unit = tank.p.eos.rho0 * tank.p.gravity * depth, scale = std::sqrt(tank.p.gravity / depth);
  constexpr std::array<double, 3> windows{0.001, 0.003, 0.005};
  struct Sample {
    double time, dt, pressure;
  };
  std::deque<Sample> samples;
  Impact result{1e300, {}, 0.0};
  double after = 0.0, lasted = 0.0;
  while (sea.time() * scale < end) {
    if (sea.time() * scale < 2.0) {
      sea.advance(0.02);
      continue;
    }
    const double dt = sea.begin_step(1.0);
    samples.push_back({sea.time(), dt, sea.load_on(2, Eigen::Vector3d::Zero()).force[0] / strip / unit});
    sea.half_step(), sea.end_step();
    while (samples.front().time < samples.back().time - windows.back()) samples.pop_front();
    for (std::size_t w = 0; w < windows.size(); ++w) {
      double sum = 0.0;
      for (const Sample& s : samples)
        if (s.time > samples.back().time - windows[w]) sum += s.pressure * s.dt / windows[w];
      if (w == 0 && sum > 0.3) result.arrival = std::min(result.arrival, sea.time() * scale);
      result.peaks[w] = std::max(result.peaks[w], sum);
    }
    if (sea.time() * scale > 2.6 && sea.time() * scale < 2.8) after += samples.back().pressure * dt, lasted += dt;
  }
  CHECK(sea.store().lost.empty());
  result.after = after / lasted;
  return result;
}

}  // namespace

TEST_CASE("water from a broken dam arrives at the far wall when measured, where the bed is without friction; with it 4 % late",
          "[verification][sea][nightly]") {
  const Impact smooth = impact(0.006, 0.0);
  CAPTURE(smooth.arrival, smooth.peaks[0], smooth.peaks[1], smooth.peaks[2], smooth.after);
  CHECK(smooth.arrival == Approx(2.43).epsilon(0.03));
}
