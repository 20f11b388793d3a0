// From the options of a scene to the numbers of a sea of particles: see particle_sea.hpp.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernels/waves/dispersion.hpp"
#include "src/sea/particle_plan.hpp"
#include "src/sea/wave_field.hpp"
#include "src/sea/wave_model.hpp"

namespace spindrift::sea {
namespace {

constexpr double default_sound_speed_factor = 10.0, sound_speed_factor_of_a_dam = 20.0;
/// Sound over the speed of bodies that enter the water: with ten a dropped cylinder lags by 0.05 to 0.15 of its diameter.
constexpr double sound_over_entry_speed = 20.0;

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

/// Waves with the wave numbers that they have over a bed shallower than the scene's.
std::vector<waves::Component> over_bed(std::vector<waves::Component> waves, double bed, const SeaEnvironment& environment) {
  if (bed != -environment.water_depth)
    for (waves::Component& c : waves) c.wave_number = waves::wave_number(c.angular_frequency, -bed, environment.gravity);
  return waves;
}

}  // namespace

double deepest_water(const SeaOptions& o, double water_depth) {
  double deepest = 0.0;
  for (const BoxOptions& box : o.water) deepest = std::max(deepest, box.high_m[2] + water_depth);
  return o.water.empty() ? water_depth : deepest;
}

sph::TankPlan tank_of(const SeaOptions& o, const SeaEnvironment& environment) {
  const TankOptions& t = *o.tank;
  sph::TankPlan tank;
  tank.x = t.x_m, tank.y = t.y_m, tank.depth = environment.water_depth, tank.top = t.top_m;
  tank.periodic = {t.sides_x == "periodic", t.sides_y == "periodic"}, tank.mirrored = t.symmetric();
  tank.open = {t.sides_x == "open", t.sides_y == "open"}, tank.over_edge_open = t.over_edge == "open";
  for (const scene::MeshOptions& m : t.meshes)
    if (const auto& surface = m.prism ? m.prism : m.surface) tank.walls.push_back({surface, m.water == "inside"});
  tank.bed = t.bed_m, tank.modified_walls = o.particles->modified_walls();
  for (const BoxOptions& box : o.water) tank.water.push_back({box.low_m, box.high_m});
  for (const BoxOptions& box : o.obstacles) tank.obstacles.push_back({box.low_m, box.high_m});
  return tank;
}

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
  plan.damping_zones = o.damping_zones, plan.probes = o.probes, plan.sensors = o.sensors;
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

}  // namespace spindrift::sea
