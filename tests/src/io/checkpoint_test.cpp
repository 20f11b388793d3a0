// src/io/checkpoint.hpp on sound files: what is written is read, on any number of ranks; the newest few are kept.
// SPDX-License-Identifier: Apache-2.0
#include "src/io/checkpoint.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "src/io/checksum.hpp"
#include "src/io/collective.hpp"
#include "src/io/machine_failure.hpp"
#include "tests/src/io/scratch.hpp"

using namespace spindrift;
using Catch::Matchers::Contains;

namespace {

/// Blocks of 7 values of a global array, dealt to the ranks in turn; value = f(index).
struct Blocks {
  std::vector<std::vector<double>> data;
  std::vector<io::Slice<const double>> slices;
  Blocks(int blocks, int rank, int ranks) {
    for (int b = rank; b < blocks; b += ranks) {
      data.emplace_back(7);
      for (int i = 0; i < 7; ++i) data.back()[static_cast<std::size_t>(i)] = 1.0 / (7.0 * b + i + 1.0);
    }
    int b = rank;
    for (const auto& block : data) {
      slices.push_back({7 * b, block});
      b += ranks;
    }
  }
};

void write_blocks(MPI_Comm comm, const std::filesystem::path& path, int blocks) {
  const Blocks mine(blocks, io::rank_of(comm), io::size_of(comm));
  io::CheckpointWriter writer(comm, path);
  writer.write<double>("air/state", 7 * blocks, mine.slices);
  writer.set("time_s", 1.0 / 3.0);
  writer.commit();
}

void check_blocks(const io::CheckpointReader& reader, int blocks) {
  const auto values = reader.read<double>("air/state");
  REQUIRE(values.size() == static_cast<std::size_t>(7 * blocks));
  for (std::size_t i = 0; i < values.size(); ++i) REQUIRE(values[i] == 1.0 / (static_cast<double>(i) + 1.0));
  CHECK(reader.number("time_s") == 1.0 / 3.0);
}

}  // namespace

TEST_CASE("a checkpoint gives back each array and value, bit by bit", "[io][fast]") {
  const test::Scratch folder("checkpoint");
  const std::vector<double> doubles = {0.0, -0.0, 5e-324, std::numeric_limits<double>::infinity(), 1.0 / 3.0};
  const std::vector<std::int64_t> integers = {std::numeric_limits<std::int64_t>::min(), -1, 0, 1LL << 53, (1LL << 53) + 1};
  const std::vector<std::byte> bytes = {std::byte{0}, std::byte{255}, std::byte{7}};
  {
    io::CheckpointWriter writer(MPI_COMM_SELF, folder / "a.h5");
    writer.write<double>("bodies/motion", doubles);
    writer.write<std::int64_t>("sea/id", integers);
    writer.write<std::byte>("coupling/state", bytes);
    writer.write<double>("sea/none", std::span<const double>());
    writer.set("time_s", 0.1);
    writer.set("tick", std::int64_t{123456789012345});
    writer.set("scene", std::string("Wellengang fünf"));
    CHECK_FALSE(std::filesystem::exists(folder / "a.h5"));  // whole or absent
    writer.commit();
  }
  CHECK_FALSE(std::filesystem::exists(folder / "a.h5.tmp"));
  const io::CheckpointReader reader(MPI_COMM_SELF, folder / "a.h5");
  const auto back = reader.read<double>("bodies/motion");
  REQUIRE(back.size() == doubles.size());
  for (std::size_t i = 0; i < back.size(); ++i)
    CHECK(std::bit_cast<std::uint64_t>(back[i]) == std::bit_cast<std::uint64_t>(doubles[i]));
  CHECK(reader.read<std::int64_t>("sea/id") == integers);
  CHECK(reader.read<std::byte>("coupling/state") == bytes);
  CHECK(reader.read<double>("sea/none").empty());
  CHECK(reader.number("time_s") == 0.1);
  CHECK(reader.integer("tick") == 123456789012345);
  CHECK(reader.text("scene") == "Wellengang fünf");
  CHECK(reader.has("sea/id"));
  CHECK_FALSE(reader.has("air/state"));
  CHECK(reader.size("sea/id") == 5);
}

TEST_CASE("a checkpoint that is not committed leaves nothing behind", "[io][fast]") {
  const test::Scratch folder("checkpoint");
  { io::CheckpointWriter writer(MPI_COMM_SELF, folder / "a.h5"); }
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("asking a checkpoint for what another scene would have is the user's error", "[io][fast]") {
  const test::Scratch folder("checkpoint");
  write_blocks(MPI_COMM_SELF, folder / "a.h5", 2);
  const io::CheckpointReader reader(MPI_COMM_SELF, folder / "a.h5");
  CHECK_THROWS_AS(reader.read<double>("sea/position"), io::InputError);
  CHECK_THROWS_WITH(reader.read<std::int64_t>("air/state"), Contains("another type"));
  std::vector<double> more(15);
  const io::Slice<double> all{0, more};
  CHECK_THROWS_WITH(reader.read<double>("air/state", std::span(&all, 1)), Contains("14 values") && Contains("asks for 15"));
}

TEST_CASE("slices that do not make up the whole array are a programmer's error", "[io][fast]") {
  const test::Scratch folder("checkpoint");
  const std::vector<double> part(4);
  const io::Slice<const double> slice{0, part};
  io::CheckpointWriter writer(MPI_COMM_SELF, folder / "a.h5");
  CHECK_THROWS_AS(writer.write<double>("x", 5, std::span(&slice, 1)), std::logic_error);
}

TEST_CASE("the checksum does not depend on how an array is cut, and sees every change of one element", "[io][fast]") {
  std::vector<double> values(100);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sqrt(static_cast<double>(i));
  const std::span<const double> all(values);
  const auto whole = io::checksum<double>(0, all);
  for (const std::size_t cut : {0u, 1u, 50u, 100u})
    CHECK(io::checksum<double>(0, all.first(cut)) + io::checksum<double>(static_cast<std::int64_t>(cut), all.subspan(cut)) ==
          whole);
  std::swap(values[3], values[4]);
  CHECK(io::checksum<double>(0, all) != whole);
  std::swap(values[3], values[4]);
  for (int bit = 0; bit < 64; ++bit) {
    const double kept = values[7];
    values[7] = std::bit_cast<double>(std::bit_cast<std::uint64_t>(kept) ^ (1ULL << bit));
    CHECK(io::checksum<double>(0, all) != whole);
    values[7] = kept;
  }
}

TEST_CASE("a series keeps the last few and finds the newest, by number and not by name's length", "[io][fast]") {
  const test::Scratch folder("checkpoint");
  io::CheckpointSeries series(MPI_COMM_SELF, folder / "checkpoints", 2);
  CHECK_FALSE(series.newest());
  for (const std::int64_t tick : {9L, 10L, 100L, 99999999999L})
    series.save(tick, [&](io::CheckpointWriter& writer) { writer.set("time_s", 0.1 * static_cast<double>(tick)); });
  CHECK_FALSE(std::filesystem::exists(series.path(10)));
  CHECK(std::filesystem::exists(series.path(100)));
  const auto newest = series.newest();
  REQUIRE(newest);
  CHECK(newest->integer("tick") == 99999999999);
}

TEST_CASE("a checkpoint written by two ranks is the one that one rank writes, and each reads the other's", "[io][mpi2]") {
  const test::Scratch folder("checkpoint_mpi2", MPI_COMM_WORLD);
  const int rank = io::rank_of(MPI_COMM_WORLD);
  const int blocks = GENERATE(1, 2, 5);  // 1: rank 1 has nothing to write
  write_blocks(MPI_COMM_WORLD, folder / "two.h5", blocks);
  const auto alone = folder / ("one_" + std::to_string(rank) + ".h5");
  write_blocks(MPI_COMM_SELF, alone, blocks);
  check_blocks(io::CheckpointReader(MPI_COMM_WORLD, folder / "two.h5"), blocks);
  check_blocks(io::CheckpointReader(MPI_COMM_SELF, folder / "two.h5"), blocks);
  check_blocks(io::CheckpointReader(MPI_COMM_SELF, alone), blocks);
  MPI_Barrier(MPI_COMM_WORLD);
  check_blocks(io::CheckpointReader(MPI_COMM_WORLD, folder / "one_0.h5"), blocks);
}

TEST_CASE("two ranks write and read empty arrays and replicated ones", "[io][mpi2]") {
  const test::Scratch folder("checkpoint_mpi2", MPI_COMM_WORLD);
  const std::vector<std::int64_t> same = {1, 2, 3};
  io::CheckpointWriter writer(MPI_COMM_WORLD, folder / "r.h5");
  writer.write<double>("empty", 0, std::span<const io::Slice<const double>>());
  writer.write<std::int64_t>("same", same);
  writer.commit();
  const io::CheckpointReader reader(MPI_COMM_WORLD, folder / "r.h5");
  CHECK(reader.read<double>("empty").empty());
  CHECK(reader.read<std::int64_t>("same") == same);
}
