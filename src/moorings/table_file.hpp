// The file of a tabulated line: columns distance_m, tension_N.
// Called by options.cpp (to check) and line_table.cpp (to use); tested in tests/src/moorings/options_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace spindrift::moorings {

struct TableFile {
  std::vector<double> distance, tension;  ///< [m], [N]; strictly increasing, not decreasing
};

/// Throws scene::SceneError naming file and line where the table is not one a line can follow.
TableFile read_line_table(const std::string& path);

}  // namespace spindrift::moorings
