// The drive train: torque turns it as Newton says, events change its mode, its memory is all there is of it.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/turbine_control.hpp"

#include <catch2/catch.hpp>

#include "src/aero/control_doubts.hpp"
#include "src/scene/document.hpp"
#include "tests/order.hpp"
#include "tests/src/aero/data_file.hpp"

using namespace spindrift;
using namespace spindrift::aero;

namespace {

const std::string turbines = SPINDRIFT_SOURCE_DIR "/inputs/turbines/";

TurbineControl made(const ControlOptions& options = {.model = ControlModel::dtu}, double speed = 0.8, double pitch = 0.0) {
  return {options,
          read_controller(turbines + "dtu_10mw_controller.toml"),
          read_operation(turbines + "dtu_10mw_operation.csv"),
          3,
          {0.0, speed, pitch}};
}

}  // namespace

TEST_CASE("the shaft obeys Newton: torque in less torque out is inertia times acceleration", "[aero][fast]") {
  const TurbineControl control = made();
  const double inertia = control.drive_train().rotor_inertia_kg_m2 + control.drive_train().generator_inertia_kg_m2;
  std::vector<double> memory(control.memory_size());
  control.begin(0.0, {5e6, 9.0}, memory);
  double before = TurbineControl::state(memory).speed;
  for (int n = 1; n <= 200; ++n) {
    const double torque = 5e6 + 1e6 * std::sin(0.1 * n);
    control.advance(0.05 * n, 0.05, {torque, 9.0}, memory);
    const TurbineControl::State s = TurbineControl::state(memory);
    CHECK(inertia * (s.speed - before) / 0.05 == Approx(torque - s.shaft_torque).epsilon(1e-9));
    before = s.speed;
  }
}

TEST_CASE("the generator's torque holds over a step, also the first and where it jumps", "[aero][fast]") {
  const TurbineControl control = made({.model = ControlModel::dtu, .events = {{.what = ControlEvent::grid_loss, .time_s = 1.0}}});
  const double inertia = control.drive_train().rotor_inertia_kg_m2 + control.drive_train().generator_inertia_kg_m2;
  constexpr double air = 5e6, h = 0.05;  // of air whose torque stays each step is exact
  std::vector<double> memory(control.memory_size());
  control.begin(0.0, {air, 9.0}, memory);
  for (int n = 1; n <= 40; ++n) {
    const TurbineControl::State before = TurbineControl::state(memory);
    control.advance(h * n, h, {air, 9.0}, memory);
    CHECK(inertia * (TurbineControl::state(memory).speed - before.speed) ==
          Approx(h * (air - before.generator_torque)).epsilon(1e-9));
  }
  CHECK(TurbineControl::state(memory).generator_torque == 0.0);
}

TEST_CASE("a run begins with what the law asks of the generator, whatever the air's torque at that instant", "[aero][fast]") {
  const double air = GENERATE(4e6, 14e6), rated = 1.0053;
  const ControllerDtu law = law_of({.model = ControlModel::dtu}, read_controller(turbines + "dtu_10mw_controller.toml"),
                                   read_operation(turbines + "dtu_10mw_operation.csv"));
  const TurbineControl high = made({.model = ControlModel::dtu}, rated, 0.2), low = made({.model = ControlModel::dtu}, 0.8, 0.0);
  std::vector<double> memory(high.memory_size());
  high.begin(0.0, {air, 15.0}, memory);
  CHECK(TurbineControl::state(memory).generator_torque * rated == Approx(law.rated_power));
  low.begin(0.0, {air, 9.0}, memory);
  CHECK(TurbineControl::state(memory).generator_torque == Approx(law.torque_gain * 0.8 * 0.8));
  low.advance(0.01, 0.01, {air, 9.0}, memory);
  const TurbineControl::State s = TurbineControl::state(memory);
  CHECK(s.generator_torque == Approx(law.torque_gain * 0.8 * 0.8).epsilon(1e-3));
}

TEST_CASE(
    "a shaft let go swings between rotor and generator at its frequency, keeps their momentum and loses what its damper takes",
    "[aero][fast]") {
  const double damping = GENERATE(0.0, 6e6);
  ControllerOptions train = read_controller(turbines + "dtu_10mw_controller.toml");
  train.shaft_stiffness_N_m_rad = 2.317e9, train.shaft_damping_N_m_s_rad = damping;
  const TurbineControl control({.model = ControlModel::dtu, .events = {{.what = ControlEvent::grid_loss, .time_s = 1.0}}}, train,
                               read_operation(turbines + "dtu_10mw_operation.csv"), 3, {0.0, 0.8, 0.0});
  std::vector<double> memory(control.memory_size());
  const double air = 5e6, h = 0.005, rotor = train.rotor_inertia_kg_m2, generator = train.generator_inertia_kg_m2;
  control.begin(0.0, {air, 9.0}, memory);
  CHECK(control.shaft(memory).twist == Approx(TurbineControl::state(memory).generator_torque / 2.317e9));
  const auto momentum = [&] {
    return rotor * TurbineControl::state(memory).speed + generator * control.shaft(memory).generator_speed;
  };
  // With the generator off the twist swings about what turns the generator along with the rotor.
  const double rest = air * generator / (rotor + generator) / 2.317e9,
               omega = std::sqrt(2.317e9 * (1.0 / rotor + 1.0 / generator));
  std::vector<double> crossings;
  std::vector<std::pair<double, double>> peaks;  // time and height
  double earlier = 0.0, before = control.shaft(memory).twist - rest;
  for (int n = 1; n <= 800; ++n) {
    const double had = momentum();
    control.advance(h * n, h, {air, 9.0}, memory);
    CHECK(momentum() - had == Approx(h * (air - TurbineControl::state(memory).shaft_torque)).margin(1e-3 * h * air));
    const double off = control.shaft(memory).twist - rest;
    if (h * n > 1.02 && before < 0.0 && off >= 0.0) crossings.push_back(h * (n - off / (off - before)));
    if (h * n > 1.02 && std::abs(before) > std::abs(earlier) && std::abs(before) >= std::abs(off))
      peaks.emplace_back(h * (n - 1), std::abs(before));
    earlier = before, before = off;
  }
  REQUIRE(crossings.size() > 5);
  const double ratio = 0.5 * damping * omega / 2.317e9;  // of critical
  const double period = (crossings.back() - crossings.front()) / double(crossings.size() - 1);
  CHECK(period == Approx(2.0 * pi / (omega * std::sqrt(1.0 - ratio * ratio))).epsilon(0.005));
  REQUIRE(peaks.size() > 10);
  const auto [first_at, first] = peaks.front();
  const auto [last_at, last] = peaks.back();
  CHECK(last / first == Approx(std::exp(-ratio * omega * (last_at - first_at))).epsilon(0.02));
}

TEST_CASE("an emergency stop without a brake is doubted by its place in the list, one with a brake is not", "[aero][fast]") {
  ControlOptions control{
      .model = ControlModel::library,
      .events = {{.what = ControlEvent::grid_loss, .time_s = 1.0}, {.what = ControlEvent::emergency_stop, .time_s = 2.0}}};
  control.drive_train = DriveTrainOptions{.rotor_inertia_kg_m2 = 1e7};
  const scene::Doubts doubts = control_doubts(control);
  REQUIRE(doubts.size() == 1);
  CHECK(doubts[0].key == "control.events[1]");
  control.drive_train->brake_torque_N_m = 1e6;
  CHECK(control_doubts(control).empty());
}

TEST_CASE("a curve that has one pitch, or none near feather where blades go there, is doubted under a controller",
          "[aero][fast]") {
  ControlOptions control{.model = ControlModel::dtu, .file = turbines + "dtu_10mw_controller.toml"};
  const auto doubts = [&](const std::vector<int>& pitches) {
    std::string text = "tip_speed_ratio,blade_pitch_deg,ct,cp\n";
    for (const int pitch : pitches) text += "4," + std::to_string(pitch) + ",.5,.4\n8," + std::to_string(pitch) + ",.5,.4\n";
    return control_doubts(control, data_file("pitches.csv", text)).size();
  };
  CHECK(doubts({0}) == 1);
  CHECK(doubts({0, 30}) == 0);
  control.events = {{.what = ControlEvent::blade_stuck, .time_s = 1.0}};
  CHECK(doubts({0, 30}) == 0);
  control.events.push_back({.what = ControlEvent::shut_down, .time_s = 2.0});
  CHECK(doubts({0, 30}) == 1);
  CHECK(doubts({0, 30, 80}) == 0);
}

TEST_CASE("after a loss of grid the generator is off, the blades feather at their largest rate", "[aero][fast]") {
  const TurbineControl control =
      made({.model = ControlModel::dtu, .events = {{.what = ControlEvent::grid_loss, .time_s = 1.0}}}, 1.005, 0.2);
  std::vector<double> memory(control.memory_size());
  control.begin(0.0, {10e6, 15.0}, memory);
  double fastest = 0.0, last = 0.2;
  for (int n = 1; n <= 400; ++n) {
    control.advance(0.05 * n, 0.05, {n > 20 ? 0.0 : 10e6, 15.0}, memory);
    if (n >= 20) CHECK(TurbineControl::state(memory).generator_torque == 0.0);
    fastest = std::max(fastest, (control.pitch(memory)[0] - last) / 0.05), last = control.pitch(memory)[0];
  }
  CHECK(last == Approx(0.5 * pi).epsilon(1e-3));
  CHECK(fastest == Approx(10.0 * radians_per_degree).epsilon(1e-2));
}

TEST_CASE("an event at time 0 happens before the first step, each kind as it would later", "[aero][fast]") {
  const auto begun = [](const EventOptions& event, ControlStart start = ControlStart::operating) {
    const TurbineControl control = made({.model = ControlModel::dtu, .start = start, .events = {event}}, 1.005, 0.2);
    std::vector<double> memory(control.memory_size());
    control.begin(0.0, {10e6, 15.0}, memory);
    const TurbineControl::State s = TurbineControl::state(memory);
    for (int n = 1; n <= 20; ++n) control.advance(0.05 * n, 0.05, {10e6, 15.0}, memory);
    const auto pitch = control.pitch(memory);
    return std::tuple(TurbineControl::Mode(s.mode), s.generator_torque, std::vector(pitch.begin(), pitch.end()));
  };
  using enum TurbineControl::Mode;
  for (const auto& [what, mode] :
       {std::pair(ControlEvent::grid_loss, tripped), std::pair(ControlEvent::emergency_stop, braked)}) {
    const auto [at_once, torque, pitch] = begun({.what = what});
    CHECK(at_once == mode);
    CHECK(torque == 0.0);
    CHECK(pitch[0] > 0.2 + 5.0 * radians_per_degree);
  }
  const auto [stopped, falling, to_feather] = begun({.what = ControlEvent::shut_down});
  CHECK(stopped == stopping);
  CHECK(falling > 0.0);
  CHECK(to_feather[0] > 0.2);
  const auto [started, none, from_feather] = begun({.what = ControlEvent::start_up}, ControlStart::parked);
  CHECK(started == starting);
  CHECK(none == 0.0);
  CHECK(from_feather[0] < 0.5 * pi);
  const auto [on, full, blades] = begun({.what = ControlEvent::blade_stuck, .blade = 2});
  CHECK(on == operating);
  CHECK(full > 0.0);
  CHECK(blades[1] == 0.2);
  CHECK(blades[0] != 0.2);
}

TEST_CASE("an event is not lost where a time less its step rounds past it", "[aero][fast]") {
  const double step = 0.03, at = 3.6;
  const TurbineControl control = made({.model = ControlModel::dtu, .events = {{.what = ControlEvent::grid_loss, .time_s = at}}});
  std::vector<double> memory(control.memory_size());
  control.begin(0.0, {5e6, 9.0}, memory);
  int changes = 0;
  double mode = TurbineControl::state(memory).mode;
  for (int n = 1; n <= 130; ++n) {
    control.advance(step * n, step, {5e6, 9.0}, memory);
    const double now = TurbineControl::state(memory).mode;
    changes += now != mode, mode = now;
  }
  CHECK(changes == 1);
  CHECK(TurbineControl::Mode(mode) == TurbineControl::Mode::tripped);
}

TEST_CASE("a stuck blade stays while the others pitch", "[aero][fast]") {
  const TurbineControl control = made({.model = ControlModel::dtu,
                                       .events = {{.what = ControlEvent::blade_stuck, .time_s = 1.0, .blade = 2},
                                                  {.what = ControlEvent::shut_down, .time_s = 2.0}}});
  std::vector<double> memory(control.memory_size());
  control.begin(0.0, {5e6, 9.0}, memory);
  for (int n = 1; n <= 400; ++n) control.advance(0.05 * n, 0.05, {0.0, 9.0}, memory);
  CHECK(control.pitch(memory)[1] == 0.0);
  CHECK(control.pitch(memory)[0] > 0.5);
  CHECK(control.pitch(memory)[0] == control.pitch(memory)[2]);
}

TEST_CASE("a controller file is refused by the key that is wrong", "[aero][fast]") {
  const auto problems = [](const std::string& text) -> std::string {
    scene::Document doc = scene::parse(text, "controller.toml", "/");
    doc.read(controller_section());
    try {
      doc.finish();
    } catch (const scene::SceneError& e) { return e.what(); }
    return "";
  };
  const std::string good =
      "[controller]\nrated_power_W = 1e7\nmin_speed_rpm = 6.0\nrated_speed_rpm = 9.6\nmax_torque_N_m = 15.6e6\n"
      "rotor_inertia_kg_m2 = 1e8\n[controller.gains]\nkp_s = 1.0\nki = 0.1\n";
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return problems(text.replace(text.find(from), from.size(), to));
  };
  CHECK(problems(good).empty());
  CHECK(with("min_speed_rpm = 6.0", "min_speed_rpm = 10.0").find("min_speed_rpm") != std::string::npos);
  CHECK(with("max_torque_N_m = 15.6e6", "max_torque_N_m = 1.0e6").find("max_torque_N_m") != std::string::npos);
  CHECK(with("kp_s = 1.0", "").find("kp_s") != std::string::npos);
}
