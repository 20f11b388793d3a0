// Block ILU(0): exact on a line, the textbook product of its factors in a box, and the product of the matrix itself.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/linear/block_ilu.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <vector>

using namespace spindrift::linear;

namespace {

/// A diagonally heavy random matrix over a box, also as a dense one.
template <int n, class SideNumber = float>
struct Example {
  CellBox box;
  int directions;
  std::vector<float> data;
  Eigen::MatrixXd dense;
  StencilMatrix<n, SideNumber> a;

  Example(CellBox box, int directions)
      : box(box), directions(directions), data(StencilMatrix<n, SideNumber>::size(box, directions)) {
    a = {data.data(), box, directions};
    dense.setZero(box.count() * n, box.count() * n);
    std::srand(7);
    std::ptrdiff_t cell = 0;
    for (int k = 0; k < box.nk; ++k)
      for (int j = 0; j < box.nj; ++j)
        for (int i = 0; i < box.ni; ++i, ++cell) {
          const int at[3] = {i, j, k}, end[3] = {box.ni, box.nj, box.nk};
          fill(cell, cell, a.block(cell, a.diagonal), 8.0f);
          for (int d = 0; d < directions; ++d) {
            fill(cell, at[d] > 0 ? cell - box.stride(d) : -1, a.side(cell, 2 * d), 0.0f);
            fill(cell, at[d] + 1 < end[d] ? cell + box.stride(d) : -1, a.side(cell, 2 * d + 1), 0.0f);
          }
        }
  }
  /// Neighbours outside the box get numbers too: the ILU must not look at them.
  template <class Number>
  void fill(std::ptrdiff_t row, std::ptrdiff_t column, Number* block, float on_diagonal) {
    Eigen::Matrix<float, n, n> numbers = Eigen::Matrix<float, n, n>::Random();
    numbers.diagonal().array() += on_diagonal;
    for (int e = 0; e < n * n; ++e) block[e] = Number(numbers.data()[e]);
    if (column >= 0) dense.block(row * n, column * n, n, n) = as_double(block);
  }
  template <class Number>
  static Eigen::MatrixXd as_double(const Number* block) {
    Eigen::MatrixXd numbers(n, n);
    for (int e = 0; e < n * n; ++e) numbers.data()[e] = double(float(block[e]));
    return numbers;
  }
  Eigen::VectorXd solved(const Eigen::VectorXd& r) const {
    std::vector<float> in(r.size()), out(r.size());
    for (int m = 0; m < r.size(); ++m) in[std::size_t(m)] = float(r[m]);
    solve(a, in.data(), out.data());
    Eigen::VectorXd z(r.size());
    for (int m = 0; m < r.size(); ++m) z[m] = double(out[std::size_t(m)]);
    return z;
  }
};

/// (L + P^-1) P (P^-1 + U) from the pivots that factor() left.
template <int n, class SideNumber>
Eigen::MatrixXd product_of_factors(const Example<n, SideNumber>& e) {
  Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(e.dense.rows(), e.dense.cols()), upper = lower, pivots = lower;
  for (std::ptrdiff_t row = 0; row < e.box.count(); ++row) {
    Eigen::Map<Eigen::Matrix<float, n, n>> pivot(e.a.block(row, 1));
    const Eigen::MatrixXd inverse = pivot.template cast<double>();
    pivots.block(row * n, row * n, n, n) = inverse;
    lower.block(row * n, row * n, n, n) = upper.block(row * n, row * n, n, n) = inverse.inverse();
    lower.block(row * n, 0, n, row * n) = e.dense.block(row * n, 0, n, row * n);
    const auto after = e.dense.cols() - (row + 1) * n;
    upper.block(row * n, (row + 1) * n, n, after) = e.dense.block(row * n, (row + 1) * n, n, after);
  }
  return lower * pivots * upper;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("block ILU(0) of a line of cells is its exact solution", "[linear][fast]",
                       ((int n, class SideNumber), n, SideNumber), (1, float), (2, float), (5, float), (5, ShortFloat)) {
  Example<n, SideNumber> e({40, 1, 1}, 3);
  REQUIRE(factor(e.a) == -1);
  const Eigen::VectorXd r = Eigen::VectorXd::Random(e.dense.rows()), z = e.solved(r);
  CHECK((e.dense * z - r).norm() < 2e-6 * r.norm());
}

TEMPLATE_TEST_CASE_SIG("block ILU(0) of a box keeps the matrix where it has entries", "[linear][fast]",
                       ((int n, class SideNumber), n, SideNumber), (1, float), (2, float), (5, float), (5, ShortFloat)) {
  for (const int directions : {2, 3}) {
    Example<n, SideNumber> e({5, 4, directions == 3 ? 3 : 1}, directions);
    REQUIRE(factor(e.a) == -1);
    const Eigen::MatrixXd m = product_of_factors(e);
    for (int r = 0; r < m.rows(); ++r)
      for (int c = 0; c < m.cols(); ++c)
        if (e.dense(r, c) != 0.0) CHECK(m(r, c) == Approx(e.dense(r, c)).margin(1e-5));
    const Eigen::VectorXd r = Eigen::VectorXd::Random(m.rows()), z = e.solved(r);
    CHECK((m * z - r).norm() < 2e-6 * r.norm());
  }
}

TEMPLATE_TEST_CASE_SIG("the product with a vector reads ghosts of the box", "[linear][fast]",
                       ((int n, class SideNumber), n, SideNumber), (1, float), (2, float), (5, float), (5, ShortFloat)) {
  Example<n, SideNumber> e({6, 5, 4}, 3);
  const int row = 8, plane = 8 * 7, origin = plane + row + 1, component = plane * 6;
  std::vector<float> x(std::size_t(component * n));
  for (float& number : x) number = float(std::rand()) / float(RAND_MAX) - 0.5f;
  std::vector<float> y(std::size_t(e.box.count() * n));
  multiply(e.a, x.data(), {origin, row, plane, component}, y.data());
  const std::ptrdiff_t steps[6] = {-1, 1, -row, row, -plane, plane};
  double error = 0.0;
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 6; ++i) {
        const std::ptrdiff_t cell = (k * 5 + j) * 6 + i, at = origin + k * plane + j * row + i;
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(n);
        const auto add = [&](const auto* block, std::ptrdiff_t from) {
          Eigen::Map<Eigen::Matrix<float, n, 1>, 0, Eigen::InnerStride<>> value(x.data() + from, Eigen::InnerStride<>(component));
          sum += e.as_double(block) * value.template cast<double>();
        };
        add(e.a.block(cell, e.a.diagonal), at);
        for (int side = 0; side < 6; ++side) add(e.a.side(cell, side), at + steps[side]);
        for (int c = 0; c < n; ++c) error = std::max(error, std::abs(sum[c] - double(y[std::size_t(cell * n + c)])));
      }
  CHECK(error < 5e-6);
}

TEST_CASE("a singular pivot is named by its cell", "[linear][fast]") {
  Example<2> e({4, 3, 1}, 2);
  for (int m = 0; m < 4; ++m) e.a.block(7, e.a.diagonal)[m] = 0.0f;
  for (int side = 0; side < 4; ++side)
    for (int m = 0; m < 4; ++m) e.a.side(7, side)[m] = 0.0f;
  CHECK(factor(e.a) == 7);
}

TEST_CASE("numbers of sides with few digits leave the sum of a row of blocks as it is", "[linear][fast]") {
  using Matrix = StencilMatrix<5, ShortFloat>;
  const CellBox box{2, 1, 1};
  std::vector<float> data(Matrix::size(box, 3));
  const Matrix a{data.data(), box, 3};
  CHECK(data.size() == 2 * (2 * 25 + 6 * 25 / 2) + block_overrun);
  double exact = 0.0, rounded = 0.0, largest = 0.0;
  for (int side = 0; side < 6; ++side) {
    const float value = 1.0f + 0.1234567f * float(side);
    a.put_side(1, side, 7, value);
    exact += double(value), rounded += double(float(a.side(1, side)[7]));
    largest = std::max(largest, std::abs(double(value) - double(float(a.side(1, side)[7]))));
  }
  CHECK(largest > 1e-4);
  CHECK(rounded + double(a.block(1, a.diagonal)[7]) == Approx(exact).epsilon(1e-6));
}
