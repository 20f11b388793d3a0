// The undisturbed sea: elevation, slope and water kinematics anywhere under it, for every [waves] model.
// Owns the harmonics of kernels/waves/components.hpp; applies the ramp and the stretching rule (docs/theory/waves.md, section 4).
// Used by EngineeringSea and, for output, by the coupling; tested in tests/src/sea/wave_field_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kernels/waves/bound_waves.hpp"
#include "kernels/waves/components.hpp"
#include "kernels/waves/dispersion.hpp"
#include "src/sea/options.hpp"

namespace spindrift::sea {

class WaveField {
 public:
  WaveField() = default;  ///< still water
  WaveField(const WavesOptions& options, const SeaEnvironment& environment);

  bool still() const { return groups_.empty(); }
  /// Level and slope of the surface at earth x, y [m].
  waves::Surface surface(double t, double x, double y) const;
  double elevation(double t, double x, double y) const { return surface(t, x, y).elevation; }
  /// Water motion at an earth point that lies under the surface, whose level there is `elevation` [m].
  waves::Kinematics kinematics(double t, const Eigen::Vector3d& point, double elevation) const {
    return bound_.empty() ? kinematics(t, point, elevation, groups_) : second_order(t, point, elevation);
  }
  /// Of such groups, to first order.
  waves::Kinematics kinematics(double t, const Eigen::Vector3d& point, double elevation,
                               std::span<const waves::ComponentGroup> groups) const;
  /// These waves with the inertia that MacCamy and Fuchs have on an upright column of this radius [m]: the acceleration of such
  /// groups, times the mass of the water displaced, is its inertia load.
  std::vector<waves::ComponentGroup> scattered(double radius) const;

  /// Of the waves to first order, but for a Stokes wave and a stream function.
  const std::vector<waves::Component>& components() const { return components_; }
  /// Share of the waves that has grown by then.
  double ramp(double t) const;

 private:
  waves::Kinematics second_order(double t, const Eigen::Vector3d& point, double elevation) const;

  enum class Stretching { wheeler, vertical, extrapolated };

  std::vector<waves::Component> components_;
  std::vector<waves::ComponentGroup> groups_;
  waves::BoundWaves bound_;  ///< empty to first order
  double depth_ = 0.0, ramp_end_ = 0.0;
  Stretching stretching_ = Stretching::wheeler;
};

/// Frequency up to which harmonics of a sea of this height carry bound waves [rad/s]: sqrt(2 g / Hs), where the expansion ends,
/// after Stansberg (1998) as DNV-RP-C205 has it.
double bound_wave_limit(double significant_height, double gravity);

/// What is wrong with a wave of these options in this water, one sentence each with its key; empty when nothing is.
struct OptionProblem {
  std::string key, what;
  std::string follows_from = {};  ///< as scene::Problem has it
};
std::vector<OptionProblem> wave_problems(const WavesOptions& options, const SeaEnvironment& environment);

}  // namespace spindrift::sea
