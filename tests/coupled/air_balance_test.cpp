// Tiles of the air that begin on the wrong ranks are dealt out anew by what they took, with the bits of one rank: histories,
// state, and what goes on from a checkpoint. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include <algorithm>
#include <map>
#include <utility>

#include "src/coupling/sides.hpp"
#include "src/coupling/window.hpp"
#include "tests/coupled/runs.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using namespace spindrift::coupling::test;

namespace {

const std::string settled = "[start]\nair_steps = 3\n";
const std::string few_steps = R"(
max_pseudo_steps = 3
unconverged_share = 1.0
drop = 0.0
tile_cells = 512
)";
/// 25 000 cells.
const std::string air_of_blades = settled + shared_scene("air_of_blades.toml") + "cfl_max = 20.0\nkrylov_steps = 3" + few_steps;
const std::string all_sectors = "aero.grid.sectors=all";
const std::string blades = rotor_on_platform + air_of_blades;
const std::string blades_that_pitch = "base = \"control/dtu_10mw_fixed.toml\"\n" + air_of_blades;
const std::string lines = rotor_on_platform + settled + shared_scene("air_of_lines.toml") + few_steps;

runtime::World all_ranks() { return {MPI_COMM_WORLD, runtime::rank_in(MPI_COMM_WORLD), runtime::ranks_in(MPI_COMM_WORLD)}; }
const runtime::World alone{MPI_COMM_SELF, 0, 1};

using Arrays = std::map<std::string, std::vector<double>>;

/// What the ranks of `comm` would save between them.
Arrays whole(const std::vector<SavedArray>& mine, MPI_Comm comm) {
  runtime::Packer packer;
  for (const SavedArray& array : mine) {
    packer.put(std::span<const char>(array.name)), packer.put_one(array.total), packer.put_one(array.pieces.size());
    for (const SavedArray::Piece& piece : array.pieces)
      packer.put_one(piece.offset), packer.put(std::span<const double>(piece.values));
  }
  Arrays all;
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm, packer.take()))
    for (runtime::Unpacker from(bytes); !from.done();) {
      const std::vector<char> name = from.many<char>();
      std::vector<double>& values = all[std::string(name.begin(), name.end())];
      values.resize(std::size_t(from.one<std::int64_t>()), -1e300);
      for (std::size_t pieces = from.one<std::size_t>(); pieces > 0; --pieces) {
        const auto offset = from.one<std::int64_t>();
        std::ranges::copy(from.many<double>(), values.begin() + offset);
      }
    }
  return all;
}

/// A run in memory, window by window.
class Going {
 public:
  Going(const Scenario& scenario, runtime::Parts parts)
      : parts_(std::move(parts)),
        floating_(scenario),
        state_(make_start(floating_).state),
        window_(floating_, make_sides(floating_, state_.motions, parts_), parts_.mine().comm) {}

  AirSide& air() const { return window_.sides().air(); }
  CoupledWindow& window() { return window_; }
  bodies::BodiesState& state() { return state_; }
  void begin() { window_.begin(state_); }
  void advance(int windows) {
    for (int n = 0; n < windows; ++n) {
      const WindowReport report = window_.advance(state_);
      INFO(report.failure);
      REQUIRE(report.ok());
      for (const double value : air().values()) history_.push_back(value);
    }
  }
  std::size_t own_tiles() const {
    for (const SavedArray& array : air().saved())
      if (array.name == "flow/tiles") return array.pieces.size();
    return 0;
  }
  /// Bodies, scheme, columns of the air in every window, and the air's state, of the ranks that have it.
  bool same_as(Going& one_rank) {
    const auto packed = [](const bodies::BodiesState& state) {
      std::vector<double> values(state.packed_size());
      state.pack(values);
      return values;
    };
    CHECK(packed(state_) == packed(one_rank.state_));
    CHECK(window_.history() == one_rank.window_.history());
    const std::size_t common = std::min(history_.size(), one_rank.history_.size());  // one may have begun later
    CHECK(std::equal(history_.end() - std::ptrdiff_t(common), history_.end(), one_rank.history_.end() - std::ptrdiff_t(common)));
    if (!parts_.has(air_part)) return true;
    return whole(air().saved(), parts_.mine().comm) == whole(one_rank.air().saved(), MPI_COMM_SELF);
  }
  /// As a checkpoint holds it.
  void save(const std::filesystem::path& file) const {
    io::CheckpointWriter writer(parts_.world().comm, file);
    for (const SavedArray& array : air().saved()) write(writer, array);
    writer.commit();
  }
  void restore(const std::filesystem::path& file, Going& from) {
    state_ = from.state_;
    REQUIRE(window_.restore(from.window_.history()));
    air().restore(io::CheckpointReader(parts_.world().comm, file));
  }

 private:
  runtime::Parts parts_;
  FloatingSystem floating_;
  bodies::BodiesState state_;
  mutable CoupledWindow window_;
  std::vector<double> history_;
};

/// A tile for each rank of the air, the rest for its last.
aero::TileMove onto_the_last(std::size_t tiles, int ranks) {
  std::vector<int> rank_of_tile(tiles, ranks - 1);
  for (int r = 0; r < ranks; ++r) rank_of_tile[std::size_t(r)] = r;
  return {std::move(rank_of_tile), 1.0, double(ranks)};
}

/// Lines that tell of moves.
int moves_told(const std::vector<std::string>& lines) {
  return int(std::ranges::count_if(lines, [](const std::string& line) { return line.find("go to other ranks") != line.npos; }));
}

struct Kind {
  std::string name, scene;
  std::vector<std::string> overrides;
};
std::vector<Kind> kinds() {
  return {{"blades, a set-up kept over steps",
           blades,
           {all_sectors, "aero.flow.preconditioner=coarse", "aero.flow.common_every=1000", "aero.flow.common_steps=3",
            "aero.flow.group_cells=0"}},
          {"blades, iterated",
           blades,
           {all_sectors, "coupling.scheme=iqn_ils", "coupling.tolerance=1e-3", "coupling.max_evaluations=30"}},
          {"blades that pitch",
           blades_that_pitch,
           {all_sectors, "wind.speed_m_s=18.0", "coupling.scheme=css", "start.air_steps=30", "time.end_s=12.0",
            "time.window_s=0.1", "time.step_s=0.05"}},
          {"lines", lines, {"coupling.scheme=css"}}};
}

}  // namespace

TEST_CASE("tiles of the air that one rank has too many of go to others, with the bits of one rank and over a restart",
          "[coupled][air][mpi2][mpi4]") {
  const Kind kind = kinds().at(GENERATE(0, 1, 2, 3));
  INFO(kind.name);
  const Scenario scenario = scenario_of(kind.scene, kind.overrides);
  const runtime::World world = all_ranks();
  Going expected(scenario, runtime::Parts(alone)), moved(scenario, runtime::Parts(world));
  expected.begin(), moved.begin();
  const std::size_t tiles = expected.own_tiles();
  REQUIRE(tiles >= std::size_t(3 * world.size));
  moved.air().log_lines();
  moved.air().move_tiles(onto_the_last(tiles, world.size));
  const std::size_t most = tiles - std::size_t(world.size - 1);
  REQUIRE(moved.own_tiles() == (world.rank == world.size - 1 ? most : 1));
  CHECK(moves_told(moved.air().log_lines()) == 1);

  moved.advance(2);
  CHECK(moved.own_tiles() == (world.rank == world.size - 1 ? most : 1));
  moved.advance(2);  // weighed before the first of them
  CHECK(moves_told(moved.air().log_lines()) >= 1);
  CHECK(moved.own_tiles() < std::size_t(0.8 * double(most)));
  CHECK(moved.own_tiles() > 1);
  expected.advance(4);
  CHECK(moved.same_as(expected));
  if (kind.name == "blades that pitch") {
    const std::vector<double> places = whole(expected.air().saved(), MPI_COMM_SELF).at("air/places");
    CHECK(places.back() != 0.0);
  }

  int id = getpid();
  MPI_Bcast(&id, 1, MPI_INT, 0, MPI_COMM_WORLD);
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("spindrift_air_balance_" + std::to_string(id) + ".h5");
  moved.save(file);
  Going again(scenario, runtime::Parts(world)), on_one(scenario, runtime::Parts(alone));
  again.restore(file, moved), on_one.restore(file, moved);
  MPI_Barrier(MPI_COMM_WORLD);
  if (world.rank == 0) std::filesystem::remove(file);
  for (Going* run : {&expected, &moved, &again, &on_one}) run->advance(2);
  CHECK(moved.same_as(expected));
  CHECK(again.same_as(expected));
  CHECK(on_one.same_as(expected));
}

TEST_CASE("tiles of the air move among its own ranks where it has some of a run's", "[coupled][air][mpi4]") {
  const Scenario scenario = scenario_of(blades, {all_sectors, "coupling.scheme=cps2"});
  const runtime::World world = all_ranks();
  Going expected(scenario, runtime::Parts(alone)),
      moved(scenario, runtime::Parts(world, 2, world.rank == 0 ? sea_part : air_part));
  expected.begin(), moved.begin();
  moved.air().log_lines();
  moved.air().move_tiles(onto_the_last(expected.own_tiles(), world.size - 1));
  CHECK(moves_told(moved.air().log_lines()) == 1);  // also where the sea is
  moved.advance(4), expected.advance(4);
  CHECK(moves_told(moved.air().log_lines()) >= 1);
  CHECK(moved.same_as(expected));
}

TEST_CASE("tiles stay where bits would follow the clock", "[coupled][air][mpi2]") {
  const std::vector<std::string> overrides{"aero.flow.preconditioner=coarse", "aero.flow.direct_groups=0"};
  const runtime::World world = all_ranks();
  Going run(scenario_of(lines, overrides), runtime::Parts(world));
  run.begin();
  const std::size_t own = run.own_tiles();
  std::int64_t tiles = std::int64_t(own);
  MPI_Allreduce(MPI_IN_PLACE, &tiles, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  run.air().move_tiles(onto_the_last(std::size_t(tiles), world.size));
  run.air().log_lines();
  run.advance(4);
  CHECK(moves_told(run.air().log_lines()) == 0);
  CHECK(run.own_tiles() == (world.rank == 0 ? 1 : std::size_t(tiles - 1)));
}
