// What is refused and doubted of a sea of particles, by its options alone.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "src/sea/doubts.hpp"
#include "src/sea/particle_sea.hpp"

using namespace spindrift;
using namespace spindrift::sea;

namespace {

constexpr SeaEnvironment metre_deep{.water_density = 1000.0, .water_depth = 1.0, .gravity = 9.81};

struct Scene {
  SeaOptions sea;
  WavesOptions waves;
  std::vector<ParticleBody> bodies;

  /// Key and text of each problem, one a line.
  std::string refused() const {
    std::string all;
    for (const OptionProblem& p : particle_problems(sea, waves, metre_deep, bodies)) all += p.key + " " + p.what + "\n";
    return all;
  }
  std::string doubted() const {
    std::string all;
    for (const scene::Doubt& doubt : sea_doubts(sea, waves, metre_deep, {})) all += doubt.key + " " + doubt.what + "\n";
    return all;
  }
};
/// A tank of 4 x 2 x 1 m of particles a tenth of a metre apart; in 2-D without its width.
Scene particle_tank(bool planar = false) {
  Scene s;
  s.sea.model = "sph";
  s.sea.particles = ParticleOptions{.spacing_m = 0.1, .dimensions = planar ? "2" : "3"};
  s.sea.tank = TankOptions{.x_m = {0.0, 4.0}, .y_m = {0.0, planar ? 0.0 : 2.0}, .top_m = 0.5};
  return s;
}
Scene with_waves(Scene s) {
  s.waves = {.model = "airy", .height_m = 0.2, .period_s = 1.5};
  return s;
}
SensorOptions sensor(Eigen::Vector3d low, Eigen::Vector3d high, std::string body = {}) {
  return {.name = "a", .body = std::move(body), .low_m = low, .high_m = high};
}

}  // namespace

TEST_CASE("a sensor that no particle of a wall or body is on is refused", "[sea][sph][sensor][fast]") {
  using Catch::Contains;
  Scene s = particle_tank();
  REQUIRE(s.refused() == "");
  SECTION("on the sides, the bed and an obstacle there are particles") {
    s.sea.obstacles = {{{2.0, 0.5, -1.0}, {2.5, 1.5, 0.2}}};
    for (const auto& [low, high] : {std::pair<Eigen::Vector3d, Eigen::Vector3d>{{0, 0.5, -0.5}, {0, 0.7, -0.3}},
                                    {{4, 0.5, -0.5}, {4, 0.7, -0.3}},
                                    {{1, 0, -0.5}, {2, 0, -0.3}},
                                    {{1, 0.5, -1}, {1.5, 1, -1}},
                                    {{1, 0.51, -1}, {1.5, 0.53, -1}},
                                    {{2.0, 0.9, -0.9}, {2.0, 1.1, -0.8}}}) {
      s.sea.sensors = {sensor(low, high)};
      CAPTURE(low, high);
      CHECK(s.refused() == "");
    }
  }
  SECTION("in the middle of the water there are none, nor deep in an obstacle") {
    s.sea.obstacles = {{{2.0, 0.5, -1.0}, {3.5, 1.5, 0.2}}};
    for (const auto& [low, high] :
         {std::pair<Eigen::Vector3d, Eigen::Vector3d>{{1, 0.5, -0.5}, {1, 0.7, -0.3}}, {{2.5, 0.9, 0.5}, {2.7, 0.9, 0.6}}}) {
      s.sea.sensors = {sensor(low, high)};
      CHECK_THAT(s.refused(), Contains("sea.sensors[0]"));
    }
  }
  SECTION("nor on sides that repeat or are open") {
    s.sea.tank->sides_x = GENERATE("periodic", "open");
    s.sea.sensors = {sensor({0, 0.5, -0.5}, {0, 0.7, -0.3})};
    CHECK_THAT(s.refused(), Contains("sea.sensors[0] is on no wall"));
  }
  SECTION("the face of a body is half a spacing before its particles") {
    s.bodies = {{.name = "box", .mass = 100.0, .described = {.position = {2, 1, 0}}, .shapes = {Box{.size = {1, 1, 1}}}}};
    s.sea.sensors = {sensor({1.4, 0.4, -0.51}, {2.6, 1.6, -0.49}, "box")};
    CHECK_THAT(s.refused(), Contains("sea.sensors[0] has no particle of box"));
    s.sea.sensors = {sensor({1.4, 0.4, -0.51}, {2.6, 1.6, -0.4}, "box")};
    CHECK(s.refused() == "");
  }
  SECTION("a flap is one wall, what is under its hinge another") {
    s = with_waves(particle_tank(true));
    s.sea.wavemaker = WavemakerOptions{.type = "flap", .hinge_m = -0.5};
    for (const auto& [low, high, well] : {std::tuple{-0.4, 0.1, true}, {-0.9, -0.6, true}, {-0.6, -0.4, false}}) {
      s.sea.sensors = {sensor({0, 0, low}, {0, 0, high})};
      CHECK((s.refused() == "") == well);
    }
  }
}

TEST_CASE("boxes of water and obstacles without a particle are refused", "[sea][sph][fast]") {
  using Catch::Contains;
  Scene s = particle_tank(GENERATE(false, true));
  const std::vector<BoxOptions> nothing{
      {{1.0, 0.2, -1.0}, {1.04, 1.0, 0.0}}, {{5.0, 0.2, -1.0}, {6.0, 1.0, 0.0}}, {{1.0, 0.2, -3.0}, {2.0, 1.0, -1.0}}};
  for (const BoxOptions& box : nothing) {
    CAPTURE(box.low_m, box.high_m);
    s.sea.obstacles = {box}, s.sea.water.clear();
    CHECK_THAT(s.refused(), Contains("sea.obstacles[0] holds no particle"));
    s.sea.obstacles.clear(), s.sea.water = {{{3.0, 0.0, -1.0}, {4.0, 2.0, 0.0}}, box};
    CHECK_THAT(s.refused(), Contains("sea.water[1] holds no particle"));
  }
  s.sea.water = {{{0.0, 0.0, -1.0}, {1.0, 2.0, 0.0}}}, s.sea.obstacles = {{{1.5, 0.5, -1.0}, {1.9, 1.0, 0.0}}};
  CHECK(s.refused() == "");
}
