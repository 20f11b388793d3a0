// The list of kinds of waves, and what several of them are made of: see wave_model.hpp. SPDX-License-Identifier: Apache-2.0
#include <array>

#include "kernels/base/constants.hpp"
#include "kernels/waves/dispersion.hpp"
#include "kernels/waves/realisation.hpp"
#include "src/sea/wave_model.hpp"

namespace spindrift::sea {

#define MODEL(name) extern const WaveModel name;
#include "src/sea/wave_models.inc"
#undef MODEL

namespace {

#define MODEL(name) &name,
const std::array models{
#include "src/sea/wave_models.inc"
};
#undef MODEL

}  // namespace

scene::Models<WaveModel> wave_models() { return scene::Models<WaveModel>(models); }

waves::Component airy_wave(const WavesOptions& options, const SeaEnvironment& environment) {
  const double omega = 2.0 * pi / options.period_s, amplitude = 0.5 * options.height_m;
  return {.wave_number = waves::wave_number(omega, environment.water_depth, environment.gravity),
          .angular_frequency = omega,
          .amplitude = amplitude,
          .speed_amplitude = amplitude * omega,
          .phase = options.phase,
          .direction = options.direction};
}

std::vector<waves::Component> random_sea(const WavesOptions& options, const SeaEnvironment& environment,
                                         double peak_enhancement) {
  const waves::SeaState sea{options.height_m, options.period_s, peak_enhancement};
  std::vector<waves::Component> components(std::size_t(options.components));
  if (options.spacing == "equal_energy")
    waves::equal_energy(sea, components);
  else
    waves::equal_frequency(sea, components);
  waves::finish_realisation(sea, std::uint64_t(options.seed), options.direction, environment.water_depth, environment.gravity,
                            components);
  return components;
}

}  // namespace spindrift::sea
