// SPDX-License-Identifier: Apache-2.0
#include "src/moorings/table_file.hpp"

#include <fmt/format.h>

#include "src/scene/columns.hpp"

namespace spindrift::moorings {

TableFile read_line_table(const std::string& path) {
  const scene::Columns table = scene::read_columns(path);
  table.allow_only({"distance_m", "tension_N"});
  table.require_rows(2);
  table.require_increasing("distance_m", "the distance between the ends");
  const auto distance = table["distance_m"], tension = table["tension_N"];
  if (distance[0] < 0.0) table.fail(0, "distance_m must not be negative");
  for (std::size_t i = 1; i < tension.size(); ++i)
    if (tension[i] < tension[i - 1])
      table.fail(int(i),
                 fmt::format("tension_N = {} is below {} of the row before: a line that pulls less as it lengthens is unstable",
                             tension[i], tension[i - 1]));
  return {{distance.begin(), distance.end()}, {tension.begin(), tension.end()}};
}

}  // namespace spindrift::moorings
