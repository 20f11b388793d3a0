// Cells at walls: the distance of the first ones in units of the boundary layer (y+) and how fast those beyond them grow. What a
// grid lets expect before a run, and whether it suits how the walls are treated. Called by src/run/flow_simulation.cpp and
// `spindrift check`; tested in tests/src/aero/first_cells_test.cpp. SPDX-License-Identifier: Apache-2.0
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
  double growth = 1.0;  ///< largest ratio of neighbours' heights from the wall to wall_layer_y_plus, within a block; 1: not known
};

/// Growth of the cells at resolved walls that is doubted, and beyond which a section has no answer. Measured in
/// docs/developer/notes/air.md: growth off walls.
inline constexpr double doubted_growth = 1.5, useless_growth = 3.0;

/// By how the walls are treated: resolved down to them, or by the law of the wall.
struct FirstCells {
  std::vector<FirstCell> resolved, by_law;
};

/// What a turbulent boundary layer on a flat plate would have, which begins where the walls do: cf = 0.027 / Re_x^(1/7)
/// (White, Fluid Mechanics, 7th ed. 2011, eq. 7.43). Empty where the flow has no turbulence model.
FirstCells expected_first_cells(const MultiBlockGrid& grid, const FlowOptions& options, const FlowSetting& setting);

/// The same on the blades of a resolved rotor, each section a plate of its chord at the speed of its radius. Of resolved blades
/// some surfaces of nodes are made for it. The turbine file must be readable; throws scene::SceneError where no grid can be made.
FirstCells expected_first_cells(const ResolvedRotorSetup& setup);

/// Whether the cells at the blades leave the boundary layer to a law of the wall, of a closure that has one: y+ of 10 and more
/// over half of their area. A rotor whose speed is not known turns at a tip-speed ratio of 7.
bool suits_wall_law(const ResolvedRotorSetup& setup);

/// Of the cells' area, what those have whose y+ is not from `least` to `most`; 0 of none.
double share_outside(const std::vector<FirstCell>& cells, double least, double most);
/// Likewise those whose growth is more than `most`.
double share_growing(const std::vector<FirstCell>& cells, double most);

/// Middle and largest of them: "0.4 in the middle, 1.2 at most".
std::string describe(const std::vector<FirstCell>& cells);
/// The same of their growth.
std::string describe_growth(const std::vector<FirstCell>& cells);

/// A sentence for each treatment that does not suit a tenth of its walls' area or more: resolved walls want y+ up to 5, the law
/// of the wall 15 to 1000. Another for resolved walls whose cells grow by more than doubted_growth over a tenth of their area;
/// `remedy` says where more layers are asked for, see more_layers().
std::vector<std::string> doubts_of(const FirstCells& cells, const std::string& remedy);

/// The key, or the file, that gives the boundary layer more cells.
std::string more_layers(const FlowOptions& options);

}  // namespace spindrift::aero
