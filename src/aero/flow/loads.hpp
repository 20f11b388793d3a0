// Forces and moments of the flow on its walls, patch by patch, and what is seen on a wall: pressure, friction, first cell's y+.
// Called by flow_solver.cpp (partials of a tile, summed in the order of tiles) and by output; tested in tests/src/aero/flow.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "src/aero/flow/boundary.hpp"
#include "src/aero/flow/sweep_viscous.hpp"

namespace spindrift::aero {

/// On a patch, earth axes; moments about the origin; pressure above the reference.
struct PatchLoads {
  std::array<double, 3> pressure_force{}, viscous_force{}, moment{};
};
inline constexpr int load_components = 9;
PatchLoads patch_loads(std::span<const double> sums, int patch);

/// Adds the loads on a tile's walls to partial[patch][component].
void add_loads(const FlowTile& tile, const double* state, const ViscousSetting& viscous, const BoundarySetting& boundary,
               std::span<double> partial);

/// Calls body(window, k, j, i, force by pressure, by friction [N]) for each wall face of a tile, its cell (k, j, i); order of the windows,
/// low directions innermost.
using WallForceFunction =
    std::function<void(const FlowBoundary&, int k, int j, int i, const Eigen::Vector3d& pressure, const Eigen::Vector3d& friction)>;
void for_wall_forces(const FlowTile& tile, const double* state, const ViscousSetting& viscous, const WallForceFunction& body);

/// A wall face.
struct WallPoint {
  int patch = 0;
  std::array<double, 3> place{};  ///< [m] centre of the face
  std::array<double, 3> traction{};  ///< viscous, of the flow on the wall [Pa]
  double pressure = 0.0;          ///< above the reference [Pa]
  double area = 0.0, y_plus = 0.0;
};
void gather_wall(const FlowTile& tile, const double* state, const ViscousSetting& viscous, const BoundarySetting& boundary,
                 std::vector<WallPoint>& points);

}  // namespace spindrift::aero
