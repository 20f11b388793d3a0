// One steady regular wave of any height: kernels/waves/stream_function.hpp. SPDX-License-Identifier: Apache-2.0
#include "kernels/waves/stream_function.hpp"

#include "src/sea/wave_field.hpp"
#include "src/sea/wave_model.hpp"

namespace spindrift::sea {

namespace {

std::vector<waves::Component> steady_wave(const WavesOptions& o, const SeaEnvironment& e) {
  return waves::stream_function_components(o.height_m, o.period_s, e.water_depth, e.gravity, o.phase, o.direction);
}

}  // namespace

extern const WaveModel stream_function{
    .name = "stream_function",
    .help = "one regular wave of any height, by a Fourier series of the stream function",
    .keys = {"height_m", "period_s", "phase_deg"},
    .regular = true,
    .nonlinear = true,
    .components = steady_wave,
    .check = [](const WavesOptions& o, const SeaEnvironment& e, std::vector<OptionProblem>& problems) {
      if (steady_wave(o, e).empty())
        problems.push_back({"waves.height_m",
                            "belongs to no steady wave of this period and depth that 48 harmonics can hold: "
                            "it is at or beyond the highest; use a lower wave"});
    }};

}  // namespace spindrift::sea
