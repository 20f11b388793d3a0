// CGNS files of structured grids (CGNS 3.4, Standard Interface Data Structures): nodes, 1-to-1 connections, boundaries. One rank
// reads or writes; where the program was built without the library both refuse. Called by the program's `grid` command; tested in
// tests/src/aero/grid/cgns_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

bool cgns_available();

/// The base that has zones; more than one is refused. Lengths are in the units of the file, metres where it states none. A
/// boundary's patch is its family, else its own name. Windows in neither a connection nor a boundary are joined where coordinates
/// coincide only if the file has no connections at all. Periodic maps are found from the nodes (the file holds them in single
/// precision). Throws scene::SceneError.
MultiBlockGrid read_cgns(const std::filesystem::path& file, double planar_width = 1.0);

void write_cgns(const MultiBlockGrid& grid, const std::filesystem::path& file);

}  // namespace spindrift::aero
