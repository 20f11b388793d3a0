// Columns of history.csv of the air alone, and how a row of the march fills them. Used by flow_simulation.cpp; tested in
// tests/coupled/flow_run_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/flow_options.hpp"
#include "src/aero/grid_motion.hpp"
#include "src/aero/resolved_rotor.hpp"
#include "src/io/history.hpp"

namespace spindrift::run {

class FlowColumns {
 public:
  /// Declares them. `rotor`, `motion`: null where the scene has none; they outlive the columns.
  FlowColumns(io::History& history, const aero::ResolvedRotor* rotor, const aero::GridMotion* motion, bool steady);
  /// `wind`: undisturbed [m/s]; `time` [s]; `unconverged`: windows so far.
  void fill(std::span<double> row, double time, const aero::FlowSetting& setting, const aero::PseudoRow& p,
            const aero::FlowOptions& options, const Eigen::Vector3d& wind, long unconverged) const;

 private:
  void add_rotor(io::History& history);
  void fill_rotor(std::span<double> row, const aero::PseudoRow& p) const;
  void add_motion(io::History& history);
  void fill_motion(std::span<double> row, double time) const;

  const aero::ResolvedRotor* rotor_;
  const aero::GridMotion* motion_;
  const bool steady_;
  std::size_t force_[3], lift_ = 0, drag_ = 0, residual_, momentum_, model_, cfl_, krylov_, steps_, fraction_, balance_,
                         unconverged_ = 0;
  std::size_t pitch_ = 0, heave_[3] = {0, 0, 0};
  std::size_t thrust_ = 0, torque_ = 0, power_ = 0, azimuth_ = 0, rpm_ = 0;
  std::vector<std::array<std::size_t, 2>> blades_;  ///< thrust and torque
};

}  // namespace spindrift::run
