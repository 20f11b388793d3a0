// Doubts about waves, water and its resolution. Called by src/coupling/doubts.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "src/scene/doubt.hpp"
#include "src/sea/options.hpp"

namespace spindrift::sea {

scene::Doubts wave_doubts(const WavesOptions& waves, const SeaEnvironment& environment);
/// What the bodies are to the sea: their draft [m], 0 where none floats, the speed at which they meet it [m/s], boxes round
/// those that have shapes, earth axes, and their cylinders.
struct BodiesInSea {
  double draft = 0.0, entry_speed = 0.0;
  std::vector<std::pair<std::string, Eigen::AlignedBox3d>> boxes{};
  /// Cylinders as the scene describes them, initial earth coordinates [m].
  struct Member {
    std::string name;
    double diameter;
    Eigen::Vector3d start, end;
    double top() const { return std::max(start.z(), end.z()); }
    double bottom() const { return std::min(start.z(), end.z()); }
  };
  std::vector<Member> members{};
};
scene::Doubts sea_doubts(const SeaOptions& sea, const WavesOptions& waves, const SeaEnvironment& environment,
                         const BodiesInSea& bodies);

/// Waves and drafts of few particles: what they come to in such a run, and which spacing would do. `draft` 0: nothing floats.
std::vector<std::string> resolution_notes(const SeaOptions& sea, const WavesOptions& waves, double draft);

/// Length of a linear wave [m].
double wave_length(double period_s, const SeaEnvironment& environment);

}  // namespace spindrift::sea
