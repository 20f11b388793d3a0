// The resolved rotor as the air, the run and the coupling see it: a uniform stream stays one while the rotor spins, surges,
// pitches and its blades pitch; one sector stands for three; loads add up; bits do not depend on threads and ranks; a window
// undone leaves no trace. SPDX-License-Identifier: Apache-2.0
#include "src/aero/resolved_rotor.hpp"

#include <malloc.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "kernels/base/constants.hpp"
#include "kernels/rigid/rotation.hpp"
#include "src/scene/document.hpp"
#include "src/scene/error.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Catch::Matchers::Contains;
using Eigen::Vector3d;

namespace {

constexpr double rated_rpm = 8.836;

/// The DTU 10-MW rotor on a grid of 6 400 cells a sector, 11 m/s.
ResolvedRotorSetup tiny(const std::string& time, bool whole) {
  ResolvedRotorSetup s;
  s.grid.resolution = 1.0, s.grid.cells_round = 28, s.grid.cells_layers = 6, s.grid.first_cell_chords = 4e-3;
  s.grid.sectors = whole ? "all" : "one";
  s.rotor.turbine = std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/turbines/dtu_10mw.toml";
  s.rotor.hub_m = {1.0, -2.0, 119.0};
  s.rotor.speed = rated_rpm * pi / 30.0;
  s.wind = {11.0, 0.0, 0.0};
  s.flow.time = time, s.flow.viscous = "none", s.flow.matrix_free_below = 0.0, s.flow.krylov_steps = 8, s.flow.cfl = 2.0,
  s.flow.cfl_max = 20.0;
  s.dt = time == "steady" ? 0.0 : 0.05;
  return s;
}

/// Hub on a platform that surges and pitches about the water line while the rotor turns.
RotorPose on_platform(const ResolvedRotor& rotor, std::int64_t step, double t) {
  RotorPose pose = rotor.turned(step);
  const double lean = 0.06 * std::sin(0.7 * t);
  const Eigen::Quaterniond turn = rotation_exp(Vector3d(0.0, lean, 0.0));
  pose.hub.attitude = turn * pose.hub.attitude;
  pose.hub.position = turn * pose.hub.position + Vector3d(2.0 * std::sin(0.5 * t), 0.0, 0.0);
  return pose;
}

/// All blades alike.
RotorPlace pitched(const ResolvedRotor& rotor, const RotorPose& pose, double pitch) {
  return {pose, std::vector<double>(std::size_t(rotor.made().blades()), pitch)};
}

/// Largest deviation from the stream after that many steps; velocity over the tip's.
double free_stream(int steps) {
  ResolvedRotorSetup s = tiny("bdf2", true);
  s.wind = {9.0, 3.0, -4.0};
  for (const char* patch : {"blade_1", "blade_2", "blade_3", "hub", "inflow", "outflow", "far"})
    s.flow.boundaries.push_back({patch, Condition::far_field, false});
  s.flow.drop = 0.0, s.flow.max_pseudo_steps = 2;
  ResolvedRotor rotor(s);
  rotor.solver().start_uniform();
  rotor.prepare(MPI_COMM_SELF, {.threads = 1});
  for (int n = 1; n <= steps; ++n) {
    const double t = n * s.dt, pitch = 4.0 * radians_per_degree * std::sin(1.3 * t);
    rotor.move_to({on_platform(rotor, n, t), {pitch, -pitch, 0.5 * pitch}});
    rotor.run();
  }
  return testing::stream_deviation(rotor.solver());
}

}  // namespace

TEST_CASE("a uniform stream stays one while the rotor spins, surges, leans and its blades pitch", "[rotor][fast]") {
  const double deviation = free_stream(6);
  const double of_bound = deviation / 1e-12;  // printed with digits
  CHECK(of_bound < 1.0);
}
TEST_CASE("a uniform stream stays one through a hundred steps of spin, surge, lean and blade pitch", "[rotor][nightly]") {
  const double deviation = free_stream(100);
  const double of_bound = deviation / 1e-12;  // printed with digits
  CHECK(of_bound < 1.0);
}

namespace {
/// Largest change of velocity over the reference wind's after three steps of a turning rotor grid whose every side lets air
/// through.
double sheared_stream(double resolution, WindLaw law) {
  ResolvedRotorSetup s = tiny("bdf2", true);
  s.grid.resolution = resolution;
  s.grid.cells_round = s.grid.cells_layers = std::nullopt;
  s.grid.radial_extent = s.grid.upstream_extent = 3.0, s.grid.downstream_extent = 6.0;  // cells that the profile's kink asks for
  s.profile = {.law = law, .reference_height = 119.0, .least_height = 10.0};
  for (const char* patch : {"blade_1", "blade_2", "blade_3", "hub", "inflow", "outflow", "far"})
    s.flow.boundaries.push_back({patch, Condition::far_field, false});
  s.flow.drop = 0.0, s.flow.max_pseudo_steps = 4;
  ResolvedRotor rotor(s);
  rotor.solver().start_uniform();
  rotor.prepare(MPI_COMM_SELF, {.threads = 1});
  for (int n = 1; n <= 3; ++n) rotor.advance({rotor.turned(n)});
  double squares = 0.0, volume = 0.0;
  for (const FlowTile& tile : rotor.solver().tiles()) {
    const TileGeometry& g = *tile.geometry;
    for (int k = 0; k < tile.box.nk; ++k)
      for (int j = 0; j < tile.box.nj; ++j)
        for (int i = 0; i < tile.box.ni; ++i) {
          const double* at = tile.state.data() + tile.cells.at(k, j, i) + tile.cells.component;
          const double z = g.centre_data.data()[g.cell_box.at(k, j, i) + 2 * g.cell_box.component];
          const double v = g.volume_data.data()[g.cell_box.at(k, j, i)];
          const Vector3d off(at[0] - 11.0 * s.profile.share(z), at[tile.cells.component], at[2 * tile.cells.component]);
          squares += v * off.squaredNorm(), volume += v;
        }
  }
  return std::sqrt(squares / volume) / 11.0;
}
}  // namespace

TEST_CASE("a wind profile stays what it is through a turning rotor grid to the error of its cells", "[rotor][fast]") {
  const double coarse = sheared_stream(1.0, WindLaw::power);
  CAPTURE(coarse);
  CHECK(coarse < 5e-3);
}

TEST_CASE("one sector with rotational periodicity stands for the rotor, and rows of faces add up to blades", "[rotor][fast]") {
  RotorLoad loads[2];
  for (const bool whole : {false, true}) {
    ResolvedRotorSetup s = tiny("steady", whole);
    s.flow.max_pseudo_steps = 12, s.flow.drop = 0.0;
    ResolvedRotor rotor(s);
    rotor.solver().start_uniform();
    rotor.prepare(MPI_COMM_SELF, {.threads = 1});
    rotor.run();
    loads[whole] = rotor.load();
    CHECK(rotor.load(rotor.solver().rows().back()).thrust == Approx(loads[whole].thrust).epsilon(1e-12));
    double thrust = 0.0, lever = 0.0;
    for (const SpanLoad& row : rotor.span_loads())
      thrust += row.load.normal * row.length, lever += row.load.tangential * row.length * row.radius;
    const double blades = whole ? 1.0 : 3.0;
    CHECK(blades * thrust == Approx(loads[whole].thrust).epsilon(1e-10));
    CHECK(blades * lever == Approx(loads[whole].torque).epsilon(0.05));  // forces act off the quarter-chord line of a row
    double mean = 0.0, along = 0.0;
    const std::span last_rows = std::span(rotor.solver().rows()).last(5);
    for (const PseudoRow& row : last_rows) mean += rotor.load(row).thrust / 5.0;
    for (const SpanLoad& row : rotor.span_loads(last_rows)) along += blades * row.load.normal * row.length;
    CHECK(along == Approx(mean).epsilon(1e-10));
    CHECK(std::abs(mean / loads[whole].thrust - 1.0) > 1e-6);
    CHECK(loads[whole].power == Approx(loads[whole].torque * s.rotor.speed).epsilon(1e-14));
  }
  CHECK(loads[0].thrust > 2e5);
  // On the way, after 12 steps: a matrix of 16 bits is not rounded alike in turned axes.
  CHECK(loads[1].thrust == Approx(loads[0].thrust).epsilon(1e-4));
  CHECK(loads[1].torque == Approx(loads[0].torque).epsilon(3e-4));
  CHECK(loads[0].force.cross(Vector3d::UnitX()).norm() < 1e-6 * loads[0].thrust);
}

namespace {
ResolvedRotorSetup turning() {
  ResolvedRotorSetup s = tiny("bdf2", true);
  s.flow.viscous = "full", s.flow.turbulence = "sa", s.flow.max_pseudo_steps = 3;
  return s;
}
RotorLoad step(ResolvedRotor& rotor, int n) { return rotor.advance(pitched(rotor, on_platform(rotor, n, 0.05 * n), 0.01 * n)); }
}  // namespace

TEST_CASE("threads leave every bit of a turning rotor as it is", "[rotor][fast]") {
  std::vector<double> expected;
  for (const int threads : {1, 3}) {
    ResolvedRotor rotor(turning());
    rotor.solver().start_uniform();
    rotor.prepare(MPI_COMM_SELF, {.threads = threads});
    for (int n = 1; n <= 2; ++n) step(rotor, n);
    const std::vector<double> now = testing::state_of(rotor.solver());
    if (expected.empty()) expected = now;
    CHECK(now == expected);
  }
}

TEST_CASE("loads along the blades are summed at the end of a step of time, and for every state of a steady march",
          "[rotor][fast]") {
  for (const bool unsteady : {true, false}) {
    ResolvedRotorSetup s = unsteady ? turning() : tiny("steady", true);
    if (!unsteady) s.flow.max_pseudo_steps = 3, s.flow.drop = 0.0;
    ResolvedRotor rotor(s);
    rotor.solver().start_uniform();
    rotor.prepare(MPI_COMM_SELF, {.threads = 1});
    constexpr double untouched = -12345.0;
    Judgement& judgement = rotor.solver().judgement();
    REQUIRE_FALSE(judgement.bands.result.empty());
    std::ranges::fill(judgement.bands.result, untouched);
    int rows = 0, summed = 0;
    judgement.rows.watcher = [&](const PseudoRow&) { ++rows, summed += judgement.bands.result[0] != untouched; };
    if (unsteady)
      step(rotor, 1);
    else
      rotor.run();
    CHECK(rows >= 3);
    CHECK(summed == (unsteady ? 0 : rows - 1));  // of the rows before
    const std::size_t bands = judgement.bands.result.size(), patches = judgement.loads.result.size();
    CHECK(std::ranges::count(judgement.bands.result, untouched) == 0);
    const std::vector<PseudoRow>& all = judgement.rows.all;
    CHECK(all.back().loads.size() == patches + bands);
    CHECK(std::ranges::equal(std::span(all.back().loads).last(bands), judgement.bands.result));
    CHECK(all.front().loads.size() == patches + (unsteady ? 0 : bands));
  }
}

TEST_CASE("two ranks give the bits of one for a turning rotor", "[rotor][mpi2]") {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  ResolvedRotor whole(turning()), part(turning(), 2, rank);
  whole.solver().start_uniform(), part.solver().start_uniform();
  whole.prepare(MPI_COMM_SELF, {.threads = 1});
  part.prepare(MPI_COMM_WORLD, {.threads = 1});
  for (int n = 1; n <= 2; ++n) {
    const RotorLoad a = step(whole, n), b = step(part, n);
    CHECK(a.force == b.force);
    CHECK(a.moment == b.moment);
  }
  const auto a = whole.span_loads(), b = part.span_loads();
  REQUIRE(a.size() == b.size());
  for (std::size_t n = 0; n < a.size(); ++n)
    CHECK((a[n].load.normal == b[n].load.normal && a[n].friction.tangential == b[n].friction.tangential));
}

TEST_CASE("a window undone and done again leaves the bits of one done once", "[rotor][fast]") {
  ResolvedRotor once(turning()), twice(turning());
  for (ResolvedRotor* rotor : {&once, &twice}) {
    rotor->solver().start_uniform();
    rotor->prepare(MPI_COMM_SELF, {.threads = 1});
    step(*rotor, 1);
  }
  step(once, 2);
  const RotorLoad expected = step(once, 3);
  step(twice, 2);
  const ResolvedRotor::Snapshot before = twice.snapshot();
  RotorPose astray = on_platform(twice, 3, 0.15);
  astray.hub.position += Vector3d(0.1, 0.0, 0.05);
  const RotorLoad other = twice.advance(pitched(twice, astray, -0.02));
  CHECK((other.force - expected.force).norm() > 1.0);
  twice.restore(before);
  const RotorLoad again = step(twice, 3);
  CHECK(again.force == expected.force);
  CHECK(again.moment == expected.moment);
  CHECK(testing::state_of(twice.solver()) == testing::state_of(once.solver()));
}

namespace {
/// One sector with rotational periodicity.
ResolvedRotorSetup preconditioned(const std::string& time, const std::string& name, int direct_groups = 512) {
  ResolvedRotorSetup s = tiny(time, false);
  s.flow.preconditioner = name, s.flow.group_cells = 4, s.flow.direct_groups = direct_groups;
  s.flow.cfl = 50.0, s.flow.cfl_max = 50.0, s.flow.drop = 0.0, s.flow.max_pseudo_steps = 2;
  return s;
}
constexpr int coarse_levels[]{4096, 0};  // by elimination, by multigrid: most groups that are eliminated
}  // namespace

TEST_CASE("preconditioners with a coarse level end in block ILU's flow round a periodic sector, and solve more at long steps",
          "[rotor][fast]") {
  struct Marched {
    RotorLoad load;
    double drop;  // of the linear residual, by at most 40 iterations
  };
  const auto marched = [](ResolvedRotorSetup s, double cfl) {
    s.flow.krylov_steps = 40, s.flow.krylov_drop = 1e-4, s.flow.cfl = s.flow.cfl_max = cfl;
    ResolvedRotor rotor(s);
    rotor.solver().start_uniform();
    rotor.prepare(MPI_COMM_SELF, {.threads = 1});
    rotor.run();
    return Marched{rotor.load(), rotor.solver().march().last.linear_drop};
  };
  const ResolvedRotorSetup plain = preconditioned("steady", "block_ilu");
  const Marched ilu = marched(plain, 10.0), ilu_long = marched(plain, 1000.0);
  REQUIRE(ilu.drop <= 1e-3);
  REQUIRE(ilu_long.drop > 1e-2);
  for (const int direct : coarse_levels) {
    const ResolvedRotorSetup s = preconditioned("steady", "coarse", direct);
    const Marched with = marched(s, 10.0), with_long = marched(s, 1000.0);
    CAPTURE(direct, with.drop, ilu_long.drop, with_long.drop, ilu.load.thrust, with.load.thrust);
    CHECK(with.drop <= 1e-3);
    // Two steps, each with what a drop of 1e-3 leaves of its linear system.
    CHECK(with.load.thrust == Approx(ilu.load.thrust).epsilon(2e-3));
    CHECK(with.load.torque == Approx(ilu.load.torque).epsilon(2e-3));
    CHECK(with_long.drop < 0.7 * ilu_long.drop);
  }
}

TEST_CASE("a turning periodic sector with a coarse level kept over steps: same bits on any threads and after a restart",
          "[rotor][fast]") {
  for (const int direct : coarse_levels) {
    CAPTURE(direct);
    ResolvedRotorSetup s = preconditioned("bdf2", "coarse", direct);
    s.flow.common_every = 2, s.flow.common_steps = 2;
    ResolvedRotor one(s), three(s), again(s);
    one.solver().start_uniform(), three.solver().start_uniform();
    one.prepare(MPI_COMM_SELF, {.threads = 1}), three.prepare(MPI_COMM_SELF, {.threads = 3}),
        again.prepare(MPI_COMM_SELF, {.threads = 2});
    for (int n = 1; n <= 3; ++n) one.advance({one.turned(n)}), three.advance({three.turned(n)});
    CHECK(testing::state_of(one.solver()) == testing::state_of(three.solver()));
    ResolvedRotor::Snapshot saved = three.snapshot();  // step 4 goes on with the set-up of step 3
    saved.air.set_up.number = 0;                       // another rotor's
    again.restore(saved);
    one.advance({one.turned(4)}), again.advance({again.turned(4)});
    CHECK(testing::state_of(one.solver()) == testing::state_of(again.solver()));
  }
}

TEST_CASE("two ranks give a periodic sector with an eliminated coarse correction the bits of one", "[rotor][mpi2]") {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const ResolvedRotorSetup s = preconditioned("bdf2", "coarse", 4096);
  ResolvedRotor whole(s), part(s, 2, rank);
  whole.solver().start_uniform(), part.solver().start_uniform();
  whole.prepare(MPI_COMM_SELF, {.threads = 1}), part.prepare(MPI_COMM_WORLD, {.threads = 1});
  for (int n = 1; n <= 2; ++n) {
    const RotorLoad a = whole.advance({whole.turned(n)}), b = part.advance({part.turned(n)});
    CHECK(a.force == b.force);
    CHECK(a.moment == b.moment);
  }
}

namespace {
std::string problems(const std::string& rotor, const std::string& aero, const Vector3d& wind, const WindProfile& profile = {}) {
  scene::Document doc = scene::parse("[aero]\nmodel = 'blade_resolved'\n[aero.grid]\n" + aero + "\n[rotor]\n" + rotor,
                                     "test.toml", std::filesystem::path(SPINDRIFT_SOURCE_DIR) / "inputs" / "turbines");
  const AeroOptions air = doc.read(aero_section());
  const RotorOptions options = doc.read(rotor_section());
  check_resolved_rotor(doc, air, options, wind, profile);
  try {
    doc.finish();
  } catch (const scene::SceneError& e) { return e.what(); }
  return "";
}
}  // namespace

TEST_CASE("a scene that no resolved rotor can be made of says what is wrong", "[rotor][fast]") {
  const std::string dtu = "turbine = 'dtu_10mw.toml'\nspeed_rpm = 8.836\n", bdf2 = "[aero.flow]\ntime = 'bdf2'\n",
                    steady = "[aero.flow]\ntime = 'steady'\n";
  CHECK(problems(dtu, steady, {11, 0, 0}).empty());
  CHECK(problems(dtu, "sectors = 'all'\n" + bdf2, {10, 4, 0}).empty());
  CHECK_THAT(problems("speed_rpm = 8.836\n", steady, {11, 0, 0}),
             Contains("rotor.turbine") && Contains("must name a turbine file"));
  CHECK_THAT(problems(dtu, steady, {10, 4, 0}), Contains("needs the wind along the rotor axis; it is 21.8 degrees off"));
  CHECK_THAT(problems(dtu, "sectors = 'one'\n" + bdf2, {10, 4, 0}), Contains("aero.grid.sectors") && Contains("take \"all\""));
  const WindProfile power{.law = WindLaw::power, .reference_height = 119.0};
  CHECK(problems(dtu, "sectors = 'all'\n" + bdf2, {11, 0, 0}, power).empty());
  CHECK_THAT(problems(dtu, steady, {11, 0, 0}, power), Contains("aero.flow.time") && Contains("needs a wind of one speed"));
  CHECK_THAT(problems(dtu, "sectors = 'one'\n" + bdf2, {11, 0, 0}, power),
             Contains("aero.grid.sectors") && Contains("gives each its own wind: take \"all\""));
  CHECK_THAT(problems("turbine = 'dtu_10mw.toml'\n", bdf2, {0, 0, 0}), Contains("nothing would move"));
  CHECK_THAT(problems(dtu, bdf2 + "grid = 'dtu_10mw.toml'\nmap = 'dtu_10mw.toml'\n", {11, 0, 0}), Contains("beside [aero.grid]"));
}

TEST_CASE(
    "a rotor held still and one that turns have the same wall distances, and the next solver of a grid takes those of the last",
    "[rotor][fast]") {
  const auto setup = [](const std::string& time) {
    ResolvedRotorSetup s = tiny(time, false);
    s.flow.viscous = "full", s.flow.turbulence = "sa";
    return s;
  };
  const auto distances = [](ResolvedRotor& rotor) {
    WallDistances all;
    keep_wall_distance(rotor.store(), all);
    return all;
  };
  ResolvedRotor held(setup("steady")), turning(setup("bdf2"));
  const WallDistances own = distances(held);
  CHECK(own.size() == std::size_t(held.store().tiling().size()));
  CHECK(distances(turning) == own);
  // As far from a blade as where the held rotor stands: the nearest wall face there.
  const WallSurface blades = [&] {
    std::vector<WallSurface::Face> faces = made_rotor_grid(setup("steady"))->walls;
    for (WallSurface::Face& face : faces)
      for (Vector3d& x : face) x = held.pose().attitude() * x + held.pose().hub.position;
    return WallSurface(faces);
  }();
  const TileGeometry& tile = std::as_const(held.store())[0];
  const auto centre = tile.centre();
  const int k = tile.inner_box.nk / 2, j = tile.inner_box.nj / 2, i = tile.inner_box.ni / 2;
  CHECK(tile.wall_distance()(0, k, j, i) ==
        Approx(blades.distance({centre(0, k, j, i), centre(1, k, j, i), centre(2, k, j, i)})).epsilon(1e-9));

  const std::shared_ptr<const MadeRotorGrid> made = made_rotor_grid(setup("steady"));
  ResolvedRotor first(setup("steady"), 1, 0, 0, made);
  CHECK(*made->distances == own);
  for (auto& [t, values] : *made->distances) values[0] += 1.0;
  ResolvedRotor second(setup("bdf2"), 1, 0, 0, made);
  CHECK(distances(second) == *made->distances);
}

TEST_CASE("the memory of a rotor is foretold within a tenth of what it takes", "[rotor][fast]") {
  for (const std::string time : {"steady", "bdf2"})
    for (const std::string turbulence : {"none", "sa", "sst"}) {
      ResolvedRotorSetup s = tiny(time, true);
      if (turbulence != "none") s.flow.viscous = "full", s.flow.turbulence = turbulence;
      if (turbulence == "sst") s.flow.tile_cells = 256;
      s.flow.max_pseudo_steps = 1, s.flow.drop = 0.0, s.flow.krylov_drop = 1e-9;  // so that all vectors are made
      ResolvedRotor rotor(s);
      rotor.solver().start_uniform();
      rotor.prepare(MPI_COMM_SELF, {.threads = 1});
      if (time != "steady") rotor.move_to({rotor.turned(1)});
      rotor.run();
      const ResolvedRotorSize size = resolved_rotor_size(s);
      CHECK(size.cells == rotor.solver().cells());
      const double state = 8.0 * double(size.cells) *
                           (turbulence == "none" ? 5
                            : turbulence == "sa" ? 6
                                                 : 7) *
                           (time == "steady" ? 1 : 3);
      CHECK(size.bytes_of_checkpoint == Approx(state));
      const double note = time == "steady" ? 0.0 : state;
      CHECK(size.bytes - note == Approx(double(rotor.solver().bytes() + rotor.store().bytes())).epsilon(0.1));
    }
}

TEST_CASE("third order in time, and a tolerance of its error, cost a past level each, as foretold", "[rotor][fast]") {
  const auto sizes = [](const std::string& time, std::optional<double> tolerance) {
    ResolvedRotorSetup s = tiny(time, true);
    s.flow.time_tolerance = tolerance;
    const ResolvedRotor rotor(s);
    const ResolvedRotorSize size = resolved_rotor_size(s);
    const double cells = double(size.cells), state = 5.0 * 8.0;
    return std::array{(size.bytes - size.bytes_of_checkpoint) / cells,  // without the copy that a restart point takes
                      double(const_cast<ResolvedRotor&>(rotor).store().bytes() + rotor.solver().bytes()) / cells,
                      size.bytes_of_checkpoint / cells / state,
                      double(rotor.solver().restart().size(0)) / double(rotor.solver().tiles()[0].box.count()) / 5.0};
  };
  const auto second = sizes("bdf2", {}), third = sizes("bdf3", {}), held = sizes("bdf3", 1e-3);
  CHECK(second[3] == 3.0);
  CHECK(third[3] == 4.0);
  CHECK(held[3] == 5.0);
  for (const auto& of : {second, third, held}) CHECK(of[2] == Approx(of[3]));
  CAPTURE(second[1], third[1], held[1]);
  CHECK(third[1] - second[1] > 90.0);  // the flow's past, places of nodes and swept volumes
  CHECK(third[0] - second[0] == Approx(third[1] - second[1]).epsilon(0.1));
  CHECK(held[0] - third[0] == Approx(held[1] - third[1]).epsilon(0.1));
}

#if !defined(SPINDRIFT_SANITIZED)  // whose heap is not the one that is asked
TEST_CASE("a rank has the air of its own tiles, and not a number for each cell of all others", "[rotor][fast]") {
  const auto in_use = [] {
    const struct mallinfo2 now = mallinfo2();
    return double(now.uordblks) + double(now.hblkhd);
  };
  constexpr int ranks = 8;
  struct Share {
    double cells = 0.0, one = 0.0, most = 0.0, on_every_rank = 0.0;  ///< bytes: of one rank alone, of the largest of eight
  };
  const auto share = [&](const ResolvedRotorSetup& s) {
    Share found;
    const auto bytes = [&](int of, int rank) {
      const double before = in_use();
      const ResolvedRotor rotor(s, of, rank);
      found.cells = double(rotor.solver().cells());
      return in_use() - before;
    };
    (void)bytes(1, 0);  // what the first one leaves for all
    found.one = bytes(1, 0);
    double all = 0.0;
    for (int rank = 0; rank < ranks; ++rank) {
      const double mine = bytes(ranks, rank);
      all += mine, found.most = std::max(found.most, mine);
    }
    found.on_every_rank = (all - found.one) / (ranks - 1);
    return found;
  };
  const std::string time = GENERATE("steady", "bdf2");
  ResolvedRotorSetup s = tiny(time, true);
  const Share coarse = share(s);
  s.grid.resolution = 1.4;
  const Share fine = share(s);
  // Turbine and descriptions of tiles are everywhere; what grows with the cells is not.
  const double more = (fine.on_every_rank - coarse.on_every_rank) / (fine.cells - coarse.cells);
  INFO(fine.cells << " cells: " << fine.one << " bytes on one rank, " << fine.most << " at most on one of " << ranks
                  << ", of them " << fine.on_every_rank << " on every one, " << more << " for each further cell");
  CHECK(more < sizeof(double));
  CHECK(fine.most < 1.3 * fine.one / ranks);
}
#endif

TEST_CASE("far sides that act like a wind tunnel's walls are said to, with what they add", "[rotor][fast]") {
  CHECK(far_side_excess({.radial_extent = 3.0}) == Approx(0.0497).margin(1e-4));
  CHECK_THAT(far_side_note({.radial_extent = 3.0}),
             Contains("at 3 tip radii") && Contains("some 5.0 %") && Contains("6 % of thrust and 15 % of power"));
  CHECK_THAT(far_side_note({.radial_extent = 6.0}), Contains("some 1.2 %"));
  CHECK(far_side_note({.radial_extent = 12.0}).empty());
}

TEST_CASE("a short march measures what a pseudo-step costs", "[rotor][fast]") {
  const AirRate rate = measured_air_rate(tiny("bdf2", true));
  CHECK(rate.pseudo_steps == 8);
  CHECK(rate.core_seconds > 1e-7);
  CHECK(rate.core_seconds < 1e-3);
}
