// The echo of a scene reads back to the same options bit for bit.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

#include "src/scene/document.hpp"
#include "src/scene/printed.hpp"
#include "tests/src/scene/example_sections.hpp"
#include "tests/src/scene/temporary.hpp"

using namespace spindrift;
using namespace spindrift::scene;

namespace {
std::string echo_of(std::string_view text, const std::string& directory) {
  Document doc = parse(text, "s.toml", directory);
  for (const SectionBase* section : example::sections()) doc.read_any(*section);
  doc.finish();
  return doc.echo();
}
}  // namespace

TEST_CASE("an echo echoes itself, from anywhere", "[scene][fast]") {
  const Temporary dir;
  dir.file("t \"1\".csv", "");
  const std::string scene = GENERATE(
      R"([time]
end_s = 1)",
      R"([time]
end_s = 0.1
window_s = 1e-3
seed = -9223372036854775807
[sea]
model = "sph"
probes_m = [0.1, 1e300, 5e-324]
bodies = ["a\tb", "c\"\\d", "\u00e9\u007f\u0001"]
profile_m = [[1, 2], [3.5, 4e-9]]
table = "t \"1\".csv"
paddle_speed_rpm = 8.8
[sea.grid]
[bodies.z]
mass_kg = 1
pitch_deg = 5.1
inertia_kg_m2 = [[1.0, -0.5, 0.0], [-0.5, 2.0, 0.0], [0.0, 0.0, 3.0]]
[bodies.a]
mass_kg = 1
cylinders = [{diameter_m = 1.0, name = "x"}, {diameter_m = 2.0}]
[moorings.l]
body = "z"
stiffness_N_m = 3.427e6)");
  const std::string echo = echo_of(scene, dir.path());
  INFO(echo);
  CHECK(echo_of(echo, "/nowhere") == echo);  // same text means same bits: numbers are printed to the last one
}

TEST_CASE("the echo reads back to the same bits", "[scene][fast]") {
  std::mt19937_64 random(7);
  for (int n = 0; n < 2000; ++n) {
    const double mass = std::exp(std::uniform_real_distribution(-300.0, 300.0)(random));
    const double pitch_deg = std::uniform_real_distribution(-90.0, 90.0)(random);
    const auto read = [](const std::string& text) {
      Document doc = parse(text, "s.toml", "/");
      auto bodies = doc.read_named(example::body_section());
      doc.finish();
      return std::pair(bodies.at(0).options, doc.echo());
    };
    const auto [options, echo] =
        read("[bodies.a]\nmass_kg = " + toml_number(mass) + "\npitch_deg = " + toml_number(pitch_deg) + "\n");
    const auto again = read(echo).first;
    REQUIRE(options.mass_kg == mass);
    REQUIRE(again.mass_kg == mass);
    REQUIRE(options.pitch == pitch_deg * radians_per_degree);
    REQUIRE(again.pitch == options.pitch);
  }
}

TEST_CASE("a default that its unit cannot say is moved to one that it can", "[scene][fast]") {
  Document doc = parse("[bodies.a]\nmass_kg = 1\n", "s.toml", "/");
  const double pitch = doc.read_named(example::body_section()).at(0).options.pitch;  // declared as 0.1 rad
  CHECK(pitch == Approx(0.1).epsilon(1e-15));
  CHECK(to_key_unit(pitch, radians_per_degree) * radians_per_degree == pitch);
}

TEST_CASE("degrees and rpm are echoed as a person wrote them", "[scene][fast]") {
  for (int i = 1; i < 3600; ++i) {  // the quotient alone misses 7 and 12 % of them by its last bit
    REQUIRE(toml_number(to_key_unit(i / 10.0 * radians_per_degree, radians_per_degree)) == toml_number(i / 10.0));
    REQUIRE(toml_number(to_key_unit(i / 10.0 * rad_s_per_rpm, rad_s_per_rpm)) == toml_number(i / 10.0));
  }
}

TEST_CASE("the echo leaves out what has no effect and what was not chosen", "[scene][fast]") {
  const std::string echo = echo_of("[time]\nend_s = 1\n[moorings.l]\nbody = \"b\"\naxial_stiffness_N = 4e8\n", "/");
  using Catch::Contains;
  CHECK_THAT(echo, Contains("window_s = 0.1  # s; Length of a coupling window.\n"));
  CHECK_THAT(echo, Contains("model = \"none\"  # none | morison | sph; Which model.\n"));
  CHECK_THAT(echo, Contains("axial_stiffness_N = 4e8  # N; EA of the line.\n"));
  CHECK_THAT(echo, !Contains("drag_coefficient"));
  CHECK_THAT(echo, !Contains("\nstiffness_N_m"));
  CHECK_THAT(echo, !Contains("anchor_m"));
}
