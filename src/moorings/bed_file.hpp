// The file of a bed: columns x_m, y_m, depth_m, one row to each node of a grid, in any order.
// Called by src/coupling; tested in tests/src/moorings/bed_file_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kernels/mooring/bed.hpp"

namespace spindrift::moorings {

/// Throws scene::SceneError naming file and line where the rows are no grid.
Bed read_bed(const std::string& path);

}  // namespace spindrift::moorings
