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

TEST_CASE("water at rest on compressed rows has the mass that its density and its place say", "[sph][fast]") {
  Parameters p;
  p.spacing = 0.05, p.eos = {1000.0, 10.0 * std::sqrt(9.81)};
  const int rows = 20;
  const double depth = rows * p.spacing;
  p.mass_factor = p.eos.mean_density_ratio(depth, p.gravity);
  CHECK(p.mass_factor == Approx(1.0 + 0.5 * 0.01).margin(2e-4));  // 1 + g H/(2 c0^2)
  std::vector<Seed<2>> seeds;
  add_water_at_rest<2>(seeds, {0, 0}, p, {0, 0}, {1, rows});
  const auto z = [&](int row) { return seeds[row].position[1]; };
  CHECK(z(0) > -0.5 * p.spacing);
  CHECK(depth - 0.5 * p.spacing - z(rows - 1) == Approx(0.5 * p.spacing).epsilon(0.02));
  for (int row = 1; row + 1 < rows; ++row) {
    const double volume = 0.5 * (z(row + 1) - z(row - 1)) * p.spacing;
    CHECK(p.mass(2) / volume == Approx(p.eos.rho0 + seeds[row].deviation).epsilon(1e-5));
    CHECK(seeds[row].deviation == Approx(p.eos.hydrostatic_deviation(depth - 0.5 * p.spacing - z(row), p.gravity)));
  }
}
