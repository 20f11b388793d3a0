// One linear regular wave. SPDX-License-Identifier: Apache-2.0
#include "src/sea/wave_model.hpp"

namespace spindrift::sea {

extern const WaveModel airy{.name = "airy",
                            .help = "one linear regular wave",
                            .keys = {"height_m", "period_s", "phase_deg", "stretching"},
                            .regular = true,
                            .components = [](const WavesOptions& o, const SeaEnvironment& e) -> std::vector<waves::Component> {
                              return {airy_wave(o, e)};
                            }};

}  // namespace spindrift::sea
