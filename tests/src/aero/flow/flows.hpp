// Flows that tests share: air at sea level in a box, solved on any number of threads, ranks and schedules.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "runtime/executor/executor.hpp"
#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/grid/generators/box.hpp"

namespace spindrift::aero::testing {

/// Air at 101325 Pa and 288.15 K flowing at a Mach number along a direction.
inline FlowSetting air(double mach, Eigen::Vector3d direction = Eigen::Vector3d::UnitX()) {
  FlowSetting s;
  s.gas.pressure_reference = 101325.0;
  s.gas.temperature_reference = 288.15;
  s.speed = mach * std::sqrt(s.gas.gamma * s.gas.gas_constant * s.gas.temperature_reference);
  const Eigen::Vector3d u = s.speed * direction.normalized();
  s.stream = {0.0, u[0], u[1], u[2], 0.0};
  return s;
}

/// The stream and, round the middle of a plane unit box, a vortex whose fastest air turns at half the stream's speed so far from
/// there [m]: without gradients of entropy.
inline gas::Primitive<double> vortex_in_stream(const FlowSetting& s, const Eigen::Vector3d& x, double radius) {
  const double dx = (x[0] - 0.5) / radius, dz = (x[2] - 0.5) / radius,
               swirl = 0.5 * s.speed * std::exp(0.5 * (1.0 - dx * dx - dz * dz));
  gas::Primitive<double> q = s.stream;
  q.u += swirl * dz, q.w -= swirl * dx;
  q.T = -0.5 * swirl * swirl / s.gas.cp();
  q.p = s.gas.pressure_reference * (std::pow(1.0 + q.T / s.gas.temperature_reference, 3.5) - 1.0);
  return q;
}

/// Largest deviation of the flow from its uniform stream: pressure and temperature over the air's, velocity over the scale of
/// speed. A number that is none deviates without bound.
inline double stream_deviation(const FlowSolver& solver) {
  const FlowSetting& f = solver.setting();
  const double stream[5] = {f.stream.p, f.stream.u, f.stream.v, f.stream.w, f.stream.T};
  const double unit[5] = {f.gas.pressure_reference, f.speed, f.speed, f.speed, f.gas.temperature_reference};
  double largest = 0.0;
  for (const FlowTile& tile : solver.tiles())
    for (int c = 0; c < 5; ++c)
      for_rows(tile.box, [&](int k, int j) {
        for (int i = 0; i < tile.box.ni; ++i) {
          const double off = std::abs(tile.state.data()[c * tile.cells.component + tile.cells.at(k, j, i)] - stream[c]) / unit[c];
          if (!(off <= largest)) largest = std::isnan(off) ? std::numeric_limits<double>::infinity() : off;
        }
      });
  return largest;
}

/// Residuals, CFL numbers, linear iterations and matrices of all steps.
inline std::vector<double> fingerprint(const FlowSolver& solver) {
  std::vector<double> all;
  for (const PseudoRow& row : solver.rows())
    all.insert(all.end(),
               {row.density_residual, row.mean_residual, row.model_residual, row.cfl, double(row.krylov), double(row.matrices)});
  return all;
}

/// What would be saved of this rank's tiles, one after the other.
inline std::vector<double> state_of(const FlowSolver& solver) {
  std::vector<double> all;
  for (const std::vector<double>& tile : solver.restart().save_tiles()) all.insert(all.end(), tile.begin(), tile.end());
  return all;
}

/// As by a checkpoint: the state and the march of one solver into another of the same tiles.
inline void carry_over(const FlowSolver& from, FlowSolver& to) {
  to.restart().load_tiles(from.restart().save_tiles());
  to.restart().load_march(from.restart().save_march());
}

/// A grid with its solver on one rank, or a part of it on several.
struct Case {
  MultiBlockGrid grid;
  std::unique_ptr<GridStore> store;
  std::unique_ptr<FlowSolver> solver;
  std::unique_ptr<runtime::Executor> executor;

  Case(MultiBlockGrid from, const FlowSetting& setting, const std::vector<std::pair<std::string, PatchCondition>>& conditions,
       const TilingOptions& tiling = {}, int ranks = 1, int rank = 0, bool moving = false)
      : grid(std::move(from)) {
    std::vector<std::string> walls;
    TilingOptions options = tiling;
    for (const auto& [name, c] : conditions) {
      if (is_closed(c.condition)) walls.push_back(name);
      if (setting.viscous && of(c.condition).surface == Surface::no_slip) options.sticky.push_back(name);
    }
    Tiling tiles = make_tiling(grid, walls, options);
    std::vector<PatchCondition> by_patch(tiles.patches.size());
    for (const auto& [name, c] : conditions)
      if (const int p = tiles.patch(name); p >= 0) by_patch[std::size_t(p)] = c;
    std::vector<int> rank_of_tile(std::size_t(tiles.size()));
    for (std::size_t t = 0; t < rank_of_tile.size(); ++t) rank_of_tile[t] = int(t) * ranks / int(rank_of_tile.size());
    store = std::make_unique<GridStore>(std::move(tiles), std::move(rank_of_tile), rank);
    store->build_all(grid, moving);
    solver = std::make_unique<FlowSolver>(*store, setting, by_patch);
    solver->start_uniform();
  }
  /// Records the march; `comm` has as many ranks as the case.
  void prepare(MPI_Comm comm = MPI_COMM_SELF, runtime::ExecutorOptions options = {.threads = 1}) {
    if (comm != MPI_COMM_SELF) solver->fill_geometry(comm);
    runtime::Graph graph(comm);
    solver->record(graph);
    executor = std::make_unique<runtime::Executor>(std::move(graph), options);
  }
  void run(std::uint32_t n = 1) { executor->run(n); }
};

}  // namespace spindrift::aero::testing
