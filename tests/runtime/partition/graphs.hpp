// Block graphs for the tests of the partition: a box of air blocks over a sheet of sea columns, with uneven costs.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

#include "runtime/partition/block_graph.hpp"

namespace spindrift::runtime::testing {

/// n x n x n air blocks (cost 1 to 3 in the first constraint) and m x m sea columns (cost 0.5 to 1.5 in the second), each a
/// lattice of its own: the fluids touch different blocks, as in a run.
inline BlockGraph air_over_sea(int n, int m) {
  BlockGraph graph;
  graph.constraints = 2;
  std::mt19937 random(7);
  const auto uniform = [&random](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  const auto air = [n](int k, int j, int i) { return (k * n + j) * n + i; };
  const auto sea = [n, m](int j, int i) { return n * n * n + j * m + i; };
  for (int b = 0; b < n * n * n; ++b) graph.cost.insert(graph.cost.end(), {uniform(1, 3), 0.0});
  for (int b = 0; b < m * m; ++b) graph.cost.insert(graph.cost.end(), {0.0, uniform(0.5, 1.5)});
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        if (i > 0) graph.edges.push_back({air(k, j, i), air(k, j, i - 1), 1.0});
        if (j > 0) graph.edges.push_back({air(k, j, i), air(k, j - 1, i), 1.0});
        if (k > 0) graph.edges.push_back({air(k, j, i), air(k - 1, j, i), 1.0});
      }
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i) {
      if (i > 0) graph.edges.push_back({sea(j, i), sea(j, i - 1), 0.5});
      if (j > 0) graph.edges.push_back({sea(j, i), sea(j - 1, i), 0.5});
    }
  return graph;
}

/// A row of blocks with these costs, neighbours joined with weight 1.
inline BlockGraph row(std::vector<double> cost, int constraints = 1) {
  BlockGraph graph;
  graph.constraints = constraints;
  graph.cost = std::move(cost);
  for (int b = 1; b < graph.blocks(); ++b) graph.edges.push_back({b - 1, b, 1.0});
  return graph;
}

}  // namespace spindrift::runtime::testing
