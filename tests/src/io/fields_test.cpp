// src/io/fields.hpp: what is written is read back by h5py through the XDMF file, as ParaView would (read_fields.py), on one and
// two ranks. SPDX-License-Identifier: Apache-2.0
#include "src/io/fields.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>
#include <vector>

#include "src/io/atomic_file.hpp"
#include "src/io/collective.hpp"
#include "tests/src/io/scratch.hpp"

using namespace spindrift;
using Catch::Matchers::Contains;

namespace {

/// The last one is more than a stretch that a rank writes.
const std::vector<io::GridBlock> blocks = {{"inner", 4, 3, 2}, {"wall", 6, 5, 0}, {"wake", 5, 1, 1}, {"outer", 48, 41, 40}};
const std::vector<io::Field> grid_fields = {
    {"pressure", "Pa", 1}, {"velocity", "m/s", 3}, {"absolute", "Pa", 1, io::Precision::full}};

/// A box of a block's cells and its values at time t; read_fields.py knows the same formulas.
struct Tile {
  int block;
  std::array<int, 3> low, high;
  std::vector<double> points{}, pressure{}, velocity{}, absolute{};

  void fill(double t, double t_points) {
    const auto& b = blocks[static_cast<std::size_t>(block)];
    const auto last = [&](int k) { return b.nk == 0 ? k + 1 : k; };  // a surface has no layer of cells, and one of faces
    for (int k = low[2]; k <= high[2]; ++k)
      for (int j = low[1]; j <= high[1]; ++j)
        for (int i = low[0]; i <= high[0]; ++i) points.insert(points.end(), {i + 100.0 * block, j + t_points, k + 0.1 * i});
    for (int k = low[2]; k < last(high[2]); ++k)
      for (int j = low[1]; j < high[1]; ++j)
        for (int i = low[0]; i < high[0]; ++i) {
          const int n = (k * b.nj + j) * b.ni + i;
          pressure.push_back(1000.0 * block + n + 0.5 * t);
          velocity.insert(velocity.end(), {n + t, 2.0 * n, -1.0 * block});
          absolute.push_back(101325.0 + 1e-9 * n);  // single precision has steps of 8e-3 there
        }
  }
};

/// The blocks in at most so many tiles each way, uneven ones, the last tile first.
std::vector<Tile> tiles_of(int cuts) {
  std::vector<Tile> tiles;
  for (int b = static_cast<int>(blocks.size()) - 1; b >= 0; --b) {
    const auto& block = blocks[static_cast<std::size_t>(b)];
    const std::array<int, 3> n{block.ni, block.nj, block.nk};
    std::array<int, 3> parts;
    for (std::size_t d = 0; d < 3; ++d) parts[d] = std::clamp(n[d], 1, cuts);
    for (int part = parts[0] * parts[1] * parts[2] - 1; part >= 0; --part) {
      const std::array<int, 3> p{part % parts[0], part / parts[0] % parts[1], part / (parts[0] * parts[1])};
      Tile& tile = tiles.emplace_back(Tile{b, {}, {}});
      for (std::size_t d = 0; d < 3; ++d) tile.low[d] = n[d] * p[d] / parts[d], tile.high[d] = n[d] * (p[d] + 1) / parts[d];
    }
  }
  return tiles;
}

void write_grid(MPI_Comm comm, const std::filesystem::path& folder, bool moves, int from, int to, int cuts) {
  io::GridFields out(comm, folder, "air", blocks, grid_fields, moves, from == 0 ? io::from_the_start : 0.5 * from);
  for (int n = from; n < to; ++n) {
    const double t = 0.5 * (n + 1);
    std::vector<Tile> tiles = tiles_of(cuts);
    std::vector<io::GridFields::Values> mine;
    for (auto m = static_cast<std::size_t>(io::rank_of(comm)); m < tiles.size();
         m += static_cast<std::size_t>(io::size_of(comm))) {
      Tile& tile = tiles[m];
      tile.fill(t, moves ? t : 0.0);
      mine.push_back({tile.block, tile.low, tile.high, tile.points, {tile.pressure, tile.velocity, tile.absolute}});
    }
    out.write(n + 1, t, mine);
  }
}

void write_particles(MPI_Comm comm, const std::filesystem::path& folder, int per_rank) {
  io::ParticleFields out(comm, folder, "sea", {{"density", "kg/m3", 1}, {"velocity", "m/s", 3}});
  for (const double t : {0.0, 1.5}) {
    std::vector<std::int64_t> ids;
    std::vector<double> position, density, velocity;
    for (int n = io::rank_of(comm); n < per_rank * io::size_of(comm); n += io::size_of(comm)) {
      ids.push_back(n);
      position.insert(position.end(), {0.1 * n, t, -1.0});
      density.push_back(1000.0 + n);
      velocity.insert(velocity.end(), {0.0, t, 2.0 * n});
    }
    const std::vector<std::span<const double>> fields = {density, velocity};
    out.write(static_cast<std::int64_t>(10 * t), t, ids, position, fields);
  }
}

/// Runs the checks of read_fields.py on a folder.
void check_by_python(const std::string& arguments) {
  const std::string command =
      "/usr/bin/env -i /usr/bin/python3 " SPINDRIFT_SOURCE_DIR "/tests/src/io/read_fields.py " + arguments;
  INFO(command);
  CHECK(std::system(command.c_str()) == 0);
}

}  // namespace

TEST_CASE("a moving multi-block grid reads back as a time series, however it is cut into tiles", "[io][fast]") {
  const test::Scratch folder("fields");
  for (const int cuts : {1, 5}) {
    write_grid(MPI_COMM_SELF, folder.path() / std::to_string(cuts), true, 0, 3, cuts);
    check_by_python("grid " + (folder.path() / std::to_string(cuts) / "air.xdmf").string() + " moving 3");
  }
  CHECK(io::read_file(folder / "1/air.xdmf") == io::read_file(folder / "5/air.xdmf"));
}

TEST_CASE("a grid at rest is stored once, and a restart goes on with the series cut back", "[io][fast]") {
  const test::Scratch folder("fields");
  write_grid(MPI_COMM_SELF, folder.path(), false, 0, 5, 2);
  write_grid(MPI_COMM_SELF, folder.path(), false, 2, 4, 3);
  check_by_python("grid " + (folder / "air.xdmf").string() + " resting 4");
}

TEST_CASE("a series knows what it ends with, after a restart too", "[io][fast]") {
  const test::Scratch folder("fields");
  const std::vector<double> points(3 * 12), two(2);
  const io::GridFields::Values values{0, {0, 0, 0}, {2, 1, 1}, points, {two}};
  const auto series = [&](double resume_s) {
    return io::GridFields(MPI_COMM_SELF, folder.path(), "air", {{"b", 2, 1, 1}}, {{"p", "Pa", 1}}, false, resume_s);
  };
  {
    auto out = series(io::from_the_start);
    CHECK_FALSE(out.ends_with(0.1));
    for (const double t : {0.1, 0.3}) out.write(std::int64_t(10 * t), t, std::span(&values, 1));
    CHECK(out.ends_with(0.3));
  }
  CHECK(series(0.3).ends_with(0.3));
  CHECK_FALSE(series(0.2).ends_with(0.2));
  CHECK(series(0.2).ends_with(0.1));
}

TEST_CASE("particles read back as a time series, none as no entry", "[io][fast]") {
  const test::Scratch folder("fields");
  write_particles(MPI_COMM_SELF, folder.path(), 7);
  check_by_python("particles " + (folder / "sea.xdmf").string() + " 7");
  write_particles(MPI_COMM_SELF, folder / "none", 0);
  CHECK_THAT(io::read_file(folder / "none/sea.xdmf"), !Contains("Polyvertex"));
}

TEST_CASE("values that do not fit the declaration are a programmer's error that names the field", "[io][fast]") {
  const test::Scratch folder("fields");
  io::GridFields out(MPI_COMM_SELF, folder.path(), "air", {{"b", 2, 1, 1}}, {{"p", "Pa", 1}}, true);
  const std::vector<double> points(3 * 12), two(2), three(3);
  const io::GridFields::Values good{0, {0, 0, 0}, {2, 1, 1}, points, {two}}, bad{0, {0, 0, 0}, {2, 1, 1}, points, {three}};
  CHECK_NOTHROW(out.write(1, 0.1, std::span(&good, 1)));
  CHECK_THROWS_WITH(out.write(2, 0.2, std::span(&bad, 1)), Contains("b/p: 3 values, expected 2"));
}

TEST_CASE("boxes that leave a part of a block out, cover it twice or reach beyond it are a programmer's error", "[io][fast]") {
  const test::Scratch folder("fields");
  io::GridFields out(MPI_COMM_SELF, folder.path(), "air", {{"b", 4, 1, 1}}, {{"p", "Pa", 1}}, false);
  const std::vector<double> points(3 * 12), two(2);
  const auto box = [&](int low) { return io::GridFields::Values{0, {low, 0, 0}, {low + 2, 1, 1}, points, {two}}; };
  const std::vector<io::GridFields::Values> halves{box(2), box(0)}, half{box(0)}, thrice{box(0), box(2), box(1)},
      beyond{box(0), box(3)};
  CHECK_NOTHROW(out.write(1, 0.1, halves));
  CHECK_THROWS_WITH(out.write(2, 0.2, half), Contains("boxes give 2 elements of a stretch of 4"));
  CHECK_THROWS_WITH(out.write(3, 0.3, thrice), Contains("boxes give 6 elements of a stretch of 4"));
  CHECK_THROWS_WITH(out.write(4, 0.4, beyond), Contains("elements 3 to 5 along i of an array with 4"));
}

TEST_CASE("two ranks write the fields of one, whichever rank has which tile or particle", "[io][mpi2]") {
  const test::Scratch folder("fields_mpi2", MPI_COMM_WORLD);
  write_grid(MPI_COMM_WORLD, folder.path(), true, 0, 3, 5);
  write_particles(MPI_COMM_WORLD, folder.path(), 4);
  if (io::rank_of(MPI_COMM_WORLD) == 0) {
    check_by_python("grid " + (folder / "air.xdmf").string() + " moving 3");
    check_by_python("particles " + (folder / "sea.xdmf").string() + " 8");
  }
  MPI_Barrier(MPI_COMM_WORLD);
}
