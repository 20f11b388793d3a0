// Laws of src/sea/sph/lattice.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/lattice.hpp"

#include <catch2/catch.hpp>

using namespace spindrift::sph;

TEST_CASE("a block of water has the count and the hydrostatic density of its lattice", "[sph][fast]") {
  const EosTait eos{1000.0, 20.0};
  std::vector<Seed<3>> seeds;
  add_water<3>(seeds, {1, 2, 3}, 0.1, {0, 0, 0}, {4, 5, 6}, eos, 9.81, 3.6);
  REQUIRE(seeds.size() == 120);
  for (const auto& seed : seeds) {
    CHECK(seed.deviation == Approx(eos.hydrostatic_deviation(3.6 - seed.position[2], 9.81)));
    CHECK(seed.owner == 0);
  }
  CHECK(seeds.front().position == std::array<double, 3>{1, 2, 3});
  CHECK(seeds.back().position[2] == Approx(3.5));
}

TEST_CASE("a tank surrounds its inside on all sides but the top", "[sph][fast]") {
  const int layers = GENERATE(1, 3);
  std::vector<Seed<3>> seeds;
  add_tank<3>(seeds, {0, 0, 0}, 1.0, {0, 0, 0}, {4, 5, 6}, layers, {}, 9.81, 0.0, 2);
  CHECK(seeds.size() == std::size_t((4 + 2 * layers) * (5 + 2 * layers) * (6 + layers) - 4 * 5 * 6));
  for (const auto& seed : seeds) CHECK((seed.owner == 2 && seed.position[2] < 6.0));
  std::vector<Seed<2>> flat;
  add_tank<2>(flat, {0, 0}, 1.0, {0, 0}, {4, 6}, layers, {}, 9.81, 0.0);
  CHECK(flat.size() == std::size_t((4 + 2 * layers) * (6 + layers) - 24));
}
