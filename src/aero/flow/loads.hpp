// Forces and moments of the flow on its walls, patch by patch, and the values on a wall: pressure, friction, first cell's y+.
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

/// Wall faces gathered into bands that cross patches or divide them: the rows of faces along a blade.
struct LoadBands {
  int count = 0;
  std::function<int(const FlowTile&, int k, int j, int i)> of;  ///< of the cell at a wall face of a patch with loads; -1: none
};
/// On a band, earth axes.
struct BandLoads {
  std::array<double, 3> pressure_force{}, viscous_force{};
};
inline constexpr int band_components = 6;
/// `sums`: of the bands, as add_loads fills them, or of the patches and then of the bands.
BandLoads band_loads(std::span<const double> sums, int bands, int band);

/// Whether a tile has walls whose loads count.
bool has_loads(const FlowTile& tile);
/// Adds the loads on a tile's walls to of_patches[patch][component] and of_bands[band][component].
void add_loads(const FlowTile& tile, const double* state, const ViscousSetting& viscous, const LoadBands& bands,
               std::span<double> of_patches, std::span<double> of_bands);

/// A wall face.
struct WallPoint {
  int patch = 0;
  std::array<double, 3> place{};     ///< [m] centre of the face
  std::array<double, 3> traction{};  ///< viscous, of the flow on the wall [Pa]
  double pressure = 0.0;             ///< above the reference [Pa]
  double area = 0.0, y_plus = 0.0;
  double growth = 1.0;  ///< as FirstCell::growth
};
void gather_wall(const FlowTile& tile, const double* state, const ViscousSetting& viscous, const BoundarySetting& boundary,
                 std::vector<WallPoint>& points);

}  // namespace spindrift::aero
