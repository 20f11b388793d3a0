// A floating system as the driver runs it: bodies, moorings, sea and rotor in windows (src/coupling/window.hpp), whatever of them
// the scene has. Used by driver.cpp; tested through tests/coupled. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "runtime/mpi/parts.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/recorder.hpp"
#include "src/coupling/saved_start.hpp"
#include "src/coupling/window.hpp"
#include "src/run/simulation.hpp"

namespace spindrift::run {

/// What moves; the rest stands by, for measurements of one side alone.
enum class Moves { both, air, sea };

class SystemSimulation final : public Simulation {
 public:
  /// `start`: of the bodies at t = 0. `records`: of the trace, per thread. The floating system and parts outlive it. Collective.
  SystemSimulation(coupling::FloatingSystem& floating, bodies::BodiesState start, const runtime::Parts& parts,
                   std::size_t records, Moves moves = Moves::both);

  const coupling::Scenario& scenario() const override { return floating_.scenario(); }
  const coupling::Timeline& timeline() const override { return floating_.timeline(); }
  std::int64_t file_number(std::int64_t window) const override;

  std::int64_t begin(const io::RunDirectory& directory) override;
  void restore(const io::CheckpointReader& file) override;
  void nothing_left() override { window_.sides().air().fill_gradients(); }
  void save(io::CheckpointCopy& copy) override;
  Advance advance(std::int64_t window, std::int64_t last) override;
  coupling::OutputTask& output() override { return window_.sides().output(); }

  void declare(io::History& history) override;
  bool has_rows() const override;
  void fill_row(std::int64_t window, std::span<double> row) override;
  std::vector<std::unique_ptr<Output>> outputs(const io::RunDirectory& directory, double resume_s) override;

  std::string failure_at_end() const override { return window_.sides().air().failure_at_end(); }
  void summarise(io::Summary& summary, runtime::Ledger& ledger) override;

 private:
  std::int64_t take_over();
  void restore_fluids(const io::CheckpointReader& file, const std::optional<coupling::NamedState>& named = {});
  void start_clocks();
  void write_log_lines();
  void log_window(const coupling::WindowReport& report, double end_s, double wall_s);
  void describe_sides(io::Summary& summary, const runtime::Ledger& ledger);

  coupling::FloatingSystem& floating_;
  const runtime::Parts& parts_;
  bodies::BodiesState state_;
  std::int64_t steps_ = 0;  ///< of the bodies in all windows, repeated ones counted once
  coupling::CoupledWindow window_;
  std::optional<coupling::Recorder> recorder_;
  std::array<double, 4> core_seconds_{};  ///< of air, sea, bodies and waiting so far, as last logged
};

}  // namespace spindrift::run
