// Water that is beyond its bounds is named: the particle, where it is, its value and the limit; the worst of all ranks.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/bounds.hpp"

#include <catch2/catch.hpp>

#include "src/sea/sph/ordering.hpp"
#include "tests/src/sea/sph/scenes.hpp"

using namespace spindrift::sph;

namespace {

constexpr double d = 0.1;

/// A block of water over a wall of which two particles, by identity, have another speed or density deviation.
std::optional<Beyond> judged(std::size_t first, double speed, std::size_t second, double deviation) {
  Parameters p;
  p.spacing = d, p.h_over_d = 1.5, p.eos = {1000.0, 20.0};
  std::vector<Seed<2>> seeds = disordered_block<2>(d, {12, 12}, {0.0, 0.0}, true);
  seeds[first].velocity = {speed, 0.0}, seeds[second].deviation = deviation;
  Store<2, float> store;
  fill<2, float>(store, seeds, Columns<2>(domain_around<2>({0.0, 0.0}, 1.2), 2.0 * p.reach(), 2.0 * p.reach()), p.anchor_step());
  return beyond_bounds<2>(store, p, MPI_COMM_SELF);
}

}  // namespace

TEST_CASE("water below its speed of sound and within half of its density is within bounds", "[sea][sph][fast]") {
  CHECK_FALSE(judged(60, 19.9, 70, 499.0));
  CHECK_FALSE(judged(60, -19.9, 70, -499.0));
  CHECK_FALSE(judged(3, 1e3, 4, 1e4));  // of the wall
}

TEST_CASE("the particle that is farthest beyond a bound is named with value and limit", "[sea][sph][fast]") {
  const auto fast = judged(60, 30.0, 70, -501.0);
  REQUIRE(fast);
  CHECK_FALSE(fast->dense);
  CHECK(fast->particle == 60);
  CHECK(fast->value == 30.0);
  CHECK(fast->limit == 20.0);
  CHECK(fast->describe(2).find("sea: the speed of particle 60 at (") == 0);
  CHECK(fast->describe(2).find("came to 30 m/s, the limit is 20 m/s") != std::string::npos);
  const auto torn = judged(60, 21.0, 70, -800.0);
  REQUIRE(torn);
  CHECK(torn->dense);
  CHECK(torn->value == Approx(200.0));
  CHECK(torn->limit == Approx(500.0));
  const auto none = judged(60, std::numeric_limits<double>::quiet_NaN(), 70, 2000.0);
  REQUIRE(none);
  CHECK(none->particle == 60);
}
