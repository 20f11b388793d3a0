// The state by identity: the same for any number of ranks, put back bit for bit, lost particles included; instruments on ranks.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/by_identity.hpp"

#include <catch2/catch.hpp>

#include "src/sea/sph/gauges.hpp"
#include "tests/src/sea/sph/scenes.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

struct Pool {
  Parameters p;
  std::vector<Seed<2>> seeds = disordered_block<2>(0.1, {40, 12}, {0.0, 0.0}, true);
  Domain<2> domain{{-0.5, -0.5}, {5.0, 1.5}};

  explicit Pool(StepChoice step = StepChoice::symplectic) {
    p.spacing = 0.1, p.eos = {1000.0, 20.0}, p.step = step, p.lost_at_most = 1;
    seeds.back().velocity = {0.0, 60.0};  // leaves through the top
  }
};

/// All ranks' runs of values one after the other.
template <class Sea>
std::vector<double> values_of(const Sea& sea, std::size_t particles, MPI_Comm comm) {
  runtime::Packer mine;
  mine.put(std::span<const double>(by_identity(sea, particles, comm).values));
  std::vector<double> all;
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take())) {
    const auto theirs = runtime::Unpacker(bytes).template many<double>();
    all.insert(all.end(), theirs.begin(), theirs.end());
  }
  return all;
}

void goes_back_bit_for_bit(StepChoice step, MPI_Comm comm) {
  const Pool scene(step);
  SeaSph<2, float> sea(scene.p, scene.domain, scene.seeds, {.comm = comm, .threads = 1});
  const auto mine = identities_of(scene.seeds.size(), runtime::rank_in(comm), runtime::ranks_in(comm));
  std::vector<std::uint16_t> owner;
  for (std::size_t id = mine.first; id < mine.last; ++id) owner.push_back(scene.seeds[id].owner);
  for (int n = 0; n < 40; ++n) sea.step(1.0);
  sea.sort();
  REQUIRE(sea.store().lost.size() == 1);
  const auto saved = by_identity(sea, scene.seeds.size(), comm);
  const double time = sea.time();
  const long steps = sea.state().work.steps;
  for (int n = 0; n < 10; ++n) sea.step(1.0);
  const std::vector<double> first = values_of(sea, scene.seeds.size(), comm);
  set_by_identity<2, float>(sea, mine, saved.values, owner, time, steps);
  CHECK(sea.store().lost.size() == 1);
  CHECK(sea.time() == time);
  for (int n = 0; n < 10; ++n) sea.step(1.0);
  CHECK(values_of(sea, scene.seeds.size(), comm) == first);
  // A fresh sea that never lost or moved anything goes on the same way.
  SeaSph<2, float> other(scene.p, scene.domain, scene.seeds, {.comm = comm, .threads = 1});
  set_by_identity<2, float>(other, mine, saved.values, owner, time, steps);
  for (int n = 0; n < 10; ++n) other.step(1.0);
  CHECK(values_of(other, scene.seeds.size(), comm) == first);
}

void visits_what_is_wanted(MPI_Comm comm) {
  const Pool scene;
  SeaSph<2, float> sea(scene.p, scene.domain, scene.seeds, {.comm = comm, .threads = 1});
  for (int n = 0; n < 40; ++n) sea.step(1.0);
  sea.sort();
  REQUIRE(sea.store().lost.size() == 1);
  const auto all = by_identity(sea, scene.seeds.size(), comm);
  std::vector<std::uint32_t> expected, visited;
  const auto wanted = [](std::uint16_t owner, const std::array<double, 2>& x) { return owner == 0 && x[0] < 2.0; };
  for (std::size_t id = all.range.first; id < all.range.last; ++id) {
    const double* x = &all.values[5 * (id - all.range.first)];
    if (id != sea.store().lost[0].id && wanted(scene.seeds[id].owner, {x[0], x[1]})) expected.push_back(std::uint32_t(id));
  }
  std::size_t count = 0, wrong = 0;
  visit_by_identity(
      sea, scene.seeds.size(), comm, wanted, [&](std::size_t n) { count = n; },
      [&](std::uint32_t id, std::uint16_t owner, std::span<const double> values) {
        visited.push_back(id);
        wrong += owner != 0 || !std::equal(values.begin(), values.end(), &all.values[5 * (id - all.range.first)]);
      });
  CHECK(visited.size() > 10);
  CHECK(visited == expected);
  CHECK(count == visited.size());
  CHECK(wrong == 0);
}

}  // namespace

TEST_CASE("runs of identities share out all particles, and each knows its rank", "[sph][identity][fast]") {
  for (const std::size_t particles : {1u, 7u, 1000u})
    for (const int ranks : {1, 2, 3, 8}) {
      std::size_t next = 0;
      for (int rank = 0; rank < ranks; ++rank) {
        const IdentityRange range = identities_of(particles, rank, ranks);
        CHECK(range.first == next);
        for (std::size_t id = range.first; id < range.last; ++id)
          if (rank_of_identity(id, particles, ranks) != rank) FAIL("identity " << id << " of " << particles << " on " << ranks);
        next = range.last;
      }
      CHECK(next == particles);
    }
}

TEST_CASE("a state by identity goes back in bit for bit, with what was lost, with either step", "[sph][identity][fast]") {
  goes_back_bit_for_bit(GENERATE(StepChoice::symplectic, StepChoice::verlet), MPI_COMM_SELF);
}

TEST_CASE("particles that are wanted are visited by identity", "[sph][identity][fast]") { visits_what_is_wanted(MPI_COMM_SELF); }

TEST_CASE("a state of another sea is refused", "[sph][identity][fast]") {
  const Pool scene;
  SeaSph<2, float> sea(scene.p, scene.domain, scene.seeds);
  const std::vector<double> few(5);
  const std::vector<std::uint16_t> owner(scene.seeds.size());
  CHECK_THROWS_AS((set_by_identity<2, float>(sea, {0, scene.seeds.size()}, few, owner, 0.0, 0)), std::invalid_argument);
}

TEST_CASE("on two ranks the state by identity and all instruments have the bits of one", "[sph][identity][mpi2]") {
  const Pool scene;
  SeaSph<2, float> alone(scene.p, scene.domain, scene.seeds, {.threads = 1});
  SeaSph<2, float> sea(scene.p, scene.domain, scene.seeds, {.comm = MPI_COMM_WORLD, .threads = 1});
  for (int n = 0; n < 20; ++n) alone.step(1.0), sea.step(1.0);
  CHECK(values_of(sea, scene.seeds.size(), MPI_COMM_WORLD) == values_of(alone, scene.seeds.size(), MPI_COMM_SELF));
  std::vector<std::array<double, 1>> places;
  for (int n = 0; n < 20; ++n) places.push_back({0.1 + 0.2 * n});
  places.push_back({4.8});  // dry
  CHECK(surface_heights<2>(sea.store(), sea.parameters(), scene.domain, std::span<const std::array<double, 1>>(places), -9.0,
                           MPI_COMM_WORLD) == surface_heights<2>(alone.store(), alone.parameters(), scene.domain,
                                                                 std::span<const std::array<double, 1>>(places), -9.0));
  for (const double x : {0.3, 1.9, 2.0, 2.1, 3.5}) {
    const auto one = probe<2>(alone.store(), alone.parameters(), scene.domain, {x, 0.5});
    const auto two = probe<2>(sea.store(), sea.parameters(), scene.domain, {x, 0.5}, MPI_COMM_WORLD);
    CHECK(one.pressure == two.pressure);
    CHECK(one.velocity == two.velocity);
  }
}
TEST_CASE("a state by identity goes back in bit for bit on two ranks", "[sph][identity][mpi2]") {
  goes_back_bit_for_bit(StepChoice::symplectic, MPI_COMM_WORLD);
}

TEST_CASE("particles that are wanted are visited by identity on two ranks", "[sph][identity][mpi2]") {
  visits_what_is_wanted(MPI_COMM_WORLD);
}
