// A fully developed sea: the spectrum of JONSWAP without its peak's enhancement. SPDX-License-Identifier: Apache-2.0
#include "src/sea/wave_model.hpp"

namespace spindrift::sea {

extern const WaveModel pierson_moskowitz{
    .name = "pierson_moskowitz",
    .help = "irregular, fully developed sea",
    .keys = {"height_m", "period_s", "stretching", "seed", "components", "spacing", "second_order", "spreading_exponent",
             "crest_height_m"},
    .components = [](const WavesOptions& o, const SeaEnvironment& e) { return random_sea(o, e, 1.0); }};

}  // namespace spindrift::sea
