// Products and inverses of small blocks against Eigen in double.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/linear/small_block.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>

using namespace spindrift::linear;

namespace {

template <int n>
void compare_with_eigen() {
  using Matrix = Eigen::Matrix<float, n, n>;
  std::srand(n);
  for (int trial = 0; trial < 20; ++trial) {
    float a[n * n + block_overrun] = {}, b[n * n + block_overrun] = {}, c[n * n + block_overrun] = {}, x[n], y[n];
    Eigen::Map<Matrix> ma(a), mb(b), mc(c);
    Eigen::Map<Eigen::Matrix<float, n, 1>> vx(x), vy(y);
    ma.setRandom(), mb.setRandom(), vx.setRandom(), mc.setRandom();
    const Matrix before = mc;
    multiply<n>(a, x, y);
    CHECK((vy - ma * vx).norm() < 1e-6f * float(n));
    subtract_product<n>(a, b, c);
    CHECK((mc - (before - ma * mb)).norm() < 1e-6f * float(n * n));
    multiply_blocks<n>(a, b, c);
    CHECK((mc - ma * mb).norm() < 1e-6f * float(n * n));
    REQUIRE(invert<n>(a, c));
    const Eigen::MatrixXd exact = ma.template cast<double>().inverse();
    CHECK((mc.template cast<double>() - exact).norm() < 1e-6 * exact.norm());
  }
}

}  // namespace

TEST_CASE("products and inverses of small blocks agree with Eigen", "[linear][fast]") {
  compare_with_eigen<1>();
  compare_with_eigen<2>();
  compare_with_eigen<5>();
}

TEST_CASE("a zero on the diagonal is no obstacle, a singular or broken block is reported", "[linear][fast]") {
  float swap[4] = {0, 2, 2, 0}, inverse[4];
  REQUIRE(invert<2>(swap, inverse));
  CHECK(inverse[1] == 0.5f);
  float singular[4] = {1, 2, 2, 4};
  CHECK_FALSE(invert<2>(singular, inverse));
  float broken[4] = {1, 0, NAN, 1};
  CHECK_FALSE(invert<2>(broken, inverse));
}
