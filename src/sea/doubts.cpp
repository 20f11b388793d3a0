// SPDX-License-Identifier: Apache-2.0
#include "src/sea/doubts.hpp"
#include "src/sea/wave_model.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kernels/base/constants.hpp"

namespace spindrift::sea {

double wave_length(double period_s, const SeaEnvironment& e) {
  const double deep = e.gravity * period_s * period_s / (2.0 * pi);
  double length = deep;
  for (int n = 0; n < 100; ++n) length = 0.5 * (length + deep * std::tanh(2.0 * pi * e.water_depth / length));
  return length;
}

scene::Doubts wave_doubts(const WavesOptions& w, const SeaEnvironment& e) {
  scene::Doubts doubts;
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
  if (w.height_m > 0.78 * e.water_depth)
    doubts.push_back({"waves.height_m", fmt::format("{:.4g} m in water {:.4g} m deep", w.height_m, e.water_depth),
                      "up to 0.78 of the depth (McCowan 1894)", "look at environment.water_depth_m"});
  if (w.height_m > 25.0)
    doubts.push_back({"waves.height_m", fmt::format("{:.4g} m", w.height_m), "up to 25 m at sea",
                      "look at its unit: metres, crest to trough"});
  if (w.period_s > 30.0)
    doubts.push_back({"waves.period_s", fmt::format("{:.4g} s", w.period_s), "up to 30 s: longer ones are tides and surges",
                      "look at its unit: seconds, not a frequency"});
  if (model.second_order) {
    // Ursell number of second order's range: beyond 26 its second harmonic is no longer small (Hedges 1995).
    const double ursell = w.height_m * length * length / std::pow(e.water_depth, 3);
    if (ursell > 40.0)
      doubts.push_back({"waves.model", fmt::format("{} with an Ursell number of {:.3g}", w.model, ursell),
                        "below 40 (Hedges 1995)", "the wave is too long for this depth; look at environment.water_depth_m"});
  }
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

void doubt_coefficients(scene::Doubts& doubts, const SeaOptions& sea) {
  for (const auto& [key, value, bound] : {std::tuple{"sea.drag_coefficient", sea.drag_coefficient, 3.0},
                                          std::tuple{"sea.added_mass_coefficient", sea.added_mass_coefficient, 3.0},
                                          std::tuple{"sea.axial_drag_coefficient", sea.axial_drag_coefficient, 12.0},
                                          std::tuple{"sea.axial_added_mass_coefficient", sea.axial_added_mass_coefficient, 12.0}})
    if (value > bound)
      doubts.push_back({key, fmt::format("{:.4g}", value), fmt::format("up to {:.4g} (DNV-RP-C205)", bound),
                        "coefficients have no unit; look at the point"});
}

}  // namespace

scene::Doubts sea_doubts(const SeaOptions& sea, const WavesOptions& waves, const SeaEnvironment& e, const BodiesInSea& bodies) {
  scene::Doubts doubts;
  if (sea.model == "none") return doubts;
  doubt_water(doubts, e);
  if (sea.model == "morison") doubt_coefficients(doubts, sea);
  if (const double current = sea.current_m_s.norm(); current > 5.0)
    doubts.push_back(
        {"sea.current_m_s", fmt::format("{:.4g} m/s", current), "up to 5 m/s", "look at its unit: m/s, not km/h or cm/s"});
  const bool wavy = waves.model != "none" && waves.period_s > 0.0;
  if (sea.model == "morison" && wavy) {
    const double length = wave_length(waves.period_s, e);
    if (sea.strip_length_m > length / 5.0)
      doubts.push_back({"sea.strip_length_m", fmt::format("{:.4g} m under waves {:.4g} m long", sea.strip_length_m, length),
                        "up to a fifth of the wave", "the strips do not see the wave; shorten them"});
  }
  if (!sea.has_particles() || !sea.particles) return doubts;
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

}  // namespace spindrift::sea
