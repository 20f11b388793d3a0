// Several rotors on the same bodies, [rotors.NAME]: their loads together, their winds, what a scene may not ask of them.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"
#include "src/coupling/doubts.hpp"
#include "src/coupling/recorder.hpp"
#include "src/coupling/start.hpp"
#include "src/scene/error.hpp"
#include "tests/src/coupling/scenes.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using Catch::Contains;

namespace {

using Texts = std::vector<std::string>;

Texts operator+(Texts a, const Texts& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// A body that floats free of weight, alike left and right.
const char* const carrier = R"(
[time]
end_s = 4.0
window_s = 0.1
step_s = 0.02
[environment]
gravity_m_s2 = 0.0
[wind]
speed_m_s = 11.0
[aero]
model = "bem"
[bodies.platform]
mass_kg = 2.0e7
inertia_kg_m2 = [2.0e11, 5.0e10, 2.0e11]
centre_m = [0.0, 0.0, 0.0]
)";

const std::string turbine = "inputs/turbines/dtu_10mw.toml";

/// A rotor of the DTU 10 MW turbine in this section.
Texts rotor(const std::string& section, double y, const std::string& more = "") {
  Texts keys{section + ".body='platform'", section + ".turbine='" + SPINDRIFT_SOURCE_DIR "/" + turbine + "'",
             section + ".hub_m=[-8.0," + std::to_string(y) + ",119.0]", section + ".azimuth_deg=25.0",
             section + ".operating_point='table'"};
  if (!more.empty()) keys.push_back(section + "." + more);
  return keys;
}
Texts twin(double y = 105.0) { return rotor("rotors.left", y) + rotor("rotors.right", -y, "turns='counter_clockwise'"); }

Wrench of_sources(const bodies::Evaluation& now) {
  Wrench sum;
  for (const std::vector<Wrench>& source : now.by_source) sum += source[0];
  return sum;
}

std::vector<double> history_row(FloatingSystem& floating, const bodies::BodiesState& state, double t, Texts& names) {
  io::History history;
  Recorder recorder(floating, history);
  names.clear();
  for (const io::Column& column : history.columns()) names.push_back(column.name);
  std::vector<double> row(history.columns().size());
  recorder.fill(row, state, t);
  return row;
}

double value(const std::vector<double>& row, const Texts& names, const std::string& name) {
  const auto at = std::ranges::find(names, name);
  REQUIRE(at != names.end());
  return row[std::size_t(at - names.begin())];
}

}  // namespace

TEST_CASE("two rotors side by side that turn against each other have twice the load of one and neither yaw, roll nor sway",
          "[coupling][fast]") {
  const Texts conditions{"wind.profile='power_law'", "wind.reference_height_m=119.0",
                         "wind.shear_exponent=0.14", "aero.dynamic_inflow='oye'",
                         "aero.dynamic_stall='oye'", "aero.tower.stations=[[0.0,8.0,1.0],[115.0,5.5,1.0]]"};
  FloatingSystem both(test::scenario(
      carrier, conditions + twin() + Texts{"rotors.left.tower_foot_m=[0.0,105.0]", "rotors.right.tower_foot_m=[0.0,-105.0]"}));
  FloatingSystem one(test::scenario(carrier, conditions + rotor("rotor", 105.0) + Texts{"aero.tower.foot_m=[0.0,105.0]"}));
  const bodies::BodiesState start = make_start(both).state, start_of_one = make_start(one).state;
  const Wrench sum = of_sources(both.multibody().evaluate(start, 0.0));
  const Wrench single = of_sources(one.multibody().evaluate(start_of_one, 0.0));
  CHECK(single.force.x() > 1e6);
  CHECK(sum.force.x() == Approx(2.0 * single.force.x()).epsilon(1e-13));
  CHECK(sum.force.z() == Approx(2.0 * single.force.z()).epsilon(1e-12));
  CHECK(sum.moment.y() == Approx(2.0 * single.moment.y()).epsilon(1e-13));
  CHECK(std::abs(single.moment.z()) > 1e8);  // one alone yaws and rolls the platform
  CHECK(std::abs(single.moment.x()) > 1e7);
  CHECK(std::abs(sum.force.y()) < 1e-12 * sum.force.x());
  CHECK(std::abs(sum.moment.x()) < 1e-12 * sum.moment.y());
  CHECK(std::abs(sum.moment.z()) < 1e-12 * sum.moment.y());
}

TEST_CASE("a platform with two controlled rotors that turn against each other keeps its heading; with two alike it does not",
          "[coupling][fast]") {
  const auto after = [](const Texts& overrides) {
    FloatingSystem floating(test::scenario(carrier, Texts{"control.model='dtu'"} + overrides));
    bodies::BodiesState state = make_start(floating).state;
    for (int n = 0; n < 200; ++n) REQUIRE(floating.multibody().advance(state, 0.02, 1).ok());
    const Motion& m = state.motions[0];
    return std::pair(m.omega_earth(), m.velocity);
  };
  const auto [turning, velocity] = after(twin());
  CHECK(velocity.x() > 0.1);
  CHECK(turning.y() > 1e-3);
  CHECK(std::abs(turning.x()) < 1e-10 * turning.y());
  CHECK(std::abs(turning.z()) < 1e-10 * turning.y());
  CHECK(std::abs(velocity.y()) < 1e-10 * velocity.x());
  const auto [turning_alike, velocity_alike] = after(rotor("rotors.left", 105.0) + rotor("rotors.right", -105.0));
  CHECK(std::abs(turning_alike.x()) > 1e-4);  // the generators' torques add up
}

TEST_CASE("a rotor alone in [rotors.a] has the numbers of [rotor], bit for bit", "[coupling][fast]") {
  const Texts models{"aero.dynamic_inflow='oye'",     "aero.dynamic_stall='beddoes_leishman'",
                     "control.model='dtu'",           "wind.profile='power_law'",
                     "wind.reference_height_m=119.0", "wind.shear_exponent=0.14",
                     "wind.event.what='eog'",         "wind.event.start_s=0.0",
                     "environment.gravity_m_s2=9.81", "aero.tower.stations=[[0.0,8.0,1.0],[115.0,5.5,1.0]]"};
  const std::string masses = std::string("blade_masses='") + SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw/blade_masses.csv'";
  std::vector<double> rows[2];
  Texts names[2];
  for (const bool several : {false, true}) {
    FloatingSystem floating(test::scenario(carrier, models + rotor(several ? "rotors.a" : "rotor", 3.0, masses)));
    bodies::BodiesState state = make_start(floating).state;
    for (int n = 0; n < 100; ++n) REQUIRE(floating.multibody().advance(state, 0.02, 1).ok());
    rows[several] = history_row(floating, state, 2.0, names[several]);
  }
  REQUIRE(rows[0].size() == rows[1].size());
  CHECK(rows[0] == rows[1]);
  for (std::size_t n = 0; n < names[0].size(); ++n) {
    std::string expected = names[0][n];
    if (const auto at = expected.find("rotor."); at != std::string::npos) expected.replace(at, 6, "rotor.a.");
    CHECK(names[1][n] == expected);
  }
}

TEST_CASE("each rotor meets the wind at its own hub: its height in shear, its place in one box of turbulence",
          "[coupling][fast]") {
  const Texts sheared{"wind.profile='power_law'", "wind.reference_height_m=119.0", "wind.shear_exponent=0.14"};
  FloatingSystem steady(test::scenario(carrier, sheared + twin() + Texts{"rotors.right.hub_m=[-8.0,-105.0,140.0]"}));
  Texts names;
  const auto row = history_row(steady, make_start(steady).state, 0.0, names);
  CHECK(value(row, names, "rotor.left.wind_x_m_s") == Approx(11.0));
  CHECK(value(row, names, "rotor.right.wind_x_m_s") == Approx(11.0 * std::pow(140.0 / 119.0, 0.14)));
  CHECK(value(row, names, "rotor.right.rpm") > value(row, names, "rotor.left.rpm"));  // the table at its own wind

  const Texts box{"wind.turbulence.model='kaimal'", "wind.turbulence.points_across=9", "wind.turbulence.points_up=5",
                  "wind.turbulence.duration_s=20.0", "wind.turbulence.step_s=0.5"};
  FloatingSystem gusty(test::scenario(carrier, box + twin()));
  const aero::Wind &left = gusty.rotors()[0].loads.wind(), &right = gusty.rotors()[1].loads.wind();
  CHECK(left.in_time == right.in_time);  // one box
  const Eigen::Vector3d at_left(-8, 105, 119), at_right(-8, -105, 119);
  CHECK(left.at(3.0, at_left) == right.at(3.0, at_left));
  CHECK((left.at(3.0, at_left) - left.at(3.0, at_right)).norm() > 0.1);
  // It goes on beyond both tips, and does not yet hold its edge there.
  const Eigen::Vector3d outermost(-8, 105 + 0.5 * 178.3, 119), beyond(-8, 105 + 0.54 * 178.3, 119);
  CHECK((left.at(3.0, outermost) - left.at(3.0, beyond)).norm() > 1e-6);
  const auto gust = history_row(gusty, make_start(gusty).state, 3.0, names);
  CHECK(value(gust, names, "rotor.left.wind_x_m_s") == left.at(3.0, at_left).x());
  CHECK(value(gust, names, "rotor.right.wind_x_m_s") == left.at(3.0, at_right).x());
  CHECK_THROWS_WITH(FloatingSystem(test::scenario(carrier, box + twin() + Texts{"wind.turbulence.width_m=300.0"})),
                    Contains("does not cover the rotors") && Contains("210 m apart across the wind"));
}

TEST_CASE("an event that names a rotor happens to that one alone", "[coupling][fast]") {
  const auto after = [](const std::string& rotor) {
    FloatingSystem floating(test::scenario(
        carrier, twin() + Texts{"control.model='dtu'", "control.events=[{what='grid_loss',time_s=0.5" + rotor + "}]"}));
    bodies::BodiesState state = make_start(floating).state;
    for (int n = 0; n < 50; ++n) REQUIRE(floating.multibody().advance(state, 0.02, 1).ok());
    Texts names;
    const auto row = history_row(floating, state, 1.0, names);
    return std::pair(value(row, names, "rotor.left.generator_torque_N_m"), value(row, names, "rotor.right.generator_torque_N_m"));
  };
  const auto [left, right] = after(",rotor='right'");
  CHECK(left > 1e6);
  CHECK(right == 0.0);
  CHECK(after("") == std::pair(0.0, 0.0));
}

TEST_CASE("each of two rotors on bodies of their own loads its own body alone", "[coupling][fast]") {
  const Texts other{"bodies.other.mass_kg=2.0e7", "bodies.other.inertia_kg_m2=[2.0e11,5.0e10,2.0e11]",
                    "bodies.other.centre_m=[0.0,-300.0,0.0]", "rotors.right.body='other'"};
  FloatingSystem floating(test::scenario(carrier, twin(300.0) + other));
  const bodies::BodiesState state = make_start(floating).state;
  const bodies::Evaluation& now = floating.multibody().evaluate(state, 0.0);
  const auto sources = floating.multibody().loads();
  for (std::size_t s = 0; s < sources.size(); ++s) {
    if (sources[s].name == "rotor.left")
      CHECK(
          (now.by_source[s][0].force.x() > 1e6 && now.by_source[s][1].force.norm() == 0.0 && !floating.sources.loads_body(s, 1)));
    if (sources[s].name == "rotor.right")
      CHECK(
          (now.by_source[s][1].force.x() > 1e6 && now.by_source[s][0].force.norm() == 0.0 && !floating.sources.loads_body(s, 0)));
  }
}

TEST_CASE("rotors in bearings that turn against each other have a positive speed each by their tables", "[coupling][fast]") {
  Texts bearings;
  for (const std::string side : {"left", "right"}) {
    const std::string y = side == "left" ? "105.0" : "-105.0", body = "bodies.hub_" + side, joint = "joints.bearing_" + side;
    bearings = bearings + Texts{body + ".mass_kg=2.0e5",
                                body + ".inertia_kg_m2=[1.5e8,7.5e7,7.5e7]",
                                body + ".centre_m=[-8.0," + y + ",119.0]",
                                joint + ".type='revolute'",
                                joint + ".bodies=['platform','hub_" + side + "']",
                                joint + ".point_m=[-8.0," + y + ",119.0]",
                                joint + ".axis=[1.0,0.0,0.0]",
                                joint + ".rotation.speed_rpm=1.0",
                                "rotors." + side + ".body='hub_" + side + "'",
                                "rotors." + side + ".joint='bearing_" + side + "'",
                                "rotors." + side + ".turbine='" + SPINDRIFT_SOURCE_DIR "/" + turbine + "'",
                                "rotors." + side + ".operating_point='table'"};
  }
  FloatingSystem floating(test::scenario(carrier, bearings + Texts{"rotors.right.turns='counter_clockwise'"}));
  Texts names;
  const auto row = history_row(floating, make_start(floating).state, 0.0, names);
  const double speed = value(row, names, "rotor.left.rpm");
  CHECK(speed > 8.0);
  CHECK(value(row, names, "rotor.right.rpm") == Approx(speed));
  CHECK(value(row, names, "rotor.right.power_W") == Approx(value(row, names, "rotor.left.power_W")));
  CHECK(value(row, names, "hub_right.wx_rad_s") == Approx(-speed * rad_s_per_rpm));
}

TEST_CASE("a rotor in the wake of another is told, and so are rotors whose blades would meet", "[coupling][fast]") {
  const auto told = [](const Texts& overrides) {
    FloatingSystem floating(test::scenario(carrier, overrides));
    const Start start = make_start(floating);
    std::string all;
    for (const scene::Doubt& doubt : doubts(floating, start, stability(floating, start.state))) all += scene::text(doubt) + "\n";
    return all;
  };
  CHECK_THAT(told(twin()), !Contains("wake") && !Contains("apart"));
  CHECK_THAT(told(twin() + Texts{"rotors.right.hub_m=[400.0,100.0,119.0]"}),
             Contains("rotors.right: 408 m behind rotors.left in the wind") && Contains("wake, which is not modelled"));
  CHECK_THAT(told(twin(80.0)), Contains("hubs of rotors.left and rotors.right are 160 m apart"));
  CHECK_THAT(told(twin() + Texts{"rotors.right.operating_point='given'", "rotors.right.speed_rpm=80.0"}),
             Contains("rotors.right.speed_rpm") && !Contains("rotors.left"));
}

TEST_CASE("what several rotors cannot have is refused by its key", "[coupling][fast]") {
  const auto refused = [](const Texts& overrides, const std::string& words) {
    CHECK_THROWS_WITH(test::scenario(carrier, overrides), Contains(words));
  };
  refused(twin() + rotor("rotor", 0.0), "[rotors] has the rotors; give one of the two");
  refused(twin() + Texts{"rotors.left.body='plattform'"}, "rotors.left.body");
  refused(twin() + Texts{"rotors.right.turns='backwards'"}, "rotors.right.turns");
  refused(twin() + Texts{"rotors.right.speed=3.0"}, "rotors.right.speed");
  refused(twin() + Texts{"rotors.right.turbine='none.toml'"}, "rotors.right.turbine");
  refused(rotor("rotors.blade_1", 0.0), "rotors.blade_1");
  refused(twin() + Texts{"coupling.scheme='cps2'"}, "coupling.scheme");
  refused(twin() + Texts{"aero.model='none'"}, "rotors: has no effect");
  refused(twin() + Texts{"aero.model='actuator_line'", "aero.flow.grid='none.p3d'"}, "resolved air has one rotor");
  refused(twin() + Texts{"wind.event.what='ews_horizontal'", "wind.event.start_s=1.0"}, "wind.event.what");
  refused(twin() + Texts{"rotors.left.tower_foot_m=[0.0,105.0]"}, "rotors.left.tower_foot_m");
  const std::string stop = "control.events=[{what='grid_loss',time_s=0.5,rotor=";
  refused(twin() + Texts{"control.model='dtu'", stop + "'middle'}]"}, "control.events[0].rotor");
  refused(rotor("rotor", 0.0) + Texts{"control.model='dtu'", stop + "'left'}]"}, "control.events[0].rotor");
  const Texts tower{"aero.tower.stations=[[0.0,8.0,1.0],[115.0,5.5,1.0]]", "rotors.left.tower_foot_m=[0.0,0.0]"};
  refused(twin() + tower, "rotors.right.tower_foot_m");
  refused(twin() + tower + Texts{"rotors.right.tower_foot_m=[0.0,0.0]"}, "the drag of one tower would count twice");
  refused(twin() + tower + Texts{"rotors.right.tower_foot_m=[0.0,-105.0]", "aero.tower.foot_m=[0.0,1.0]"}, "aero.tower.foot_m");
}
