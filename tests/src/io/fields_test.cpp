// src/io/fields.hpp: what is written is read back by h5py through the XDMF file, as ParaView would (read_fields.py), on one and
// two ranks. SPDX-License-Identifier: Apache-2.0
#include "src/io/fields.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>

#include "src/io/atomic_file.hpp"
#include "src/io/collective.hpp"
#include "tests/src/io/scratch.hpp"

using namespace spindrift;
using Catch::Matchers::Contains;

namespace {

const std::vector<io::GridBlock> blocks = {{"inner", 4, 3, 2}, {"outer", 2, 2, 1}, {"wake", 5, 1, 1}};
const std::vector<io::Field> grid_fields = {{"pressure", "Pa", 1}, {"velocity", "m/s", 3}};

/// One block's values at time t; read_fields.py knows the same formulas.
struct BlockValues {
  std::vector<double> points, pressure, velocity;
  BlockValues(int block, double t) {
    const auto& b = blocks[static_cast<std::size_t>(block)];
    for (int k = 0; k <= b.nk; ++k)
      for (int j = 0; j <= b.nj; ++j)
        for (int i = 0; i <= b.ni; ++i) points.insert(points.end(), {i + 10.0 * block, j + t, k + 0.1 * i});
    for (int n = 0; n < b.ni * b.nj * b.nk; ++n) {
      pressure.push_back(1000.0 * block + n + 0.5 * t);
      velocity.insert(velocity.end(), {n + t, 2.0 * n, -1.0 * block});
    }
  }
};

void write_grid(MPI_Comm comm, const std::filesystem::path& folder, bool moves, int from, int to) {
  io::GridFields out(comm, folder, "air", blocks, grid_fields, moves, from == 0 ? io::from_the_start : 0.5 * from);
  for (int n = from; n < to; ++n) {
    const double t = 0.5 * (n + 1);
    std::vector<BlockValues> kept;
    kept.reserve(blocks.size());
    std::vector<io::GridFields::Values> mine;
    for (int b = io::rank_of(comm); b < 3; b += io::size_of(comm)) {
      kept.emplace_back(b, moves ? t : 0.0);
      kept.back().pressure = BlockValues(b, t).pressure;
      kept.back().velocity = BlockValues(b, t).velocity;
      mine.push_back({b, kept.back().points, {kept.back().pressure, kept.back().velocity}});
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

TEST_CASE("a moving multi-block grid reads back as a time series", "[io][fast]") {
  const test::Scratch folder("fields");
  write_grid(MPI_COMM_SELF, folder.path(), true, 0, 3);
  check_by_python("grid " + (folder / "air.xdmf").string() + " moving 3");
}

TEST_CASE("a grid at rest is stored once, and a restart goes on with the series cut back", "[io][fast]") {
  const test::Scratch folder("fields");
  write_grid(MPI_COMM_SELF, folder.path(), false, 0, 5);
  write_grid(MPI_COMM_SELF, folder.path(), false, 2, 4);
  check_by_python("grid " + (folder / "air.xdmf").string() + " resting 4");
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
  const io::GridFields::Values good{0, points, {two}}, bad{0, points, {three}};
  CHECK_NOTHROW(out.write(1, 0.1, std::span(&good, 1)));
  CHECK_THROWS_WITH(out.write(2, 0.2, std::span(&bad, 1)), Contains("b/p: 3 values, expected 2"));
}

TEST_CASE("two ranks write the fields of one, whichever rank has which block or particle", "[io][mpi2]") {
  const test::Scratch folder("fields_mpi2", MPI_COMM_WORLD);
  write_grid(MPI_COMM_WORLD, folder.path(), true, 0, 3);
  write_particles(MPI_COMM_WORLD, folder.path(), 4);
  if (io::rank_of(MPI_COMM_WORLD) == 0) {
    check_by_python("grid " + (folder / "air.xdmf").string() + " moving 3");
    check_by_python("particles " + (folder / "sea.xdmf").string() + " 8");
  }
  MPI_Barrier(MPI_COMM_WORLD);
}
