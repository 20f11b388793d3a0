// The air's side of a coupled window where the air marches in pseudo-time on a grid: physical steps, files, columns and output.
// What blades on a moving grid and actuators in a resting one have of their own is in resolved_air.cpp and actuator_air.cpp,
// which derive from it. Tested in tests/coupled. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/aero/changing_wind.hpp"
#include "src/aero/flow/flow_solver.hpp"
#include "src/coupling/air_file.hpp"
#include "src/coupling/air_output.hpp"
#include "src/coupling/air_settling.hpp"
#include "src/coupling/air_side.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/saved_air.hpp"

namespace spindrift::coupling {

class MarchingAir : public AirSide {
 public:
  void settle_in(const io::RunDirectory& directory) final { directory_ = &directory; }
  void prepare(double t, double dt, const aero::RotorState& at_end) final;
  Tasks record(runtime::Graph& graph) final;
  void forget_tasks() final { solver_->forget_graphs(); }
  aero::RotorLoad load_at_end() override;
  std::optional<aero::TileMove> better_ranks(const Measured& measured) final;
  void move_tiles(const aero::TileMove& move) final;
  void ease(int retry) final;
  const aero::RotorLoad* written() const final { return &loads_.on_bodies; }
  std::vector<SavedArray> saved() const final;
  void restore(const io::CheckpointReader& file) override;
  std::vector<io::Column> columns() const final;
  std::vector<double> values() const final;
  void open_output(const io::RunDirectory& directory, double resume_s) final;
  Writing copy_fields(std::int64_t number, double t) final { return output_->copy(number, t); }
  void write_span() final;
  void end_window() final;
  void fill_gradients() final { solver_->fill_gradients(world_.comm); }
  Account account() const final;
  std::string failure_at_end() const final;
  std::vector<std::string> log_lines() final { return std::exchange(log_lines_, {}); }

 protected:
  /// `now`: of the rotor at the start. loads_.computed is to have as many blades as are told one by one.
  MarchingAir(const FloatingSystem& floating, const aero::RotorState& now, const runtime::World& world);

  /// solver_, in the wind as it comes, on the tiles that rank_of_tile_ says.
  virtual void make() = 0;
  /// make() by the clock.
  void make_timed();
  /// solver_ anew, with its state as `send` returns it for other tiles; the one before is gone first: two would not fit where one
  /// does. Snapshots are of no use afterwards.
  using Send = std::function<aero::FlowSnapshot(aero::FlowSnapshot)>;
  virtual void make_anew(const Send& send) = 0;
  /// The rotor goes where state_ has it at the end of the step.
  virtual void move() = 0;
  /// After a step.
  virtual ComputedLoads computed() const = 0;
  virtual std::vector<SavedArray> computed_arrays() const = 0;
  virtual std::vector<aero::SpanLoad> span_loads() const = 0;
  /// What of a rotor's load acts on the bodies.
  virtual aero::RotorLoad on_bodies(const aero::RotorLoad& load) const { return load; }

  const Scenario& scenario() const { return floating_.scenario(); }
  /// Whether the preconditioner is still to be chosen; by trial on the flow as it is.
  bool automatic() const { return preconditioner_ == "auto"; }
  void choose();
  /// At the end of make(); and its line for the log, once.
  void place_wind() { wind_.place(solver_->grid(), world_.comm); }
  const aero::ChangingWind& wind() const { return wind_; }
  void tell_wind();
  /// Until start.air_steps are made, from the CFL number of this retry.
  void settle(const SteadyMarch& march, int retry);
  /// From loads_.computed, with RotorSource::ramp_of_air() of now.
  aero::RotorLoad update_load_on_bodies();

  /// After the last step: as computed, and as it acts on the bodies.
  struct Loads {
    ComputedLoads computed;
    aero::RotorLoad on_bodies;
  };

  const FloatingSystem& floating_;
  const runtime::World world_;
  double t_ = 0.0;  ///< of the last prepare(), as the rotor's state
  aero::RotorState state_;
  Loads loads_;
  std::string preconditioner_;          ///< or what "auto" became
  std::vector<int> rank_of_tile_;       ///< none: by their cells
  aero::FlowSolver* solver_ = nullptr;  ///< made by begin() or restore()
  std::vector<std::string> log_lines_;

 private:
  aero::ChangingWind wind_;
  const io::RunDirectory* directory_ = nullptr;
  bool has_time_tolerance() const { return scenario().aero.flow->time_tolerance.has_value(); }
  void judge_time_error();

  std::unique_ptr<AirOutput> output_;
  double made_s_ = 0.0;      ///< that make() took at most
  bool told_spent_ = false;  ///< that a step spent its pseudo-steps
  /// Of the last pseudo-steps of windows of this process.
  aero::UpdateLimits limits_;
  aero::LimitPlaces worst_limits_;
  bool has_made_windows_ = false;  ///< since this process began
  long above_tolerance_ = 0;       ///< windows of this process whose error in time was
};

/// Of the air in a coupled window [s].
double step_of(const Scenario& scenario);

}  // namespace spindrift::coupling
