// A wind that changes in time, as resolved air takes it: what is the same along the wind drives all air alike, and turbulence is
// given to the air that passes a plane upwind of the rotor, where cells are small enough to carry it. Method: docs/theory/air.md.
// Used by src/coupling and src/run; tested in tests/src/aero/changing_wind_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>

#include "runtime/mpi/exchange.hpp"
#include "src/aero/flow/boundary.hpp"
#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/grid/multi_block.hpp"
#include "src/aero/grid/store.hpp"
#include "src/aero/wind.hpp"

namespace spindrift::aero {

/// Empty where the wind is not turbulent or the middle of the plane is between the corners of a grid.
std::string why_inflow_plane_outside(const WindOptions& wind, const WindSite& site, const Corners& grid);
/// Throws scene::SceneError where the wind is turbulent and the middle of the plane is not between the corners of the grid.
void require_inflow_plane_inside(const MultiBlockGrid& grid, const WindOptions& wind, const WindSite& site);

class ChangingWind {
 public:
  /// Steady.
  ChangingWind() = default;
  ChangingWind(const WindOptions& wind, const WindSite& site);

  /// Before the first step: the forces are spread over two cells of this grid. Collective. Throws scene::SceneError where the
  /// grid has no cells at the plane.
  void place(const GridStore& store, MPI_Comm comm);
  bool steady() const { return wind_.steady(); }
  /// As a step of the air that ends at t takes it.
  UndisturbedWind until(double t) const;
  /// At t = 0, held: for air that settles. Empty where the wind is steady.
  UndisturbedWind at_start() const;
  /// Takes air from this wind [m/s at a place], which it started or settled in, to that of t = 0 where the wind changes in time:
  /// what drives air in its steps are changes alone.
  void begin(std::span<FlowTile> tiles, const std::function<Eigen::Vector3d(const Eigen::Vector3d& place)>& from) const;
  /// The same for air that started in its setting's stream.
  void begin(FlowSolver& solver) const;
  /// Whether there is a plane.
  bool has_plane() const { return wind_.turbulent(); }
  /// "turbulence enters 178 m upwind of the hub, spread over 17.8 m, and comes to it after 16.2 s"; empty without a plane.
  std::string description() const;

 private:
  Wind wind_;
  WindSite site_;
  InflowPlane plane_;
};

}  // namespace spindrift::aero
