// Fields on the nodes of a grid: second order where the solution is known, no extremes between what is given, one value for nodes
// that are one, refusals, the same on two ranks to tolerance. SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/node_field.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "src/aero/grid/generators/box.hpp"
#include "src/aero/grid/generators/plane_cases.hpp"
#include "tests/order.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Eigen::Vector3d;

namespace {

MultiBlockGrid skewed_box(int n) {
  const BoxOptions box{.ni = n, .nj = n, .nk = n};
  return perturbed(cartesian_box(box), box, 0.05);
}
const std::vector<std::string> all_sides{"i_min", "i_max", "j_min", "j_max", "k_min", "k_max"};

}  // namespace

TEST_CASE("a field between two circles is the logarithm of the radius, to second order; stiff near the inner one, its known law",
          "[grid][fast]") {
  for (const double stiffness : {0.0, 1.0}) {
    std::vector<double> h, error;
    for (const int n : {32, 64, 128}) {
      const double a = 0.5, far = 4.0;
      const MultiBlockGrid grid =
          cylinder({.around = n, .outward = int(n * std::log(far / a) / 6.283), .radius = a, .far = far, .first_cell = 0.02});
      const std::vector<std::string> wall{"wall"};
      NodeField field(grid, {"wall", "farfield"}, wall, {.stiffness = stiffness});
      const NodeField::Values f = field.solve([](int patch, const Vector3d&) { return patch == 0 ? 1.0 : 0.0; });
      // (r k f')' = 0 with k = 1 or 1 / (r - a): f' goes with 1 / r or (r - a) / r.
      const auto integral = [&](double r) { return stiffness == 0.0 ? std::log(r / a) : r - a - a * std::log(r / a); };
      double squares = 0.0;
      for (std::size_t m = 0; m < f[0].size(); ++m) {
        const Vector3d& x = grid.blocks[0].nodes[m];
        const double off = f[0][m] - (1.0 - integral(std::hypot(x[0], x[2])) / integral(far));
        squares += off * off;
      }
      h.push_back(1.0 / n), error.push_back(std::sqrt(squares / double(f[0].size())));
    }
    CAPTURE(stiffness, error);
    CHECK(observed_order(h, error) > 1.8);
    CHECK(error[2] < 1e-3);
  }
}

TEST_CASE("a field on leaning cells has no extremes between what is given, and what is the same everywhere stays so",
          "[grid][fast]") {
  const MultiBlockGrid grid = skewed_box(10);
  NodeField field(grid, all_sides, std::vector<std::string>{"i_min"});
  const auto wavy = [](int, const Vector3d& x) { return std::sin(7.0 * x[0]) * std::cos(5.0 * x[1] + 3.0 * x[2]); };
  double low = 1.0, high = -1.0, inner_low = 1.0, inner_high = -1.0;
  const NodeField::Values f = field.solve(wavy);
  const Block& b = grid.blocks[0];
  for (int k = 0; k <= b.nk; ++k)
    for (int j = 0; j <= b.nj; ++j)
      for (int i = 0; i <= b.ni; ++i) {
        const bool side = i == 0 || j == 0 || k == 0 || i == b.ni || j == b.nj || k == b.nk;
        const double value = f[0][b.node(k, j, i)];
        if (side) CHECK(value == wavy(0, b.nodes[b.node(k, j, i)]));
        (side ? low : inner_low) = std::min(side ? low : inner_low, value),
                      (side ? high : inner_high) = std::max(side ? high : inner_high, value);
      }
  CHECK(inner_low > low);
  CHECK(inner_high < high);
  const NodeField::Values even = field.solve([](int, const Vector3d&) { return 0.3; });
  for (const double value : even[0]) CHECK(value == 0.3);
}

TEST_CASE("nodes that are one have one value: across a wake's cut and through the thickness of a planar grid", "[grid][fast]") {
  const MultiBlockGrid grid = naca0012({.n = 1, .far = 20.0});
  NodeField field(grid, {"wall", "farfield", "outflow"}, std::vector<std::string>{"wall"});
  const NodeField::Values f = field.solve([](int patch, const Vector3d&) { return patch == 0 ? 1.0 : 0.0; });
  std::map<std::array<double, 3>, double> seen;
  const Block& b = grid.blocks[0];
  for (std::size_t n = 0; n < f[0].size(); ++n) {
    const auto [at, fresh] = seen.try_emplace({b.nodes[n][0], 0.0, b.nodes[n][2]}, f[0][n]);
    CHECK(at->second == f[0][n]);
  }
  CHECK(seen.size() < f[0].size() / 2);
  CHECK(field.unknowns() < int(seen.size()));
}

TEST_CASE("a field with nothing given, or not solved in the cycles allowed, is refused", "[grid][fast]") {
  const MultiBlockGrid grid = skewed_box(6);
  CHECK_THROWS_WITH(NodeField(grid, {"wall"}, all_sides), Catch::Contains("no patch"));
  NodeField field(grid, {"i_min", "i_max"}, all_sides, {.most = 1});
  CHECK_THROWS_WITH(field.solve([](int patch, const Vector3d&) { return double(patch); }), Catch::Contains("after 1 cycles"));
  CHECK_THROWS_WITH(field.solve([](int, const Vector3d&) { return std::nan(""); }), Catch::Contains("not finite"));
}

TEST_CASE("two ranks find the field of one to tolerance", "[grid][mpi2]") {
  const MultiBlockGrid grid = skewed_box(12);
  const auto value = [](int patch, const Vector3d& x) { return patch + x[1]; };
  NodeField one(grid, {"i_min", "i_max"}, all_sides), two(grid, {"i_min", "i_max"}, all_sides, {}, MPI_COMM_WORLD);
  const NodeField::Values a = one.solve(value), b = two.solve(value);
  double apart = 0.0;
  for (std::size_t n = 0; n < a[0].size(); ++n) apart = std::max(apart, std::abs(a[0][n] - b[0][n]));
  CHECK(apart < 1e-9);
}
