// The distance of first cells from walls in units of the boundary layer (y+): what a grid lets expect before a run, and whether
// it suits how the walls are treated. Called by src/run/flow_simulation.cpp and `spindrift check`; tested in
// tests/src/aero/first_cells_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

struct FlowOptions;
struct FlowSetting;
struct ResolvedRotorSetup;

/// A face of a wall that air sticks to, and the y+ of the centre of the cell at it.
struct FirstCell {
  double area = 0.0;  ///< [m2]
  double y_plus = 0.0;
};

/// By how the walls are treated: resolved down to them, or by the law of the wall.
struct FirstCells {
  std::vector<FirstCell> resolved, by_law;
};

/// What a turbulent boundary layer on a flat plate would have, which begins where the walls do: cf = 0.027 / Re_x^(1/7)
/// (White, Fluid Mechanics, 7th ed. 2011, eq. 7.43). Empty where the flow has no turbulence model.
FirstCells expected_first_cells(const MultiBlockGrid& grid, const FlowOptions& options, const FlowSetting& setting);

/// The same on the blades of a resolved rotor, each section a plate of its chord at the speed of its radius, up to where the tip
/// is closed. The turbine file must be readable.
FirstCells expected_first_cells(const ResolvedRotorSetup& setup);

/// Whether the cells at the blades leave the boundary layer to a law of the wall, of a closure that has one: y+ of 10 and more
/// over half of their area. A rotor whose speed is not known turns at a tip-speed ratio of 7.
bool suits_wall_law(const ResolvedRotorSetup& setup);

/// Of the cells' area, what those have whose y+ is not from `least` to `most`; 0 of none.
double share_outside(const std::vector<FirstCell>& cells, double least, double most);

/// Middle and largest of them: "0.4 in the middle, 1.2 at most".
std::string describe(std::vector<FirstCell> cells);

/// A sentence for each treatment that does not suit a tenth of its walls' area or more: resolved walls want y+ up to 5, the law
/// of the wall 15 to 1000.
std::vector<std::string> doubts_of(const FirstCells& cells);

}  // namespace spindrift::aero
