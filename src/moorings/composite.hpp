// The line that a scene's sections and clumps make: kernels/mooring/line_composite.hpp. Used by line_composite_catenary.cpp and
// doubts.cpp; tested in tests/src/moorings. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernels/mooring/line_composite.hpp"
#include "src/moorings/options.hpp"

namespace spindrift::moorings {

/// Sections are cut where clumps hang between their joints.
struct CompositeParts {
  std::vector<CatenarySection> sections;
  std::vector<double> hung;    ///< net weight in water at each joint [N]
  std::vector<double> joints;  ///< distances from the anchor [m]
};
CompositeParts composite_parts(const LineOptions& line, double water_density_kg_m3, double gravity_m_s2);

LineComposite composite_line(const CompositeParts& parts, const LineOptions& line);

}  // namespace spindrift::moorings
