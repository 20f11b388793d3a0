// One regular wave with its bound second harmonic: kernels/waves/stokes.hpp. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "kernels/waves/dispersion.hpp"
#include "kernels/waves/stokes.hpp"
#include "src/sea/wave_field.hpp"
#include "src/sea/wave_model.hpp"

namespace spindrift::sea {

extern const WaveModel stokes2{
    .name = "stokes2",
    .help = "one regular wave to second order in steepness",
    .keys = {"height_m", "period_s", "phase_deg"},
    .regular = true,
    .second_order = true,
    .nonlinear = true,
    .components = [](const WavesOptions& o, const SeaEnvironment& e) -> std::vector<waves::Component> {
      const waves::Component first = airy_wave(o, e);
      return {first, waves::stokes_second(first, e.water_depth)};
    },
    .check =
        [](const WavesOptions& o, const SeaEnvironment& e, std::vector<OptionProblem>& problems) {
          const auto wave = waves::wave_properties(o.period_s, e.water_depth, e.gravity);
          const double ratio = waves::stokes_ratio(o.height_m, wave.wave_number, e.water_depth);
          constexpr double most = 0.25;
          if (ratio > most)
            problems.push_back({"waves.model", fmt::format("stokes2 fails for this wave: its second harmonic is {:.3g} of the "
                                                           "first (limit {:.3g}, a second crest in the trough); use a lower or "
                                                           "shorter wave, or without particles \"stream_function\"",
                                                           ratio, most)});
        }};

}  // namespace spindrift::sea
