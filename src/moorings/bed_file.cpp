// SPDX-License-Identifier: Apache-2.0
#include "src/moorings/bed_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "src/scene/columns.hpp"

namespace spindrift::moorings {

namespace {

std::vector<double> nodes_of(std::span<const double> column) {
  std::vector<double> nodes(column.begin(), column.end());
  std::ranges::sort(nodes);
  nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
  return nodes;
}

std::size_t place(const std::vector<double>& nodes, double value) {
  return std::size_t(std::ranges::lower_bound(nodes, value) - nodes.begin());
}

}  // namespace

Bed read_bed(const std::string& path) {
  const scene::Columns table = scene::read_columns(path);
  table.allow_only({"x_m", "y_m", "depth_m"});
  table.require_rows(2);
  const auto x = table["x_m"], y = table["y_m"], depth = table["depth_m"];
  const std::vector<double> east = nodes_of(x), north = nodes_of(y);
  std::vector<double> z(east.size() * north.size(), 0.0);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (!(depth[row] > 0.0))
      table.fail(int(row), fmt::format("depth_m = {:g} must be above zero: depths count downwards", depth[row]));
    double& here = z[place(north, y[row]) * east.size() + place(east, x[row])];
    if (here != 0.0) table.fail(int(row), fmt::format("x_m = {:g}, y_m = {:g} is in a row before", x[row], y[row]));
    here = -depth[row];
  }
  for (std::size_t node = 0; node < z.size(); ++node)
    if (z[node] == 0.0)
      table.fail(-1, fmt::format("has no row for x_m = {:g}, y_m = {:g}: a depth is wanted at each of {} x {} places of its grid",
                                 east[node % east.size()], north[node / east.size()], east.size(), north.size()));
  return {east, north, z};
}

}  // namespace spindrift::moorings
