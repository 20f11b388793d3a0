// The kinds of waves that a scene may choose from. Each is a file, wave_NAME.cpp, and a line in wave_models.inc. The file
// has its name, what the reference says of it, the keys of [waves] that it reads, and the harmonics that it is made of; the line
// names its variable. Used by wave_field.cpp, options.cpp, problems.cpp and doubts.cpp; tested in tests/src/sea.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kernels/waves/components.hpp"
#include "src/scene/models.hpp"
#include "src/sea/options.hpp"

namespace spindrift::sea {

struct OptionProblem;

struct WaveModel {
  std::string_view name, help;
  std::vector<std::string> keys;  ///< that it reads besides model, direction_deg and ramp_s
  bool regular = false;           ///< one wave, which repeats after its period; else a sea state
  bool second_order = false;      ///< in steepness: its harmonics are a free and a bound one
  bool nonlinear = false;         ///< holds up to the crest, without stretching
  /// Harmonics at full height; bound ones included.
  std::vector<waves::Component> (*components)(const WavesOptions&, const SeaEnvironment&) = nullptr;
  /// What is wrong with such a wave in this water beyond breaking; null where nothing can be.
  void (*check)(const WavesOptions&, const SeaEnvironment&, std::vector<OptionProblem>&) = nullptr;
};

/// "none" is not among them.
scene::Models<WaveModel> wave_models();

/// The linear regular wave of height, period, direction and phase.
waves::Component airy_wave(const WavesOptions& options, const SeaEnvironment& environment);
/// A sea of random phases with the JONSWAP spectrum of this peak enhancement (1: Pierson-Moskowitz).
std::vector<waves::Component> random_sea(const WavesOptions& options, const SeaEnvironment& environment, double peak_enhancement);

}  // namespace spindrift::sea
