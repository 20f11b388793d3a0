// Angles in radians where degrees are asked for: src/scene/angle_doubts.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/scene/angle_doubts.hpp"

#include <catch2/catch.hpp>

using namespace spindrift::scene;

TEST_CASE("round degrees given as radians are known, and degrees are let be", "[scene][fast]") {
  for (const double radians :
       {0.0873, 0.08727, -0.1745, 0.2618, 0.5236, 0.7854, 0.785, 1.5708, 1.57, -1.57, 3.14159, 3.14, 0.0436})
    CHECK(looks_like_radians(radians));
  for (const double degrees : {0.0, 1.0, 2.5, 5.0, 0.1, 0.05, 0.087, 2.751, 1.966, 0.896, 11.61083, 90.0, -45.0, 5.44})
    CHECK_FALSE(looks_like_radians(degrees));
}

TEST_CASE("a scene's keys in degrees are looked at, phases and long lists are not", "[scene][fast]") {
  const Doubts found = angle_doubts(
      "[rotor]\nblade_pitch_deg = 0.0873\nspeed_rpm = 0.0873\n[bodies.spar]\nrotation_deg = [0.0, 0.2618, 0.0]\n"
      "[[waves.components]]\nphase_deg = 0.0873\n[aero]\ntable_deg = [0.0873, 0.1, 0.2, 0.3]\n");
  REQUIRE(found.size() == 2);
  CHECK(found[0].key == "rotor.blade_pitch_deg");
  CHECK(found[0].advice == "in radians? that is 5 degrees");
  CHECK(found[1].key == "bodies.spar.rotation_deg");
}
