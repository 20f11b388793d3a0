// The air: a compressible flow on the tiles of this rank, one implicit (pseudo-)time march as tasks. Puts the parts together:
// arrays (tile_arrays), residual (flow_residual), moving grid (tile_motion), linear system (implicit_system), decisions
// (judgement), restart (flow_restart); the graph itself is tasks.cpp, the method docs/theory/air.md. Built by
// src/aero/resolved_rotor.cpp, src/run/flow_case.cpp and by tests; tested in tests/src/aero/flow and tests/verification/air.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/graph/graph.hpp"
#include "src/aero/flow/flow_residual.hpp"
#include "src/aero/flow/flow_restart.hpp"
#include "src/aero/flow/flow_setting.hpp"
#include "src/aero/flow/implicit_system.hpp"
#include "src/aero/flow/judgement.hpp"
#include "src/aero/flow/physical_time.hpp"
#include "src/aero/flow/tasks.hpp"
#include "src/aero/flow/tile_arrays.hpp"
#include "src/aero/flow/tile_motion.hpp"
#include "src/aero/flow/time_error.hpp"

namespace spindrift::aero {

class FlowSolver {
 public:
  /// `conditions` by patch of the grid's tiling. The grid must outlive the solver and have been built.
  FlowSolver(GridStore& grid, const FlowSetting& setting, std::vector<PatchCondition> conditions);

  /// Every cell as the undisturbed flow there.
  void start_uniform();
  /// Any state: body(centre) gives the primitive values above the references; turbulence is that of the undisturbed flow.
  template <class Body>
  void start(Body&& body) {
    const std::array<double, 2>& carried = residual_.boundary().carried;
    for (FlowTile& tile : arrays_.tiles)
      for_centres(tile, [&](int k, int j, int i, const Eigen::Vector3d& x) {
        const std::ptrdiff_t at = tile.cells.at(k, j, i);
        gas::store_primitive<double>(tile.state.data() + at, std::size_t(tile.cells.component), body(x));
        for (int t = 0; t < tile.turbulence; ++t)
          tile.state.data()[at + (mean_unknowns + t) * tile.cells.component] = carried[std::size_t(t)];
      });
    forget();
  }
  /// The state of another solver on the same tiles, a steady one say; no past.
  void start_from(const FlowSolver& other);
  /// No past: the physical step that follows is the first.
  void forget() { time_.steps = 0; }

  /// From here on waves run at their own speeds in the pseudo-time, as without low-Mach preconditioning; far field and flow stay.
  void use_physical_pseudo_time() { system_.use_physical_pseudo_time(); }
  /// Reconstruction from here on, by a name of FlowSetting::limiter: that of the setting, or first order to get over a hard
  /// start.
  void use_limiter(std::string_view limiter) { residual_.use_limiter(limiter); }
  /// In place of the one the setting names; before record().
  void use(std::unique_ptr<Preconditioner> preconditioner) { system_.use(std::move(preconditioner)); }
  /// The undisturbed wind where it changes in time: before each physical step. Far sides take it, and what makes it change
  /// drives all air alike, so that a gust is where the blades are at once, as in a blade-element model.
  void set_wind(UndisturbedWind wind) { residual_.set_wind(std::move(wind)); }
  /// A force inside the air; before record().
  void set_body_force(std::shared_ptr<BodyForce> force);
  /// Bands whose loads are summed beside those of the patches (Judgement::takes_bands); before record().
  void gather_bands(LoadBands bands);
  /// Records one march: the whole steady solution, or one physical step. See tasks.cpp.
  void record(runtime::Graph& graph);
  /// Fills ghost volumes and centres from other ranks; once, and after the grid was placed elsewhere. Collective.
  void fill_geometry(MPI_Comm comm);
  /// The same, and ghosts and gradients of the state as it is: friction of a state from a file. Collective.
  void fill_gradients(MPI_Comm comm);
  /// What recorded graphs refer to is freed: their executors are gone.
  void forget_graphs() { recorded_ = {}; }

  /// Length of the next physical step and, where it is not that of the last one made, of those before it [s].
  void set_time_step(double dt, std::optional<double> before = {});
  /// Length of the n-th last step that was made [s].
  double step_before(std::size_t n) const { return time_.before[n]; }
  /// Of the step made last, where the setting has a tolerance.
  std::optional<double> time_error() const { return time_error_.estimate(); }
  /// Physical steps since the start.
  std::int64_t time_steps() const { return time_.steps; }

  const FlowSetting& setting() const { return setting_; }
  GridStore& grid() const { return arrays_.grid; }
  std::span<FlowTile> tiles() { return arrays_.tiles; }
  std::span<const FlowTile> tiles() const { return arrays_.tiles; }
  TileMotion& motion() { return motion_; }
  Judgement& judgement() { return judgement_; }
  const Judgement& judgement() const { return judgement_; }
  const MarchState& march() const { return judgement_.march.state(); }
  const std::vector<PseudoRow>& rows() const { return judgement_.rows.all; }
  FlowRestart& restart() { return restart_; }
  const FlowRestart& restart() const { return restart_; }
  LimitPlaces limited_cells(Updates which, MPI_Comm comm) const { return aero::limited_cells(arrays_, which, comm); }
  std::string worst_cells(MPI_Comm comm) const { return aero::worst_cells(arrays_, system_, comm); }
  std::vector<WallPoint> wall_points(const FlowTile& tile) const { return residual_.wall_points(tile); }

  /// Whether the flow's last bits depend on which rank has which tile.
  bool knows_ranks() const { return system_.preconditioner().knows_ranks(); }

  std::size_t bytes() const { return arrays_.bytes(); }
  long cells() const { return arrays_.cells(); }  ///< of all ranks
  int unknowns() const { return mean_unknowns + residual_.model().equations; }

 private:
  FlowSetting setting_;
  PhysicalTime time_;
  FlowResidual residual_;
  TileArrays arrays_;
  TileMotion motion_;
  ImplicitSystem system_;
  Judgement judgement_;
  TimeError time_error_;
  FlowRestart restart_;
  RecordedGraphs recorded_;
};

}  // namespace spindrift::aero
