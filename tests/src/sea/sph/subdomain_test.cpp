// What ranks own, show and see fits together, and costs follow the pairs.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/subdomain.hpp"

#include <catch2/catch.hpp>

#include <map>

using namespace spindrift::sph;

TEST_CASE("what one rank shows is what the other sees, and every neighbour of an own group is there", "[sph][fast]") {
  const bool periodic = GENERATE(false, true);
  const int rings = GENERATE(1, 2), ranks = 3;
  const Columns<3> columns(Domain<3>{{0, 0, 0}, {7, 5, 1}, {periodic, false, false}}, 1.0, 1.0);
  std::vector<int> rank_of_group(std::size_t(columns.groups()));
  for (std::size_t g = 0; g < rank_of_group.size(); ++g) rank_of_group[g] = int(g * g % 7) % ranks;
  std::vector<Subdomain> subdomains;
  for (int r = 0; r < ranks; ++r) subdomains.push_back(subdomain_of(columns, rank_of_group, r, rings));
  std::map<std::pair<int, int>, const Subdomain::Border*> border;
  std::size_t owned = 0;
  for (const Subdomain& t : subdomains) {
    owned += t.own.size();
    for (const Subdomain::Border& b : t.borders) border[{t.rank, b.rank}] = &b;
  }
  CHECK(owned == rank_of_group.size());
  for (const auto& [between, b] : border) {
    REQUIRE(border.count({between.second, between.first}) == 1);
    CHECK(b->sent == border[{between.second, between.first}]->received);
    CHECK(std::is_sorted(b->sent.begin(), b->sent.end()));
    for (const int g : b->sent) CHECK(rank_of_group[std::size_t(g)] == between.first);
    for (const int g : b->received) CHECK(rank_of_group[std::size_t(g)] == between.second);
  }
  for (int g = 0; g < columns.groups(); ++g)
    columns.for_forward(g, [&](const Neighbour<3>& near) {
      const int a = rank_of_group[std::size_t(g)], b = rank_of_group[std::size_t(near.group)];
      if (a == b) return;
      const auto &received = border.at({a, b})->received, &sent = border.at({a, b})->sent;
      CHECK(std::binary_search(received.begin(), received.end(), near.group));
      CHECK(std::binary_search(sent.begin(), sent.end(), g));
    });
}

TEST_CASE("one rank has no border", "[sph][fast]") {
  const Columns<2> columns(Domain<2>{{0, 0}, {7, 1}}, 1.0, 1.0);
  const Subdomain whole = whole_subdomain(columns);
  CHECK(whole.borders.empty());
  CHECK(int(whole.own.size()) == columns.groups());
}

TEST_CASE("a group costs what its pairs cost: nothing without water near, more beside more water", "[sph][fast]") {
  const Columns<2> columns(Domain<2>{{0, 0}, {4, 1}}, 1.0, 1.0);
  const auto cost = [&](const std::vector<GroupCount>& counts) { return block_graph(columns, counts).cost; };
  const auto walls = cost({{0, 0, 4}, {1, 0, 4}, {2, 0, 4}, {3, 0, 0}});
  CHECK(walls[3] == 0.0);
  CHECK(walls[0] < 0.1 * cost({{0, 4, 0}, {1, 4, 0}, {2, 0, 0}, {3, 0, 0}})[0]);
  CHECK(cost({{0, 4, 0}, {1, 4, 0}, {2, 0, 0}, {3, 0, 0}})[0] > cost({{0, 4, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}})[0]);
  const auto graph = block_graph(columns, {{0, 4, 0}, {1, 4, 0}, {2, 0, 0}, {3, 0, 0}});
  CHECK(graph.edges.size() == 2);  // empty neighbours exchange nothing
}
