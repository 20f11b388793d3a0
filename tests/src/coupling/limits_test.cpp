// Limits on steps and windows: src/coupling/limits.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/limits.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <span>

#include "src/coupling/start.hpp"
#include "src/scene/error.hpp"
#include "tests/src/coupling/scenes.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using Catch::Contains;

TEST_CASE("a line that no step can follow when it snaps taut is refused", "[coupling][fast]") {
  // One tonne on a line of 1e8 N/m: omega = sqrt(1e5) 1/s, less by the water's inertia.
  const auto with = [](const std::vector<std::string>& more) {
    std::vector<std::string> all{"bodies.buoy.mass_kg=1000.0", "moorings.chain.tension_only=true",
                                 "moorings.chain.stiffness_N_m=1e8", "moorings.chain.rest_length_m=30.0", "time.window_s=0.1"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  const auto require = [&](const std::vector<std::string>& overrides) {
    FloatingSystem floating(test::scenario(test::buoy, overrides));
    make_start(floating);
    require_followed_lines(floating);
  };
  FloatingSystem floating(test::scenario(test::buoy, with({})));
  make_start(floating);
  const std::span<const bodies::Onset> watched = floating.multibody().watched();
  REQUIRE(watched.size() == 1);
  CHECK(watched[0].name == "chain");
  CHECK(watched[0].rate < 1.03 * std::sqrt(1e5));  // its fairlead is half a metre off the centre
  CHECK(watched[0].rate > 0.5 * std::sqrt(1e5));
  CHECK_NOTHROW(require(with({"time.step_s=0.05"})));
  CHECK_THROWS_WITH(require(with({"time.step_s=0.1", "moorings.chain.stiffness_N_m=1e14"})),
                    Contains("moorings.chain.stiffness_N_m") && Contains("pieces"));
  FloatingSystem two_way(test::scenario(test::buoy));
  make_start(two_way);
  CHECK(two_way.multibody().watched().empty());  // the linearisation sees it
}

TEST_CASE("a weight that falls into a line keeps its energy, whatever the line and the integrator", "[coupling][fast]") {
  // A tonne falls 1 m, and bounces for 20 s with steps of .01 s.
  const std::string line = GENERATE(as<std::string>(), "model = \"spring_damper\"\nrest_length_m = 11.0\nstiffness_N_m = 2.5e8\n",
                                    "model = \"catenary\"\nrest_length_m = 11.0\nweight_N_m = 100.0\n"
                                    "axial_stiffness_N = 1.0e9\nbed_contact = false\n",
                                    "model = \"composite_catenary\"\nbed_contact = false\n"
                                    "sections = [{rest_length_m = 5.0, weight_N_m = 100.0, axial_stiffness_N = 1.0e9},"
                                    " {rest_length_m = 6.0, weight_N_m = 50.0, axial_stiffness_N = 5.0e8}]\n");
  const std::string integrator = GENERATE(as<std::string>(), "rk4", "symplectic");
  CAPTURE(line, integrator);
  FloatingSystem floating(test::scenario(R"(
[time]
end_s = 20.0
window_s = 0.01
[environment]
gravity_m_s2 = 9.81
[bodies.weight]
mass_kg = 1000.0
inertia_kg_m2 = [100.0, 100.0, 100.0]
centre_m = [0.0, 0.0, -10.0]
[moorings.line]
body = "weight"
fairlead_m = [0.0, 0.0, -10.0]
anchor_m = [0.0, 0.0, 0.0]
)" + line,
                                         {"time.integrator=\"" + integrator + "\""}));
  bodies::BodiesState state = make_start(floating).state;
  REQUIRE(floating.multibody().watched().size() == 1);
  const double tick = floating.timeline().tick_s();
  double highest = -11.0, last_highest = -11.0;
  for (int n = 0; n < 2000; ++n) {
    const bodies::StepReport report = floating.multibody().advance(state, tick, std::lround(0.01 / tick));
    if (!report.ok()) { FAIL(floating.multibody().describe(report)); }
    if (n < 20) continue;
    highest = std::max(highest, state.motions[0].position.z());
    if (n > 1900) last_highest = std::max(last_highest, state.motions[0].position.z());
  }
  CHECK(highest < -10.0 + 0.01);  // one per cent of the energy put in
  CHECK(last_highest > -10.0 - 0.01);
}
