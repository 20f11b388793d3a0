// A tree of bounding boxes over things in space, so that the nearest to a point is found with a look at few of them. Things are
// divided at the median of their middles along the longest side. Used by kernels/rigid/closed_surface.cpp and
// src/aero/grid/wall_distance.cpp; tested through them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "kernels/grid/nearest_point.hpp"

namespace spindrift {

class BoxTree {
 public:
  static constexpr int leaf_things = 4;
  struct Node {
    Eigen::AlignedBox3d box;
    int first, last, left;  ///< things of order(); children at `left` and `left` + 1, 0 in leaves
  };

  BoxTree() = default;
  /// `box_of(thing)`, `middle_of(thing)`: of each of the things, whose order does not matter.
  template <class BoxOf, class MiddleOf>
  BoxTree(std::vector<int> things, const BoxOf& box_of, const MiddleOf& middle_of) : order_(std::move(things)) {
    if (order_.empty()) return;
    nodes_.reserve(order_.size());
    nodes_.push_back({{}, 0, int(order_.size()), 0});
    for (std::size_t n = 0; n < nodes_.size(); ++n) divide(n, box_of, middle_of);
  }

  /// Things of a node stand beside each other.
  std::span<const int> order() const { return order_; }
  std::span<const Node> nodes() const { return nodes_; }

  /// Calls look(place in order()), which lowers `least` where it finds less, for all whose box may be nearer. `share`: of the
  /// squared distance to a box, below 1 where rounding may make it larger than that to a thing in it.
  template <class Look>
  void search(const Eigen::Vector3d& p, double share, const double& least, const Look& look) const {
    if (nodes_.empty()) return;
    const auto bound = [&](int n) {
      const Eigen::AlignedBox3d& box = nodes_[std::size_t(n)].box;
      return share * squared_distance_to_box(p, box.min(), box.max());
    };
    std::array<std::pair<double, int>, 128> waiting;  // depth is log2(things) + 1; both children of a level may wait
    std::size_t count = 0;
    waiting[count++] = {bound(0), 0};
    while (count > 0) {
      const auto [nearer, number] = waiting[--count];
      if (nearer >= least) continue;
      const Node& node = nodes_[std::size_t(number)];
      if (node.left == 0) {
        for (int n = node.first; n < node.last; ++n) look(n);
        continue;
      }
      const double left = bound(node.left), right = bound(node.left + 1);
      const std::pair near(std::min(left, right), left < right ? node.left : node.left + 1),
          far(std::max(left, right), left < right ? node.left + 1 : node.left);
      if (far.first < least) waiting[count++] = far;
      if (near.first < least) waiting[count++] = near;
    }
  }

 private:
  template <class BoxOf, class MiddleOf>
  void divide(std::size_t number, const BoxOf& box_of, const MiddleOf& middle_of) {
    Node node = nodes_[number];
    Eigen::AlignedBox3d middles;
    for (int n = node.first; n < node.last; ++n)
      node.box.extend(box_of(order_[std::size_t(n)])), middles.extend(Eigen::Vector3d(middle_of(order_[std::size_t(n)])));
    if (node.last - node.first > leaf_things) {
      int axis;
      middles.sizes().maxCoeff(&axis);
      const int half = (node.first + node.last) / 2;
      std::nth_element(order_.begin() + node.first, order_.begin() + half, order_.begin() + node.last,
                       [&](int a, int b) { return std::pair(middle_of(a)[axis], a) < std::pair(middle_of(b)[axis], b); });
      node.left = int(nodes_.size());
      nodes_.push_back({{}, node.first, half, 0});
      nodes_.push_back({{}, half, node.last, 0});
    }
    nodes_[number] = node;
  }

  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace spindrift
