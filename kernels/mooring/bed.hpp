// The bed under mooring lines as heights on a grid: bilinear between its nodes, the edge values beyond. Called by
// line_lumped_mass.hpp and line_network.hpp; tested in tests/kernels/mooring/bed_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <utility>
#include <vector>

#include "kernels/base/interpolation.hpp"

namespace spindrift {

class Bed {
 public:
  /// `x`, `y`: increasing [m]; `z`: heights, below zero, x fastest [m].
  Bed(std::vector<double> x, std::vector<double> y, std::vector<double> z)
      : x_(std::move(x)), y_(std::move(y)), z_(std::move(z)), highest_(*std::max_element(z_.begin(), z_.end())) {}

  double highest() const { return highest_; }
  double level(double x, double y) const { return interpolate_bilinear(x_, y_, z_, x, y); }
  /// Unit, upwards; on a line between cells that of the cell above it in x and y.
  Eigen::Vector3d normal(double x, double y) const {
    const auto across = [](const std::vector<double>& nodes, double at) {  // ends of the cell; none beyond the grid
      if (nodes.size() == 1 || at < nodes.front() || at > nodes.back()) return std::pair(at, at);
      const std::size_t i = interval(nodes, at);
      return std::pair(nodes[i], nodes[i + 1]);
    };
    const auto [west, east] = across(x_, x);
    const auto [south, north] = across(y_, y);
    const double slope_x = east > west ? (level(east, y) - level(west, y)) / (east - west) : 0.0;
    const double slope_y = north > south ? (level(x, north) - level(x, south)) / (north - south) : 0.0;
    return Eigen::Vector3d(-slope_x, -slope_y, 1.0).normalized();
  }
  bool covers(double x, double y) const {
    const auto within = [](const std::vector<double>& nodes, double at) {
      return nodes.size() == 1 || (at >= nodes.front() && at <= nodes.back());
    };
    return within(x_, x) && within(y_, y);
  }

 private:
  std::vector<double> x_, y_, z_;
  double highest_;
};

}  // namespace spindrift
