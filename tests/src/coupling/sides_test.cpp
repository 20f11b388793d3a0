// A side that only some ranks have answers on all of them, or fails on all of them.
// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/sides.hpp"

#include <catch2/catch.hpp>

#include "kernels/base/failure.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "src/coupling/retries.hpp"
#include "src/io/machine_failure.hpp"
#include "src/scene/error.hpp"

namespace spindrift::coupling {

namespace {

using runtime::Parts, runtime::World;

/// Answers with the time it was aimed at; fails at some.
class ToldAir final : public AirSide {
 public:
  aero::RotorLoad begin(double t, const aero::RotorState&) override {
    if (t > 50.0) throw io::InputError("no such air");
    t_ = t;
    return load_at_end();
  }
  void prepare(double t, double, const aero::RotorState&) override { t_ = t; }
  aero::RotorLoad load_at_end() override {
    if (t_ < -5.0) throw LastingFailure("the air will not do", "aero/rotor", 8, t_);
    if (t_ < 0.0) throw NumericalFailure("the air gave up", "aero/rotor", 7, t_, 0.5);
    load_.thrust = t_, load_.force = {1.0 / 3.0 * t_, 2.0, 3.0}, load_.moment = {4.0, 5.0, 1e300};
    return load_;
  }
  const aero::RotorLoad* written() const override { return &load_; }
  std::vector<io::Column> columns() const override { return {{"air.told", "s", "when"}}; }
  std::vector<double> values() const override { return {2.0 * t_}; }
  std::vector<std::string> log_lines() override { return {"aimed", "hit"}; }
  void end_window() override { ++windows_; }
  Account account() const override {
    return {{{"windows_hit", windows_}, {"windows_missed", 0}}, {"all shots are faint"}, {"warning: hit often"}};
  }

 private:
  double t_ = 0.0;
  std::int64_t windows_ = 0;
  aero::RotorLoad load_;
};

class ToldBodies final : public BodySide {
 public:
  void prepare(const bodies::BodiesState& from, std::int64_t end_tick) override { state_ = from, state_.tick = end_tick; }
  bodies::BodiesState finish() override {
    if (state_.tick > 100) throw NumericalFailure("the sea gave up", "sea", long(state_.tick), 1.0, 0.25);
    steps_ += 3, own_ns_ += 11;
    state_.motions[0].position.x() += 1.0 / 3.0;
    state_.joint_angles[0] = 2.0, state_.independent[1] = 1;
    return state_;
  }

 private:
  bodies::BodiesState state_;
};

World world() { return {MPI_COMM_WORLD, runtime::rank_in(MPI_COMM_WORLD), runtime::ranks_in(MPI_COMM_WORLD)}; }
Parts last_rank_has_the_air() { return Parts(world(), 2, world().rank == world().size - 1 ? air_part : sea_part); }

}  // namespace

TEST_CASE("the air's answer, columns and sentences are on every rank, and so is its failure", "[coupling][mpi2]") {
  const Parts parts = last_rank_has_the_air();
  const auto air = share_air(parts, parts.has(air_part) ? std::make_unique<ToldAir>() : nullptr);
  REQUIRE(air->columns().size() == 1);
  CHECK(air->columns()[0].name == "air.told");
  CHECK(air->log_lines() == std::vector<std::string>{"aimed", "hit"});
  CHECK(air->log_lines().empty());
  CHECK(air->begin(1.0, {}).thrust == 1.0);
  air->take_snapshot(AirSide::window);
  air->prepare(5.0, 0.1, {});
  const aero::RotorLoad load = air->load_at_end();
  CHECK(load.thrust == 5.0);
  CHECK((load.force == Eigen::Vector3d(1.0 / 3.0 * 5.0, 2.0, 3.0) && load.moment == Eigen::Vector3d(4.0, 5.0, 1e300)));
  CHECK(air->values() == std::vector<double>{10.0});
  REQUIRE(air->written());
  CHECK(air->written()->thrust == 5.0);
  air->return_to(AirSide::window);
  CHECK(air->written()->thrust == 1.0);
  for (int window = 0; window < 3; ++window) air->end_window();
  CHECK(air->account().counts == std::vector<std::pair<std::string, std::int64_t>>{{"windows_hit", 3}, {"windows_missed", 0}});
  CHECK(air->account().doubts == std::vector<std::string>{"all shots are faint"});
  CHECK(air->account().sentences == std::vector<std::string>{"aimed", "hit", "warning: hit often"});
  air->prepare(-1.0, 0.1, {});
  try {
    air->load_at_end();
    FAIL("a failure of the air is not noticed");
  } catch (const NumericalFailure& f) {
    CHECK(std::string(f.what()) == "the air gave up");
    CHECK((f.place == "aero/rotor" && f.step == 7 && f.time_s == -1.0 && f.limit == 0.5));
  }
  air->prepare(-9.0, 0.1, {});
  CHECK_THROWS_AS(air->load_at_end(), LastingFailure);
  CHECK_THROWS_AS(air->begin(60.0, {}), io::InputError);
}

TEST_CASE("the bodies' state and steps are on every rank, and so is the sea's failure", "[coupling][mpi2]") {
  const Parts parts = last_rank_has_the_air();
  const auto side = share_bodies(parts, parts.has(sea_part) ? std::make_unique<ToldBodies>() : nullptr);
  bodies::BodiesState state;
  state.motions.resize(1), state.joint_angles.resize(1), state.independent.resize(6), state.active.resize(2);
  side->prepare(state, 42);
  const bodies::BodiesState end = side->finish();
  CHECK((end.tick == 42 && end.motions[0].position.x() == 1.0 / 3.0 && end.joint_angles[0] == 2.0 && end.independent[1] == 1));
  CHECK((side->steps() == 3 && side->own_ns() == 11));
  side->prepare(state, 101);
  CHECK_THROWS_AS(side->finish(), NumericalFailure);
}

TEST_CASE("what is wrong with the files of one side stops all ranks with the same words", "[coupling][mpi2]") {
  const Parts parts = last_rank_has_the_air();
  int done = 0;
  on_parts(parts, [&] { ++done; });
  CHECK(done == 1);
  CHECK_THROWS_WITH(on_parts(parts,
                             [&] {
                               if (parts.has(air_part)) throw io::InputError("no such air");
                             }),
                    "no such air");
  CHECK_THROWS_WITH(on_parts(parts,
                             [&] {
                               if (parts.has(sea_part)) throw scene::SceneError({{"a.toml", 3, "sea", "", "too small"}});
                             }),
                    Catch::Contains("too small"));
  CHECK_THROWS_AS(on_parts(parts,
                           [&] {
                             if (parts.has(air_part)) throw runtime::StopAsked();
                           }),
                  runtime::StopAsked);
}

TEST_CASE("arrays of one side are written by its ranks into the file of all", "[coupling][mpi2]") {
  const Parts parts = last_rank_has_the_air();
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "spindrift_sides_test.h5";
  {
    io::CheckpointWriter file(parts.world().comm, path);
    std::vector<SavedArray> mine;
    if (parts.has(air_part)) mine = {{"air/a", 3, {{0, {1.0, 2.0}}, {2, {3.0}}}}, {"air/b", 1, {{0, {4.0}}}}};
    io::CheckpointCopy copy;
    write(copy, parts, air_part, mine);
    copy.write_to(file);
    file.commit();
  }
  const io::CheckpointReader file(parts.world().comm, path);
  CHECK(file.read<double>("air/a") == std::vector<double>{1.0, 2.0, 3.0});
  CHECK(file.read<double>("air/b") == std::vector<double>{4.0});
}

}  // namespace spindrift::coupling
