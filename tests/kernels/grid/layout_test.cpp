// SPDX-License-Identifier: Apache-2.0
#include "kernels/grid/layout.hpp"

#include <catch2/catch.hpp>

#include <set>

using namespace spindrift;

TEST_CASE("every cell and face ghost of a box has a place of its own, with i = 0 on a line", "[grid][fast]") {
  const int ni = GENERATE(1, 4, 7, 8, 13), ghosts = GENERATE(0, 1, 2), components = 3;
  const BoxLayout box(ni, 3, 2, {ghosts, ghosts, ghosts});
  std::set<std::ptrdiff_t> places;
  std::size_t asked = 0;
  for (int c = 0; c < components; ++c)
    for (int k = -ghosts; k < 2 + ghosts; ++k)
      for (int j = -ghosts; j < 3 + ghosts; ++j) {
        CHECK((c * box.component + box.at(k, j, 0)) % row_lanes == 0);
        for (int i = -ghosts; i < ni + ghosts; ++i, ++asked) places.insert(c * box.component + box.at(k, j, i));
      }
  CHECK(places.size() == asked);
  CHECK(*places.begin() >= 0);
  CHECK(std::size_t(*places.rbegin()) + load_overrun <= box.size(components));
}
