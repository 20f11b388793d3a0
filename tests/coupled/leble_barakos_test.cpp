// The paper's cases 1 and 2 at engineering fidelity against its figures (Leble & Barakos 2016, sections 4.4 and 4.5):
// heave -0.603 m, surge 0.215 m, pitch 5.2 degrees; moorings alone carry the thrust; case 2 shows in the pitch acceleration.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include <algorithm>

#include "kernels/rigid/rotation.hpp"
#include "tests/coupled/runs.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using namespace spindrift::coupling::test;

namespace {
constexpr double pitch_period = 22.57;  // s, as `spindrift check` gives it
const std::string case1 = input("leble_barakos/case1_engineering.toml"), case2 = input("leble_barakos/case2_engineering.toml");
}  // namespace

TEST_CASE("case 1 settles where the paper finds its turbine, and where the statics put it", "[coupled][fast]") {
  const Folder folder("case1");
  const io::Summary summary = run_scene(case1, {}, folder.path());
  REQUIRE(summary.exit_code == 0);
  const scene::Columns history = scene::read_columns((folder.path() / "history.csv").string());
  const auto mean = [&](const char* column) { return mean_of_last(history, column, 2 * pitch_period); };
  CHECK(mean("platform.z_m") == Approx(-0.60).margin(0.03));
  CHECK(mean("platform.pitch_deg") == Approx(5.2).margin(0.2));
  CHECK(mean("platform.x_m") == Approx(0.215).margin(0.03));

  scene::Document document = scene::load(case1, {"start.equilibrium=true"});
  FloatingSystem floating(read_scenario(document));
  const Start rest = make_start(floating);
  const Motion& platform = rest.state.motions[0];
  const Motion described = described_motion(floating.scenario().bodies[0].options);
  const Eigen::Vector3d at = platform.point(floating.reference_point(0)) - described.point(floating.reference_point(0));
  CHECK(at.x() == Approx(mean("platform.x_m")).margin(0.005));
  CHECK(at.z() == Approx(mean("platform.z_m")).margin(0.005));
  CHECK(euler_angles(platform.attitude).y() / radians_per_degree == Approx(mean("platform.pitch_deg")).margin(0.05));

  // "Only the mooring lines are responsible for balancing the thrust force" (section 4.5).
  CHECK(mean("platform.moorings.fx_N") == Approx(-1.5e6).epsilon(0.01));
  CHECK(std::abs(mean("platform.sea.fx_N")) < 0.01 * 1.5e6);
}

TEST_CASE("the equilibrium of case 3 has the thrust of a rotor that turns", "[coupled][fast]") {
  scene::Document document = scene::load(input("leble_barakos/case3_engineering.toml"));  // its waves grow from nothing
  FloatingSystem floating(read_scenario(document));
  const Start rest = make_start(floating);
  const aero::RotorState rotor = floating.rotor()->state(0.0, rest.state.motions);
  CHECK(floating.rotor()->load(0.0, rotor, 1.0).thrust == Approx(1.50e6).epsilon(0.03));
  const Eigen::Vector3d angles = euler_angles(rest.state.motions[0].attitude) / radians_per_degree;
  CHECK(angles.y() == Approx(5.2).margin(0.4));
  CHECK(std::abs(angles.z()) < 1.5);  // the torque of a shaft that leans
}

TEST_CASE(
    "the free platform in still water stays within a tenth of a metre of the heave of hydrostatics and half a degree of its "
    "pitch",
    "[coupled][sea][nightly]") {
  // Over half a pitch period from hydrostatic rest (-0.588 m, 5.11 degrees). The pitch swings about a rest 0.1 degrees further:
  // of particles 2.5 m apart the floats are narrow by 0.016 spacings, which takes 2 % of the restoring moment.
  const Folder folder("free_platform");
  REQUIRE(run_scene(input("validation/free_platform/free_platform.toml"), {}, folder.path()).exit_code == 0);
  const scene::Columns history = scene::read_columns((folder.path() / "history.csv").string());
  CHECK(mean_of_last(history, "platform.z_m", 12.0) == Approx(-0.588).margin(0.1));
  const auto pitch = history["platform.pitch_deg"];
  CHECK(*std::max_element(pitch.begin(), pitch.end()) < 5.11 + 0.5);
  CHECK(*std::min_element(pitch.begin(), pitch.end()) > 5.11 - 0.5);
}

TEST_CASE("case 2 differs from case 1 as the thrust does, seen in the pitch acceleration of the last 20 s", "[coupled][fast]") {
  const Folder folder("case2");
  const auto steps = std::vector<std::string>{"time.window_s=0.05"};
  REQUIRE(run_scene(case1, steps, folder.path() / "1").exit_code == 0);
  REQUIRE(run_scene(case2, steps, folder.path() / "2").exit_code == 0);
  const scene::Columns one = scene::read_columns((folder.path() / "1/history.csv").string());
  const scene::Columns two = scene::read_columns((folder.path() / "2/history.csv").string());
  // The difference of pitch accelerations and the varying part of the thrust, over the last 20 s: same shape, same phase.
  double xy = 0.0, xx = 0.0, yy = 0.0, mean = 0.0;
  const auto time = two["time_s"], thrust = two["rotor.thrust_N"];
  const auto a1 = one["platform.awy_rad_s2"], a2 = two["platform.awy_rad_s2"];
  std::size_t count = 0;
  for (std::size_t i = 0; i < time.size(); ++i)
    if (time[i] > 130.0) {
      const double x = thrust[i] - 1.5e6, y = a2[i] - a1[i];
      xy += x * y, xx += x * x, yy += y * y, mean += thrust[i], ++count;
    }
  CHECK(mean / double(count) == Approx(1.5e6).epsilon(2e-3));
  CHECK(xy / std::sqrt(xx * yy) > 0.97);  // correlation: the paper's "follows the shape of the thrust without phase shift"
  CHECK(xy / xx == Approx(119.0 / 2.6e10).epsilon(0.3));  // arm over pitch inertia with the water's
  // The dip three times per revolution, 48 kN of it in five harmonics.
  CHECK(*std::min_element(thrust.begin(), thrust.end()) < 1.453e6);
}
