// Columns of history.csv of the air alone, and how a row of the march fills them. Used by flow_simulation.cpp; tested in
// tests/coupled/flow_run_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "src/aero/actuator.hpp"
#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/flow_options.hpp"
#include "src/aero/grid_motion.hpp"
#include "src/aero/resolved_rotor.hpp"
#include "src/coupling/columns.hpp"

namespace spindrift::run {

/// Force over dynamic pressure and reference area.
struct Coefficients {
  double lift, drag;
};

/// Angle of the walls that move [deg], their shift [m].
struct WallMotion {
  double pitch_deg;
  Eigen::Vector3d shift;
};

/// Of a window whose error in time is held to a tolerance.
struct TimeSteps {
  double error = 0.0;  ///< the largest of its steps; 0 where none could be estimated
  int count = 1;
};

class FlowColumns {
 public:
  /// Declares them. `rotor`, `actuator`, `motion`: null where the scene has none; they outlive the columns.
  FlowColumns(io::History& history, const aero::ResolvedRotor* rotor, const aero::Actuator* actuator,
              const aero::GridMotion* motion, const aero::FlowSetting& setting);
  /// `wind`: undisturbed [m/s]; `time` [s]; `unconverged`: windows so far.
  void fill(std::span<double> row, double time, const aero::FlowSetting& setting, const aero::PseudoRow& p,
            const aero::FlowOptions& options, const Eigen::Vector3d& wind, long unconverged, const TimeSteps& steps) const;

 private:
  template <class Source>
  using Group = io::ColumnGroup<Source>;

  const aero::ResolvedRotor* rotor_;
  const aero::Actuator* actuator_;
  const aero::GridMotion* motion_;
  std::optional<Group<coupling::RotorRow>> rotor_columns_;
  std::vector<Group<aero::RotorLoad>> blades_;
  std::optional<Group<WallMotion>> motion_columns_;
  std::optional<Group<Coefficients>> coefficients_;
  Group<aero::PseudoRow> march_;
  Group<aero::MassBalance> mass_;
  std::optional<Group<double>> unsteady_;
  std::optional<Group<TimeSteps>> time_steps_;
};

/// Of every scene: those of a floating system and of the air alone. For pages.
std::vector<io::ColumnSection> all_columns();

}  // namespace spindrift::run
