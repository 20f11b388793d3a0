// Plot3D grid files: formatted or binary, one block or many, two- or three-dimensional; what kind a file is is found from its
// size. Two-dimensional coordinates (x, y) become the x-z plane, one cell thick. So does a three-dimensional grid of one cell
// between two planes that are alike but for a step along y or z, as CFL3D and FUN3D take sections. Connections and boundaries
// come from a neutral map file (neutral_map.hpp) or from coordinates (connect.hpp). Called by the program's `grid` command and
// src/aero/flow; tested in tests/src/aero/grid/files_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

/// Blocks only. Formatted: numbers in any layout, Fortran repeats (3*0.0) and exponents (1.0D-3) understood. Binary: with or
/// without Fortran record marks, either byte order, single or double precision; iblank arrays are skipped. Throws
/// scene::SceneError. A three-dimensional grid that is one cell wide becomes planar and is as wide as it was.
MultiBlockGrid read_plot3d(const std::filesystem::path& file, double planar_width = 1.0);

enum class Plot3dForm { formatted, binary };  ///< binary: Fortran records, double precision, this computer's byte order
/// Multi-block, every coordinate to the last digit; a planar grid as two-dimensional.
void write_plot3d(const MultiBlockGrid& grid, const std::filesystem::path& file, Plot3dForm form = Plot3dForm::formatted);

}  // namespace spindrift::aero
