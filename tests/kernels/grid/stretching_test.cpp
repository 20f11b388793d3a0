// Sizes along a line: sums, ends, limits.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/grid/stretching.hpp"

#include <catch2/catch.hpp>
#include <numeric>
#include <vector>

using namespace spindrift;

TEST_CASE("geometric sizes begin as asked, keep their ratio and fill the length", "[grid][fast]") {
  const auto first = GENERATE(1e-6, 1e-3, 0.1, 1.0);
  const auto cells = GENERATE(4, 31);
  std::vector<double> size(static_cast<std::size_t>(cells));
  geometric_sizes(first, 3.0, size);
  CHECK(std::accumulate(size.begin(), size.end(), 0.0) == Approx(3.0).epsilon(1e-13));
  CHECK(size[0] == Approx(first).epsilon(1e-9));
  for (std::size_t i = 2; i < size.size(); ++i) CHECK(size[i] / size[i - 1] == Approx(size[1] / size[0]).epsilon(1e-12));
}

TEST_CASE("limited sizes never pass their limit, however thin the first", "[grid][fast]") {
  const auto first = GENERATE(1e-7, 1e-5, 1e-3);
  std::vector<double> size(40);
  limited_sizes(first, 0.2, 4.0, size);
  CHECK(std::accumulate(size.begin(), size.end(), 0.0) == Approx(4.0).epsilon(1e-13));
  CHECK(size[0] == Approx(first).epsilon(0.01));
  CHECK(*std::max_element(size.begin(), size.end()) < 0.2);
  CHECK(std::is_sorted(size.begin(), size.end()));
}
