// Laws of the sorting: nobody lost, full clusters, groups that hold what is in them, colours that do not meet, order from state
// alone.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/ordering.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>

#include "tests/src/sea/sph/scenes.hpp"

using namespace spindrift::sph;

namespace {

Store<3, float> sorted_store(const std::vector<Seed<3>>& seeds, const Columns<3>& columns) {
  Store<3, float> store;
  fill(store, SeedStream<3>(seeds), columns, 0.25);
  return store;
}

}  // namespace

TEST_CASE("sorting keeps every particle with its state, in full clusters of one owner inside its column", "[sph][fast]") {
  const auto seeds = disordered_block<3>(1.0, {17, 13, 19}, {0, 0, 0}, true);
  const Columns<3> columns(domain_around<3>({0, 0, 0}, 20.0), 4.0, 4.0);
  const auto store = sorted_store(seeds, columns);
  std::vector<int> seen(seeds.size(), 0);
  for (int g = 0; g < columns.groups(); ++g) {
    for (std::uint32_t cluster = store.groups[g].fluid; cluster < store.groups[g].end; ++cluster) {
      CHECK((store.owner[cluster] == 0) == (cluster < store.groups[g].solid));
      for (std::size_t slot = cluster * cluster_size; slot < (cluster + 1u) * cluster_size; ++slot) {
        if (store.id[slot] == no_particle) continue;
        ++seen[store.id[slot]];
        const Seed<3>& seed = seeds[store.id[slot]];
        REQUIRE(seed.position == std::array<double, 3>{store.x[0][slot], store.x[1][slot], store.x[2][slot]});
        REQUIRE(seed.velocity == std::array<double, 3>{store.v[0][slot], store.v[1][slot], store.v[2][slot]});
        REQUIRE(seed.deviation == store.deviation[slot]);
        REQUIRE(seed.owner == store.owner[cluster]);
        REQUIRE(columns.group(seed.position) == g);
      }
    }
  }
  CHECK(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
  CHECK(store.lost.empty());
}

TEST_CASE("the order after sorting does not depend on the order before", "[sph][fast]") {
  auto seeds = disordered_block<3>(1.0, {12, 9, 10}, {0, 0, 0}, true);
  seeds[100].position = seeds[101].position;  // a tie, which identity decides
  const Columns<3> columns(domain_around<3>({0, 0, 0}, 14.0), 4.0, 4.0);
  auto store = sorted_store(seeds, columns);
  const auto before = store.id;
  for (std::size_t first = 0; first < store.slots(); first += cluster_size) {  // turn each cluster's particles round
    std::size_t count = 0;
    while (count < cluster_size && store.id[first + count] != no_particle) ++count;
    const auto turn = [&](auto& values) { std::reverse(values.begin() + first, values.begin() + first + count); };
    for (int k = 0; k < 3; ++k) turn(store.x[k]), turn(store.v[k]);
    turn(store.deviation), turn(store.id);
  }
  sort(store, columns, 0.25);
  CHECK(store.id == before);
}

TEST_CASE("particles outside the domain, or nowhere, are listed as lost and the others stay", "[sph][fast]") {
  auto seeds = disordered_block<3>(1.0, {6, 6, 6}, {0, 0, 0}, false);
  const Columns<3> columns(domain_around<3>({0, 0, 0}, 8.0), 4.0, 4.0);
  auto store = sorted_store(seeds, columns);
  store.x[2][5] = 1e5;
  store.x[0][9] = std::numeric_limits<double>::quiet_NaN();
  const std::set<std::uint32_t> gone{store.id[5], store.id[9]};
  sort(store, columns, 0.25);
  REQUIRE(store.lost.size() == 2);
  CHECK(std::set<std::uint32_t>{store.lost[0].id, store.lost[1].id} == gone);
  const auto left = std::count_if(store.id.begin(), store.id.end(), [](auto id) { return id != no_particle; });
  CHECK(std::size_t(left) == seeds.size() - 2);
}

TEST_CASE("columns of one colour never add to the same sums, every pair of neighbours occurs once", "[sph][fast]") {
  const bool periodic_x = GENERATE(false, true), periodic_y = GENERATE(false, true);
  const int nx = GENERATE(3, 4, 5, 7), ny = GENERATE(3, 5, 6, 7);
  Domain<3> domain{{0, 0, 0}, {double(nx), double(ny), 1}, {periodic_x, periodic_y, false}};
  const Columns<3> columns(domain, 1.0, 1.0);
  REQUIRE(columns.groups() == nx * ny);
  std::vector<std::multiset<int>> writes(columns.groups());  // what is carried to the next row apart, from groups() on
  std::multiset<std::pair<int, int>> pairs;
  for (int g = 0; g < columns.groups(); ++g) {
    writes[g].insert(g);
    columns.for_forward(g, [&](const Neighbour<3>& n) {
      const int row = n.group / ny, own_row = g / ny;
      REQUIRE(n.in_next_row == (row != own_row));
      writes[g].insert(n.group + (n.in_next_row ? columns.groups() : 0)), pairs.insert(std::minmax(g, n.group));
    });
  }
  for (int a = 0; a < columns.groups(); ++a) {
    REQUIRE(columns.colour(a) < columns.colours());
    for (int b = 0; b < a; ++b) {
      const int dx = std::abs(a / ny - b / ny), dy = std::abs(a % ny - b % ny);
      const bool near = std::min(dx, periodic_x ? nx - dx : dx) <= 1 && std::min(dy, periodic_y ? ny - dy : dy) <= 1;
      REQUIRE(pairs.count(std::minmax(a, b)) == (near ? 1u : 0u));
      if (columns.colour(a) != columns.colour(b)) continue;
      for (int g : writes[a]) REQUIRE(writes[b].count(g) == 0);
    }
  }
}

TEST_CASE("a periodic side narrower than three supports is refused", "[sph][fast]") {
  CHECK_THROWS(Columns<2>(Domain<2>{{0, 0}, {2.5, 1}, {true, false}}, 1.0, 1.0));
}
