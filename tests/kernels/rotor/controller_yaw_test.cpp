// Active yaw: when it starts, where it stops, what it leaves alone. SPDX-License-Identifier: Apache-2.0
#include "kernels/rotor/controller_yaw.hpp"

#include <catch2/catch.hpp>

using namespace spindrift;

namespace {

constexpr double degree = pi / 180.0;
const YawController yaw{8.0 * degree, 1.0 * degree, 0.0, 30.0, 0.3 * degree};

/// Wind of 10 m/s towards `direction`, a nacelle that is where it is asked to be; from the wind along x at t = 0.
struct Nacelle {
  const YawController& law;
  YawState state{0.0, 10.0, 0.0, 0.0, 0.0, 0.0};
  void go(double until, double direction, double h = 0.1) {
    while (state.time < until - 0.5 * h) {
      const double t = state.time + h, heading = law.asked(state, t);
      state =
          law.advanced(state, t, 10.0 * std::cos(direction), 10.0 * std::sin(direction), std::cos(heading), std::sin(heading));
    }
  }
  double heading() const { return state.asked; }
};

}  // namespace

TEST_CASE("a nacelle waits, follows the wind at its rate and stops within the threshold, either way round", "[rotor][fast]") {
  const double direction = GENERATE(20.0, -20.0, 170.0, -170.0) * degree, way = direction > 0.0 ? 1.0 : -1.0;
  Nacelle nacelle{yaw};
  nacelle.go(29.0, direction);
  CHECK(nacelle.heading() == 0.0);
  nacelle.go(50.0, direction);
  CHECK(way * nacelle.heading() == Approx(20.0 * 0.3 * degree).margin(0.061 * degree));  // two steps
  nacelle.go(700.0, direction);
  CHECK(nacelle.state.turning == 0.0);
  CHECK(way * (direction - nacelle.heading()) <= 1.0 * degree);
  CHECK(way * (direction - nacelle.heading()) > 1.0 * degree - 0.031 * degree);  // a step's turn
}

TEST_CASE("errors that are small or short do not move the nacelle", "[rotor][fast]") {
  Nacelle nacelle{yaw};
  nacelle.go(200.0, 7.9 * degree);
  CHECK(nacelle.heading() == 0.0);
  for (int k = 0; k < 5; ++k) nacelle.go(nacelle.state.time + 25.0, 30.0 * degree), nacelle.go(nacelle.state.time + 1.0, 0.0);
  CHECK(nacelle.heading() == 0.0);
}

TEST_CASE("the filter hides what is fast and does not let the nacelle run past the wind", "[rotor][fast]") {
  YawController slow = yaw;
  slow.filter_time = 60.0, slow.delay = 0.0;
  Nacelle nacelle{slow};
  for (int k = 0; k < 100; ++k) nacelle.go(nacelle.state.time + 2.0, (k % 2 ? 25.0 : -25.0) * degree);
  CHECK(nacelle.heading() == 0.0);
  Nacelle turned{slow};
  turned.go(1500.0, 40.0 * degree);
  CHECK(turned.heading() < 40.0 * degree);
  CHECK(turned.heading() > 32.0 * degree);
}

TEST_CASE("in still air there is no error", "[rotor][fast]") { CHECK(YawController::error({}, 1.0, 0.0) == 0.0); }
