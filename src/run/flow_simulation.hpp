// The air alone, as the driver runs it: a scene whose aero.model is "blade_resolved" and that has no bodies: a rotor, wings,
// plates or cylinders in the wind. Steady scenes have a row of history per pseudo-step (a window is one), unsteady ones a row per
// window. Used by driver.cpp; tested in tests/coupled/flow_run_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>

#include "src/coupling/air_file.hpp"
#include "src/run/flow_case.hpp"
#include "src/run/flow_columns.hpp"
#include "src/run/simulation.hpp"

namespace spindrift::run {

class FlowSimulation final : public Simulation {
 public:
  /// `records`: of the trace, per thread; `chunk`: pseudo-steps of a steady flow in an advance(). All outlive it. Collective.
  FlowSimulation(const coupling::Scenario& scenario, const io::RunDirectory& directory, const runtime::World& world,
                 std::size_t records, int chunk = FlowCase::steady_chunk);

  const coupling::Scenario& scenario() const override { return scenario_; }
  const coupling::Timeline& timeline() const override { return timeline_; }
  bool counts_pseudo_steps() const override { return air_.steady(); }
  std::int64_t file_number(std::int64_t window) const override { return window; }

  std::int64_t begin(const io::RunDirectory& directory) override;
  void restore(const io::CheckpointReader& file) override;
  std::string settled() const override { return settled_; }
  void nothing_left() override;
  void save(io::CheckpointCopy& copy) override;
  Advance advance(std::int64_t window, std::int64_t last) override;
  coupling::OutputTask& output() override { return output_; }
  std::string failure_at_end() const override;
  std::string done() const override;

  void declare(io::History& history) override;
  bool has_first_row() const override { return false; }  // rows are of pseudo-steps
  void fill_row(std::int64_t window, std::span<double> row) override;
  std::vector<std::unique_ptr<Output>> outputs(const io::RunDirectory& directory, double resume_s) override;

  void summarise(io::Summary& summary, runtime::Ledger& ledger) override;

  const aero::FlowSolver& solver() const { return air_.solver(); }

 private:
  bool begin_again(const std::string& why);
  std::string unconverged_windows(std::int64_t window) const;
  std::string too_many_unconverged() const;
  void use(const std::string& preconditioner, const std::string& reason);
  void record();
  std::size_t averaged(std::int64_t windows) const;
  bool made_window(std::int64_t window);
  bool holds_tolerance(std::int64_t window);
  void count_limits(std::span<const aero::PseudoRow> rows);
  void write_at_end(std::int64_t window);

  const coupling::Scenario& scenario_;
  const io::RunDirectory& directory_;
  const runtime::World& world_;
  const std::size_t records_;
  coupling::Timeline timeline_;
  FlowCase air_;
  coupling::AirFile file_;
  std::string settled_;  ///< why, where the last advance() or the run before came to that
  std::string chosen_;   ///< what preconditioner = "auto" became
  coupling::OutputTask output_;
  std::optional<runtime::Executor> march_;
  std::optional<FlowColumns> columns_;
  std::vector<aero::PseudoRow> rows_;  ///< of the windows that the last advance() completed
  std::int64_t rows_from_ = 0;         ///< the window before them
  std::deque<aero::PseudoRow> last_rows_;
  std::int64_t windows_ = 0;                ///< completed by this process
  std::vector<std::string> doubts_;         ///< of the flow at the end, said in the log
  aero::UpdateLimits limits_;               ///< of the pseudo-steps of this process
  std::optional<aero::WindowSteps> steps_;  ///< where the error in time has a tolerance
  TimeSteps window_;                        ///< of the last one
  int pseudo_steps_ = 0;                    ///< that it took
  long above_tolerance_ = 0;                ///< windows of this process
};

}  // namespace spindrift::run
