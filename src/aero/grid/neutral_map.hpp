// NASA's neutral map files (.nmf): which windows of a Plot3D grid's blocks bound the flow and which meet (V2k, GEOLAB, NASA
// Langley; www.geolab.larc.nasa.gov/Volume/Doc/nmf.htm). Read beside read_plot3d; tested in tests/src/aero/grid/files_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

/// Adds connections and boundaries to a grid's blocks. A boundary's type becomes the patch name. A one-to-one line whose nodes do
/// not lie on one another is periodic: the rigid map is found from them. A planar grid takes maps of its three-dimensional form
/// (one dimension of 2 nodes) too. Blocks whose indices are left-handed have i and j exchanged at the end. Throws
/// scene::SceneError.
void read_neutral_map(MultiBlockGrid& grid, const std::filesystem::path& file);

/// Patch names become types. The map of a periodic connection is not in the file: the reader finds it again.
void write_neutral_map(const MultiBlockGrid& grid, const std::filesystem::path& file);

/// Exchanges i and j of blocks whose volumes are negative.
void make_right_handed(MultiBlockGrid& grid);

}  // namespace spindrift::aero
