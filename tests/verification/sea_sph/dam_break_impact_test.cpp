// A column of water, 0.6 m wide and 0.3 m high, breaks and runs 1.01 m along a dry bed to a wall: when it arrives and how hard it
// presses on sensor 1 of Lobovsky et al. (2014), J. Fluids Struct. 48, 407: 4.2 mm across, 3 mm above the bed, arrival at
// t sqrt(g/H) = 2.43, peak 2.84 rho g H. Pressure is the force on the rows of wall particles that the sensor covers, over their
// area: what single particles say depends on the speed of sound (rho c0 u is 39 rho g H). docs/developer/notes/sea_physics.md.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <deque>

#include "tests/verification/sea_sph/tank.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

constexpr double sensor_low = 0.0009, sensor_high = 0.0051;  ///< over the bed [m]

struct Broken {
  double spacing, friction = 0.0;
  bool modified = false;
  double h_over_d = 1.5;
};

struct Impact {
  double arrival = 1e300;         ///< t sqrt(g/H) when the mean over 1 ms first exceeds 0.3 rho g H
  std::array<double, 4> peaks{};  ///< greatest means over 1, 2, 3 and 5 ms [rho g H]
  double after = 0.0;             ///< mean from 2.6 to 2.8 t sqrt(g/H)
};

Impact impact(const Broken& dam) {
  constexpr double depth = 0.3, end = 2.85;
  const double spacing = dam.spacing;
  Tank tank(spacing, 0.6, depth, 20.0);
  tank.p.alpha = 0.02, tank.p.alpha_solid = dam.friction, tank.p.h_over_d = dam.h_over_d;
  std::vector<Seed<2>> seeds;
  tank.add_water_to(seeds);
  const int length = int(std::lround(1.61 / spacing)), layers = dam.h_over_d > 1.5 ? 4 : Tank::wall_layers;
  const std::size_t first = seeds.size();
  add_tank<2>(seeds, {0, 0}, spacing, {0, 0}, {length, 2 * tank.rows}, layers, tank.p.eos, tank.p.gravity, 0.0);
  std::vector<double> shares;  // of the sensor, by row of wall particles: owner 2, 3, ...
  for (int row = 0; row * spacing < sensor_high; ++row)
    shares.push_back((std::min(sensor_high, (row + 1) * spacing) - std::max(sensor_low, row * spacing)) /
                     (sensor_high - sensor_low));
  for (std::size_t n = first; n < seeds.size(); ++n) {
    Seed<2>& seed = seeds[n];
    if (dam.modified)
      seed.ghost = mirror_in_box<2>(seed.position, {tank.bottom(), tank.bottom()}, {(length - 0.5) * spacing, 1e300});
  }
  for (std::size_t row = 0; row < shares.size(); ++row)
    for (std::size_t n = first; n < seeds.size(); ++n)
      if (seeds[n].position[0] > (length - 0.5) * spacing &&
          std::abs(seeds[n].position[1] - double(row) * spacing) < 0.5 * spacing)
        seeds[n].owner = std::uint16_t(2 + row);
  SeaSph<2> sea(tank.p, {{-1, -1}, {3, 3}}, seeds);
  const double unit = tank.p.eos.rho0 * tank.p.gravity * depth, scale = std::sqrt(tank.p.gravity / depth);
  constexpr std::array<double, 4> windows{0.001, 0.002, 0.003, 0.005};
  struct Sample {
    double time, dt, pressure;
  };
  std::deque<Sample> samples;
  Impact result;
  double lasted = 0.0;
  while (sea.time() * scale < end) {
    if (sea.time() * scale < 2.0) {
      sea.advance(0.02);
      continue;
    }
    const double dt = sea.begin_step(1.0);
    double pressure = 0.0;
    for (std::size_t row = 0; row < shares.size(); ++row)
      pressure += shares[row] * sea.load_on(std::uint16_t(2 + row), Eigen::Vector3d::Zero()).force[0] / spacing / unit;
    samples.push_back({sea.time(), dt, pressure});
    sea.half_step(), sea.end_step();
    while (samples.front().time < samples.back().time - windows.back()) samples.pop_front();
    for (std::size_t w = 0; w < windows.size(); ++w) {
      double sum = 0.0;
      for (const Sample& s : samples)
        if (s.time > samples.back().time - windows[w]) sum += s.pressure * s.dt / windows[w];
      if (w == 0 && sum > 0.3) result.arrival = std::min(result.arrival, sea.time() * scale);
      result.peaks[w] = std::max(result.peaks[w], sum);
    }
    if (sea.time() * scale > 2.6 && sea.time() * scale < 2.8) result.after += samples.back().pressure * dt, lasted += dt;
  }
  CHECK(sea.store().lost.empty());
  result.after /= lasted;
  return result;
}

}  // namespace

// The experiment's own record gives 2.80, 2.75, 2.70 and 2.61 for the greatest means over 1, 2, 3 and 5 ms: its pulse stands for
// some 5 ms.
TEST_CASE(
    "water from a broken dam arrives at the far wall when measured, where the bed is without friction; its greatest pressure "
    "over the "
    "5 ms of the measured pulse comes near that with finer particles, over shorter times it is a blow of sound",
    "[verification][sea][nightly]") {
  const Impact coarse = impact({0.006}), fine = impact({0.003});
  CAPTURE(coarse.arrival, coarse.peaks[0], coarse.peaks[1], coarse.peaks[2], coarse.peaks[3], coarse.after);
  CAPTURE(fine.arrival, fine.peaks[0], fine.peaks[1], fine.peaks[2], fine.peaks[3], fine.after);
  CHECK(coarse.arrival == Approx(2.43).epsilon(0.03));
  CHECK(fine.arrival == Approx(2.43).epsilon(0.03));
  // Three jittered starts: 2.24 to 2.64 (coarse 1.1 to 1.7), arrivals within 0.04 %, the mean after 1.19. One start is not enough
  // for this bar, which is the measurement's; the scene's own, 2.26, is near it.
  CHECK(fine.peaks[3] == Approx(2.61).epsilon(0.15));
  CHECK(coarse.peaks[3] < 0.8 * fine.peaks[3]);
  CHECK(fine.peaks[0] > 1.5 * coarse.peaks[0]);  // the front is as thin as its particles: no convergence over 1 ms
  CHECK(fine.after > 3.0 * coarse.after);        // 1.51 is measured
}
