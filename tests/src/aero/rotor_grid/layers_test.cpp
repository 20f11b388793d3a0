// A rotor's grid in layers is the one made whole, bit by bit, and so is what is taken of its parts: quality, lengths of edges,
// stations, wall faces, nodes of tiles. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>

#include "src/aero/grid/checks.hpp"
#include "src/aero/grid/store.hpp"
#include "src/aero/grid/tiling.hpp"
#include "src/aero/grid/wall_distance.hpp"
#include "src/aero/rotor_grid/pitching.hpp"
#include "src/aero/rotor_grid/stations.hpp"
#include "tests/src/aero/rotor_grid/example.hpp"

using namespace spindrift;
using namespace spindrift::aero;

namespace {

RotorGridSpec one_of_three() {
  RotorGridSpec spec = GENERATE(spec_of(1.0, 1e-3, 7.0, true), spec_of(1.7, 2e-3), spec_of(2.0, 1e-3, 10.0));
  if (spec.pitch > 0.0 && !spec.whole) spec.sizes.edge = 4, spec.coarsen = 1;
  return spec;
}

template <class Use>
void for_layers(const RotorGridMaker& maker, int at_once, Use&& use) {
  for (int first = 0; first < maker.layers(); first += at_once)
    use(maker.make(first, std::min(maker.layers(), first + at_once), true));
}

/// Of cells that are worst alike, in sectors that are turned, either may be named.
bool alike(const Extreme& a, const Extreme& b) { return a.value == b.value && a.k == b.k && a.block % 10 == b.block % 10; }

std::vector<std::array<double, 12>> sorted(const std::vector<WallSurface::Face>& faces) {
  std::vector<std::array<double, 12>> numbers;
  for (const WallSurface::Face& face : faces) {
    std::array<double, 12>& n = numbers.emplace_back();
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t d = 0; d < 3; ++d) n[3 * c + d] = face[c][Eigen::Index(d)];
  }
  std::ranges::sort(numbers);
  return numbers;
}

}  // namespace

TEST_CASE("a rotor's grid in layers has the nodes of the whole", "[rotor_grid][fast]") {
  const RotorGridSpec spec = one_of_three();
  const RotorGridMaker maker(dtu(), spec);
  const MultiBlockGrid whole = make_rotor_grid(dtu(), spec);
  CHECK(grid_faults(maker.described(), {.nodes = false}).empty());
  REQUIRE(maker.described().blocks.size() == whole.blocks.size());
  CHECK(maker.described().connections.size() == whole.connections.size());
  for (std::size_t b = 0; b < whole.blocks.size(); ++b) {
    CHECK(maker.described().blocks[b].cells() == whole.blocks[b].cells());
    CHECK(maker.described().blocks[b].nodes.empty());
  }
  std::vector<int> seen(whole.blocks.size(), 0);
  for_layers(maker, GENERATE(1, 5, 16), [&](const GridLayers& part) {
    for (std::size_t b = 0; b < whole.blocks.size(); ++b) {
      const Block &piece = part.grid.blocks[b], &all = whole.blocks[b];
      if (part.count[b] > 0) {
        CHECK(part.first[b] == seen[b]);
        seen[b] += part.count[b];
      }
      CHECK(std::equal(piece.nodes.begin(), piece.nodes.end(),
                       all.nodes.begin() + std::ptrdiff_t(piece.nodes.empty() ? 0 : all.node(part.first[b], 0, 0))));
    }
  });
  for (std::size_t b = 0; b < whole.blocks.size(); ++b) CHECK(seen[b] == whole.blocks[b].nk);
}

TEST_CASE("what is taken of a rotor's grid in layers is that of the whole", "[rotor_grid][fast]") {
  const RotorGridSpec spec = one_of_three();
  const RotorGridMaker maker(dtu(), spec);
  const MultiBlockGrid whole = make_rotor_grid(dtu(), spec);
  const std::vector<std::string> patches = {"blade_1", "blade_2", "hub", "far"};
  RotorGridQuality quality;
  EdgeLengths edges(maker.described());
  std::vector<std::vector<BladeStation>> stations;
  std::vector<WallSurface::Face> faces;
  for_layers(maker, GENERATE(1, 3, 16), [&](const GridLayers& part) {
    merge(quality, rotor_grid_quality(part, blade_walls()));
    edges.add(part);
    add_stations(part, stations);
    const std::vector<WallSurface::Face> more = wall_faces(part, patches);
    faces.insert(faces.end(), more.begin(), more.end());
  });
  const RotorGridQuality all = rotor_grid_quality(whole, blade_walls());
  CHECK(quality.general.cells == all.general.cells);
  CHECK((quality.folded == all.folded && quality.skewed == all.skewed));
  CHECK(quality.general.volume == Approx(all.general.volume).epsilon(1e-12));
  CHECK(quality.reach == all.reach);
  CHECK(quality.first_cell_low == all.first_cell_low);
  CHECK(quality.first_cell_high == all.first_cell_high);
  for (const auto value :
       {&GridQuality::min_volume, &GridQuality::max_volume, &GridQuality::aspect_ratio, &GridQuality::skewness,
        &GridQuality::scaled_jacobian, &GridQuality::non_orthogonality, &GridQuality::stretch, &GridQuality::volume_ratio})
    CHECK(alike(quality.general.*value, all.general.*value));
  for (std::size_t d = 0; d < 3; ++d) CHECK(alike(quality.stretch[d], all.stretch[d]));
  CHECK(quality.interface_gap == all.interface_gap);
  CHECK(alike(quality.wall_orthogonality, all.wall_orthogonality));
  const EdgeLengths lengths = EdgeLengths::of_whole(whole);
  for (int b = 0; b < int(whole.blocks.size()); ++b) CHECK(edges.of(b) == lengths.of(b));
  std::vector<std::vector<BladeStation>> expected;
  add_stations(one_part(whole), expected);
  REQUIRE(stations.size() == expected.size());
  for (std::size_t b = 0; b < expected.size(); ++b) {
    REQUIRE(stations[b].size() == expected[b].size());
    for (std::size_t n = 0; n < expected[b].size(); ++n) {
      CHECK((stations[b][n].k == expected[b][n].k && stations[b][n].block == expected[b][n].block));
      CHECK((stations[b][n].quarter == expected[b][n].quarter && stations[b][n].wetted_area == expected[b][n].wetted_area));
    }
  }
  CHECK((sorted(faces) == sorted(wall_faces(whole, patches))));  // in brackets: thousands of faces are not for printing
}

TEST_CASE("tiles and pitching blades of a rank have the same from layers as from the whole", "[rotor_grid][fast]") {
  const RotorGridSpec spec = one_of_three();
  const RotorGridMaker maker(dtu(), spec);
  const MultiBlockGrid whole = make_rotor_grid(dtu(), spec);
  const std::vector<std::string> walls = {"blade_1", "blade_2", "blade_3"};
  const Tiling tiling = make_tiling(whole, walls),
               described = make_tiling(maker.described(), walls, {}, EdgeLengths::of_whole(whole));
  REQUIRE(described.size() == tiling.size());
  CHECK(described.links.size() == tiling.links.size());
  std::vector<int> rank_of_tile(std::size_t(tiling.size()));
  for (std::size_t t = 0; t < rank_of_tile.size(); ++t) rank_of_tile[t] = int(t % 3);
  GridStore at_once(tiling, rank_of_tile, 1), in_parts(described, rank_of_tile, 1);
  at_once.build_all(whole, true);
  std::vector<double> radii;
  in_parts.begin_parts();
  for_layers(maker, 4, [&](const GridLayers& part) {
    in_parts.take(part);
    const std::vector<double> more = surface_radii(part.grid.blocks[0]);
    radii.insert(radii.end(), more.begin(),
                 part.first[0] + part.count[0] == maker.layers() ? more.end() : more.begin() + part.count[0]);
  });
  in_parts.end_parts(true);
  for (const int t : at_once.owned()) {
    CHECK(std::ranges::equal(at_once[t].node_data.span(), in_parts[t].node_data.span()));
    CHECK(std::ranges::equal(at_once[t].centre_data.span(), in_parts[t].centre_data.span()));
    CHECK(std::ranges::equal(at_once[t].volume_data.span(), in_parts[t].volume_data.span()));
    for (std::size_t d = 0; d < 3; ++d)
      CHECK(std::ranges::equal(at_once[t].face_data[d].span(), in_parts[t].face_data[d].span()));
  }
  BladePitching of_whole(whole, surface_radii(whole.blocks[0]), dtu(), spec);
  of_whole.add_rows(one_part(whole), {});
  BladePitching of_parts(maker.described(), radii, dtu(), spec);
  for_layers(maker, 4, [&](const GridLayers& part) { of_parts.add_rows(part, {}); });
  for (int k = 0; k <= maker.layers(); ++k) CHECK(of_parts.share(0, k, 3, 2) == of_whole.share(0, k, 3, 2));
}
