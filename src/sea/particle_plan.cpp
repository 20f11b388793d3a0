// From the options of a scene to the numbers of a sea of particles, and what is wrong with them: see particle_sea.hpp.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kernels/rigid/closed_surface.hpp"
#include "kernels/waves/dispersion.hpp"
#include "src/sea/particle_sea.hpp"
#include "src/sea/sph/sensors.hpp"
#include "src/sea/sph/tank_count.hpp"
#include "src/sea/sph/tank_lattice.hpp"
#include "src/sea/wave_field.hpp"
#include "src/sea/wave_model.hpp"

namespace spindrift::sea {
namespace {

constexpr double default_sound_speed_factor = 10.0, sound_speed_factor_of_a_dam = 20.0;
/// Sound over the speed of bodies that enter the water: with ten a dropped cylinder lags by 0.05 to 0.15 of its diameter.
constexpr double sound_over_entry_speed = 20.0;

/// Depth that sets the speed of sound: of the deepest water of the scene.
double deepest_water(const SeaOptions& o, double water_depth) {
  double deepest = 0.0;
  for (const BoxOptions& box : o.water) deepest = std::max(deepest, box.high_m[2] + water_depth);
  return o.water.empty() ? water_depth : deepest;
}

/// Whether a box of water has nothing under it: over a level bed, away from other boxes and obstacles.
bool hangs(const SeaOptions& o, const BoxOptions& box, double water_depth) {
  const double foot = box.low_m[2] - o.particles->spacing_m;
  const auto carries = [&](const BoxOptions& other) {
    return &other != &box && other.low_m[2] < foot && other.high_m[2] > foot && other.low_m[0] < box.high_m[0] &&
           other.high_m[0] > box.low_m[0] &&
           (o.particles->planar() || (other.low_m[1] < box.high_m[1] && other.high_m[1] > box.low_m[1]));
  };
  return o.tank->bed_m.empty() && o.tank->meshes.empty() && foot > -water_depth && std::ranges::none_of(o.water, carries) &&
         std::ranges::none_of(o.obstacles, carries);
}

/// Water that is not held all round runs at twice sqrt(g depth): columns that do not reach from side to side, or to sides that
/// are open, and boxes that fall.
bool breaks(const SeaOptions& o, double water_depth) {
  const TankOptions& t = *o.tank;
  const bool planar = o.particles->planar();
  const auto loose = [&](const BoxOptions& box) {
    return box.low_m[0] > t.x_m[0] || box.high_m[0] < t.x_m[1] ||
           (!planar && (box.low_m[1] > t.y_m[0] || box.high_m[1] < t.y_m[1])) || hangs(o, box, water_depth);
  };
  return t.sides_x == "open" || (!planar && t.sides_y == "open") || std::ranges::any_of(o.water, loose);
}

struct SoundSpeed {
  double value;  ///< [m/s]
  std::string from;
};
SoundSpeed sound_speed(const SeaOptions& o, const SeaEnvironment& environment, double entry_speed) {
  const ParticleOptions& p = *o.particles;
  if (p.sound_speed_m_s) return {*p.sound_speed_m_s, "the scene's"};
  const double default_factor = breaks(o, environment.water_depth) ? sound_speed_factor_of_a_dam : default_sound_speed_factor;
  const double factor = p.sound_speed_factor.value_or(default_factor), entry = sound_over_entry_speed * entry_speed;
  const double waves = factor * std::sqrt(environment.gravity * deepest_water(o, environment.water_depth));
  if (!p.sound_speed_factor && entry > waves)
    return {entry,
            fmt::format("{:g} times the {:.3g} m/s at which a body enters the water", sound_over_entry_speed, entry_speed)};
  return {waves, fmt::format("{:g} sqrt(g depth)", factor)};
}

sph::Parameters parameters_of(const SeaOptions& o, const SeaEnvironment& environment, double sound_speed) {
  const ParticleOptions& s = *o.particles;
  sph::Parameters p;
  p.spacing = s.spacing_m, p.h_over_d = s.smoothing_over_spacing, p.kernel = s.kernel;
  p.eos.rho0 = environment.water_density;
  p.eos.c0 = sound_speed;
  p.viscosity = s.viscosity_model;
  const bool sticks = s.walls.ends_with("no_slip");
  p.alpha = s.viscosity, p.alpha_solid = s.solid_viscosity.value_or(sticks ? s.viscosity : 0.0);
  p.nu = s.kinematic_viscosity_m2_s, p.nu_solid = s.solid_kinematic_viscosity_m2_s.value_or(s.kinematic_viscosity_m2_s);
  p.boundary = s.walls == "dynamic"              ? sph::BoundaryChoice::dynamic
               : s.walls.starts_with("modified") ? sph::BoundaryChoice::modified
                                                 : sph::BoundaryChoice::extrapolated;
  p.wall = sticks                            ? sph::WallChoice::no_slip
           : s.walls == "modified_free_slip" ? sph::WallChoice::free_slip
                                             : sph::WallChoice::still;
  p.own_mass = s.body_particles == "own";
  p.contact = s.contact, p.contact_stiffness = s.contact_stiffness, p.contact_damping = s.contact_damping;
  p.contact_friction = s.contact_friction;
  p.verlet_join_every = s.verlet_join_every;
  p.diffusion = s.density_diffusion, p.delta = s.diffusion_strength;
  p.gravity = environment.gravity;
  p.step = s.step, p.filter = s.density_filter, p.filter_every = s.filter_every, p.shifting = s.shifting, p.cfl = s.cfl;
  return p;
}

sph::TankPlan::Block block_of(const BoxOptions& box) { return {box.low_m, box.high_m}; }

/// Walls, bed and boxes of the tank, at rest.
sph::TankPlan tank_of(const SeaOptions& o, const SeaEnvironment& environment) {
  const TankOptions& t = *o.tank;
  sph::TankPlan tank;
  tank.x = t.x_m, tank.y = t.y_m, tank.depth = environment.water_depth, tank.top = t.top_m;
  tank.periodic = {t.sides_x == "periodic", t.sides_y == "periodic"}, tank.mirrored = t.symmetric();
  tank.open = {t.sides_x == "open", t.sides_y == "open"}, tank.over_edge_open = t.over_edge == "open";
  for (const scene::MeshOptions& m : t.meshes)
    if (const auto& surface = m.prism ? m.prism : m.surface) tank.walls.push_back({surface, m.water == "inside"});
  tank.bed = t.bed_m, tank.modified_walls = o.particles->modified_walls();
  for (const BoxOptions& box : o.water) tank.water.push_back(block_of(box));
  for (const BoxOptions& box : o.obstacles) tank.obstacles.push_back(block_of(box));
  return tank;
}

/// Waves with the wave numbers that they have over a bed shallower than the scene's.
std::vector<waves::Component> over_bed(std::vector<waves::Component> waves, double bed, const SeaEnvironment& environment) {
  if (bed != -environment.water_depth)
    for (waves::Component& c : waves) c.wave_number = waves::wave_number(c.angular_frequency, -bed, environment.gravity);
  return waves;
}

std::array<double, 2> ordered(double a, double b) { return {std::min(a, b), std::max(a, b)}; }

/// " (surfaces: sea.water[0] -0.3 m, ...)"
std::string surfaces_of(const SeaOptions& o) {
  std::string all;
  for (std::size_t n = 0; n < o.water.size(); ++n)
    all += fmt::format("{}sea.water[{}] {:g} m", n == 0 ? "" : ", ", n, o.water[n].high_m[2]);
  return " (surfaces: " + all + ")";
}

}  // namespace

ParticlePlan particle_plan(const SeaOptions& o, const WavesOptions& waves, const SeaEnvironment& environment,
                           std::vector<ParticleBody> bodies, double entry_speed) {
  const SoundSpeed sound = sound_speed(o, environment, entry_speed);
  ParticlePlan plan{.options = *o.particles,
                    .parameters = parameters_of(o, environment, sound.value),
                    .sound_speed_from = sound.from,
                    .bodies = std::move(bodies)};
  const TankOptions& t = *o.tank;
  plan.tank = tank_of(o, environment);
  plan.tank.jitter = o.particles->jitter, plan.tank.jitter_seed = std::uint64_t(o.particles->jitter_seed);
  if (waves.model != "none") plan.waves = WaveField(waves, environment).components();
  plan.second_order = waves.model != "none" && wave_models().named(waves.model).second_order;
  if (o.starts_in_waves()) plan.tank.waves = plan.waves;
  if (o.initial && o.initial->state == "standing") {
    for (waves::Component& c : plan.tank.waves) c.amplitude *= 0.5, c.speed_amplitude *= 0.5;
    for (const waves::Component& c : plan.waves) {
      waves::Component mirrored = c;
      mirrored.direction += pi, mirrored.phase = -c.phase, mirrored.amplitude *= 0.5, mirrored.speed_amplitude *= 0.5;
      plan.tank.waves.push_back(mirrored);
    }
  }
  if (o.initial)  // the sea begins in the waves of then
    for (waves::Component& c : plan.tank.waves) c.phase += c.angular_frequency * o.initial->settle_s;
  plan.settle_damping = o.initial ? o.initial->settle_damping_1_s : 0.0;
  plan.damping_zones = o.damping_zones, plan.gauges = o.gauges, plan.probes = o.probes, plan.sensors = o.sensors;
  if (o.wavemaker) {
    plan.wavemaker = o.wavemaker;
    if (!plan.wavemaker->ramp_s) plan.wavemaker->ramp_s = o.starts_in_waves() ? 0.0 : growth_time(waves);
    const double bed = plan.tank.bed_at(t.x_m[0]), hinge = o.wavemaker->hinge_m.value_or(bed);
    const sph::Paddle paddle{.flap = o.wavemaker->type == "flap",
                             .x = t.x_m[0],
                             .hinge = hinge,
                             .bed = bed,
                             .start_s = o.wavemaker->start_s,
                             .ramp_s = *plan.wavemaker->ramp_s,
                             .in_waves = o.initial && o.initial->state == "waves"};
    const std::vector<waves::Component> made = over_bed(plan.waves, bed, environment);
    plan.paddle.emplace(paddle, made, plan.second_order, o.wavemaker->stroke_m.value_or(0.0));
    const double reach = plan.paddle->reach();
    plan.tank.paddle = paddle;
    plan.tank.paddle_reach = paddle.flap ? reach * (t.top_m - hinge) / -hinge : reach;
  }
  return plan;
}

bool stands_level(const SeaOptions& o, double water_depth, const std::array<double, 2>& x, const std::array<double, 2>& y) {
  if (o.water.empty()) return true;
  const sph::TankPlan ground{.depth = water_depth, .bed = o.tank->bed_m};
  double bed = std::min(ground.bed_at(x[0]), ground.bed_at(x[1]));
  for (const auto& point : ground.bed)
    if (point[0] > x[0] && point[0] < x[1]) bed = std::min(bed, point[1]);
  const double near = 1e-6 * water_depth;
  return std::ranges::any_of(o.water, [&](const BoxOptions& box) {
    const auto reaches = [&](int axis, const std::array<double, 2>& stretch) {
      return box.low_m[axis] <= stretch[0] + near && box.high_m[axis] >= stretch[1] - near;
    };
    return std::abs(box.high_m[2]) <= near && box.low_m[2] <= bed + near && reaches(0, x) &&
           (o.particles->planar() || reaches(1, y));
  });
}

std::vector<OptionProblem> particle_problems(const SeaOptions& o, const WavesOptions& waves, const SeaEnvironment& environment,
                                             std::span<const ParticleBody> bodies) {
  std::vector<OptionProblem> problems;
  const auto wrong = [&](std::string key, std::string what, std::string follows_from = {}) {
    problems.push_back({std::move(key), std::move(what), std::move(follows_from)});
  };
  const ParticleOptions& p = *o.particles;
  const TankOptions& t = *o.tank;
  const bool planar = p.planar(), waved = waves.model != "none";
  const double d = p.spacing_m, depth = environment.water_depth, reach = 2.0 * p.smoothing_over_spacing * d;
  const sph::TankPlan ground{.depth = depth, .bed = t.bed_m};
  const sph::TankPlan tank = tank_of(o, environment);
  sph::Parameters lattice;
  lattice.spacing = d, lattice.h_over_d = p.smoothing_over_spacing;

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

  // What follows looks for places of the lattice, which must be one that can be laid out.
  constexpr double longest = 1e6;  // in spacings
  const bool laid_out =
      problems.empty() && std::max({t.x_m[1] - t.x_m[0], t.y_m[1] - t.y_m[0], t.top_m + depth, depth}) < longest * d;
  const double edge_of_cells = !laid_out ? d
                               : planar  ? std::sqrt(sph::TankLattice<2>(tank, d).cell())
                                         : std::cbrt(sph::TankLattice<3>(tank, d).cell());
  if (o.fields && o.fields->surface_spacing_m > 0.0 && o.fields->surface_spacing_m < 0.1 * d)
    wrong("sea.fields.surface_spacing_m", fmt::format("must be at least a tenth of the particles' spacing, {:.4g} m", 0.1 * d));
  std::set<std::string> names;
  const auto name = [&](const std::string& key, const std::string& value) {
    if (value.empty() || value.find_first_of(" ,.\"\t\n") != std::string::npos)
      wrong(key, "must be a name without spaces, commas, dots and quotes");
    if (!names.insert(value).second) wrong(key, "is the name of another gauge, probe or sensor");
  };
  for (std::size_t n = 0; n < o.gauges.size(); ++n) {
    const std::string key = fmt::format("sea.gauges[{}]", n);
    name(key + ".name", o.gauges[n].name);
    if (!(o.gauges[n].point_m[0] >= t.x_m[0] && o.gauges[n].point_m[0] <= t.x_m[1]))
      wrong(key + ".point_m", "is outside the tank");
    if (!planar && !(o.gauges[n].point_m[1] >= t.y_m[0] && o.gauges[n].point_m[1] <= t.y_m[1]))
      wrong(key + ".point_m", "is outside the tank");
  }
  for (std::size_t n = 0; n < o.probes.size(); ++n) {
    const std::string key = fmt::format("sea.probes[{}]", n);
    name(key + ".name", o.probes[n].name);
    const Eigen::Vector3d& x = o.probes[n].point_m;
    if (!(x[0] >= t.x_m[0] && x[0] <= t.x_m[1]) || (!planar && !(x[1] >= t.y_m[0] && x[1] <= t.y_m[1])))
      wrong(key + ".point_m", "is outside the tank");
    else if (const double bed = ground.bed_at(x[0]); x[2] < bed - 1e-9 * depth)
      wrong(key + ".point_m", fmt::format("is below the bed, which is at {:.6g} m there", bed));
  }
  const auto shaped = [&](const std::string& key, const std::string& body) {
    const auto named = std::find_if(bodies.begin(), bodies.end(), [&](const ParticleBody& b) { return b.name == body; });
    if (named != bodies.end() && !named->shapes.empty()) return named;
    std::string known;
    for (const ParticleBody& b : bodies)
      if (!b.shapes.empty()) known += (known.empty() ? "" : ", ") + b.name;
    wrong(key + ".body", "names '" + body + "', which is no body with a shape; known: " + (known.empty() ? "none" : known));
    return bodies.end();
  };
  for (std::size_t n = 0; n < o.gauges.size(); ++n)
    if (!o.gauges[n].body.empty()) shaped(fmt::format("sea.gauges[{}]", n), o.gauges[n].body);
  for (std::size_t n = 0; n < o.sensors.size(); ++n) {
    const SensorOptions& sensor = o.sensors[n];
    const std::string key = fmt::format("sea.sensors[{}]", n);
    name(key + ".name", sensor.name);
    if (!sensor.body.empty()) {
      const auto body = shaped(key, sensor.body);
      if (body == bodies.end()) continue;
      const Eigen::Vector3d low = sensor.low_m - body->described.position, high = sensor.high_m - body->described.position;
      const sph::Cut cut = sph::cut_of(planar, t.symmetric());
      if (t.symmetric() && sensor.low_m[1] < t.y_m[0])
        wrong(key, fmt::format("reaches y = {} m, beyond the plane of symmetry (sea.tank.sides_y) at {} m", sensor.low_m[1],
                               t.y_m[0]));
      else if (sph::points_of_surface(sph::fill_body(body->shapes, edge_of_cells, cut), body->shapes, low, high, d, cut).empty())
        wrong(key,
              fmt::format("has nothing of the surface of {} between low_m and high_m, where the scene describes it, or a strip "
                          "narrower than the rows of its particles, {} m",
                          sensor.body, d));
      continue;
    }
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
        continue;
      }
      sph::TankPlan::Block near = sph::particles_of_rectangle(sensor.low_m, sensor.high_m, reach);
      near.low.array() -= d, near.high.array() += d;  // those of pressure alone may fit between two rows
      if (!(planar ? sph::holds_wall<2>(tank, lattice, near) : sph::holds_wall<3>(tank, lattice, near)))
        wrong(key, "is on no wall: within reach of it there is no particle of a side, the bed, an obstacle or a mesh");
    }
  }
  for (std::size_t n = 0; n < o.damping_zones.size(); ++n) {
    const DampingZoneOptions& zone = o.damping_zones[n];
    const std::string key = fmt::format("sea.damping_zones[{}]", n);
    if (planar && zone.axis == "y") {
      wrong(key, "is along y: sea.particles.dimensions is 2");
      continue;
    }
    if (zone.towards == "waves") {
      if (!waved) wrong(key + ".towards", "has no waves to bring the water to: give [waves]");
      if (o.wavemaker)
        wrong(key + ".towards", "must be \"rest\" with [sea.wavemaker], whose waves grow and steepen on their way");
      if (o.initial && o.initial->state == "standing")
        wrong(key + ".towards", "must be \"rest\" where waves stand: [waves] travels");
      const double low = zone.axis == "x" ? std::min(zone.from_m, zone.to_m) : t.x_m[0],
                   high = zone.axis == "x" ? std::max(zone.from_m, zone.to_m) : t.x_m[1];
      double highest = std::max(ground.bed_at(low), ground.bed_at(high));
      for (const auto& point : t.bed_m)
        if (point[0] > low && point[0] < high) highest = std::max(highest, point[1]);
      if (!stands_level(o, depth, {low, high}, zone.axis == "y" ? ordered(zone.from_m, zone.to_m) : t.y_m))
        wrong(key + ".towards",
              fmt::format(
                  "must be \"rest\" where no box of [[sea.water]] holds the whole zone, down to the bed and up to z = 0, of "
                  "which [waves] is{}",
                  surfaces_of(o)));
      if (highest > -depth + 1e-9 * depth)
        wrong(key + ".towards", fmt::format("must be \"rest\" where the bed (sea.tank.bed_m) rises to {:.4g} m: [waves] is of a "
                                            "level bed at environment.water_depth_m",
                                            highest));
    }
    const auto& sides = zone.axis == "y" ? t.y_m : t.x_m;
    for (const double end : {zone.from_m, zone.to_m})
      if (!(end >= sides[0] && end <= sides[1])) wrong(key, fmt::format("reaches {} = {} m, outside the tank", zone.axis, end));
  }
  for (std::size_t n = 0; n < o.water.size(); ++n)
    for (std::size_t m = 0; m < n; ++m) {
      const Eigen::Vector3d common = o.water[n].high_m.cwiseMin(o.water[m].high_m) - o.water[n].low_m.cwiseMax(o.water[m].low_m);
      const auto inside = [&](int axis) { return common[axis] > 1e-6 * d; };
      if (inside(0) && (planar || inside(1)) && inside(2))
        wrong(fmt::format("sea.water[{}]", n),
              fmt::format("overlaps sea.water[{}], where there would be water twice; boxes may touch", m));
    }
  const auto require_places = [&](const std::string& name, const std::vector<BoxOptions>& boxes) {
    for (std::size_t n = 0; laid_out && n < boxes.size(); ++n) {
      const sph::TankPlan::Block block = block_of(boxes[n]);
      if ((planar ? sph::places_in<2>(tank, lattice, block) : sph::places_in<3>(tank, lattice, block)) == 0.0)
        wrong(fmt::format("sea.{}[{}]", name, n),
              fmt::format("holds no particle: it is outside the tank, in its bed, or thinner than the spacing of {} m", d));
    }
  };
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

  const sph::Cut cut = planar ? sph::Cut::plane : sph::Cut::space;
  for (const ParticleBody& body : bodies)
    for (const sph::BodyShape& shape : body.shapes) {
      const std::string key = "bodies." + body.name;
      const auto* mesh = std::get_if<Mesh>(&shape);
      constexpr double enough = 1e5;  // points tell where a shape reaches, however small particles are
      sph::Points points;
      if (mesh)
        for (const Eigen::Vector3d& x : mesh->surface->points()) points.push_back(x - mesh->origin);
      else
        points =
            sph::fill_shape(shape, std::max(d, std::pow(sph::volume_of(shape, cut) / enough, planar ? 0.5 : 1.0 / 3.0)), cut);
      const double count = mesh ? std::round(sph::volume_of(shape, cut) / std::pow(d, planar ? 2 : 3)) : double(points.size());
      if (count < (planar ? 4.0 : 8.0))
        wrong(key,
              fmt::format("has a shape of {} particle{} at a spacing of {} m: too coarse", count, count == 1.0 ? "" : "s", d));
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
      const std::string size = mesh ? fmt::format("; its mesh is {:.4g}{} x {:.4g} m{}: look at its scale", high[0] - low[0],
                                                  across, high[2] - low[2], planar ? " in the plane" : "")
                                    : "";
      if (low[2] < bed) wrong(key, fmt::format("reaches {:.4g} m, below the bed at {:.4g} m{}", low[2], bed, size));
      const bool outside_x = t.sides_x == "wall" && (low[0] < t.x_m[0] || high[0] > t.x_m[1]);
      const bool outside_y = !planar && ((t.sides_y == "wall" && (low[1] < t.y_m[0] || high[1] > t.y_m[1])) ||
                                         (t.symmetric() && high[1] > t.y_m[1]));
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
  return problems;
}

}  // namespace spindrift::sea
