// SPDX-License-Identifier: Apache-2.0
#include "src/aero/line_wakes.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/rotor/actuator_line.hpp"

namespace spindrift::aero {

namespace {

/// Quarter of a chord: the width at which a line stands for a lifting surface (Martinez-Tossas & Meneveau 2019, section 4).
constexpr double lifting_width_chords = 0.25;

}  // namespace

LineWakes::LineWakes(const BladeElementMomentum& sections, std::span<const double> width, int blades)
    : width_(width.begin(), width.end()), tip_radius_(sections.tip_radius()), blades_(blades) {
  for (std::size_t e = 0; e < sections.elements(); ++e) sections_.push_back(sections.section(e));
}

const LineWakes::Matrix& LineWakes::of_level(int level) {
  const auto found = made_.find(level);
  if (found != made_.end()) return found->second;
  const std::size_t n = sections_.size();
  std::vector<double> edge(n + 1), width(n + 1);
  for (std::size_t e = 0; e <= n; ++e) {
    const BladeElementMomentum::BladeSection& s = sections_[std::min(e, n - 1)];
    edge[e] = s.radius + (e < n ? -0.5 : 0.5) * s.length * s.normal_axial;
    width[e] = 0.5 * (width_[e > 0 ? e - 1 : 0] + width_[std::min(e, n - 1)]);
  }
  const HelicalWake helix{step * level, tip_radius_};
  Matrix& m = made_[level];
  std::vector<TrailedVelocity> of_edge(n + 1);
  for (int later = 0; later < blades_; ++later)
    for (std::size_t at = 0; at < n; ++at) {
      const BladeElementMomentum::BladeSection& s = sections_[at];
      for (std::size_t e = 0; e <= n; ++e)
        of_edge[e] = missing_velocity(s.radius, edge[e], 2.0 * pi * later / blades_, helix, lifting_width_chords * s.chord,
                                      joint_width(width_[at], width[e]));
      // Bound circulation runs outward and leaves downstream at the outer edge; what comes in at the inner one leaves there less.
      for (std::size_t of = 0; of < n; ++of) {
        m.normal.push_back(of_edge[of + 1].axial - of_edge[of].axial);
        m.tangential.push_back(of_edge[of].ahead - of_edge[of + 1].ahead);
      }
    }
  return m;
}

LineWakes::Matrix LineWakes::at(double angle) {
  const int level = int(std::floor(angle / step));
  const double s = angle / step - level;
  const Matrix &low = of_level(level), &high = of_level(level + 1);
  Matrix m = low;
  for (std::size_t k = 0; k < m.normal.size(); ++k) {
    m.normal[k] += s * (high.normal[k] - low.normal[k]);
    m.tangential[k] += s * (high.tangential[k] - low.tangential[k]);
  }
  return m;
}

}  // namespace spindrift::aero
