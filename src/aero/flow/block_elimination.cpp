// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/block_elimination.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "kernels/base/wide.hpp"
#include "src/aero/flow/singular_matrix.hpp"

namespace spindrift::aero {

namespace {

/// Reverse Cuthill-McKee: place of each row.
std::vector<int> order_rows(int rows, std::span<const BlockElimination::Entry> entries) {
  std::vector<std::vector<int>> near(static_cast<std::size_t>(rows));
  for (const auto& e : entries)
    if (e.row != e.column) near[std::size_t(e.row)].push_back(e.column);
  for (auto& list : near) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  const auto fewer = [&](int a, int b) {
    return std::pair(near[std::size_t(a)].size(), a) < std::pair(near[std::size_t(b)].size(), b);
  };
  std::vector<int> by_degree(std::size_t(rows), 0), order;
  std::iota(by_degree.begin(), by_degree.end(), 0);
  std::ranges::sort(by_degree, fewer);
  std::vector<char> seen(std::size_t(rows), 0);
  for (const int start : by_degree) {
    if (seen[std::size_t(start)]) continue;
    seen[std::size_t(start)] = 1;
    order.push_back(start);
    for (std::size_t next = order.size() - 1; next < order.size(); ++next) {
      std::vector<int> level;
      for (const int r : near[std::size_t(order[next])])
        if (!seen[std::size_t(r)]) seen[std::size_t(r)] = 1, level.push_back(r);
      std::ranges::sort(level, fewer);
      order.insert(order.end(), level.begin(), level.end());
    }
  }
  std::vector<int> place(static_cast<std::size_t>(rows));
  for (std::size_t p = 0; p < order.size(); ++p) place[std::size_t(order[p])] = rows - 1 - int(p);
  return place;
}

/// Sum of products; eight lanes, always added up in the same order.
double inner(const double* a, const double* b, std::ptrdiff_t count) {
  Wide<double, 8> sum = 0.0;
  std::ptrdiff_t at = 0;
  for (; at + 8 <= count; at += 8) sum += Wide<double, 8>::load(a + at) * Wide<double, 8>::load(b + at);
  double rest = 0.0;
  for (; at < count; ++at) rest += a[at] * b[at];
  alignas(64) double lanes[8];
  sum.store(lanes);
  return ((lanes[0] + lanes[4]) + (lanes[1] + lanes[5])) + ((lanes[2] + lanes[6]) + (lanes[3] + lanes[7])) + rest;
}

}  // namespace

void BlockElimination::factorise(int rows, std::span<const Entry> entries) {
  place_ = order_rows(rows, entries);
  const std::size_t count = std::size_t(rows);
  low_.resize(count), begin_.resize(count);
  std::iota(low_.begin(), low_.end(), 0);
  for (const Entry& e : entries) {
    const int r = place_[std::size_t(e.row)], c = place_[std::size_t(e.column)];
    int& low = low_[std::size_t(std::max(r, c))];
    low = std::min(low, std::min(r, c));
  }
  std::size_t size = 0;
  for (std::size_t i = 0; i < count; ++i) begin_[i] = size, size += 25 * (i - std::size_t(low_[i]));
  lower_.assign(size, 0.0), upper_.assign(size, 0.0), pivots_.assign(25 * count, 0.0);
  for (const Entry& e : entries) {
    const int r = place_[std::size_t(e.row)], c = place_[std::size_t(e.column)];
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b) {
        const double value = e.block[std::size_t(b * n + a)];
        if (r == c)
          pivots_[25 * std::size_t(r) + std::size_t(a * n + b)] += value;
        else if (r > c)
          lower_[at(r, a) + std::size_t(n * (c - low_[std::size_t(r)]) + b)] += value;
        else
          upper_[at(c, b) + std::size_t(n * (r - low_[std::size_t(c)]) + a)] += value;
      }
  }
  using Block = Eigen::Matrix<double, n, n, Eigen::RowMajor>;
  for (int i = 0; i < rows; ++i) {
    const int first = low_[std::size_t(i)];
    for (int j = first; j < i; ++j) {
      const int from = std::max(first, low_[std::size_t(j)]);
      const std::ptrdiff_t length = std::ptrdiff_t(n) * (j - from);
      const std::size_t own = std::size_t(n * (from - first)), others = std::size_t(n * (from - low_[std::size_t(j)]));
      Block l;
      for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) {
          const std::size_t block = std::size_t(n * (j - first));
          l(a, b) =
              lower_[at(i, a) + block + std::size_t(b)] - inner(&lower_[at(i, a) + own], &upper_[at(j, b) + others], length);
          // Here a is the column of the upper part, b its row.
          upper_[at(i, a) + block + std::size_t(b)] -= inner(&lower_[at(j, b) + others], &upper_[at(i, a) + own], length);
        }
      const Block scaled = l * Eigen::Map<const Block>(&pivots_[25 * std::size_t(j)]);
      for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) lower_[at(i, a) + std::size_t(n * (j - first) + b)] = scaled(a, b);
    }
    Eigen::Map<Block> pivot(&pivots_[25 * std::size_t(i)]);
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        pivot(a, b) -= i > first ? inner(&lower_[at(i, a)], &upper_[at(i, b)], std::ptrdiff_t(n) * (i - first)) : 0.0;
    const Block inverse = pivot.partialPivLu().inverse();
    if (!inverse.allFinite())
      throw SingularMatrix("flow: the coarse matrix is singular in row " + std::to_string(i) + " of its elimination");
    pivot = inverse;
  }
}

void BlockElimination::solve(std::span<const double> b, std::span<double> x) const {
  const int rows = int(place_.size());
  std::vector<double> y(std::size_t(rows) * n);
  for (int r = 0; r < rows; ++r) std::copy_n(&b[std::size_t(r) * n], n, &y[std::size_t(place_[std::size_t(r)]) * n]);
  for (int i = 0; i < rows; ++i) {
    const int first = low_[std::size_t(i)];
    if (first == i) continue;
    for (int a = 0; a < n; ++a)
      y[std::size_t(i * n + a)] -= inner(&lower_[at(i, a)], &y[std::size_t(first) * n], std::ptrdiff_t(n) * (i - first));
  }
  for (int i = rows - 1; i >= 0; --i) {
    double value[n];
    for (int a = 0; a < n; ++a) {
      value[a] = 0.0;
      for (int c = 0; c < n; ++c) value[a] += pivots_[25 * std::size_t(i) + std::size_t(a * n + c)] * y[std::size_t(i * n + c)];
    }
    const int first = low_[std::size_t(i)];
    for (int c = 0; c < n; ++c) {
      y[std::size_t(i * n + c)] = value[c];
      const double* column = upper_.data() + at(i, c);
      double* to = y.data() + std::size_t(first) * n;
      for (std::ptrdiff_t k = 0; k < std::ptrdiff_t(n) * (i - first); ++k) to[k] -= column[k] * value[c];
    }
  }
  for (int r = 0; r < rows; ++r) std::copy_n(&y[std::size_t(place_[std::size_t(r)]) * n], n, &x[std::size_t(r) * n]);
}

}  // namespace spindrift::aero
