// Grid, tiles and solver of the air alone on this rank, as a scene describes them. Used by flow_simulation.cpp; tested in
// tests/coupled/flow_run_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/executor/executor.hpp"
#include "runtime/mpi/environment.hpp"
#include "src/aero/actuator.hpp"
#include "src/aero/changing_wind.hpp"
#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/grid_motion.hpp"
#include "src/aero/resolved_rotor.hpp"
#include "src/coupling/scenario.hpp"

namespace spindrift::run {

class FlowCase {
 public:
  /// Pseudo-steps of a steady march from one run of its graph to the next: clock and disk are checked between them.
  static constexpr int steady_chunk = 20;

  /// Collective. Throws scene::SceneError where the grid does not suit the scene.
  FlowCase(const coupling::Scenario& scenario, const runtime::World& world, int chunk = steady_chunk);

  aero::FlowSolver& solver() { return *solver_; }
  const aero::FlowSolver& solver() const { return *solver_; }
  const aero::GridStore& store() const { return *store_; }
  /// Null where the scene has none.
  aero::ResolvedRotor* rotor() { return rotor_.get(); }
  const aero::ResolvedRotor* rotor() const { return rotor_.get(); }
  const aero::Actuator* actuator() const { return actuator_.get(); }
  const aero::GridMotion* motion() const { return motion_ ? &*motion_ : nullptr; }
  std::size_t blocks() const { return store_->tiling().block_cells.size(); }
  bool steady() const { return solver_->setting().time_order == 0; }
  bool steps_divide_windows() const { return solver_->setting().time_tolerance.has_value(); }

  /// Where the walls that move are after so many windows.
  void place(std::int64_t window, double window_s);
  /// Where they, a rotor and lines of force go in the step that follows, and with which wind: `end` in windows.
  void move(double end, double window_s);

  /// The state at the end of a window, saved in memory to be restored.
  aero::FlowSnapshot snapshot() const { return solver_->restart().snapshot(); }
  void return_to(const aero::FlowSnapshot& to, std::int64_t window, double window_s);

  /// How a steady march that is no rotor's begins and steps; tried in this order, but for physical_pseudo_time, which is last.
  /// Files have their numbers. first_order: without reconstruction, until that has come some way; after_first_order: from there.
  enum class Start : std::uint8_t { coarser_grids, own_grid, physical_pseudo_time, first_order, after_first_order };
  Start start() const { return start_; }
  /// The beginning that a checkpoint names; its state follows.
  void take(Start start);
  /// The march begins again by the next method in that order: returns its name, or nothing where there is none left.
  std::string begin_again(const coupling::Scenario& scenario);

  /// Whether a march of first order has done its part, and the scene's own reconstruction takes over.
  bool first_order_is_over() const;
  void raise_order();

  /// Grid sequencing of grids that are no rotor's: the flow settles on coarser grids first, the coarsest before the others, their
  /// tiles spread over the ranks like the fine one's. What a drop is counted from stays the residual of the undisturbed flow on
  /// each grid; also of a flow that begins at rest, with or without coarser grids. `march` is the fine one's. A coarser grid
  /// whose march fails, or whose flow does not settle, is passed over.
  void start_on_coarser_grids(const coupling::Scenario& scenario, runtime::Executor& march, const runtime::World& world);

 private:
  /// On a coarser grid, for at most so many pseudo-steps.
  FlowCase(aero::MultiBlockGrid grid, const coupling::Scenario& scenario, const runtime::World& world, int steps);
  void solve(aero::Tiling tiling, const coupling::Scenario& scenario, const runtime::World& world, int steps);
  void begin(const std::string& start);
  void place_actuator(double time);
  void make_actuator(const coupling::Scenario& scenario, const runtime::World& world);
  void place_wind(MPI_Comm comm);
  void follow_walls(const aero::FlowOptions& options);

  aero::ChangingWind wind_;
  std::unique_ptr<aero::ResolvedRotor> rotor_;       ///< has grid, store and solver itself
  aero::MultiBlockGrid own_grid_;                    ///< of all ranks; gone when tiles are made of it, unless walls move
  std::vector<aero::MultiBlockGrid> coarser_grids_;  ///< until the march begins
  std::unique_ptr<aero::GridStore> own_store_;
  std::unique_ptr<aero::FlowSolver> own_solver_;
  std::optional<aero::GridMotion> motion_;  ///< of an unsteady flow
  std::shared_ptr<aero::Actuator> actuator_;
  aero::DiscMotion rotor_at_start_{};  ///< of the actuator
  Start start_ = Start::own_grid;
  aero::GridStore* store_ = nullptr;
  aero::FlowSolver* solver_ = nullptr;
};

}  // namespace spindrift::run
