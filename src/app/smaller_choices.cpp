// SPDX-License-Identifier: Apache-2.0
#include "src/app/smaller_choices.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "src/aero/turbine.hpp"
#include "src/bodies/extent.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/symmetry.hpp"
#include "src/coupling/timeline.hpp"
#include "src/sea/wave_model.hpp"

namespace spindrift::app {

Overrides operator+(Overrides a, const Overrides& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

namespace {

using coupling::Scenario;

/// The overrides that make a choice, none where the scene leaves nothing to choose.
struct Choice {
  const char* name;
  std::function<Overrides(const Scenario& own, const scene::Document& document)> overrides;
  bool in_plane = false;
};

/// Those of these keys that the scene gives, as one override that takes them away; nothing where it gives none.
Overrides without(const scene::Document& document, const std::vector<std::string>& keys) {
  std::string list;
  for (const std::string& key : keys)
    if (document.given(key)) list += fmt::format("{}\"{}\"", list.empty() ? "" : ",", key);
  if (list.empty()) return {};
  return {"without=[" + list + "]"};
}

/// Keys of a wake of filaments.
const std::vector<std::string> of_wake{"aero.wake_turns", "aero.wake_step_deg", "aero.wake_core_chords"};

std::int64_t windows_of(const Scenario& s) { return coupling::whole_ratio(s.time.end_s, s.time.window_s).value_or(1); }

/// Windows twice as long; the run ends with one of them.
Overrides longer_windows(const Scenario& s) {
  const double window = 2.0 * s.time.window_s;
  return {fmt::format("time.window_s={}", window), fmt::format("time.end_s={}", window * double((windows_of(s) + 1) / 2))};
}

const std::vector<Choice>& of_engineering() {
  static const std::vector<Choice> all{
      {"longer step",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         const std::int64_t steps = coupling::whole_ratio(s.time.window_s, s.time.step()).value_or(1);
         if (steps > 1) return {fmt::format("time.step_s={}", s.time.window_s / double((steps + 1) / 2))};
         return longer_windows(s) + Overrides{fmt::format("time.step_s={}", 2.0 * s.time.window_s)};
       }},
      {"rows half as often",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         return {fmt::format("output.history_every={}", 2 * s.output.history_every)};
       }},
      {"still water",
       [](const Scenario& s, const scene::Document& document) -> Overrides {
         return s.has_waves() ? without(document, {"waves"}) : Overrides{};
       }},
      {"strips twice as long",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         if (s.sea.model != "morison") return {};
         return {fmt::format("sea.strip_length_m={}", 2.0 * s.sea.strip_length_m)};
       }},
      {"buoyancy without strips",
       [](const Scenario& s, const scene::Document& document) -> Overrides {
         if (s.sea.model != "morison") return {};
         return without(document, {"waves", "sea.drag_coefficient", "sea.added_mass_coefficient", "sea.axial_drag_coefficient",
                                   "sea.axial_added_mass_coefficient", "sea.strip_length_m", "sea.current_m_s",
                                   "sea.current_profile", "sea.coefficients"}) +
                Overrides{"sea.model=hydrostatic"};
       }},
      {"no memory of waves made",
       [](const Scenario& s, const scene::Document& document) -> Overrides {
         if (!s.sea.potential || s.sea.potential->radiation == "none") return {};
         return without(document, {"sea.potential.memory_s", "sea.potential.fit_tolerance"}) +
                Overrides{"sea.potential.radiation=none"};
       }},
      {"no slow drift",
       [](const Scenario& s, const scene::Document& document) -> Overrides {
         if (!s.sea.potential || s.sea.potential->drift == "none") return {};
         return without(document, {"sea.potential.drift_file"}) + Overrides{"sea.potential.drift=none"};
       }},
      {"first-order waves",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         if (s.has_waves() && s.waves.second_order) return {"waves.second_order=false"};
         if (!s.has_waves() || !sea::wave_models().named(s.waves.model).nonlinear) return {};
         return {"waves.model=airy"};
       }},
      {"half the wave components",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         if (!s.has_waves() || sea::wave_models().named(s.waves.model).regular || s.waves.components < 20 ||
             !s.waves.file.empty())
           return {};
         return {fmt::format("waves.components={}", s.waves.components / 2)};
       }},
      {"filters for a wake of filaments",
       [](const Scenario& s, const scene::Document& document) -> Overrides {
         if (s.aero.dynamic_inflow != "free_vortex") return {};
         return without(document, of_wake) + Overrides{"aero.dynamic_inflow=oye"};
       }},
      {"thrust curve for blades",
       [](const Scenario& s, const scene::Document& document) -> Overrides {
         if (s.aero.model != "bem" || s.rotor.operation.empty()) return {};
         std::vector<std::string> of_blades{
             "aero.induction",        "aero.dynamic_inflow",     "aero.inflow_time_s",           "aero.dynamic_stall",
             "aero.stall_lag_chords", "aero.speed_of_sound_m_s", "aero.kinematic_viscosity_m2_s"};
         of_blades.insert(of_blades.end(), of_wake.begin(), of_wake.end());
         Overrides curve{"aero.model=thrust_curve", fmt::format("aero.curve=\"{}\"", s.rotor.operation)};
         for (const Scenario& one : coupling::by_rotor(s)) {
           if (one.rotor.operation != s.rotor.operation) return {};  // one curve is for all rotors
           of_blades.push_back(one.rotor_section + ".blade_structure");
           curve.push_back(fmt::format("{}.diameter_m={}", one.rotor_section,
                                       2.0 * aero::read_turbine(one.rotor.turbine).planform.span.back()));
         }
         return without(document, of_blades) + curve;
       }},
      {"no gyroscopic moments",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         Overrides all_bodies;
         for (const auto& body : s.bodies)
           if (body.options.gyroscopic) all_bodies.push_back(fmt::format("bodies.{}.gyroscopic=false", body.name));
         return all_bodies;
       }},
  };
  return all;
}

constexpr double coarser = 1.25;

/// A tank without bodies that looks the same at every y.
bool same_across(const Scenario& s) {
  const sea::SeaOptions& o = s.sea;
  const auto across = [&](const sea::BoxOptions& box) {
    return box.low_m[1] <= o.tank->y_m[0] && box.high_m[1] >= o.tank->y_m[1];
  };
  return !o.particles->planar() && s.bodies.empty() && o.tank->meshes.empty() && std::ranges::all_of(o.water, across) &&
         std::ranges::all_of(o.obstacles, across) && std::sin(s.waves.direction) == 0.0 &&
         std::ranges::all_of(o.damping_zones, [](const sea::DampingZoneOptions& zone) { return zone.axis == "x"; });
}

/// Whether things have their images beyond the plane y = `plane`.
class Mirror {
 public:
  explicit Mirror(double plane) : plane_(plane) {}
  bool are_images(const sea::BoxOptions& a, const sea::BoxOptions& b) const {
    const Eigen::Vector3d low = place({a.low_m.x(), a.high_m.y(), a.low_m.z()}),
                          high = place({a.high_m.x(), a.low_m.y(), a.high_m.z()});
    return same(low, b.low_m) && same(high, b.high_m);
  }
  bool are_images(const scene::Named<moorings::LineOptions>& a, const scene::Named<moorings::LineOptions>& b) const {
    const moorings::LineOptions &p = a.options, &q = b.options;
    return p.model == q.model && p.body == q.body && p.anchor_body == q.anchor_body && p.rest_length_m == q.rest_length_m &&
           p.fairlead_m && p.anchor_m && q.fairlead_m && q.anchor_m && same(place(*p.fairlead_m), *q.fairlead_m) &&
           same(place(*p.anchor_m), *q.anchor_m);
  }
  bool are_images(const bodies::ForceOptions& a, const bodies::ForceOptions& b) const {
    return same(place(a.point_m), b.point_m) && same(direction(a.force_N), b.force_N) &&
           same(-direction(a.moment_N_m), b.moment_N_m);
  }
  template <class Things>
  bool keeps(const Things& things) const {
    return std::ranges::all_of(things, [&](const auto& one) {
      return std::ranges::any_of(things, [&](const auto& other) { return are_images(one, other); });
    });
  }

 private:
  static Eigen::Vector3d direction(const Eigen::Vector3d& v) { return coupling::image_across(0.0, v); }
  Eigen::Vector3d place(const Eigen::Vector3d& x) const { return coupling::image_across(plane_, x); }
  static bool same(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return (a - b).norm() <= 1e-6 * (1.0 + b.norm()); }
  double plane_;
};

/// One half of a tank that is symmetrical about the middle between its long sides, with all that is in it; what is read stands in
/// that half.
Overrides symmetric_half(const Scenario& s) {
  const sea::SeaOptions& o = s.sea;
  const sea::TankOptions& tank = *o.tank;
  const double plane = 0.5 * (tank.y_m[0] + tank.y_m[1]);
  const Mirror mirror(plane);
  const bool divides = !o.particles->planar() && tank.sides_y == "wall" && tank.meshes.empty() &&
                       (!o.initial || o.initial->state != "file") && mirror.keeps(o.water) && mirror.keeps(o.obstacles) &&
                       std::ranges::all_of(o.damping_zones, [](const auto& zone) { return zone.axis == "x"; });
  const bool loaded_alike = mirror.keeps(s.moorings) &&
                            std::ranges::all_of(s.bodies, [&](const auto& body) { return mirror.keeps(body.options.forces); });
  const bool read_there =
      std::ranges::all_of(o.gauges, [&](const auto& gauge) { return gauge.point_m[1] >= plane; }) &&
      std::ranges::all_of(o.probes, [&](const auto& probe) { return probe.point_m.y() >= plane; }) &&
      std::ranges::all_of(o.sensors, [&](const auto& sensor) { return sensor.low_m.y() >= plane && sensor.high_m.y() > plane; });
  if (!divides || !loaded_alike || !read_there || !coupling::symmetry_problems(s, plane).empty()) return {};
  return {fmt::format("sea.tank.y_m=[{:.9g},{:.9g}]", plane, tank.y_m[1]), "sea.tank.sides_y=symmetric"};
}

/// The sides of a tank half as far from the bodies in it.
Overrides nearer_tank_sides(const Scenario& s) {
  if (s.sea.particles->planar() || !s.sea.tank->meshes.empty()) return {};
  Eigen::AlignedBox3d round;
  for (const auto& body : s.bodies)
    if (Eigen::AlignedBox3d box = bodies::bounds(body.options); !box.isEmpty())
      round.extend(box.translate(body.options.displacement_m));
  if (round.isEmpty()) return {};
  const auto& sides = s.sea.tank->y_m;
  auto [low, high] = sides;
  if (!s.sea.tank->symmetric()) low = std::max(low, 0.5 * (low + round.min().y()));
  high = std::min(high, 0.5 * (high + round.max().y()));
  if (low == sides[0] && high == sides[1]) return {};
  return {fmt::format("sea.tank.y_m=[{:.6g},{:.6g}]", low, high)};
}

/// The keys of a sea of particles, for one of strips; nothing where a body has shapes that strips do not know.
Overrides strips(const Scenario& s, const scene::Document& document) {
  bool cylinders = false;
  for (const auto& body : s.bodies) {
    const bodies::BodyOptions& o = body.options;
    if (!o.boxes.empty() || !o.spheres.empty() || !o.meshes.empty()) return {};
    cylinders = cylinders || !o.cylinders.empty();
  }
  if (!cylinders || s.sea.particles->planar()) return {};
  Overrides waves;  // that grow as those of the particles
  if (s.has_given_waves())
    waves.push_back(
        fmt::format("waves.ramp_s={:.6g}", s.sea.wavemaker ? s.sea.wavemaker->ramp_s.value_or(sea::growth_time(s.waves)) : 0.0));
  return without(document,
                 {"sea.particles", "sea.tank", "sea.water", "sea.obstacles", "sea.wavemaker", "sea.damping_zones", "sea.initial",
                  "sea.gauges", "sea.probes", "sea.sensors", "sea.fields", "coupling.placement", "coupling.air_ranks"}) +
         Overrides{"sea.model=morison"} + waves;
}

/// Of [sea.particles], [sea.tank], [sea.initial], [sea].
const std::vector<Choice>& of_particles() {
  static const std::vector<Choice> all{
      {"particles 1.25 times as far",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         return {fmt::format("sea.particles.spacing_m={:.6g}", coarser * s.sea.particles->spacing_m)};
       }},
      {"fewer neighbours",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         const double less = s.sea.particles->smoothing_over_spacing / coarser;
         if (less < 1.0) return {};
         return {fmt::format("sea.particles.smoothing_over_spacing={:.6g}", less)};
       }},
      {"Wendland's kernel",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         if (s.sea.particles->kernel != sph::KernelChoice::quintic) return {};
         return {"sea.particles.kernel=wendland"};
       }},
      {"slower sound",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         constexpr double share = 0.7, least = 5.0;  // of the factor, as its key allows
         const sea::ParticleOptions& p = *s.sea.particles;
         if (p.sound_speed_factor) {
           if (*p.sound_speed_factor <= least) return {};
           return {fmt::format("sea.particles.sound_speed_factor={:.6g}", std::max(least, share * *p.sound_speed_factor))};
         }
         const double speed = share * *p.sound_speed_m_s;
         if (speed < least * std::sqrt(s.environment.gravity_m_s2 * s.environment.water_depth_m)) return {};
         return {fmt::format("sea.particles.sound_speed_m_s={:.6g}", speed)};
       }},
      {"Verlet's step",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         if (s.sea.particles->step != sph::StepChoice::symplectic) return {};
         return {"sea.particles.step=verlet"};
       }},
      {"half the settling",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         const double windows = std::floor(0.5 * s.sea.settle_s() / s.time.window_s);
         if (windows < 1.0) return {};
         return {fmt::format("sea.initial.settle_s={}", windows * s.time.window_s)};
       }},
      {"two dimensions",
       [](const Scenario& s, const scene::Document& document) -> Overrides {
         if (!same_across(s)) return {};
         const sea::TankOptions& tank = *s.sea.tank;
         return without(document, {"sea.tank.y_m", "sea.tank.sides_y"}) +
                Overrides{"sea.particles.dimensions=\"2\"",
                          fmt::format("sea.particles.width_m={}", (tank.symmetric() ? 2.0 : 1.0) * (tank.y_m[1] - tank.y_m[0]))};
       }},
      {"symmetric half", [](const Scenario& s, const scene::Document&) { return symmetric_half(s); }, true},
      {"nearer sides of the tank", [](const Scenario& s, const scene::Document&) { return nearer_tank_sides(s); }},
      {"strips for the particles", strips},
  };
  return all;
}

/// Fewer cells of a grid that the program makes.
Overrides coarser_grid(const aero::GenerateOptions& g) {
  const std::string at = "aero.flow.generate.";
  if (g.kind == "stretched_box") return {at + fmt::format("cell_m={:.6g}", coarser * g.cell_m)};
  if (g.kind == "cylinder") {
    if (g.around < 16 || g.outward < 8) return {};
    return {at + fmt::format("around={}", g.around / 2), at + fmt::format("outward={}", g.outward / 2)};
  }
  if (g.kind == "box") {
    std::array<int, 3> cells{};
    bool fewer = false;
    for (int axis = 0; axis < 3; ++axis) {
      cells[axis] = int(g.cells[axis]);
      if (cells[axis] >= 8) cells[axis] /= 2, fewer = true;
    }
    return fewer ? Overrides{at + fmt::format("cells=[{}]", fmt::join(cells, ","))} : Overrides{};
  }
  if (g.refinement < 2) return {};
  Overrides half{at + fmt::format("refinement={}", (g.refinement + 1) / 2)};
  if (g.kind == "wing" && g.span_cells >= 4) half.push_back(at + fmt::format("span_cells={}", g.span_cells / 2));
  return half;
}

/// Those of a box that grows away from its core, where they are only far: half as far from the core.
Overrides nearer_sides(const aero::FlowOptions& flow) {
  const aero::GenerateOptions& g = *flow.generate;
  if (g.kind != "stretched_box") return {};
  std::array<double, 3> low = g.low_m, high = g.high_m;
  for (const aero::PatchOptions& side : flow.boundaries) {
    if (side.condition != aero::Condition::far_field || side.patch.size() != 5) continue;
    const int axis = side.patch[0] - 'x';  // x_min ... z_max
    if (side.patch.ends_with("_min"))
      low[axis] = 0.5 * (low[axis] + g.core_low_m[axis]);
    else
      high[axis] = 0.5 * (high[axis] + g.core_high_m[axis]);
  }
  if (low == g.low_m && high == g.high_m) return {};
  return {fmt::format("aero.flow.generate.low_m=[{}]", fmt::join(low, ",")),
          fmt::format("aero.flow.generate.high_m=[{}]", fmt::join(high, ","))};
}

/// Of [aero], [aero.flow], [aero.grid], [start].
const std::vector<Choice>& of_air() {
  static const std::vector<Choice> all{
      {"fewer cells",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         if (s.aero.flow->generate) return coarser_grid(*s.aero.flow->generate);
         constexpr double least = 0.8;  // as the key allows
         if (!s.aero.grid || s.aero.grid->resolution <= least) return {};
         return {fmt::format("aero.grid.resolution={:.6g}", std::max(least, s.aero.grid->resolution / coarser))};
       }},
      {"nearer far sides",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         return s.aero.flow->generate ? nearer_sides(*s.aero.flow) : Overrides{};
       }},
      {"a looser end of each march",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         constexpr double looser = 10.0, loosest = 0.1;
         const aero::FlowOptions flow = has_resolved_rotor(s) ? coupling::resolved_rotor_setup(s).flow : *s.aero.flow;
         const bool steady = flow.time == "steady";
         if (flow.drop <= 0.0) {  // all pseudo-steps are made
           if (steady)
             return windows_of(s) < 2
                        ? Overrides{}
                        : Overrides{fmt::format("time.end_s={}", s.time.window_s * double((windows_of(s) + 1) / 2))};
           if (flow.max_pseudo_steps < 2) return {};
           return {fmt::format("aero.flow.max_pseudo_steps={}", (flow.max_pseudo_steps + 1) / 2)};
         }
         const double change = flow.load_change.value_or(0.0);
         if (steady && change > 0.0) return {fmt::format("aero.flow.load_change={:.6g}", std::min(loosest, looser * change))};
         if (flow.drop >= loosest) return {};
         return {fmt::format("aero.flow.drop={:.6g}", std::min(loosest, looser * flow.drop))};
       }},
      {"longer step",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         if (s.aero.flow->time == "steady") return {};
         if (s.bodies.empty() || s.has_particles()) return longer_windows(s);
         return longer_windows(s) + Overrides{fmt::format("time.step_s={}", s.time.step())};
       }},
      {"half the settling of the air",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         if (s.start.air_steps < 2) return {};
         return {fmt::format("start.air_steps={}", s.start.air_steps / 2)};
       }},
      {"a disc for lines",
       [](const Scenario& s, const scene::Document&) -> Overrides {
         return s.aero.model == "actuator_line" ? Overrides{"aero.model=actuator_disc"} : Overrides{};
       }},
      {"blade elements for the air",
       [](const Scenario& s, const scene::Document& document) -> Overrides {
         if (s.bodies.empty()) return {};
         return without(document,
                        {"aero.flow", "aero.grid", "aero.actuator", "start.air_steps", "start.air", "output.air_interval_s",
                         "coupling.placement", "coupling.air_ranks", "wind.turbulence.inflow_plane_m"}) +
                Overrides{"aero.model=bem"};
       }},
  };
  return all;
}

}  // namespace

std::vector<SmallerChoice> smaller_choices(const coupling::Scenario& scenario, const scene::Document& document) {
  std::vector<SmallerChoice> found;
  const auto offer = [&](const std::vector<Choice>& choices) {
    for (const Choice& choice : choices)
      if (Overrides overrides = choice.overrides(scenario, document); !overrides.empty())
        found.push_back({choice.name, std::move(overrides), choice.in_plane && !scenario.bodies.empty()});
  };
  if (scenario.has_particles()) offer(of_particles());
  if (scenario.resolves_air()) offer(of_air());
  if (!scenario.has_particles() && !scenario.resolves_air()) offer(of_engineering());
  return found;
}

bool is_out_of_plane(std::string_view column) {
  const std::string_view quantity = column.substr(column.rfind('.') + 1);
  constexpr std::array of_sway_roll_yaw{"y_m",     "roll_deg",   "yaw_deg",    "vy_m_s", "wx_rad_s", "wz_rad_s",
                                        "ay_m_s2", "awx_rad_s2", "awz_rad_s2", "fy_N",   "mx_N_m",   "mz_N_m"};
  return std::ranges::find(of_sway_roll_yaw, quantity) != of_sway_roll_yaw.end();
}

}  // namespace spindrift::app
