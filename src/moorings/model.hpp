// The models of mooring lines that a scene may choose from. Each is a file, line_NAME.cpp, and a line in models.inc. The file
// has the model's name, what the reference says of it, the keys of [moorings.NAME] that it reads, and the line it makes of them;
// the line names its variable. The physics is in kernels/mooring. Used by moorings.cpp, options.cpp and doubts.cpp; tested in
// tests/src/moorings. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/mooring/line.hpp"
#include "kernels/mooring/line_lumped_mass.hpp"
#include "src/moorings/options.hpp"
#include "src/scene/models.hpp"

namespace spindrift::moorings {

/// What surrounds dynamic lines.
struct LineEnvironment {
  double gravity_m_s2 = 9.80665, water_density_kg_m3 = 1025.0;
  std::function<LineWater(double t, const Eigen::Vector3d& point)> water = StillWater{};
  std::shared_ptr<const Bed> bed{};  ///< null: flat, at the level of each line's lower end
};

/// Where a line becomes stiff at once, and how stiff it is then.
struct TautLine {
  double chord_m = 0.0;  ///< distance of the ends from which on it counts as taut
  double stiffness_N_m = 0.0, damping_N_s_m = 0.0;
};
/// Of a line that sags: from where its sag gives a hundredth of the stiffness that it has when it is straight.
TautLine taut_from_sag(double length_m, double weight_N, double stiffness_N_m);

/// A line without a state: forces on both ends from where they are.
class StaticLine {
 public:
  virtual ~StaticLine() = default;
  /// `span` = fairlead - anchor [m], `rate` = its time derivative [m/s].
  virtual LineForces forces(const Eigen::Vector3d& span, const Eigen::Vector3d& rate) const = 0;
  /// Nothing for a line that never snaps: steps of the bodies do not look out for it.
  virtual std::optional<TautLine> taut() const { return std::nullopt; }
};

/// Of a line of kernels/mooring.
template <MooringLine L>
std::unique_ptr<const StaticLine> static_line(L line, std::optional<TautLine> taut = {}) {
  class Of final : public StaticLine {
   public:
    Of(L l, std::optional<TautLine> taut) : line_(std::move(l)), taut_(taut) {}
    LineForces forces(const Eigen::Vector3d& span, const Eigen::Vector3d& rate) const override {
      return line_.forces(span, rate);
    }
    std::optional<TautLine> taut() const override { return taut_; }

   private:
    L line_;
    std::optional<TautLine> taut_;
  };
  return std::make_unique<Of>(std::move(line), taut);
}

struct LineModel {
  std::string_view name, help;
  std::vector<std::string> keys;  ///< that it reads, besides model and ends; any other is refused
  bool hangs = false;             ///< has weight: it sags, and may lie on the bed
  /// The options have been checked. Of a dynamic model: its statics, for starts and linearisation.
  std::unique_ptr<const StaticLine> (*make)(const LineOptions&, const LineEnvironment&) = nullptr;
  /// Of a model with a state of its own.
  LineLumpedMass (*make_dynamic)(const LineOptions&, const LineEnvironment&) = nullptr;
};

scene::Models<LineModel> line_models();

}  // namespace spindrift::moorings
