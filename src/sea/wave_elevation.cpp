// A measured sea, or one of another program: harmonics of an elevation in time. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "kernels/base/constants.hpp"
#include "kernels/waves/dispersion.hpp"
#include "src/scene/columns.hpp"
#include "src/scene/error.hpp"
#include "src/sea/wave_field.hpp"
#include "src/sea/wave_model.hpp"

namespace spindrift::sea {

namespace {

/// Harmonics of the record, which begins again where it ends. Travels in one direction; linear.
std::vector<waves::Component> measured_sea(const WavesOptions& o, const SeaEnvironment& e) {
  const scene::Columns table = scene::read_columns(o.file);
  table.allow_only({"time_s", "elevation_m"});
  table.require_rows(16);
  table.require_increasing("time_s", "time");
  const auto time = table["time_s"], eta = table["elevation_m"];
  const std::size_t n = eta.size();
  const double step = (time[n - 1] - time[0]) / double(n - 1);
  for (std::size_t i = 1; i < n; ++i)
    if (std::abs(time[i] - time[0] - double(i) * step) > 1e-3 * step)
      table.fail(int(i), fmt::format("time_s = {} is not at equal steps of {:.6g} s", time[i], step));
  double mean = 0.0, variance = 0.0;
  for (const double x : eta) mean += x / double(n);
  for (const double x : eta) variance += (x - mean) * (x - mean) / double(n);
  if (!(variance > 0.0)) table.fail(0, "the elevation never changes");
  if (std::abs(mean) > 0.05 * std::sqrt(variance))
    table.fail(0, fmt::format("the elevation's mean is {:.4g} m, its deviation {:.4g} m: elevations count from still water", mean,
                              std::sqrt(variance)));
  const double lowest = 2.0 * pi / (double(n) * step);
  std::vector<waves::Component> components;
  double energy = 0.0;
  for (std::size_t j = 1; 2 * j < n; ++j) {
    const double omega = double(j) * lowest;
    if (o.highest_Hz && omega > 2.0 * pi * *o.highest_Hz) break;
    if (!o.highest_Hz && energy > 0.999 * variance) break;
    // By the rotation's recurrence, afresh now and then so that its round-off stays small.
    double cosine = 0.0, sine = 0.0, c = 1.0, s = 0.0;
    const double angle = 2.0 * pi * double(j) / double(n), c1 = std::cos(angle), s1 = std::sin(angle);
    for (std::size_t i = 0; i < n; ++i) {
      if (i % 256 == 0) c = std::cos(angle * double(i)), s = std::sin(angle * double(i));
      cosine += (eta[i] - mean) * c, sine += (eta[i] - mean) * s;
      const double next = c * c1 - s * s1;
      s = s * c1 + c * s1, c = next;
    }
    const double amplitude = 2.0 / double(n) * std::hypot(cosine, sine);
    energy += 0.5 * amplitude * amplitude;
    if (amplitude == 0.0) continue;
    components.push_back({.wave_number = waves::wave_number(omega, e.water_depth, e.gravity),
                          .angular_frequency = omega,
                          .amplitude = amplitude,
                          .speed_amplitude = amplitude * omega,
                          .phase = std::fmod(std::atan2(sine, cosine) + omega * time[0], 2.0 * pi),
                          .direction = o.direction});
  }
  if (components.empty())
    table.fail(0, fmt::format("the record of {:.6g} s has no wave below waves.highest_Hz = {:.6g}", double(n) * step,
                              o.highest_Hz.value_or(0.0)));
  return components;
}

}  // namespace

extern const WaveModel elevation{
    .name = "elevation",
    .help = "the elevation of a file at the origin, as linear waves; it repeats where the file ends",
    .keys = {"file", "highest_Hz", "stretching", "spreading_exponent", "seed"},
    .components = measured_sea,
    .check = [](const WavesOptions& o, const SeaEnvironment& e, std::vector<OptionProblem>& problems) {
      try {
        measured_sea(o, e);
      } catch (const scene::SceneError& error) { problems.push_back({"waves.file", error.what()}); }
    }};

}  // namespace spindrift::sea
