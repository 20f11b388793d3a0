// Resolved air as a side of the coupled window: what it gives the bodies is what it answers, a motion from a file is as good as
// one from the bodies, thrust falls as the hub moves downwind. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include <fstream>
#include <iomanip>
#include <iostream>

#include "src/coupling/window.hpp"
#include "tests/coupled/runs.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using namespace spindrift::coupling::test;

namespace {

const runtime::World alone{MPI_COMM_SELF, 0, 1};

Scenario on_platform(const std::string& sectors, std::vector<std::string> overrides) {
  overrides.push_back("aero.grid.sectors=" + sectors);
  return scenario_of(rotor_on_platform + shared_scene("air_of_blades.toml"), overrides);
}

/// Three pseudo-steps: enough to see what is passed on.
const std::vector<std::string> quick{"aero.flow.cfl_max=20.0", "aero.flow.krylov_steps=6", "aero.flow.max_pseudo_steps=3",
                                     "aero.flow.drop=0.0", "start.air_steps=5"};

/// Passes everything on, and writes down how the rotor was to move and what came back.
class Listening final : public AirSide {
 public:
  explicit Listening(std::unique_ptr<AirSide> inner) : inner_(std::move(inner)) {}
  aero::RotorLoad begin(double t, const aero::RotorState& now) override { return inner_->begin(t, now); }
  void prepare(double t, double dt, const aero::RotorState& s) override {
    motion << std::setprecision(17) << t << ' ' << dt;
    for (const Eigen::Vector3d& v : {s.hub, s.hub_velocity, s.axis, s.up, s.omega})
      motion << ' ' << v.x() << ' ' << v.y() << ' ' << v.z();
    motion << ' ' << s.azimuth << ' ' << s.speed << '\n';
    inner_->prepare(t, dt, s);
  }
  Tasks record(runtime::Graph& graph) override { return inner_->record(graph); }
  aero::RotorLoad load_at_end() override {
    answers.push_back(inner_->load_at_end());
    return answers.back();
  }
  const aero::RotorLoad* written() const override { return inner_->written(); }
  void take_snapshot(Snapshot n) override { inner_->take_snapshot(n); }
  void return_to(Snapshot n) override { inner_->return_to(n); }

  std::ostringstream motion;
  std::vector<aero::RotorLoad> answers;

 private:
  std::unique_ptr<AirSide> inner_;
};

}  // namespace

TEST_CASE("what the air answers is what the bodies feel, and its motion from a file gives the same bits",
          "[coupled][air][fast]") {
  const std::string sectors = GENERATE("one", "all");
  INFO(sectors);
  FloatingSystem floating(on_platform(sectors, quick));
  bodies::BodiesState state = make_start(floating).state;
  const aero::RotorState first = floating.rotor()->state(0.0, state.motions);
  auto owned = std::make_unique<Listening>(make_air(floating, first, alone));
  const Listening& heard = *owned;
  CoupledWindow window(floating, {std::move(owned), nullptr});
  window.begin(state);
  for (int n = 0; n < 3; ++n) REQUIRE(window.advance(state).ok());
  const aero::RotorLoad& load = heard.answers.back();
  CHECK(load.thrust > 3e5);

  const bodies::Evaluation& now = floating.multibody().evaluate(state, 0.3);
  const std::size_t rotor = floating.multibody().loads().size() - 1;
  REQUIRE(floating.multibody().loads()[rotor].name == "rotor");
  std::size_t b = 0;
  while (floating.multibody().bodies()[b].name != "rotor") ++b;
  const Wrench& computed = now.by_source[rotor][b];
  const Eigen::Vector3d arm = floating.rotor()->state(0.3, state.motions).hub - state.motions[b].position;
  CHECK((computed.force - load.force).norm() < 1e-13 * load.force.norm());
  CHECK((computed.moment - load.moment - arm.cross(load.force)).norm() < 1e-13 * load.moment.norm());

  const Folder folder("motion");
  std::filesystem::create_directories(folder.path());
  std::ofstream(folder.path() / "motion.txt") << heard.motion.str();
  const std::unique_ptr<AirSide> again = make_air(floating, first, alone);
  again->begin(0.0, first);
  runtime::Graph graph;
  REQUIRE(again->record(graph) != Tasks::none);
  runtime::Executor executor(std::move(graph));
  std::ifstream file(folder.path() / "motion.txt");
  double t, dt;
  std::size_t count = 0;
  while (file >> t >> dt) {
    aero::RotorState s;
    for (Eigen::Vector3d* v : {&s.hub, &s.hub_velocity, &s.axis, &s.up, &s.omega}) file >> v->x() >> v->y() >> v->z();
    file >> s.azimuth >> s.speed;
    again->prepare(t, dt, s);
    executor.run();
    const aero::RotorLoad answer = again->load_at_end();
    CHECK(answer.force == heard.answers.at(count).force);
    CHECK(answer.moment == heard.answers.at(count).moment);
    ++count;
  }
  CHECK(count == heard.answers.size());
}

TEST_CASE("wind that grows with height tilts a rotor whose air has settled in the wind of its hub", "[coupled][air][fast]") {
  // The settled flow is that of the hub's wind; the rest of the profile is added to it, and the blade that points up has more
  // load.
  double tilt[2], thrust[2];
  for (const bool grows : {false, true}) {
    std::vector<std::string> settings = quick;
    if (grows)
      settings.insert(settings.end(), {"wind.profile='power_law'", "wind.shear_exponent=0.2", "wind.reference_height_m=119.0"});
    FloatingSystem floating(on_platform("all", settings));
    const aero::RotorState first = floating.rotor()->state(0.0, make_start(floating).state.motions);
    const std::unique_ptr<AirSide> air = make_air(floating, first, alone);
    air->begin(0.0, first);
    runtime::Graph graph;
    REQUIRE(air->record(graph) != Tasks::none);
    runtime::Executor executor(std::move(graph));
    aero::RotorLoad load;
    for (int n = 1; n <= 6; ++n) {
      aero::RotorState s = first;
      s.azimuth += 0.1 * n * s.speed;
      air->prepare(0.1 * n, 0.1, s);
      executor.run();
      load = air->load_at_end();
      UNSCOPED_INFO("window " << n << ": thrust " << load.thrust << ", tilt " << load.moment.y());
    }
    tilt[grows] = load.moment.y(), thrust[grows] = load.thrust;
  }
  CAPTURE(tilt[0], tilt[1], thrust[0], thrust[1]);
  CHECK(tilt[1] - tilt[0] > 0.01 * thrust[0] * 89.0);
  CHECK(tilt[1] - tilt[0] < 0.15 * thrust[0] * 89.0);
  CHECK(thrust[1] == Approx(thrust[0]).epsilon(0.08));  // half of it at 0.2 s: what is added flows through the blades at first
}

TEST_CASE("thrust falls as the hub of the demo's rotor moves downwind", "[coupled][air][nightly]") {
  // Hub at -1 and +1 m/s from t = 0 on, after the air has settled. The first second sees the wake of the hub at rest.
  FloatingSystem floating(on_platform(
      "one",
      {"without=[\"aero.grid.cells_round\",\"aero.grid.cells_layers\",\"aero.grid.cells_span\",\"aero.grid.first_cell_chords\"]",
       "aero.flow.cfl_max=100.0", "aero.flow.drop=1e-2", "aero.flow.max_pseudo_steps=8", "start.air_steps=150"}));
  const aero::RotorState first = floating.rotor()->state(0.0, make_start(floating).state.motions);
  std::vector<double> thrust[2];
  for (int side = 0; side < 2; ++side) {
    const std::unique_ptr<AirSide> air = make_air(floating, first, alone);
    air->begin(0.0, first);
    runtime::Graph graph;
    REQUIRE(air->record(graph) != Tasks::none);
    runtime::Executor executor(std::move(graph));
    for (int n = 1; n <= 50; ++n) {
      aero::RotorState s = first;
      s.hub += (side ? 0.1 : -0.1) * n * first.axis, s.azimuth += 0.1 * n * first.speed;
      air->prepare(0.1 * n, 0.1, s);
      executor.run();
      thrust[side].push_back(air->load_at_end().thrust);
    }
  }
  for (const int n : {9, 19, 29, 39, 49})
    std::cout << "hub at -1 and +1 m/s for " << 0.1 * (n + 1) << " s: thrust " << 1e-3 * thrust[0][std::size_t(n)] << " and "
              << 1e-3 * thrust[1][std::size_t(n)] << " kN, fall "
              << 5e-4 * (thrust[0][std::size_t(n)] - thrust[1][std::size_t(n)]) << " kN per m/s\n";
  const double fall = 0.5e-3 * (thrust[0].back() - thrust[1].back());
  CHECK(fall > 100.0);
  CHECK(fall < 260.0);
}
