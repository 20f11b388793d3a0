// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "src/aero/grid/checks.hpp"
#include "src/aero/grid/connect.hpp"
#include "src/aero/grid/generators/plane_cases.hpp"
#include "src/aero/grid/neutral_map.hpp"
#include "src/aero/grid/plot3d.hpp"
#include "src/scene/error.hpp"
#include "tests/src/aero/grid/examples.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Catch::Matchers::Contains;
using Eigen::Vector3d;
namespace fs = std::filesystem;

namespace {

const fs::path data = SPINDRIFT_SOURCE_DIR "/tests/src/aero/grid/data";
const fs::path aerofoils = SPINDRIFT_SOURCE_DIR "/inputs/validation/naca0012";

/// In a planar grid y is not in the file.
bool same_nodes(const MultiBlockGrid& a, const MultiBlockGrid& b) {
  if (a.blocks.size() != b.blocks.size()) return false;
  for (std::size_t n = 0; n < a.blocks.size(); ++n) {
    if (a.blocks[n].cells() != b.blocks[n].cells() || a.blocks[n].nodes.size() != b.blocks[n].nodes.size()) return false;
    for (std::size_t p = 0; p < a.blocks[n].nodes.size(); ++p) {
      const Vector3d &x = a.blocks[n].nodes[p], &y = b.blocks[n].nodes[p];
      if (x.x() != y.x() || x.z() != y.z() || (!a.planar && x.y() != y.y())) return false;
    }
  }
  return true;
}
/// The same windows joined and bounded, whichever block is named first: what the tiles see.
void check_same_topology(const MultiBlockGrid& a, const MultiBlockGrid& b) {
  CHECK(a.connections.size() == b.connections.size());
  const Tiling x = make_tiling(a, {}, {.across_j = 3, .across_k = 3, .normal = 4}),
               y = make_tiling(b, {}, {.across_j = 3, .across_k = 3, .normal = 4});
  REQUIRE(x.size() == y.size());
  REQUIRE(x.links.size() == y.links.size());
  REQUIRE(x.boundaries.size() == y.boundaries.size());
  const auto key = [](const GhostLink& l) {
    return std::tuple(l.to, l.side, l.low, l.high, l.from, l.donor.axes, l.donor.offset, l.periodic >= 0);
  };
  std::vector<decltype(key(x.links[0]))> p, q;
  for (const auto& l : x.links) p.push_back(key(l));
  for (const auto& l : y.links) q.push_back(key(l));
  std::ranges::sort(p), std::ranges::sort(q);
  CHECK(p == q);
}

template <class T>
void put(std::string& bytes, T value, bool swapped) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (swapped) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}
/// A binary file of any of the layouts in use.
template <class Real>
std::string binary_plot3d(const MultiBlockGrid& grid, bool counted, bool records, bool swapped) {
  std::string out;
  const auto mark = [&](std::size_t n) {
    if (records) put(out, std::int32_t(n), swapped);
  };
  const int dims = grid.planar ? 2 : 3;
  if (counted) mark(4), put(out, std::int32_t(grid.blocks.size()), swapped), mark(4);
  mark(4 * dims * grid.blocks.size());
  for (const Block& b : grid.blocks)
    for (int d = 0; d < dims; ++d) put(out, std::int32_t(b.cells()[d] + 1), swapped);
  mark(4 * dims * grid.blocks.size());
  for (const Block& b : grid.blocks) {
    const std::size_t nodes = b.nodes.size() / (grid.planar ? 2 : 1);
    mark(nodes * dims * sizeof(Real));
    for (int c = 0; c < dims; ++c)
      for (std::size_t p = 0; p < nodes; ++p) put(out, Real(grid.planar && c == 1 ? b.nodes[p].z() : b.nodes[p][c]), swapped);
    mark(nodes * dims * sizeof(Real));
  }
  return out;
}

void expect_refusal(const std::function<void()>& what, const std::string& part) {
  try {
    what();
    FAIL("nothing was refused; expected: " << part);
  } catch (const scene::SceneError& e) { CHECK_THAT(e.what(), Contains(part)); }
}

}  // namespace

TEST_CASE("the TMR's files are read, closed and sound", "[aero][grid][fast]") {
  MultiBlockGrid plate = read_plot3d(data / "tmr_plate_34x24.p3d");
  read_neutral_map(plate, data / "tmr_plate_34x24.nmf");
  CHECK(plate.planar);
  CHECK(plate.blocks[0].cells() == Index{34, 24, 1});
  CHECK(grid_faults(plate).empty());
  REQUIRE(plate.boundaries.size() == 5);
  const auto wall = std::ranges::find(plate.boundaries, "viscous_solid", &Boundary::patch);
  REQUIRE(wall != plate.boundaries.end());
  CHECK(wall->where.side == Side::j_min);
  CHECK(wall->where.low == std::array<int, 2>{6, 0});
  CHECK(wall->where.high == std::array<int, 2>{34, 1});

  MultiBlockGrid foil = read_plot3d(aerofoils / "tmr_112x32.p3d");
  read_neutral_map(foil, aerofoils / "tmr_112x32.nmf");
  CHECK(grid_faults(foil).empty());
  REQUIRE(foil.connections.size() == 1);
  CHECK(!foil.connections[0].periodic);
  CHECK(foil.connections[0].orientation == std::array<int, 3>{-1, -2, 3});
  check_same_topology(foil, naca0012({.n = 1}));
}

TEST_CASE(
    "a section that is kept one cell wide is the planar grid, whichever direction is across and whichever axis it steps along",
    "[aero][grid][fast]") {
  const fs::path file = fs::temp_directory_path() / "spindrift_one_cell.p3dfmt",
                 map = fs::temp_directory_path() / "spindrift_one_cell.nmf";
  const MultiBlockGrid planar = naca0012({.n = 1, .width = 0.25});
  const Index axes = GENERATE(Index{1, 2, 3}, Index{3, 1, 2}, Index{1, 3, 2}, Index{2, 3, 1});
  const bool along_z = GENERATE(false, true), wavy = GENERATE(false, true);
  CAPTURE(axes[0], axes[1], axes[2], along_z, wavy);
  MultiBlockGrid wide = planar;
  wide.planar = false;
  const Block& b = planar.blocks[0];
  for (const Side side : {Side::k_min, Side::k_max}) wide.boundaries.push_back({{0, side, {0, 0}, {b.ni, b.nj}}, "symmetry"});
  if (along_z)
    for (Vector3d& x : wide.blocks[0].nodes) x = Vector3d(x.x(), x.z(), x.y());
  if (wavy) wide.blocks[0].nodes[b.node(1, 5, 5)].x() += 1e-3;
  reorient(wide, 0, axes);
  write_plot3d(wide, file, Plot3dForm::formatted), write_neutral_map(wide, map);
  MultiBlockGrid back = read_plot3d(file);
  read_neutral_map(back, map);
  if (wavy) {
    CHECK(!back.planar);
    CHECK_THAT(grid_faults(back)[0], Contains("two-dimensional"));
    return;
  }
  CHECK(back.planar);
  CHECK(grid_faults(back).empty());
  CHECK(back.boundaries.size() == planar.boundaries.size());  // the sides across bound nothing
  const auto area = [](const MultiBlockGrid& grid) {
    const Block& block = grid.blocks[0];
    double sum = 0.0;
    for (int j = 0; j < block.nj; ++j)
      for (int i = 0; i < block.ni; ++i) {
        const Vector3d &p = block.nodes[block.node(0, j, i)], &q = block.nodes[block.node(0, j + 1, i + 1)],
                       &r = block.nodes[block.node(0, j, i + 1)], &t = block.nodes[block.node(0, j + 1, i)];
        sum += 0.5 * (q - p).cross(t - r).norm();
      }
    return sum;
  };
  CHECK(area(back) == Approx(area(planar)).epsilon(1e-12));
  CHECK((back.blocks[0].nodes[back.blocks[0].node(1, 0, 0)] - back.blocks[0].nodes[0] - Vector3d(0, -0.25, 0)).norm() < 1e-12);
  fs::remove(file), fs::remove(map);
}

TEST_CASE("a grid written is the grid read, bit for bit", "[aero][grid][fast]") {
  const bool planar = GENERATE(false, true);
  const auto form = GENERATE(Plot3dForm::formatted, Plot3dForm::binary);
  const BoxOptions box{.ni = 6, .nj = 7, .nk = 8, .periodic = {true, false, false}};
  const MultiBlockGrid grid = turned_box(perturbed(planar ? planar_box(box) : cartesian_box(box), box, 0.05), 12);
  const ScratchFile coordinates("written.p3d"), map("written.nmf");
  write_plot3d(grid, coordinates.path, form);
  write_neutral_map(grid, map.path);
  MultiBlockGrid back = read_plot3d(coordinates.path);
  read_neutral_map(back, map.path);
  CHECK(back.planar == planar);
  CHECK(same_nodes(grid, back));
  CHECK(grid_faults(back).empty());
  check_same_topology(grid, back);
  for (const Connection& c : back.connections)
    if (c.periodic) CHECK(std::abs(std::abs(c.periodic->translation.x()) - 1) < 1e-12);
}

TEST_CASE("a sector's rotation is found from its nodes", "[aero][grid][fast]") {
  MultiBlockGrid grid;
  const double sector = 2 * std::acos(-1.0) / 3;
  grid.blocks.push_back(mapped_block("sector", 3, 6, 4, [&](double r, double phi, double z) {
    return Vector3d(z, (1 + r) * std::cos(sector * phi), (1 + r) * std::sin(sector * phi));
  }));
  RigidMap turn;
  turn.rotation = Eigen::AngleAxisd(-sector, Vector3d::UnitX()).toRotationMatrix();
  grid.connections = {{{0, Side::j_max, {0, 0}, {3, 4}}, {0, Side::j_min, {0, 0}, {3, 4}}, {1, 2, 3}, turn}};
  for (const Side s : {Side::i_min, Side::i_max}) grid.boundaries.push_back({{0, s, {0, 0}, {6, 4}}, "r"});
  for (const Side s : {Side::k_min, Side::k_max}) grid.boundaries.push_back({{0, s, {0, 0}, {3, 6}}, "x"});
  REQUIRE(grid_faults(grid).empty());
  const ScratchFile coordinates("sector.p3d"), map("sector.nmf");
  write_plot3d(grid, coordinates.path), write_neutral_map(grid, map.path);
  MultiBlockGrid back = read_plot3d(coordinates.path);
  read_neutral_map(back, map.path);
  REQUIRE(back.connections.at(0).periodic);
  CHECK((back.connections[0].periodic->rotation - turn.rotation).norm() < 1e-12);
  CHECK(back.connections[0].periodic->translation.norm() < 1e-12);
  CHECK(grid_faults(back).empty());
}

TEST_CASE("binary files of every layout are understood", "[aero][grid][fast]") {
  const bool counted = GENERATE(true, false), records = GENERATE(true, false), swapped = GENERATE(true, false),
             planar = GENERATE(true, false);
  const BoxOptions box{.ni = 5, .nj = 4, .nk = 3, .high = Vector3d(5, 4, 3)};  // whole numbers: exact in single precision
  const MultiBlockGrid grid = planar ? planar_box(box) : cartesian_box(box);
  const ScratchFile file("layout.p3d");
  file.write(binary_plot3d<double>(grid, counted, records, swapped));
  const MultiBlockGrid a = read_plot3d(file.path);
  file.write(binary_plot3d<float>(grid, counted, records, swapped));
  const MultiBlockGrid b = read_plot3d(file.path);
  for (const auto* read : {&a, &b}) {
    CHECK(read->planar == planar);
    REQUIRE(read->blocks.size() == 1);
    CHECK(read->blocks[0].cells() == grid.blocks[0].cells());
    double gap = 0;
    for (std::size_t p = 0; p < grid.blocks[0].nodes.size(); ++p) {
      Vector3d d = read->blocks[0].nodes[p] - grid.blocks[0].nodes[p];
      if (planar) d.y() = 0;
      gap = std::max(gap, d.norm());
    }
    CHECK(gap < 1e-6);
  }
}

TEST_CASE("formatted files may repeat numbers, use D exponents and turn the other way", "[aero][grid][fast]") {
  const ScratchFile file("text.p2d");
  file.write("1\n3 3\n2*0.0 0 1.0D0 1d0 +1 3*2.\n0 1 2,0 1 2\n0 1 2\n");  // i along y: clockwise
  const MultiBlockGrid grid = read_plot3d(file.path);
  CHECK(grid.blocks[0].nodes[3] == Vector3d(1, 0, 0));
  MultiBlockGrid closed = grid;
  make_right_handed(closed);
  connect_by_coordinates(closed);
  CHECK(grid_faults(closed).empty());
}

TEST_CASE("nodes may be marked as in use; holes are refused", "[aero][grid][fast]") {
  const ScratchFile file("blank.p3d");
  const std::string text = "1\n2 2 2\n0 1 0 1 0 1 0 1\n0 0 1 1 0 0 1 1\n0 0 0 0 1 1 1 1\n";
  file.write(text + "1 1 1 1 1 1 1 2\n");
  CHECK(read_plot3d(file.path).blocks[0].nodes[7] == Vector3d(1, 1, 1));
  file.write(text + "1 1 1 1 1 1 0 1\n");
  expect_refusal([&] { read_plot3d(file.path); }, "blank.p3d:6: node 7 of block 1 is blanked out (iblank 0)");
  const bool swapped = GENERATE(false, true);
  std::string bytes;
  for (const int word : {4, 1, 4, 12, 2, 2, 2, 12, 224}) put(bytes, std::int32_t(word), swapped);
  for (int n = 0; n < 24; ++n) put(bytes, double(n < 8 ? n % 2 : n < 16 ? n / 2 % 2 : n / 4 % 2), swapped);
  const std::string coordinates = bytes;
  const auto with = [&](int last) {
    bytes = coordinates;
    for (int n = 0; n < 8; ++n) put(bytes, std::int32_t(n < 7 ? 1 : last), swapped);
    put(bytes, std::int32_t(224), swapped);
    file.write(bytes);
  };
  with(1);
  CHECK(read_plot3d(file.path).blocks[0].nodes[7] == Vector3d(1, 1, 1));
  with(0);
  expect_refusal([&] { read_plot3d(file.path); }, "node 8 of block 1 is blanked out");
}

TEST_CASE("left-handed blocks get i and j exchanged with all their windows", "[aero][grid][fast]") {
  const MultiBlockGrid right = turned_box(cartesian_box({.ni = 6, .nj = 7, .nk = 8, .periodic = {true, false, false}}), 21);
  MultiBlockGrid left = right;
  reorient(left, 1, {1, 2, -3}), reorient(left, 4, {2, 1, 3});
  const ScratchFile coordinates("left.p3d"), map("left.nmf");
  write_plot3d(left, coordinates.path, Plot3dForm::binary), write_neutral_map(left, map.path);
  MultiBlockGrid back = read_plot3d(coordinates.path);
  CHECK(!grid_faults(left).empty());
  read_neutral_map(back, map.path);
  CHECK(grid_faults(back).empty());
}

TEST_CASE("planar blocks that turn both ways meet", "[aero][grid][fast]") {
  const BoxOptions box{.ni = 6, .nj = 7};
  const MultiBlockGrid right = turned_box(perturbed(planar_box(box), box, 0.05), 21);
  MultiBlockGrid left = right;
  REQUIRE(left.blocks.size() > 1);
  reorient(left, 1, {2, 1, 3});
  const ScratchFile coordinates("both.p3d"), map("both.nmf");
  write_plot3d(left, coordinates.path, Plot3dForm::binary), write_neutral_map(left, map.path);
  MultiBlockGrid back = read_plot3d(coordinates.path);
  read_neutral_map(back, map.path);
  CHECK(grid_faults(back).empty());
  CHECK(same_nodes(right, back));
  check_same_topology(right, back);
}

TEST_CASE("blocks are joined by their coordinates where no map is given", "[aero][grid][fast]") {
  const bool planar = GENERATE(false, true);
  const unsigned seed = GENERATE(1u, 2u);
  const BoxOptions box{.ni = 8, .nj = 7, .nk = 6};
  const MultiBlockGrid grid = turned_box(perturbed(planar ? planar_box(box) : cartesian_box(box), box, 0.05), seed);
  MultiBlockGrid found = grid;
  connect_by_coordinates(found);
  CHECK(grid_faults(found).empty());
  check_same_topology(grid, found);
  MultiBlockGrid foil = naca0012({.n = 1});  // the wake joins one side to itself, in faces 1e-5 high
  connect_by_coordinates(foil);
  CHECK(grid_faults(foil).empty());
  REQUIRE(foil.connections.size() == 1);
  CHECK(foil.connections[0].orientation == std::array<int, 3>{-1, -2, 3});
  CHECK(foil.connections[0].from.high[0] - foil.connections[0].from.low[0] == 24);
}

TEST_CASE("bad files are refused with file, line and what is wrong", "[aero][grid][fast]") {
  const ScratchFile file("bad.p3d"), map("bad.nmf");
  expect_refusal([&] { read_plot3d("/no/such/grid.p3d"); }, "/no/such/grid.p3d: cannot be opened");
  file.write("");
  expect_refusal([&] { read_plot3d(file.path); }, "is empty");
  file.write("1\n3 3\n0 1 2 0 1 2 0 1 2\n0 0 zero 1 1 1 2 2 2\n");
  expect_refusal([&] { read_plot3d(file.path); }, "bad.p3d:4 = zero: is not a finite number");
  file.write("1\n3 3\n0 1 2 0 1 2 0 1 2\n0 0 0 1 1 1 2 2\n");
  expect_refusal([&] { read_plot3d(file.path); }, "would be 21 numbers");
  file.write("1\n3 3\n0 1 2 0 1 2 0 1 2\n0 0 0 1 1 nan 2 2 2\n");
  expect_refusal([&] { read_plot3d(file.path); }, "bad.p3d:4 = nan: is not a finite number");
  file.write("1\n1 3\n0 1 2 0 1 2\n");
  expect_refusal([&] { read_plot3d(file.path); }, "at least 2");
  file.write(std::string("\x01\x00\x00\x00\x07\x09\x00\x00", 8));
  expect_refusal([&] { read_plot3d(file.path); }, "8 bytes are no Plot3D grid");
  file.write("99999999 99999999 99999999\n1 2 3\n");
  expect_refusal([&] { read_plot3d(file.path); }, "no Plot3D grid");

  const MultiBlockGrid box = cartesian_box({.ni = 4, .nj = 5, .nk = 6});
  const auto with = [&](const std::string& lines, const std::string& part) {
    map.write(lines);
    MultiBlockGrid grid = box;
    grid.boundaries.clear();
    expect_refusal([&] { read_neutral_map(grid, map.path); }, part);
  };
  const std::string head = "# comment\n1\n1 5 6 7\n";
  with("# nothing\n", "has no lines but comments");
  with("2\n", "bad.nmf:1 = 2: blocks, but the grid has 1");
  with("1\n1 5 6 8\n", "bad.nmf:2 = 5 6 8: nodes, but block 1 of the grid has 5 x 6 x 7");
  with(head + "'wall' 2 1 1 5 1 6\n", "bad.nmf:4 = 2: is no block");
  with(head + "'wall' 1 9 1 5 1 6\n", "is no face");
  with(head + "'wall' 1 1 1 5 1 7\n", "bad.nmf:4 = 1 7: is beyond nodes 1 to 6 of j");
  with(head + "'wall' 1 1 1 x 1 6\n", "bad.nmf:4 = x: is not a whole number");
  with(head + "'wall' 1 1 1 5 1\n", "ends before a range of nodes");
  with(head + "'wall' 1 1 1 5 3 3\n", "covers no face");
  with(head + "'one-to-one' 1 1 1 5 1 6 1 2 1 5 1 5 false\n", "joins 5 cells to 4");
  with(head + "'one-to-one' 1 1 1 5 1 6 1 2 1 5 1 6 maybe\n", "must be true or false");
  with(head + "'one-to-one' 1 3 1 4 1 4 1 5 1 4 1 4 false\n", "apart under any rigid motion");
}
