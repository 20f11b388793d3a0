// A growing sea with a narrow peak: kernels/waves/spectra.hpp. SPDX-License-Identifier: Apache-2.0
#include "kernels/waves/spectra.hpp"
#include "src/sea/wave_model.hpp"

namespace spindrift::sea {

extern const WaveModel jonswap{.name = "jonswap",
                               .help = "irregular, growing sea with a narrow peak",
                               .keys = {"height_m", "period_s", "stretching", "seed", "components", "spacing", "second_order",
                                        "peak_enhancement", "spreading_exponent", "crest_height_m"},
                               .components = [](const WavesOptions& o, const SeaEnvironment& e) {
                                 return random_sea(o, e,
                                                   o.peak_enhancement.value_or(waves::peak_enhancement(o.height_m, o.period_s)));
                               }};

}  // namespace spindrift::sea
