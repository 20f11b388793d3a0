// SPDX-License-Identifier: Apache-2.0
#include "src/sea/doubts.hpp"
#include "src/sea/wave_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "kernels/waves/wavemaker.hpp"
#include "src/sea/sph/tank.hpp"

namespace spindrift::sea {

double wave_length(double period_s, const SeaEnvironment& e) {
  const double deep = e.gravity * period_s * period_s / (2.0 * pi);
  double length = deep;
  for (int n = 0; n < 100; ++n) length = 0.5 * (length + deep * std::tanh(2.0 * pi * e.water_depth / length));
  return length;
}

scene::Doubts wave_doubts(const WavesOptions& w, const SeaEnvironment& e) {
  scene::Doubts doubts;
  if (w.crest_height_m && *w.crest_height_m > w.height_m)
    doubts.push_back({"waves.crest_height_m",
                      fmt::format("{:.4g} m in a sea of significant height {:.4g} m", *w.crest_height_m, w.height_m),
                      "up to the significant height: one in 3000 crests is higher (Rayleigh)", "look at both heights"});
  if (w.model == "none" || w.period_s <= 0.0 || w.height_m <= 0.0) return doubts;
  const WaveModel& model = wave_models().named(w.model);
  const double length = wave_length(w.period_s, e), steepness = w.height_m / length;
  // Miche (1944): regular waves break beyond 0.142 tanh(kd). Sea states beyond 1/15 at the peak are not met (DNV-RP-C205, 3.5.5).
  const double limit = !model.regular ? 1.0 / 15.0 : 0.142 * std::tanh(2.0 * pi * e.water_depth / length);
  if (steepness > limit)
    doubts.push_back({"waves.height_m",
                      fmt::format("{:.4g} m at a period of {:.4g} s is {:.3g} of the length, {:.4g} m", w.height_m, w.period_s,
                                  steepness, length),
                      fmt::format("up to {:.3g}: steeper waves break", limit), "look at the height and the period"});
  // Seas and swell have 0.001 of it or more; those that only linear answers are wanted of may have less, in regular waves.
  if (const double least = model.regular ? 2e-4 : 4e-4; steepness < least)
    doubts.push_back({"waves.height_m",
                      fmt::format("{:.4g} m at a period of {:.4g} s is {:.2g} of the length, {:.4g} m", w.height_m, w.period_s,
                                  steepness, length),
                      fmt::format("{:g} of it or more: even swell has 0.001", least),
                      "look at the unit of the height, m, and at the period"});
  if (w.height_m > 0.78 * e.water_depth)
    doubts.push_back({"waves.height_m", fmt::format("{:.4g} m in water {:.4g} m deep", w.height_m, e.water_depth),
                      "up to 0.78 of the depth (McCowan 1894)", "look at environment.water_depth_m"});
  if (w.height_m > 25.0)
    doubts.push_back({"waves.height_m", fmt::format("{:.4g} m", w.height_m), "up to 25 m at sea",
                      "look at its unit: metres, crest to trough"});
  if (w.period_s > 30.0)
    doubts.push_back({"waves.period_s", fmt::format("{:.4g} s", w.period_s), "up to 30 s: longer ones are tides and surges",
                      "look at its unit: seconds, not a frequency"});
  const double ursell = w.height_m * length * length / std::pow(e.water_depth, 3);
  if (model.second_order || w.second_order) {
    // Where second order ends and cnoidal waves begin (Hedges 1995).
    if (ursell > 40.0)
      doubts.push_back({w.second_order ? "waves.second_order" : "waves.model",
                        fmt::format("{} with an Ursell number of {:.3g}", w.model, ursell), "below 40 (Hedges 1995)",
                        "the wave is too long for this depth; look at environment.water_depth_m"});
  } else if (model.regular && !model.nonlinear && ursell > 26.0)
    // At 8 pi^2 / 3 the second harmonic of Stokes, 3 Ur / (32 pi^2) of the first in shallow water, is a quarter of it: its
    // trough has a crest of its own.
    doubts.push_back({"waves.model", fmt::format("{} with an Ursell number, H L^2 / d^3, of {:.3g}", w.model, ursell),
                      "below 26: beyond, troughs are long and crests high and short",
                      "take \"stream_function\" where the sea has no particles, or look at environment.water_depth_m"});
  return doubts;
}

namespace {

void doubt_water(scene::Doubts& doubts, const SeaEnvironment& e) {
  if (e.water_density < 900.0 || e.water_density > 1100.0)
    doubts.push_back({"environment.water_density_kg_m3", fmt::format("{:.4g} kg/m3", e.water_density), "900 to 1100 kg/m3",
                      "look at its unit"});
  if (e.gravity < 9.7 || e.gravity > 9.9)
    doubts.push_back({"environment.gravity_m_s2", fmt::format("{:.4g} m/s2", e.gravity), "9.7 to 9.9 m/s2 on earth",
                      "look at its sign and unit"});
}

/// Of cylinders DNV-RP-C205 (section 6.7, appendix E) has a drag of 0.4 to 1.2 and an added mass from 0.6 on; none is 0.
void doubt_coefficient(scene::Doubts& doubts, const std::string& key, double value, const std::string& of, bool axial) {
  const double least = axial ? 0.0 : 0.05, most = axial ? 12.0 : 3.0;
  if (value > most)
    doubts.push_back({key, fmt::format("{:.4g}{}", value, of), fmt::format("up to {:.4g} (DNV-RP-C205)", most),
                      "coefficients have no unit; look at the point"});
  else if (value > 0.0 && value < least)
    doubts.push_back({key, fmt::format("{:.4g}{}", value, of),
                      fmt::format("{:g} or more, or 0: cylinders have 0.4 to 1.2", least),
                      "coefficients have no unit and are not in per cent; look at the point"});
}

void doubt_coefficients(scene::Doubts& doubts, const SeaOptions& sea) {
  const auto doubt = [&](const std::string& at, const std::string& of, double drag, double mass, double axial_drag,
                         double axial_mass) {
    doubt_coefficient(doubts, at + "drag_coefficient", drag, of, false);
    doubt_coefficient(doubts, at + "added_mass_coefficient", mass, of, false);
    doubt_coefficient(doubts, at + "axial_drag_coefficient", axial_drag, of, true);
    doubt_coefficient(doubts, at + "axial_added_mass_coefficient", axial_mass, of, true);
  };
  doubt("sea.", "", sea.drag_coefficient, sea.added_mass_coefficient, sea.axial_drag_coefficient,
        sea.axial_added_mass_coefficient);
  for (std::size_t n = 0; n < sea.coefficients.size(); ++n) {
    const CoefficientsOptions& c = sea.coefficients[n];
    doubt(fmt::format("sea.coefficients[{}].", n), " of " + c.cylinder, c.drag_coefficient.value_or(0.0),
          c.added_mass_coefficient.value_or(0.0), c.axial_drag_coefficient.value_or(0.0),
          c.axial_added_mass_coefficient.value_or(0.0));
  }
}

}  // namespace

namespace {

/// The tank itself, which a census of particles does not question.
void doubt_tank(scene::Doubts& doubts, const SeaOptions& sea, const WavesOptions& waves, const SeaEnvironment& e,
                const BodiesInSea& bodies) {
  if (!sea.tank) return;
  const bool wavy = waves.model != "none" && waves.period_s > 0.0;
  const bool regular = wavy && wave_models().named(waves.model).regular;
  const double omega = wavy ? 2.0 * pi / waves.period_s : 0.0, length = wavy ? wave_length(waves.period_s, e) : 0.0;
  const double along = sea.tank->x_m[1] - sea.tank->x_m[0];
  if (wavy && sea.tank->top_m < 0.75 * waves.height_m)
    doubts.push_back({"sea.tank.top_m", fmt::format("{:.4g} m with waves {:.4g} m high", sea.tank->top_m, waves.height_m),
                      "three quarters of the height or more: crests are higher than troughs are deep",
                      "the water leaves over the walls; z is up from still water"});
  if (wavy && along < 0.5 * length)
    doubts.push_back({"sea.tank.x_m", fmt::format("{:.4g} m long with waves {:.4g} m long", along, length), "half a wave or more",
                      "look at the period and at the unit of the tank: m"});
  const double longest = std::max(along, (sea.tank->symmetric() ? 2.0 : 1.0) * (sea.tank->y_m[1] - sea.tank->y_m[0]));
  if (sea.tank->top_m > longest)
    doubts.push_back({"sea.tank.top_m", fmt::format("{:.4g} m for a tank {:.4g} m long", sea.tank->top_m, longest),
                      "walls lower than the tank is long", "look at its unit: m above still water"});
  const auto doubt_sides = [&](const char* key, const std::string& axis, const std::string& sides,
                               const std::array<double, 2>& ends, double cosine) {
    const double across = ends[1] - ends[0], waves_in = across / length * std::abs(cosine);
    const bool fit =
        std::abs(waves_in - std::round(waves_in)) <= 0.1 && (regular || std::abs(cosine) < 1e-9) && !waves.spreading_exponent;
    const auto led = [&](double end) {
      return std::any_of(sea.damping_zones.begin(), sea.damping_zones.end(),
                         [&](const DampingZoneOptions& z) { return z.axis == axis && z.towards == "waves" && z.to_m == end; });
    };
    if (!wavy || sides != "periodic" || fit || (led(ends[0]) && led(ends[1]))) return;
    const std::string heading =
        std::abs(cosine) > 0.999 ? "" : fmt::format(" towards {:.4g} degrees", waves.direction * 180.0 / pi);
    doubts.push_back(
        {key,
         regular ? fmt::format("{:.4g} m with periodic sides, {:.3g} waves of {:.4g} m{}", across, waves_in, length, heading)
                 : fmt::format("{:.4g} m with periodic sides for waves of many lengths", across),
         "a whole number of waves of one length",
         "where the sides meet the waves have a step; [[sea.damping_zones]] up to both of them with "
         "towards = \"waves\" keep it there"});
  };
  doubt_sides("sea.tank.x_m", "x", sea.tank->sides_x, sea.tank->x_m, std::cos(waves.direction));
  doubt_sides("sea.tank.y_m", "y", sea.tank->sides_y, sea.tank->y_m, std::sin(waves.direction));
  if (constexpr double most = 3.0; e.water_depth > most * longest)
    doubts.push_back({"environment.water_depth_m", fmt::format("{:.4g} m in a tank {:.4g} m long", e.water_depth, longest),
                      fmt::format("up to {:g} times its length", most),
                      "look at the units of both: m; the cost goes with the depth"});
  if (constexpr double most = 1.5; wavy && e.water_depth > most * length && e.water_depth > 3.0 * bodies.draft)
    doubts.push_back({"environment.water_depth_m", fmt::format("{:.4g} m under waves {:.4g} m long", e.water_depth, length),
                      fmt::format("up to {:g} wave lengths: from a half on the water at the bed rests", most),
                      "look at the units of both: m; the cost goes with the depth"});
  double free = along;
  for (const DampingZoneOptions& zone : sea.damping_zones)
    if (zone.axis != "y") free -= std::abs(zone.to_m - zone.from_m);
  if (wavy && !sea.damping_zones.empty() && free < 0.5 * length)
    doubts.push_back({"sea.damping_zones", fmt::format("leave {:.4g} m of the tank for waves {:.4g} m long", free, length),
                      "half a wave or more", "look at from_m and to_m"});
  for (std::size_t n = 0; n < sea.damping_zones.size(); ++n) {
    const DampingZoneOptions& zone = sea.damping_zones[n];
    const std::string at = fmt::format("sea.damping_zones[{}]", n);
    if (wavy && (zone.rate_1_s < 0.2 * omega || zone.rate_1_s > 30.0 * omega))
      doubts.push_back({at + ".rate_1_s",
                        fmt::format("{:.4g} 1/s, {:.3g} of the waves' angular frequency", zone.rate_1_s, zone.rate_1_s / omega),
                        "0.2 to 30 times it", "a weak zone lets waves through, a hard one throws them back"});
    if (const double wide = std::abs(zone.to_m - zone.from_m); wavy && zone.axis != "y" && wide < 0.25 * length)
      doubts.push_back({at + ".to_m", fmt::format("a zone of {:.4g} m under waves {:.4g} m long", wide, length),
                        "a quarter of a wave or more; a whole one is usual", "waves come back from the wall behind it"});
    const int axis = zone.axis == "y" ? 1 : 0;
    const auto [low, high] = std::minmax(zone.from_m, zone.to_m);
    const std::array<double, 2>& sides = axis == 1 ? sea.tank->y_m : sea.tank->x_m;
    const double middle = axis == 1 && sea.tank->symmetric() ? sides[0] : 0.5 * (sides[0] + sides[1]);
    if (low >= sides[1] || high <= sides[0])
      doubts.push_back({at + ".from_m", fmt::format("a zone from {:.4g} to {:.4g} m along {}", zone.from_m, zone.to_m, zone.axis),
                        fmt::format("within the tank, {:.4g} to {:.4g} m", sides[0], sides[1]),
                        "there is no water; look at its unit: m"});
    else if (std::abs(zone.to_m - middle) < std::abs(zone.from_m - middle))
      doubts.push_back(
          {at + ".to_m",
           fmt::format("damping that grows inwards, from {:.4g} to {:.4g} m along {}", zone.from_m, zone.to_m, zone.axis),
           "damping that grows towards the tank's end", "exchange from_m and to_m: waves meet its full strength at once"});
    const double first = zone.to_m < zone.from_m ? -1e300 : low,
                 last = zone.to_m < zone.from_m ? high : 1e300;  // beyond to_m too
    for (const auto& [name, box] : bodies.boxes)
      if (box.max()[axis] > first && box.min()[axis] < last)
        doubts.push_back({at + ".from_m",
                          fmt::format("a zone from {:.4g} to {:.4g} m along {} and from there to the end, where body {} is",
                                      zone.from_m, zone.to_m, zone.axis, name),
                          "zones beside the bodies", "the water round it is brought to rest"});
  }
}

/// Boxes of water that reach out of the tank, of which only what is inside is made.
void doubt_boxes_of_water(scene::Doubts& doubts, const SeaOptions& sea, const SeaEnvironment& e) {
  if (!sea.tank) return;
  const TankOptions& t = *sea.tank;
  const std::array<std::array<double, 2>, 3> inside{t.x_m, t.y_m, {-e.water_depth, t.top_m}};
  for (std::size_t n = 0; n < sea.water.size(); ++n)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axis == 1 && sea.particles->planar()) continue;
      const double low = sea.water[n].low_m[int(axis)], high = sea.water[n].high_m[int(axis)];
      const auto [least, most] = inside[axis];
      const double near = 0.5 * sea.particles->spacing_m;
      const bool under = low < least - near && !(axis == 1 && t.symmetric()), over = high > most + near;
      if (under || over)
        doubts.push_back(
            {fmt::format("sea.water[{}].{}_m", n, over ? "high" : "low"),
             fmt::format("{} = {:.4g} m in a tank from {:.4g} to {:.4g} m", "xyz"[axis], over ? high : low, least, most),
             "boxes within the tank", "the water outside of it is left out; look at both, and at their units"});
    }
}

/// Obstacles with water on both sides that feels itself through them. What stands on the bed or against a wall has no far side.
void doubt_obstacles(scene::Doubts& doubts, const SeaOptions& sea, const SeaEnvironment& e) {
  if (!sea.tank) return;
  constexpr double layers = 3.0;
  const double spacing = sea.particles->spacing_m, near = 0.5 * spacing;
  const sph::TankPlan ground{.depth = e.water_depth, .bed = sea.tank->bed_m};
  for (std::size_t n = 0; n < sea.obstacles.size(); ++n) {
    const BoxOptions& box = sea.obstacles[n];
    double thin = 1e300;
    for (int axis = 0; axis < 3; ++axis) {
      if (axis == 1 && sea.particles->planar()) continue;
      const std::array<double, 2> sides = axis == 0   ? sea.tank->x_m
                                          : axis == 1 ? sea.tank->y_m
                                                      : std::array{ground.bed_at(0.5 * (box.low_m[0] + box.high_m[0])), 1e300};
      if (box.low_m[axis] > sides[0] + near && box.high_m[axis] < sides[1] - near)
        thin = std::min(thin, box.high_m[axis] - box.low_m[axis]);
    }
    if (thin < (1.0 - 1e-9) * layers * spacing)
      doubts.push_back({fmt::format("sea.obstacles[{}]", n), fmt::format("{:.4g} m thick, {:.2g} spacings", thin, thin / spacing),
                        fmt::format("{:g} spacings or more between water on both sides", layers),
                        "water feels water through it, or leaks; make it thicker or the spacing smaller"});
  }
}

/// Bodies beside the tank's walls, and the wavemaker: the stroke that is given against that of linear theory (Dean & Dalrymple
/// 1991, ch. 6), of a piston half the height of its wave in deep water.
void doubt_in_tank(scene::Doubts& doubts, const SeaOptions& sea, const WavesOptions& waves, const SeaEnvironment& e,
                   const BodiesInSea& bodies) {
  if (!sea.tank) return;
  constexpr double spacings = 2.0;
  for (const auto& [name, box] : bodies.boxes)
    for (const auto& [axis, sides, kind] :
         {std::tuple{0, sea.tank->x_m, &sea.tank->sides_x}, std::tuple{1, sea.tank->y_m, &sea.tank->sides_y}}) {
      const bool half = *kind == "symmetric";
      const double over = sides[1] - box.max()[axis], gap = half ? over : std::min(box.min()[axis] - sides[0], over);
      const double spacing = sea.particles->spacing_m;
      if (sea.particles->planar() || (*kind != "wall" && !half) || box.min().z() > 0.0 || gap < 0.0 || gap >= spacings * spacing)
        continue;
      doubts.push_back({"bodies." + name,
                        fmt::format("{:.3g} m from the tank's wall, {:.2g} spacings of the particles", gap, gap / spacing),
                        fmt::format("{:g} spacings at least", spacings), "take a wider tank: no particle fits between them"});
    }
  if (!sea.wavemaker || !sea.wavemaker->stroke_m || waves.height_m <= 0.0) return;
  const double stroke = *sea.wavemaker->stroke_m;
  const bool piston = sea.wavemaker->type == "piston" && waves.period_s > 0.0;
  const double height =  // of its waves, for a stroke of 1 m
      piston ? waves::piston_transfer(2.0 * pi * e.water_depth / wave_length(waves.period_s, e)) : 1.0;
  const double usual = waves.height_m / height, least = piston ? 0.3 : 0.05, most = piston ? 3.0 : 20.0;
  if (stroke < least * usual || stroke > most * usual)
    doubts.push_back({"sea.wavemaker.stroke_m",
                      fmt::format("{:.4g} m for waves {:.4g} m high{}", stroke, waves.height_m,
                                  piston ? fmt::format(", which take {:.3g} m by linear theory", usual) : ""),
                      fmt::format("{:g} to {:g} times {}", least, most, piston ? "that" : "the height"),
                      "look at its unit: m, from end to end"});
}

/// Waves that a body hardly feels: floats of turbines are up to 100 m wide, in waves of 10 m and more.
void doubt_ripples(scene::Doubts& doubts, double length, const WavesOptions& waves, const BodiesInSea& bodies) {
  constexpr double least = 0.05;
  for (const auto& [name, box] : bodies.boxes)
    if (const double size = box.sizes().head<2>().maxCoeff(); box.min().z() < 0.0 && length < least * size) {
      doubts.push_back(
          {"waves.period_s",
           fmt::format("{:.4g} s, waves {:.3g} m long, where body {} is {:.3g} m wide", waves.period_s, length, name, size),
           fmt::format("{:g} of its width or more", least),
           "look at its unit, s, and whether it is a frequency or that of a model"});
      return;
    }
}

/// Strips and cylinders that are long or wide beside the waves: both are to see one water each.
void doubt_strips(scene::Doubts& doubts, const SeaOptions& sea, double length, const BodiesInSea& bodies) {
  constexpr double share = 0.2;
  double longest = 0.0;  // strip of a member in the water
  const BodiesInSea::Member* widest = nullptr;
  for (const BodiesInSea::Member& m : bodies.members) {
    if (m.bottom() >= 0.0 || m.top() < -0.5 * length) continue;  // where no wave is
    longest = std::max(longest, std::min(sea.strip_length_m, (m.end - m.start).norm()));
    const bool scatters = std::ranges::any_of(
        sea.coefficients, [&](const CoefficientsOptions& c) { return c.cylinder == m.name && c.diffraction != "none"; });
    if (!scatters && (!widest || m.diameter > widest->diameter)) widest = &m;
  }
  if (longest > share * length)
    doubts.push_back({"sea.strip_length_m", fmt::format("strips of {:.4g} m under waves {:.4g} m long", longest, length),
                      "up to a fifth of the wave", "the strips do not see the wave; shorten them"});
  if (widest && widest->diameter > share * length)
    doubts.push_back(
        {"sea.coefficients",
         fmt::format("cylinder {}, {:.4g} m wide, is slender to waves {:.4g} m long", widest->name, widest->diameter, length),
         fmt::format("up to {:.3g} m, a fifth of the wave", share * length),
         "it scatters them, and Morison's inertia load is too large: diffraction = \"maccamy_fuchs\" of upright "
         "columns, else sea.model = \"potential\""});
}

/// Numbers of the particles that decide cost or damping.
void doubt_schemes(scene::Doubts& doubts, const ParticleOptions& p, const SeaEnvironment& e, const BodiesInSea& bodies) {
  constexpr double most = 60.0;
  if (const double slow = std::max(std::sqrt(e.gravity * e.water_depth), bodies.entry_speed);
      p.sound_speed_m_s && *p.sound_speed_m_s > most * slow)
    doubts.push_back({"sea.particles.sound_speed_m_s",
                      fmt::format("{:.4g} m/s where nothing is faster than {:.3g} m/s", *p.sound_speed_m_s, slow),
                      fmt::format("up to {:g} times that", most),
                      "the step goes with its inverse; water's own 1500 m/s are not needed, ten times what moves is enough"});
  constexpr double least = 5.0;  // water at the bed is then denser by 1 / 25
  if (const double deep = std::sqrt(e.gravity * e.water_depth); p.sound_speed_m_s && *p.sound_speed_m_s < least * deep)
    doubts.push_back({"sea.particles.sound_speed_m_s",
                      fmt::format("{:.4g} m/s in water where long waves travel at {:.3g} m/s", *p.sound_speed_m_s, deep),
                      fmt::format("{:g} times that or more; the default is ten times", least), "the water is compressible"});
  if (p.viscosity_model == sph::ViscosityChoice::artificial && p.viscosity > 0.5)
    doubts.push_back({"sea.particles.viscosity", fmt::format("{:.4g}", p.viscosity), "0.005 to 0.5 (Monaghan 1994: .01)",
                      "alpha of the artificial viscosity has no unit; much of it stops waves"});
}

}  // namespace

scene::Doubts sea_doubts(const SeaOptions& sea, const WavesOptions& waves, const SeaEnvironment& e, const BodiesInSea& bodies) {
  scene::Doubts doubts;
  if (sea.model == "none") return doubts;
  doubt_water(doubts, e);
  if (sea.model == "morison") doubt_coefficients(doubts, sea);
  double current = sea.current_m_s.norm();
  for (const auto& row : sea.current_profile)
    current = std::max(current, (sea.current_m_s + Eigen::Vector3d(row[1], row[2], 0.0)).norm());
  if (current > 5.0)
    doubts.push_back(
        {"sea.current_m_s", fmt::format("{:.4g} m/s", current), "up to 5 m/s", "look at its unit: m/s, not km/h or cm/s"});
  if (const double up = std::abs(sea.current_m_s.z()); up > 0.1 * std::max(1.0, sea.current_m_s.norm()))
    doubts.push_back({"sea.current_m_s", fmt::format("{:.4g} m/s upwards", sea.current_m_s.z()), "level: z is up",
                      "look at the order: x, y, z"});
  if (const auto& profile = sea.current_profile;
      !profile.empty() && std::ranges::all_of(profile, [](const auto& row) { return row[0] > 0.0; }))
    doubts.push_back({"sea.current_profile", fmt::format("rows from z = {:.4g} m on", profile.front()[0]),
                      "rows under water, z below zero", "look at their sign: up is positive, depths are negative"});
  const bool wavy = waves.model != "none" && waves.period_s > 0.0;
  if (wavy) doubt_ripples(doubts, wave_length(waves.period_s, e), waves, bodies);
  if (sea.model == "morison" && sea.strip_length_m < 0.01 * bodies.draft)
    doubts.push_back({"sea.strip_length_m", fmt::format("{:.4g} m along a draft of {:.4g} m", sea.strip_length_m, bodies.draft),
                      "a hundredth of the draft or more", "the cost goes with their number; look at its unit: m"});
  if (sea.model == "morison" && wavy) doubt_strips(doubts, sea, wave_length(waves.period_s, e), bodies);
  if (!sea.has_particles() || !sea.particles) return doubts;
  doubt_tank(doubts, sea, waves, e, bodies);
  doubt_boxes_of_water(doubts, sea, e);
  doubt_obstacles(doubts, sea, e);
  doubt_in_tank(doubts, sea, waves, e, bodies);
  if (const double rate = sea.initial ? sea.initial->settle_damping_1_s : 0.0, swing = std::sqrt(e.gravity / e.water_depth);
      rate > 30.0 * swing)
    doubts.push_back({"sea.initial.settle_damping_1_s", fmt::format("{:.4g} 1/s, {:.3g} of sqrt(g / depth)", rate, rate / swing),
                      "up to 30 times that", "it holds the water fast, which then cannot settle; look at its unit: 1/s"});
  doubt_schemes(doubts, *sea.particles, e, bodies);
  const double spacing = sea.particles->spacing_m;
  if (wavy && waves.height_m > 0.0 && waves.height_m < 0.5 * spacing)
    doubts.push_back({"sea.particles.spacing_m", fmt::format("{:.4g} m for waves {:.4g} m high", spacing, waves.height_m),
                      "below twice the height: a wave within half a particle is not there",
                      "take a tenth of the height to see it well"});
  if (bodies.draft > 0.0 && bodies.draft < 2.0 * spacing)
    doubts.push_back({"sea.particles.spacing_m", fmt::format("{:.4g} m for a draft of {:.4g} m", spacing, bodies.draft),
                      "below half the draft", "a body two particles deep does not float rightly; take a tenth of the draft"});
  const double least = sea.particles->kernel == sph::KernelChoice::quintic ? 1.4 : 1.1;
  if (const double ratio = sea.particles->smoothing_over_spacing; ratio < least || ratio > 3.0)
    doubts.push_back({"sea.particles.smoothing_over_spacing", fmt::format("{:.4g}", ratio), fmt::format("{:.4g} to 3", least),
                      ratio < least ? "too few neighbours for the sums of this kernel" : "the cost goes with its cube"});
  if (const auto& factor = sea.particles->sound_speed_factor; factor && (*factor < 8.0 || *factor > 60.0))
    doubts.push_back({"sea.particles.sound_speed_factor", fmt::format("{:.4g}", *factor),
                      "8 to 60: ten keeps density within one per cent (Monaghan 1994)",
                      *factor < 8.0 ? "the water is compressible" : "the step is needlessly small"});
  if (const auto& c = sea.particles->sound_speed_m_s; c && *c < 10.0 * bodies.entry_speed)
    doubts.push_back({"sea.particles.sound_speed_m_s",
                      fmt::format("{:.4g} m/s where a body meets the water at {:.3g} m/s", *c, bodies.entry_speed),
                      "ten times that speed or more; the default is twenty times",
                      "the water gives way as a spring: the body is stopped too hard"});
  return doubts;
}

std::vector<std::string> resolution_notes(const SeaOptions& sea, const WavesOptions& waves, double draft) {
  std::vector<std::string> notes;
  if (!sea.has_particles() || !sea.particles) return notes;
  // docs/user/choosing.md: a wave tank at five particles to the height is right within 1 %, floats by ten to the draft.
  constexpr double to_height = 4.0, to_draft = 5.0;
  const double spacing = sea.particles->spacing_m;
  const auto below = [](double n) { return std::floor(100.0 * n * (1.0 + 1e-12)) / 100.0; };  // 4.999 is no 5
  if (const double n = waves.height_m / spacing; waves.model != "none" && waves.height_m > 0.0 && n < to_height) {
    notes.push_back(fmt::format(
        "{:.3g} particles to the height of the waves, {:.4g} m: {}; sea.particles.spacing_m below {:.3g} m makes it {:g}",
        below(n), waves.height_m, n < 1.5 ? "too coarse to show them" : "their height errs by some per cent",
        waves.height_m / to_height, to_height));
    // docs/verification/sea.md: 8, 4 and 1.5 % at 0.75, 1.5 and 2.5 particles to the height, between walls 3.7 % at 3.2.
    if (sea.starts_in_waves() && !sea.led_to_waves())
      notes.push_back(
          fmt::format("waves left alone with {:.2g} particles to their height lose some {:.1g} % of it in each period, between "
                      "walls up to twice that; [[sea.damping_zones]] with towards = \"waves\" keep it",
                      n, 6.0 / n));
    // docs/verification/sea.md: .4 to .55 of their height at 2.4 particles to the significant height.
    if (waves.model == "jonswap" || waves.model == "pierson_moskowitz")
      notes.push_back(
          "of a sea state of so few particles waves at twice the peak's frequency lose half of their height within a wave "
          "length of the peak, those at the peak some per cent: compare spectra");
  }
  if (const double n = draft / spacing; draft > 0.0 && n < to_draft)
    notes.push_back(
        fmt::format("{:.3g} particles to the draft of {:.4g} m: its loads are rough; sea.particles.spacing_m below "
                    "{:.3g} m makes it {:g}",
                    below(n), draft, draft / to_draft, to_draft));
  return notes;
}

}  // namespace spindrift::sea
