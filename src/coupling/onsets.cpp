// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/onsets.hpp"

#include <algorithm>
#include <cmath>

#include "src/bodies/linearise.hpp"

namespace spindrift::coupling {

namespace {

/// Of the ends towards each other [1/kg]: the largest of the line's own direction and, as it may turn before it snaps, of the
/// axes.
double largest_mobility(FloatingSystem& floating, const bodies::BodiesState& state, const moorings::Moorings::Chord& chord) {
  double most = 0.0;
  for (const Eigen::Vector3d& along :
       {Eigen::Vector3d((chord.fairlead - chord.anchor).stableNormalized()), Eigen::Vector3d(Eigen::Vector3d::UnitX()),
        Eigen::Vector3d(Eigen::Vector3d::UnitY()), Eigen::Vector3d(Eigen::Vector3d::UnitZ())}) {
    std::vector<bodies::Pull> pulls;
    if (chord.body) pulls.push_back({*chord.body, chord.fairlead, along});
    if (chord.anchor_body) pulls.push_back({*chord.anchor_body, chord.anchor, -along});
    most = std::max(most, bodies::mobility(floating.multibody(), state, pulls));
  }
  return most;
}

}  // namespace

std::vector<bodies::Onset> line_onsets(FloatingSystem& floating, const bodies::BodiesState& state) {
  std::vector<bodies::Onset> onsets;
  if (!floating.moorings() || state.motions.empty()) return onsets;
  const moorings::Moorings& lines = *floating.moorings();
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const std::optional<moorings::TautLine> taut = lines.taut(l);
    if (!taut) continue;
    const double mobility = largest_mobility(floating, state, lines.chord(l, state.motions));
    const double rate = std::max(std::sqrt(taut->stiffness_N_m * mobility), taut->damping_N_s_m * mobility);
    if (rate == 0.0) continue;  // its ends cannot move
    bodies::Onset onset{lines.name(l),
                        [&lines, l, length = taut->chord_m](std::span<const Motion> motions) {
                          const moorings::Moorings::Chord now = lines.chord(l, motions);
                          return (now.fairlead - now.anchor).squaredNorm() > length * length;
                        },
                        rate};
    onset.from_start = onset.acts(state.motions);
    onsets.push_back(std::move(onset));
  }
  return onsets;
}

}  // namespace spindrift::coupling
