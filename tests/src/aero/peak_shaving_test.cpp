// Peak shaving, src/aero/peak_shaving.hpp: on a rotor whose thrust and torque are formulas, so that the pitch is known.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/peak_shaving.hpp"

#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"

using namespace spindrift;
using namespace spindrift::aero;

namespace {

/// Thrust and torque fall linearly with pitch, whatever the speed: T = (1 - 5 pitch) w^2 kN, Q = (1 - 2 pitch) w^2 kN m.
AxialLoad linear_rotor(double wind, double /*speed*/, double pitch) {
  return {1e3 * (1.0 - 5.0 * pitch) * wind * wind, 1e3 * (1.0 - 2.0 * pitch) * wind * wind};
}

/// Rated at 10 m/s: torque of 1e5 N m at 1 rad/s.
ControllerDtu law() {
  ControllerDtu law;
  law.min_speed = 0.5, law.rated_speed = 1.0, law.rated_power = 1e5, law.max_torque = 1.2e5, law.torque_gain = 1e5;
  law.max_pitch = 0.5;
  return law;
}

Operation operation() { return {{4.0, 24.0}, {0.5, 1.0}, {}, {}}; }

}  // namespace

TEST_CASE("the largest steady thrust is that of rated wind, and the share of it is the limit", "[aero][fast]") {
  const PeakShaving shaving = shave_peak(linear_rotor, law(), operation(), 0.8);
  CHECK(shaving.largest == Approx(1e5).epsilon(1e-3));
  CHECK(shaving.largest_at == Approx(10.0));
  CHECK(shaving.limit == Approx(8e4).epsilon(1e-3));
}

TEST_CASE("blades are pitched to the limit from where the thrust reaches it, and never past operation above it", "[aero][fast]") {
  const PeakShaving shaving = shave_peak(linear_rotor, law(), operation(), 0.8);
  for (double wind = 4.0; wind <= 24.0; wind += 0.5) {
    CAPTURE(wind);
    const double operating = std::max(0.0, 0.5 * (1.0 - 100.0 / (wind * wind)));
    const double needed = std::max(0.0, 0.2 * (1.0 - 80.0 / (wind * wind)));
    CHECK(shaving.least_pitch(wind) == Approx(needed).margin(1e-4));
    if (wind > 12.0) CHECK(shaving.least_pitch(wind) < operating);
  }
  // sqrt(80) m/s, and where both pitches are the same: 0.3 = 34 / w^2
  CHECK(shaving.from == Approx(9.0));
  CHECK(shaving.to == Approx(10.5));
  CHECK(shaving.farthest == Approx(0.04).margin(1e-4));
}

TEST_CASE("how far blades are pitched beyond operation is known between the rows of the schedule too", "[aero][fast]") {
  ControllerDtu rated = law();  // at 10.25 m/s
  rated.rated_power = 1e3 * 10.25 * 10.25;
  const PeakShaving shaving = shave_peak(linear_rotor, rated, operation(), 0.8);
  const auto needed = [](double wind) { return 0.2 * (1.0 - 0.8 * 10.25 * 10.25 / (wind * wind)); };
  CHECK(shaving.farthest == Approx(0.5 * (needed(10.0) + needed(10.5))).margin(1e-4));
}

TEST_CASE("a share of one leaves operation as it is", "[aero][fast]") {
  const PeakShaving shaving = shave_peak(linear_rotor, law(), operation(), 1.0);
  CHECK(shaving.farthest < 1e-3);
  for (double wind = 4.0; wind <= 10.0; wind += 0.5) CHECK(shaving.least_pitch(wind) == Approx(0.0).margin(1e-4));
}

TEST_CASE("the operating table's own least pitch stays where it is the larger", "[aero][fast]") {
  Operation table = operation();
  table.pitch = {0.05, 0.0};
  const PeakShaving shaving = shave_peak(linear_rotor, law(), table, 0.8);
  CHECK(shaving.least_pitch(4.0) == Approx(0.05));
}

TEST_CASE("the rotor's speed is the one that its torque and the controller's law have", "[aero][fast]") {
  // Thrust that grows with speed: T = w^2 speed kN; below rated Q = K speed^2 has speed = w / 10.
  const auto load = [](double wind, double speed, double pitch) {
    return AxialLoad{1e3 * wind * wind * speed * (1.0 - 5.0 * pitch), 1e3 * wind * wind * (1.0 - 2.0 * pitch)};
  };
  const PeakShaving shaving = shave_peak(load, law(), operation(), 0.5);
  // At 8.5 m/s: speed = 0.85 sqrt(1 - 2 pitch), T = 61.4 kN (1 - 2 pitch)^0.5 (1 - 5 pitch) = 50 kN.
  const double pitch = shaving.least_pitch(8.5);
  CHECK(1e3 * 8.5 * 8.5 * 0.85 * std::sqrt(1.0 - 2.0 * pitch) * (1.0 - 5.0 * pitch) == Approx(shaving.limit).epsilon(1e-3));
}
