// Spacing laws: sums, ends, limits, and that one law on twice as many cells is the same law.
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

TEST_CASE("Vinokur's law has the slopes asked for at both ends and only grows", "[grid][fast]") {
  const auto slope0 = GENERATE(0.01, 0.3, 1.0, 2.5);
  const auto slope1 = GENERATE(0.002, 0.5, 1.0, 3.0);
  const Vinokur law(slope0, slope1);
  CHECK(law(0.0) == Approx(0.0).margin(1e-14));
  CHECK(law(1.0) == Approx(1.0).epsilon(1e-14));
  const double d = 1e-7;
  CHECK(law(d) / d == Approx(slope0).epsilon(2e-4));
  CHECK((1.0 - law(1.0 - d)) / d == Approx(slope1).epsilon(2e-4));
  double last = 0.0;
  for (int i = 1; i <= 100; ++i) {
    CHECK(law(i / 100.0) > last);
    last = law(i / 100.0);
  }
}
