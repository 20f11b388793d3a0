// What the sections of a sea of particles may not ask of each other: see particle_sea.hpp. A function for each subject; the
// refusals come in their order. Tested in tests/src/sea/particle_problems_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/rigid/closed_surface.hpp"
#include "src/sea/particle_plan.hpp"
#include "src/sea/sph/sensors.hpp"
#include "src/sea/sph/tank_count.hpp"
#include "src/sea/sph/tank_lattice.hpp"
#include "src/sea/wave_model.hpp"

namespace spindrift::sea {
namespace {

std::array<double, 2> ordered(double a, double b) { return {std::min(a, b), std::max(a, b)}; }

/// " (surfaces: sea.water[0] -0.3 m, ...)"
std::string surfaces_of(const SeaOptions& o) {
  std::string all;
  for (std::size_t n = 0; n < o.water.size(); ++n)
    all += fmt::format("{}sea.water[{}] {:g} m", n == 0 ? "" : ", ", n, o.water[n].high_m[2]);
  return " (surfaces: " + all + ")";
}

struct Rules {
  const SeaOptions& o;
  const WavesOptions& waves;
  const SeaEnvironment& environment;
  std::span<const ParticleBody> bodies;

  const ParticleOptions& p = *o.particles;
  const TankOptions& t = *o.tank;
  const bool planar = p.planar(), waved = waves.model != "none";
  const double d = p.spacing_m, depth = environment.water_depth, reach = 2.0 * p.smoothing_over_spacing * d;
  const sph::TankPlan ground{.depth = depth, .bed = t.bed_m};
  const sph::TankPlan tank = tank_of(o, environment);
  const sph::Parameters lattice = [this] {
    sph::Parameters lattice;
    lattice.spacing = d, lattice.h_over_d = p.smoothing_over_spacing;
    return lattice;
  }();

  std::vector<OptionProblem> problems = {};
  bool laid_out = false;     ///< the lattice can be: what looks for places of it may
  double edge_of_cells = d;  ///< the lattice's, a little off the spacing [m]

  void wrong(std::string key, std::string what, std::string follows_from = {}) {
    problems.push_back({std::move(key), std::move(what), std::move(follows_from)});
  }
  void judge_tank();
  void judge_shapes_of_walls();
  void judge_waves();
  void judge_start();
  void judge_wavemaker();
  void lay_out();
  std::span<const ParticleBody>::iterator shaped(const std::string& key, const std::string& body);
  void judge_gauges_and_probes();
  void judge_sensor_of_body(const SensorOptions& sensor, const std::string& key);
  void judge_sensor_of_wall(const SensorOptions& sensor, const std::string& key);
  void judge_sensors();
  void judge_leading_zone(const DampingZoneOptions& zone, const std::string& key);
  void judge_zones();
  void require_places(const std::string& section, const std::vector<BoxOptions>& boxes);
  void judge_boxes();
  void judge_shape(const ParticleBody& body, const sph::BodyShape& shape);
};

void Rules::judge_tank() {
  if (!planar && !(t.y_m[1] > t.y_m[0])) wrong("sea.tank.y_m", "is needed in 3-D and must go from the lower to the higher side");
  if (planar && t.y_m != std::array<double, 2>{})
    wrong("sea.tank.y_m", "has no effect: sea.particles.dimensions is 2", "sea.particles.dimensions");
  if (planar && t.sides_y != "wall")
    wrong("sea.tank.sides_y", "has no effect: sea.particles.dimensions is 2", "sea.particles.dimensions");
  if (!(environment.gravity > 0.0) && !p.sound_speed_m_s)
    wrong("sea.particles.sound_speed_m_s",
          "is needed where environment.gravity_m_s2 is 0: else it follows from the weight of the water",
          "environment.gravity_m_s2");
  if (!(t.top_m > -depth)) wrong("sea.tank.top_m", fmt::format("is below the bed at {} m", -depth));
  if (o.water.empty() && t.top_m < 0.0) wrong("sea.tank.top_m", "is below the still water at 0 m");
  if (deepest_water(o, depth) < 4.0 * d)
    wrong("sea.particles.spacing_m",
          fmt::format("leaves fewer than 4 particles over the depth of {} m", deepest_water(o, depth)));
  for (int axis = 0; axis < (planar ? 1 : 2); ++axis) {
    const auto& span = axis == 0 ? t.x_m : t.y_m;
    const bool periodic = (axis == 0 ? t.sides_x : t.sides_y) == "periodic";
    const char* key = axis == 0 ? "sea.tank.x_m" : "sea.tank.y_m";
    const double least = 3.0 * (reach + d) * 1.01;
    if (periodic && span[1] - span[0] < least)
      wrong(key, fmt::format("periodic sides must be at least {:.4g} m apart at this spacing (three supports)", least));
  }
  for (std::size_t n = 0; n < t.bed_m.size(); ++n)
    if (t.bed_m[n][1] < -depth - 1e-9 * depth)
      wrong(fmt::format("sea.tank.bed_m[{}]", n),
            fmt::format("is deeper than environment.water_depth_m = {} m, which is the deepest", depth));
  if (t.sides_x != "wall" && o.wavemaker) wrong("sea.wavemaker", "needs walls at the ends: sea.tank.sides_x is " + t.sides_x);
  if (t.sides_x == "periodic" && !t.bed_m.empty() && t.bed_m.front()[1] != t.bed_m.back()[1])
    wrong("sea.tank.bed_m", "must end at the height it begins with: sea.tank.sides_x is periodic");
}

void Rules::judge_shapes_of_walls() {
  if (p.modified_walls() && !t.bed_m.empty())
    wrong("sea.particles.walls",
          "must not be modified ones above slopes (sea.tank.bed_m): stairs have no ghost nodes; the default takes any shape");

  for (std::size_t n = 0; n < t.meshes.size(); ++n) {
    const std::string key = fmt::format("sea.tank.meshes[{}]", n);
    if (p.modified_walls())
      wrong("sea.particles.walls",
            "must not be modified ones with " + key + ": stairs have no ghost nodes; the default takes any shape");
    if (!t.meshes[n].surface) continue;
    const Eigen::AlignedBox3d& box = t.meshes[n].surface->box();
    const double y_low = planar ? 0.0 : t.y_m[0], y_high = planar ? 0.0 : t.y_m[1];
    if (!box.intersects(
            Eigen::AlignedBox3d(Eigen::Vector3d(t.x_m[0], y_low, -depth), Eigen::Vector3d(t.x_m[1], y_high, t.top_m))))
      wrong(key, fmt::format("is outside the tank: it reaches from ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g}) m",
                             box.min()[0], box.min()[1], box.min()[2], box.max()[0], box.max()[1], box.max()[2]));
  }
}

void Rules::judge_waves() {
  if (o.wavemaker && !waved) wrong("sea.wavemaker", "has no wave to make: give [waves]");
  if (waved && !o.wavemaker && !o.starts_in_waves() && !o.led_to_waves())
    wrong("waves.model",
          "has no effect: the sea of particles has no [sea.wavemaker], no sea.initial.state = \"waves\" and no damping zone "
          "towards them",
          "sea.initial.state");
  if (waved && waves.ramp_s.value_or(0.0) > 0.0)
    wrong("waves.ramp_s", "has no effect in a sea of particles: give sea.wavemaker.ramp_s");
  if (waved && waves.stretching != WavesOptions{}.stretching)
    wrong("waves.stretching", "has no effect in a sea of particles, where velocities go on in a straight line above still water");
  if (waved && wave_models().named(waves.model).nonlinear && !wave_models().named(waves.model).second_order)
    wrong("waves.model",
          "must not be '" + waves.model + "' in a sea of particles: its harmonics are not free waves; use 'stokes2'");
  if (waved && waves.second_order)
    wrong("waves.second_order", "must not be given in a sea of particles, which makes its own waves of second order");
  if (waved && waves.spreading_exponent && (planar || o.wavemaker))
    wrong("waves.spreading_exponent", "must not be given: the paddle, or the plane of the scene, makes waves along x");
  if (waved && std::abs(std::sin(waves.direction)) > 1e-9 && (planar || o.wavemaker))
    wrong("waves.direction_deg", "must be 0: the paddle, or the plane of the scene, makes waves along x");
  if (waved && o.wavemaker && std::cos(waves.direction) < 0.0)
    wrong("waves.direction_deg", "must be 0: the paddle stands at the lower end");
}

void Rules::judge_start() {
  if (o.starts_in_waves() && !waved) wrong("sea.initial.state", "needs [waves]");
  if (o.initial && o.initial->state == "standing" && waved && wave_models().named(waves.model).nonlinear)
    wrong("sea.initial.state", "must not be \"standing\" with waves.model '" + waves.model +
                                   "': two of these that meet are no wave that stands; use 'airy'");
  if (o.starts_in_waves() && !o.water.empty()) wrong("sea.initial.state", "fills the tank: no [[sea.water]]");
  if (o.starts_in_waves() && !t.bed_m.empty())
    wrong("sea.tank.bed_m", "must not be given with a start in waves: these are of a level bed at environment.water_depth_m");
  if (o.starts_in_waves() && waved && !planar && t.sides_y == "wall" &&
      (std::abs(std::sin(waves.direction)) > 1e-9 || waves.spreading_exponent))
    wrong("sea.initial.state", "must not have waves that run into the walls of sea.tank.sides_y: let these repeat, or be open");
  const auto ends_led = [&](double end) {
    return std::ranges::any_of(o.damping_zones, [&](const DampingZoneOptions& zone) {
      return zone.axis == "y" && zone.towards == "waves" && zone.to_m == end;
    });
  };
  if (o.led_to_waves() && !o.starts_in_waves() && waved && !planar && t.sides_y == "wall" &&
      (std::abs(std::sin(waves.direction)) > 1e-9 || waves.spreading_exponent) && !(ends_led(t.y_m[0]) && ends_led(t.y_m[1])))
    wrong("sea.damping_zones",
          "must not lead to waves that run into the walls of sea.tank.sides_y: let these repeat, or be open, or lead up to both");
  if (o.initial && o.initial->settle_damping_1_s > 0.0) {
    const char* key = "sea.initial.settle_damping_1_s";
    if (o.initial->settle_s == 0.0) wrong(key, "has no effect: settle_s is 0");
    if (o.starts_in_waves() || o.led_to_waves() || (o.wavemaker && o.wavemaker->start_s < 0.0))
      wrong(key, "must be 0 where there are waves before t = 0, which it would take away");
  }
}

void Rules::judge_wavemaker() {
  if (o.wavemaker) {
    const WavemakerOptions& w = *o.wavemaker;
    const double bed = ground.bed_at(t.x_m[0]);
    if (!(bed < 0.0))
      wrong("sea.tank.bed_m",
            fmt::format("must be below still water at the paddle of [sea.wavemaker], where it is at {:.4g} m", bed));
    if (!stands_level(o, depth, {t.x_m[0], t.x_m[0]}, t.y_m))
      wrong("sea.water[0]",
            fmt::format("with [sea.wavemaker] a box of water must begin at the paddle at x = {:g} m, reach {}down to the bed and "
                        "stand at z = 0, of which its waves are{}",
                        t.x_m[0], planar ? "" : "from side to side, ", surfaces_of(o)),
            "sea.wavemaker");
    if (w.type == "flap" && waved && wave_models().named(waves.model).second_order)
      wrong("sea.wavemaker.type", "a flap makes waves of first order: use a piston for " + waves.model);
    if (w.stroke_m && !(waved && wave_models().named(waves.model).regular))
      wrong("sea.wavemaker.stroke_m", "is that of a regular wave");
    if (w.hinge_m && !(*w.hinge_m >= bed && *w.hinge_m < 0.0))
      wrong("sea.wavemaker.hinge_m", fmt::format("must lie between the bed at {} m and still water", bed));
    if (o.initial && w.start_s < -o.initial->settle_s)
      wrong("sea.wavemaker.start_s", fmt::format("is before the sea starts at {} s", 0.0 - o.initial->settle_s));
    if (const double begin = o.initial ? 0.0 - o.initial->settle_s : 0.0; o.starts_in_waves() && w.start_s > begin)
      wrong("sea.wavemaker.start_s",
            fmt::format("must be {} s, when the sea begins in waves: the paddle would stand in moving water", begin));
    if (o.initial && o.initial->state == "waves" && w.ramp_s.value_or(0.0) > 0.0)
      wrong("sea.wavemaker.ramp_s", "must be 0 where the water starts in waves: the paddle would stand in moving water");
    if (!o.initial && w.start_s < 0.0) wrong("sea.wavemaker.start_s", "is before the sea starts: give sea.initial.settle_s");
  }
}

void Rules::lay_out() {
  constexpr double longest = 1e6;  // in spacings
  laid_out = problems.empty() && std::max({t.x_m[1] - t.x_m[0], t.y_m[1] - t.y_m[0], t.top_m + depth, depth}) < longest * d;
  if (laid_out)
    edge_of_cells = planar ? std::sqrt(sph::TankLattice<2>(tank, d).cell()) : std::cbrt(sph::TankLattice<3>(tank, d).cell());
}

/// The body of this name, which must have a shape; none where it is wrong.
std::span<const ParticleBody>::iterator Rules::shaped(const std::string& key, const std::string& body) {
  const auto named = std::ranges::find(bodies, body, &ParticleBody::name);
  if (named != bodies.end() && !named->shapes.empty()) return named;
  std::string known;
  for (const ParticleBody& b : bodies)
    if (!b.shapes.empty()) known += (known.empty() ? "" : ", ") + b.name;
  wrong(key + ".body", "names '" + body + "', which is no body with a shape; known: " + (known.empty() ? "none" : known));
  return bodies.end();
}

void Rules::judge_gauges_and_probes() {
  for (std::size_t n = 0; n < o.gauges.size(); ++n) {
    const std::string key = fmt::format("sea.gauges[{}]", n);
    if (!(o.gauges[n].point_m[0] >= t.x_m[0] && o.gauges[n].point_m[0] <= t.x_m[1]))
      wrong(key + ".point_m", "is outside the tank");
    if (!planar && !(o.gauges[n].point_m[1] >= t.y_m[0] && o.gauges[n].point_m[1] <= t.y_m[1]))
      wrong(key + ".point_m", "is outside the tank");
  }
  for (std::size_t n = 0; n < o.probes.size(); ++n) {
    const std::string key = fmt::format("sea.probes[{}]", n);
    const Eigen::Vector3d& x = o.probes[n].point_m;
    if (!(x[0] >= t.x_m[0] && x[0] <= t.x_m[1]) || (!planar && !(x[1] >= t.y_m[0] && x[1] <= t.y_m[1])))
      wrong(key + ".point_m", "is outside the tank");
    else if (const double bed = ground.bed_at(x[0]); x[2] < bed - 1e-9 * depth)
      wrong(key + ".point_m", fmt::format("is below the bed, which is at {:.6g} m there", bed));
  }
  for (std::size_t n = 0; n < o.gauges.size(); ++n)
    if (!o.gauges[n].body.empty()) shaped(fmt::format("sea.gauges[{}]", n), o.gauges[n].body);
}

void Rules::judge_sensor_of_body(const SensorOptions& sensor, const std::string& key) {
  const auto body = shaped(key, sensor.body);
  if (body == bodies.end()) return;
  const Eigen::Vector3d low = sensor.low_m - body->described.position, high = sensor.high_m - body->described.position;
  const sph::Cut cut = sph::cut_of(planar, t.symmetric());
  if (t.symmetric() && sensor.low_m[1] < t.y_m[0])
    wrong(key,
          fmt::format("reaches y = {} m, beyond the plane of symmetry (sea.tank.sides_y) at {} m", sensor.low_m[1], t.y_m[0]));
  else if (sph::points_of_surface(sph::fill_body(body->shapes, edge_of_cells, cut), body->shapes, low, high, d, cut).empty())
    wrong(key, fmt::format("has nothing of the surface of {} between low_m and high_m, where the scene describes it, or a strip "
                           "narrower than the rows of its particles, {} m",
                           sensor.body, d));
}

void Rules::judge_sensor_of_wall(const SensorOptions& sensor, const std::string& key) {
  int flat = 0;
  for (int k = 0; k < 3; ++k)
    if (!(planar && k == 1) && sensor.low_m[k] == sensor.high_m[k]) ++flat;
  if (flat != 1)
    wrong(key, "must be flat along one axis to be a rectangle on a wall (low_m and high_m equal there), or give body");
  const bool outside = sensor.low_m[0] < t.x_m[0] || sensor.high_m[0] > t.x_m[1] || sensor.low_m[2] < -depth ||
                       (!planar && (sensor.low_m[1] < t.y_m[0] || sensor.high_m[1] > t.y_m[1]));
  if (outside) wrong(key, "is outside the tank");
  if (sensor.low_m[2] >= t.top_m)
    wrong(key, fmt::format("is above the tank's walls, which end at {:.6g} m (sea.tank.top_m)", t.top_m));
  if (!outside && t.symmetric() && sensor.high_m[1] == t.y_m[0])
    wrong(key, "is on the plane of symmetry (sea.tank.sides_y), where there is no wall");
  else if (!outside && flat == 1 && laid_out && sensor.low_m[2] < t.top_m) {
    if (o.wavemaker && sensor.low_m[0] == sensor.high_m[0] && sensor.low_m[0] == t.x_m[0]) {
      const double bed = ground.bed_at(t.x_m[0]), hinge = o.wavemaker->hinge_m.value_or(bed);
      if (sensor.high_m[2] <= bed)
        wrong(key, fmt::format("is below the bed, which is at {:.6g} m there", bed));
      else if (hinge > bed && sensor.low_m[2] < hinge && sensor.high_m[2] > hinge)
        wrong(key, fmt::format("is partly on the flap of [sea.wavemaker], which turns, and partly on the wall under its hinge "
                               "at {:.6g} m: give one for each",
                               hinge));
      return;
    }
    sph::TankPlan::Block near = sph::particles_of_rectangle(sensor.low_m, sensor.high_m, reach);
    near.low.array() -= d, near.high.array() += d;  // those of pressure alone may fit between two rows
    if (!(planar ? sph::holds_wall<2>(tank, lattice, near) : sph::holds_wall<3>(tank, lattice, near)))
      wrong(key, "is on no wall: within reach of it there is no particle of a side, the bed, an obstacle or a mesh");
  }
}

void Rules::judge_sensors() {
  for (std::size_t n = 0; n < o.sensors.size(); ++n) {
    const SensorOptions& sensor = o.sensors[n];
    const std::string key = fmt::format("sea.sensors[{}]", n);
    if (sensor.body.empty())
      judge_sensor_of_wall(sensor, key);
    else
      judge_sensor_of_body(sensor, key);
  }
}

/// A zone that brings the water to the waves of the scene, which are of level water over a level bed.
void Rules::judge_leading_zone(const DampingZoneOptions& zone, const std::string& key) {
  if (!waved) wrong(key + ".towards", "has no waves to bring the water to: give [waves]");
  if (o.wavemaker) wrong(key + ".towards", "must be \"rest\" with [sea.wavemaker], whose waves grow and steepen on their way");
  if (o.initial && o.initial->state == "standing") wrong(key + ".towards", "must be \"rest\" where waves stand: [waves] travels");
  const double low = zone.axis == "x" ? std::min(zone.from_m, zone.to_m) : t.x_m[0],
               high = zone.axis == "x" ? std::max(zone.from_m, zone.to_m) : t.x_m[1];
  double highest = std::max(ground.bed_at(low), ground.bed_at(high));
  for (const auto& point : t.bed_m)
    if (point[0] > low && point[0] < high) highest = std::max(highest, point[1]);
  if (!stands_level(o, depth, {low, high}, zone.axis == "y" ? ordered(zone.from_m, zone.to_m) : t.y_m))
    wrong(key + ".towards",
          fmt::format("must be \"rest\" where no box of [[sea.water]] holds the whole zone, down to the bed and up to z = 0, of "
                      "which [waves] is{}",
                      surfaces_of(o)));
  if (highest > -depth + 1e-9 * depth)
    wrong(key + ".towards", fmt::format("must be \"rest\" where the bed (sea.tank.bed_m) rises to {:.4g} m: [waves] is of a "
                                        "level bed at environment.water_depth_m",
                                        highest));
}

void Rules::judge_zones() {
  for (std::size_t n = 0; n < o.damping_zones.size(); ++n) {
    const DampingZoneOptions& zone = o.damping_zones[n];
    const std::string key = fmt::format("sea.damping_zones[{}]", n);
    if (planar && zone.axis == "y") {
      wrong(key, "is along y: sea.particles.dimensions is 2");
      continue;
    }
    if (zone.towards == "waves") judge_leading_zone(zone, key);
    const auto& sides = zone.axis == "y" ? t.y_m : t.x_m;
    for (const double end : {zone.from_m, zone.to_m})
      if (!(end >= sides[0] && end <= sides[1])) wrong(key, fmt::format("reaches {} = {} m, outside the tank", zone.axis, end));
  }
}

void Rules::require_places(const std::string& section, const std::vector<BoxOptions>& boxes) {
  for (std::size_t n = 0; laid_out && n < boxes.size(); ++n) {
    const sph::TankPlan::Block block{boxes[n].low_m, boxes[n].high_m};
    if ((planar ? sph::places_in<2>(tank, lattice, block) : sph::places_in<3>(tank, lattice, block)) == 0.0)
      wrong(fmt::format("sea.{}[{}]", section, n),
            fmt::format("holds no particle: it is outside the tank, in its bed, or thinner than the spacing of {} m", d));
  }
}

void Rules::judge_boxes() {
  for (std::size_t n = 0; n < o.water.size(); ++n)
    for (std::size_t m = 0; m < n; ++m) {
      const Eigen::Vector3d common = o.water[n].high_m.cwiseMin(o.water[m].high_m) - o.water[n].low_m.cwiseMax(o.water[m].low_m);
      const auto inside = [&](int axis) { return common[axis] > 1e-6 * d; };
      if (inside(0) && (planar || inside(1)) && inside(2))
        wrong(fmt::format("sea.water[{}]", n),
              fmt::format("overlaps sea.water[{}], where there would be water twice; boxes may touch", m));
    }
  require_places("water", o.water), require_places("obstacles", o.obstacles);
  std::vector<BoxOptions> wet = o.water;
  if (wet.empty()) wet.push_back({{t.x_m[0], planar ? 0.0 : t.y_m[0], -depth}, {t.x_m[1], planar ? 0.0 : t.y_m[1], 0.0}});
  for (std::size_t n = 0; n < o.obstacles.size(); ++n) {
    const auto holds = [&](const BoxOptions& box) {
      const Eigen::Array3d low = box.low_m - o.obstacles[n].low_m, high = o.obstacles[n].high_m - box.high_m;
      return (planar ? std::min({low[0], low[2], high[0], high[2]}) : std::min(low.minCoeff(), high.minCoeff())) >= 0.0;
    };
    if (std::ranges::all_of(wet, holds)) wrong(fmt::format("sea.obstacles[{}]", n), "holds all of the water: there is no sea");
  }
}

void Rules::judge_shape(const ParticleBody& body, const sph::BodyShape& shape) {
  const sph::Cut cut = planar ? sph::Cut::plane : sph::Cut::space;
  const std::string key = "bodies." + body.name;
  const auto* mesh = std::get_if<Mesh>(&shape);
  constexpr double enough = 1e5;  // points tell where a shape reaches, however small particles are
  sph::Points points;
  if (mesh)
    for (const Eigen::Vector3d& x : mesh->surface->points()) points.push_back(x - mesh->origin);
  else
    points = sph::fill_shape(shape, std::max(d, std::pow(sph::volume_of(shape, cut) / enough, planar ? 0.5 : 1.0 / 3.0)), cut);
  const double count = mesh ? std::round(sph::volume_of(shape, cut) / std::pow(d, planar ? 2 : 3)) : double(points.size());
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
  for (const Eigen::Vector3d& x : points)
    low = low.cwiseMin(body.described.point(x)), high = high.cwiseMax(body.described.point(x));
  const double bed = [&] {
    double highest = -depth;
    for (const auto& point : t.bed_m)
      if (point[0] > low[0] - d && point[0] < high[0] + d) highest = std::max(highest, point[1]);
    return highest;
  }();
  const std::string across = planar ? "" : fmt::format(" x {:.4g}", high[1] - low[1]);  // a prism's width is no one's
  const std::string size = mesh ? fmt::format("; its mesh is {:.4g}{} x {:.4g} m{}: look at its scale", high[0] - low[0], across,
                                              high[2] - low[2], planar ? " in the plane" : "")
                                : "";
  if (count < (planar ? 4.0 : 8.0))
    wrong(key, fmt::format("has a shape of {} particle{} at a spacing of {} m: too coarse{}", count, count == 1.0 ? "" : "s", d,
                           size));
  if (low[2] < bed) wrong(key, fmt::format("reaches {:.4g} m, below the bed at {:.4g} m{}", low[2], bed, size));
  const bool outside_x = t.sides_x == "wall" && (low[0] < t.x_m[0] || high[0] > t.x_m[1]);
  const bool outside_y =
      !planar && ((t.sides_y == "wall" && (low[1] < t.y_m[0] || high[1] > t.y_m[1])) || (t.symmetric() && high[1] > t.y_m[1]));
  if (outside_x || outside_y) wrong(key, "stands in a wall of the tank" + size);
  for (int axis = 0; axis < (planar ? 1 : 2); ++axis) {
    const std::array<double, 2>& sides = axis == 0 ? t.x_m : t.y_m;
    const std::string& kind = axis == 0 ? t.sides_x : t.sides_y;
    if ((kind == "periodic" || kind == "open") && (low[axis] < sides[0] || high[axis] > sides[1]))
      wrong(key, fmt::format("reaches {} = {:.4g} m, over a side of the tank {}{}", "xy"[axis],
                             low[axis] < sides[0] ? low[axis] : high[axis], side_without_wall(kind == "open", axis), size));
  }
  for (std::size_t n = 0; n < t.meshes.size(); ++n) {
    const scene::MeshOptions& m = t.meshes[n];
    if (!m.surface) continue;
    const auto& wall = m.prism ? *m.prism : *m.surface;
    const bool around = m.water == "inside";
    if (std::ranges::any_of(points, [&](const Eigen::Vector3d& x) {
          Eigen::Vector3d at = body.described.point(x);
          if (planar) at.y() = 0.0;
          return (around || wall.box().contains(at)) && (around ? -1.0 : 1.0) * wall.signed_distance(at) < -d;
        }))
      wrong(key, fmt::format("stands in sea.tank.meshes[{}]{}", n, size));
  }
}

}  // namespace

std::vector<OptionProblem> particle_problems(const SeaOptions& o, const WavesOptions& waves, const SeaEnvironment& environment,
                                             std::span<const ParticleBody> bodies) {
  Rules rules{o, waves, environment, bodies};
  rules.judge_tank();
  rules.judge_shapes_of_walls();
  rules.judge_waves();
  rules.judge_start();
  rules.judge_wavemaker();
  rules.lay_out();
  if (o.fields && o.fields->surface_spacing_m > 0.0 && o.fields->surface_spacing_m < 0.1 * rules.d)
    rules.wrong("sea.fields.surface_spacing_m",
                fmt::format("must be at least a tenth of the particles' spacing, {:.4g} m", 0.1 * rules.d));
  rules.judge_gauges_and_probes();
  rules.judge_sensors();
  rules.judge_zones();
  rules.judge_boxes();
  for (const ParticleBody& body : bodies)
    for (const sph::BodyShape& shape : body.shapes) rules.judge_shape(body, shape);
  return std::move(rules.problems);
}

}  // namespace spindrift::sea
