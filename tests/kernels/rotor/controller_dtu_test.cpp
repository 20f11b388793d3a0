// The DTU controller's parts by themselves: filters against their exact answers, steady states that stay, limits that hold.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/rotor/controller_dtu.hpp"

#include <catch2/catch.hpp>

#include "tests/order.hpp"

using namespace spindrift;

namespace {

const ControllerDtu dtu{.min_speed = 0.628,
                        .rated_speed = 1.005,
                        .rated_power = 10.638e6,
                        .max_torque = 15.6e6,
                        .torque_gain = 1.22e7,
                        .torque_kp = 0.708e8,
                        .torque_ki = 0.159e8,
                        .pitch_kp = 1.395,
                        .pitch_ki = 0.334,
                        .schedule_linear = 4.93,
                        .schedule_quadratic = 7.16};
const auto no_pitch = [](double) { return 0.0; };

}  // namespace

TEST_CASE("the filter of second order converges to its step response at second order", "[rotor][order][fast]") {
  const double w = 2.5, z = 0.7, damped = w * std::sqrt(1.0 - z * z), end = 1.6;
  const double exact =
      1.0 - std::exp(-z * w * end) * (std::cos(damped * end) + z / std::sqrt(1.0 - z * z) * std::sin(damped * end));
  std::vector<double> h, error;
  for (int steps : {16, 32, 64, 128}) {
    double value = 0.0, rate = 0.0;
    for (int n = 0; n < steps; ++n) filter_second_order(1.0, w, z, end / steps, value, rate);
    h.push_back(end / steps), error.push_back(std::abs(value - exact));
  }
  CHECK(observed_order(h, error) == Approx(2.0).margin(0.1));
}

TEST_CASE("a filter of any step stays bounded and settles on its input", "[rotor][fast]") {
  const double h = GENERATE(0.01, 1.0, 100.0);
  double value = 0.0, rate = 0.0, first = 0.0;
  for (int n = 0; n < 2000; ++n) {
    filter_second_order(3.0, 2.5, 0.7, h, value, rate);
    first = filter_first_order(3.0, 2.0, h, first);
    REQUIRE(std::abs(value) < 10.0);
  }
  CHECK(value == Approx(3.0).epsilon(1e-6));
  CHECK(first == Approx(3.0).epsilon(1e-4));
}

TEST_CASE("below rated the torque is K omega^2 and the blades stay at their least pitch", "[rotor][fast]") {
  const double speed = GENERATE(0.68, 0.75, 0.89);
  ControllerDtuState s = settled(dtu, speed, 9.0, 0.0, 0.0, dtu.torque_gain * speed * speed);
  for (int n = 0; n < 2000; ++n) s = advance(dtu, s, speed, 0.0, 9.0, 0.05, no_pitch);
  CHECK(s.torque == Approx(dtu.torque_gain * speed * speed).epsilon(1e-9));
  CHECK(s.pitch == 0.0);
}

TEST_CASE("where the speed stands still the generator takes at most rated power, whatever the pitch", "[rotor][fast]") {
  const double share = GENERATE(0.9, 0.93, 0.96, 0.99, 1.0, 1.05), speed = share * dtu.rated_speed;
  ControllerDtuState s = settled(dtu, speed, 11.5, 0.0, 0.0, dtu.torque_gain * speed * speed);
  for (int n = 0; n < 4000; ++n) s = advance(dtu, s, speed, 0.0, 11.5, 0.05, no_pitch);
  CHECK(s.torque * speed <= dtu.rated_power * (1.0 + 1e-9));
}

TEST_CASE("at rated speed and pitched blades the power is rated and nothing moves", "[rotor][fast]") {
  const double pitch = GENERATE(0.05, 0.2, 0.4), torque = dtu.rated_power / dtu.rated_speed;
  ControllerDtuState s = settled(dtu, dtu.rated_speed, 15.0, pitch, 0.0, torque);
  for (int n = 0; n < 2000; ++n) s = advance(dtu, s, dtu.rated_speed, pitch, 15.0, 0.05, no_pitch);
  CHECK(s.torque == Approx(torque).epsilon(1e-9));
  CHECK(s.pitch == Approx(pitch).epsilon(1e-12));
  const ControllerDtuState gust = advance(dtu, s, 1.1 * dtu.rated_speed, pitch, 15.0, 0.05, no_pitch);
  CHECK(gust.torque < torque);  // constant power
  CHECK(gust.pitch > pitch);
}

TEST_CASE("the gains fall with pitch as 1 / (1 + pitch/KK1 + pitch^2/KK2)", "[rotor][fast]") {
  const double pitch = GENERATE(0.1, 0.3), step = 0.02;
  const auto kick = [&](double at) {
    ControllerDtuState s = settled(dtu, dtu.rated_speed, 15.0, at, 0.0, 1e7);
    s.speed = (1.0 + 1e-4) * dtu.rated_speed;
    return advance(dtu, s, s.speed, at, 15.0, step, no_pitch).pitch - at;
  };
  const double gain = (dtu.pitch_kp + dtu.pitch_ki * step) * 1e-4 * dtu.rated_speed;
  CHECK(kick(pitch) == Approx(gain / (1.0 + dtu.schedule_linear * pitch + dtu.schedule_quadratic * pitch * pitch)).epsilon(1e-6));
}

TEST_CASE("above rated speed the gains of pitch grow, to twice their value at the speed of doubling", "[rotor][fast]") {
  const double pitch = 0.2, step = 1e-3, excess = GENERATE(-0.1, 0.1, 0.3), h = 0.02;
  const auto asked = [&](double share) {  // after a step from the same state
    ControllerDtuState s = settled(dtu, dtu.rated_speed, 15.0, pitch, 0.0, 1e7);
    s.speed = share * dtu.rated_speed, s.pitch_integral = 0.5, s.pitch = 0.5;
    ControllerDtu quick = dtu;
    quick.max_pitch_rate = 1e3;
    return advance(quick, s, s.speed, pitch, 15.0, h, no_pitch).pitch - 0.5;
  };
  const double gain = (dtu.pitch_kp + dtu.pitch_ki * h) * dtu.rated_speed /
                      (1.0 + dtu.schedule_linear * pitch + dtu.schedule_quadratic * pitch * pitch);
  const double grown = excess > 0.0 ? 1.0 + excess * excess / 0.09 : 1.0;
  CHECK(asked(1.0 + excess) == Approx(gain * grown * excess));
  CHECK(asked(1.0 + excess + step) > asked(1.0 + excess));
}

TEST_CASE("blades pitch before a rotor that a gust drives reaches its rated speed", "[rotor][fast]") {
  // One mass, power by the cube of the wind, less what tip-speed ratio and pitch are off their best. From 9 to 14 m/s in 5 s.
  const double h = 0.02, inertia = 1.6e8, rated_wind = 11.4;
  ControllerDtuState s = settled(dtu, 0.75, 9.0, 0.0, 0.0, dtu.torque_gain * 0.75 * 0.75);
  double speed = 0.75, most = 0.0, first_pitched_at = 0.0;
  for (int n = 0; n < int(200.0 / h); ++n) {
    const double wind = 9.0 + std::clamp(n * h - 100.0, 0.0, 5.0), share = wind / rated_wind;
    const double off = speed / dtu.rated_speed / share - 1.0;
    const double torque = dtu.rated_power / speed * share * share * share * (1.0 - off * off - 2.6 * s.pitch);
    speed += h * (torque - s.torque) / inertia;
    s = advance(dtu, s, speed, s.pitch, wind, h, no_pitch);
    most = std::max(most, speed);
    if (first_pitched_at == 0.0 && s.pitch > 0.0) first_pitched_at = s.speed;
  }
  CAPTURE(most / dtu.rated_speed);
  CHECK(first_pitched_at < 0.98 * dtu.rated_speed);
  CHECK(most < 1.05 * dtu.rated_speed);
  CHECK(speed == Approx(dtu.rated_speed).epsilon(1e-3));
}

TEST_CASE(
    "at a limit the loop of pitch holds what it may, and leaves it when the speed grows by more than ki / kp of what it lacks",
    "[rotor][fast]") {
  const double lack = 0.05, growth = GENERATE(0.8, 1.25), h = 0.01;
  ControllerDtuState s = settled(dtu, dtu.rated_speed - lack, 9.0, 0.0, 0.0, 1e7);
  for (int n = 0; n < 500; ++n) s = advance(dtu, s, dtu.rated_speed - lack, 0.0, 9.0, h, no_pitch);
  REQUIRE(s.pitch == 0.0);
  s.speed_rate = growth * dtu.pitch_ki / dtu.pitch_kp * lack;
  s = advance(dtu, s, s.speed + 2.0 * dtu.filter_damping / dtu.filter_frequency * s.speed_rate, 0.0, 9.0, h, no_pitch);
  CHECK((s.pitch > 0.0) == (growth > 1.0));
}

TEST_CASE("the servo keeps its limits of rate and acceleration and arrives without much overshoot", "[rotor][fast]") {
  const double h = GENERATE(0.005, 0.05), rate_limit = 0.17, acceleration_limit = 0.26;
  double pitch = 0.0, rate = 0.0, most = 0.0;
  for (int n = 0; n < int(10.0 / h); ++n) {
    const double before = rate, was = pitch;
    pitch_servo(0.5, 6.28, 0.7, rate_limit, acceleration_limit, h, pitch, rate);
    REQUIRE(std::abs(rate) <= rate_limit);
    REQUIRE(std::abs(rate - before) <= acceleration_limit * h * (1.0 + 1e-12));
    REQUIRE(std::abs(pitch - was) <= rate_limit * h * (1.0 + 1e-12));
    most = std::max(most, pitch);
  }
  CHECK(pitch == Approx(0.5).epsilon(1e-3));
  CHECK(most < 0.6);
}
