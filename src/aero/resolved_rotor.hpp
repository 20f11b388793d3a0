// The blade-resolved rotor: a turbine's blades turning in compressible air. Grid, tiles, solver and poses put
// together from a scene's options; thrust, torque, loads by blade and along the span handed out. Frames and signs:
// docs/user/conventions.md; method: docs/theory/rotor_resolved.md. Built by src/run/flow_case.cpp; tested in
// tests/src/aero/resolved_rotor_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/executor/executor.hpp"
#include "runtime/mpi/environment.hpp"
#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/made_rotor_grid.hpp"
#include "src/aero/resolved_rotor_setup.hpp"
#include "src/aero/rotor_grid/motion.hpp"
#include "src/aero/rotor_grid/pitching.hpp"
#include "src/aero/rotor_loads.hpp"

namespace spindrift::aero {

/// Hub and attitude at azimuth zero: x the axis, z as upright as the axis lets it.
RotorPose hub_pose(const RotorOptions& rotor);

/// Loads of the air on a row of wall faces of a blade, per length of radius.
struct SpanLoad {
  int blade = 1;
  double radius = 0.0, length = 0.0, chord = 0.0;  ///< [m]
  StationLoad load;      ///< normal (downwind) and tangential (as the rotor turns), pressure and friction [N/m]
  StationLoad friction;  ///< friction's part [N/m]
};

/// Where a rotor is.
struct RotorPlace {
  RotorPose pose;
  std::vector<double> pitches = {};  ///< of each sector's blade, beyond that of the grid as made [rad]; none: as made

  bool pitches_blades() const {
    return std::ranges::any_of(pitches, [](double p) { return p != 0.0; });
  }
};

class ResolvedRotor {
 public:
  /// `chunk`: pseudo-steps that one run of a steady march takes at most; 0: as many as the scene allows.
  /// `made`: the grid of this scene, by a setup with the same walls; where there is none, this rank looks through it alone.
  /// `rank_of_tile`: where none are given tiles are shared out by their cells.
  /// Throws runtime::StopAsked, on this rank alone, where it is asked to stop meanwhile.
  explicit ResolvedRotor(const ResolvedRotorSetup& setup, int ranks = 1, int rank = 0, int chunk = 0,
                         std::shared_ptr<const MadeRotorGrid> made = nullptr, const GridProgress& told = {},
                         std::vector<int> rank_of_tile = {});
  /// The same on all ranks of the world, collectively: throws runtime::StopAsked on all alike where they are asked to stop
  /// meanwhile.
  static std::unique_ptr<ResolvedRotor> on(const runtime::World& world, const ResolvedRotorSetup& setup, int chunk,
                                           std::shared_ptr<const MadeRotorGrid> made, const GridProgress& told = {},
                                           std::vector<int> rank_of_tile = {});
  ResolvedRotor(const ResolvedRotor&) = delete;
  ResolvedRotor& operator=(const ResolvedRotor&) = delete;

  FlowSolver& solver() { return *solver_; }
  const FlowSolver& solver() const { return *solver_; }
  GridStore& store() { return *store_; }
  const MadeRotorGrid& made() const { return *made_; }  ///< without what only its making takes
  bool steady() const { return setup_.dt == 0.0; }

  /// The rotor turning at the scene's speed with its hub at rest, after so many windows.
  RotorPose turned(double windows) const;
  const RotorPose& pose() const { return now_.pose; }
  /// At the end of the last step and at its beginning.
  const RotorPlace& now() const { return now_; }
  const RotorPlace& before() const { return before_; }
  /// At the beginning of the step before the last one.
  const RotorPlace& long_before() const { return long_before_; }

  /// Where the rotor is at the end of the next physical step.
  void move_to(const RotorPlace& end);
  /// Its present pose and those of one step and two steps ago, without flow in between: starts away from the scene's own pose.
  void place(const RotorPlace& long_before, const RotorPlace& before, const RotorPlace& now);
  /// Restarts: the solver has been placed by FlowRestart::load_march.
  void placed_at(double windows);

  /// Of the whole rotor after the last march, about the hub; one sector's load stands for all blades.
  RotorLoad load() const;
  /// The same from a row of the march.
  RotorLoad load(const PseudoRow& row) const;
  /// Of one blade of the grid (1, 2, ...), about the hub; after the last march, or from a row of it.
  RotorLoad blade_load(int blade) const;
  RotorLoad blade_load(int blade, const PseudoRow& row) const;
  /// Along the blades of the grid from root to tip, the same on every rank: after the last march, or the mean over rows of it,
  /// which is for steady flows: theirs have all bands of loads (Judgement::bands_of_every_row).
  std::vector<SpanLoad> span_loads() const { return span_loads(solver_->judgement().bands.result); }
  std::vector<SpanLoad> span_loads(std::span<const PseudoRow> rows) const;

  // For whoever couples: a window may be tried, undone and tried again.
  /// Records the march on the ranks of `comm`; needed by advance().
  void prepare(MPI_Comm comm, runtime::ExecutorOptions options = {});
  /// The march as it stands: a steady flow, or the physical step that move_to() has prepared. Collective.
  void run() { march_->run(); }
  /// One physical step that ends in this pose; the load at its end. Throws NumericalFailure naming place and limit. Collective.
  RotorLoad advance(const RotorPlace& end);
  struct Snapshot {
    FlowSnapshot air;
    RotorPlace long_before, before, now;
  };
  Snapshot snapshot() const;
  void restore(const Snapshot& from);

 private:
  void make_nodes();
  void fill_wall_distances(const GridProgress& told);
  LoadBands rows_of_faces() const;
  std::vector<SpanLoad> span_loads(std::span<const double> sums) const;
  std::vector<BlockPose> block_poses(const RotorPlace& place) const;
  RotorLoad blade_load(const PatchLoads& loads) const;
  /// Of all blades; other walls count in their own columns.
  RotorLoad of_blades(const std::function<RotorLoad(int blade)>& load) const;
  RotorLoad about_hub(const Eigen::Vector3d& force, const Eigen::Vector3d& moment, bool all) const;

  ResolvedRotorSetup setup_;
  std::shared_ptr<const MadeRotorGrid> made_;
  std::unique_ptr<BladePitching> pitching_;
  std::unique_ptr<GridStore> store_;
  std::unique_ptr<FlowSolver> solver_;
  std::unique_ptr<runtime::Executor> march_;
  RotorPose start_;
  RotorPlace long_before_, before_, now_;
};

}  // namespace spindrift::aero
