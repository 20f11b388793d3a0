// What is refused and doubted of a sea of particles, by its options alone.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/rigid/closed_surface.hpp"
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
  std::string doubted(const BodiesInSea& in_sea = {}) const {
    std::string all;
    for (const scene::Doubt& doubt : sea_doubts(sea, waves, metre_deep, in_sea)) all += doubt.key + " " + doubt.what + "\n";
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
  SECTION("a box along a face of a body may be as thin as wanted, but not lie between two rows") {
    s.bodies = {{.name = "box", .mass = 100.0, .described = {.position = {2, 1, 0}}, .shapes = {Box{.size = {1, 1, 1}}}}};
    s.sea.sensors = {sensor({1.4, 0.4, -0.51}, {2.6, 1.6, -0.49}, "box")};
    CHECK(s.refused() == "");
    s.sea.sensors = {sensor({1.99, 0.4, -0.51}, {2.01, 1.6, -0.49}, "box")};
    CHECK_THAT(s.refused(), Contains("sea.sensors[0] has nothing of the surface of box") && Contains("narrower than the rows"));
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

TEST_CASE("boxes of water that reach out of the tank are doubted by the axis along which they do", "[sea][sph][fast]") {
  using Catch::Contains;
  Scene s = particle_tank();
  const auto doubted = [&](Eigen::Vector3d low, Eigen::Vector3d high) {
    s.sea.water = {{low, high}};
    return s.doubted();
  };
  CHECK_THAT(doubted({0, 0, -1}, {2, 2, 0}), !Contains("sea.water"));
  CHECK_THAT(doubted({0, 0, -1}, {6, 2, 0}), Contains("sea.water[0].high_m x = 6 m in a tank from 0 to 4 m"));
  CHECK_THAT(doubted({0, -2, -1}, {2, 2, 0}), Contains("sea.water[0].low_m y = -2 m in a tank from 0 to 2 m"));
  CHECK_THAT(doubted({0, 0, -10}, {2, 2, 0}), Contains("sea.water[0].low_m z = -10 m in a tank from -1 to 0.5 m"));
  s.sea.tank->sides_y = "symmetric";
  CHECK_THAT(doubted({0, -2, -1}, {2, 2, 0}), !Contains("sea.water"));
  s = particle_tank(true);  // a width is no one's in the plane
  CHECK_THAT(doubted({0, -2, -1}, {2, 2, 0}), !Contains("sea.water"));
}

TEST_CASE("sound is twice as fast in water that breaks, falls or runs out as in water that is held", "[sea][sph][fast]") {
  Scene s = particle_tank(GENERATE(false, true));
  const auto sound = [&] { return particle_plan(s.sea, s.waves, metre_deep, {}, 0.0).parameters.eos.c0; };
  const double held = 10.0 * std::sqrt(9.81), loose = 20.0 * std::sqrt(9.81);
  CHECK(sound() == Approx(held));
  SECTION("at open sides") {
    s.sea.tank->sides_x = "open";
    CHECK(sound() == Approx(loose));
  }
  SECTION("in boxes") {
    const BoxOptions lower{{0, 0, -1}, {4, 2, -0.5}}, upper{{0, 0, -0.5}, {4, 2, 0}}, column{{0, 0, -1}, {1, 2, 0}};
    s.sea.water = {lower, upper};
    CHECK(sound() == Approx(held));
    s.sea.water = {upper};
    CHECK(sound() == Approx(loose));
    s.sea.water = {column};
    CHECK(sound() == Approx(loose));
    s.sea.water = {upper}, s.sea.obstacles = {lower};
    CHECK(sound() == Approx(held));
  }
}

TEST_CASE("a shape that is too small for its particles is told with its size: a file in millimetres", "[sea][sph][fast]") {
  using Catch::Contains;
  Triangulation t;
  const Eigen::Vector3d low(-0.4e-3, -0.2e-3, -0.1e-3);
  for (int k = 0; k < 8; ++k)
    t.points.emplace_back((k & 1 ? -1 : 1) * low[0], (k & 2 ? -1 : 1) * low[1], (k & 4 ? -1 : 1) * low[2]);
  t.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  Scene s = particle_tank();
  s.bodies = {{.name = "hull",
               .mass = 1e-7,
               .described = {.position = {2, 1, 0}},
               .shapes = {Mesh{std::make_shared<const ClosedSurface>(t), Eigen::Vector3d::Zero()}}}};
  CHECK_THAT(s.refused(),
             Contains("bodies.hull has a shape of 0 particles at a spacing of 0.1 m: too coarse; its mesh is 0.0008 x "
                      "0.0004 x 0.0002 m: look at its scale"));
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

TEST_CASE("what waves do not go with in a sea of particles is refused", "[sea][sph][fast]") {
  using Catch::Contains;
  const DampingZoneOptions led{.from_m = 3.0, .to_m = 4.0, .rate_1_s = 20.0, .towards = "waves"};
  Scene s = with_waves(particle_tank());
  s.waves.height_m = 0.1;
  SECTION("zones that lead to waves over a slope, or into walls") {
    s.sea.damping_zones = {led};
    REQUIRE(s.refused() == "");
    s.sea.tank->bed_m = {{0.5, -1.0}, {1.0, -0.8}, {2.0, -1.0}};
    CHECK(s.refused() == "");
    s.sea.tank->bed_m = {{2.5, -1.0}, {3.5, -0.8}};
    CHECK_THAT(s.refused(), Contains("sea.damping_zones[0].towards"));
    s.sea.tank->bed_m.clear();
    s.waves.direction = 0.3;
    CHECK_THAT(s.refused(), Contains("walls of sea.tank.sides_y"));
    DampingZoneOptions low = led, high = led;
    low.axis = high.axis = "y", low.from_m = 0.8, low.to_m = 0.0, high.from_m = 1.2, high.to_m = 2.0;
    s.sea.damping_zones = {led, low, high};
    CHECK(s.refused() == "");
    s.sea.damping_zones = {led}, s.sea.tank->sides_y = "periodic";
    CHECK(s.refused() == "");
  }
  SECTION("damping before t = 0 where there are waves then") {
    s.sea.initial = InitialOptions{.settle_s = 1.0, .settle_damping_1_s = 5.0};
    s.sea.wavemaker = WavemakerOptions{};
    CHECK(s.refused() == "");
    SECTION("by an early paddle") { s.sea.wavemaker->start_s = -0.5; }
    SECTION("by zones") { s.sea.wavemaker.reset(), s.sea.damping_zones = {led}; }
    SECTION("by the start") { s.sea.wavemaker.reset(), s.sea.initial->state = GENERATE("waves", "standing"); }
    CHECK_THAT(s.refused(), Contains("sea.initial.settle_damping_1_s must be 0"));
  }
  SECTION("a paddle that grows in water that moves") {
    s.sea.initial = InitialOptions{.state = "waves"};
    s.sea.wavemaker = WavemakerOptions{.ramp_s = 0.0};
    CHECK(s.refused() == "");
    s.sea.wavemaker->ramp_s = 1.0;
    CHECK_THAT(s.refused(), Contains("sea.wavemaker.ramp_s must be 0"));
  }
  SECTION("water at a paddle that does not stand at z = 0") {
    s.sea.wavemaker = WavemakerOptions{};
    s.sea.obstacles = {{{2.0, 0.0, -1.0}, {2.2, 2.0, 0.1}}};
    s.sea.water = {{{0.0, 0.0, -1.0}, {2.0, 2.0, 0.0}}};  // to an obstacle, dry beyond
    CHECK(s.refused() == "");
    SECTION("lower") { s.sea.water[0].high_m[2] = -0.3; }
    SECTION("not down to the bed") { s.sea.water[0].low_m[2] = -0.6; }
    SECTION("not from side to side") { s.sea.water[0].high_m[1] = 1.0; }
    SECTION("elsewhere") { s.sea.water[0].low_m[0] = 0.5; }
    CHECK_THAT(s.refused(), Contains("sea.water[0] with [sea.wavemaker] a box of water must begin at the paddle"));
  }
  SECTION("water in a zone towards waves that does not stand at z = 0") {
    s.sea.damping_zones = {led};
    s.sea.water = {{{2.5, 0.0, -1.0}, {4.0, 2.0, 0.0}}};
    CHECK(s.refused() == "");
    SECTION("lower") { s.sea.water[0].high_m[2] = -0.3; }
    SECTION("in a part of it") { s.sea.water[0].low_m[0] = 3.5; }
    CHECK_THAT(s.refused(), Contains("sea.damping_zones[0].towards must be \"rest\""));
    s.sea.damping_zones[0].towards = "rest";
    CHECK_THAT(s.refused(), !Contains("sea.damping_zones[0]"));
  }
  SECTION("stretching") {
    s.sea.initial = InitialOptions{.state = "waves"};
    CHECK(s.refused() == "");
    s.waves.stretching = "vertical";
    CHECK_THAT(s.refused(), Contains("waves.stretching has no effect"));
  }
}

TEST_CASE("thin obstacles, bodies behind a zone and spread seas between sides that repeat are doubted", "[sea][sph][fast]") {
  using Catch::Contains;
  Scene s = particle_tank();
  SECTION("an obstacle is as thick as water feels it, or stands on the bed or against a wall") {
    for (const auto& [box, thin] : std::vector<std::pair<BoxOptions, bool>>{{{{1.0, 0.5, -0.5}, {2.0, 1.5, -0.3}}, true},
                                                                            {{{1.0, 0.5, -1.0}, {1.2, 1.5, 0.5}}, true},
                                                                            {{{1.0, 0.5, -0.6}, {2.0, 1.5, -0.3}}, false},
                                                                            {{{1.0, 0.5, -1.0}, {2.0, 1.5, -0.8}}, false},
                                                                            {{{3.8, 0.5, -1.0}, {4.0, 1.5, 0.5}}, false}}) {
      s.sea.obstacles = {box};
      CAPTURE(box.low_m, box.high_m);
      CHECK((s.doubted().find("sea.obstacles[0]") != std::string::npos) == thin);
    }
  }
  SECTION("a zone acts from its end to the tank's") {
    s.sea.damping_zones = {{.from_m = 2.0, .to_m = 3.0, .rate_1_s = 10.0}};
    for (const auto& [x, within] : {std::pair{3.6, true}, {2.5, true}, {1.0, false}}) {
      const Eigen::AlignedBox3d box(Eigen::Vector3d(x - 0.2, 0.8, -0.2), Eigen::Vector3d(x + 0.2, 1.2, 0.2));
      CAPTURE(x);
      CHECK((s.doubted({.boxes = {{"buoy", box}}}).find("where body buoy is") != std::string::npos) == within);
    }
  }
  SECTION("spreading") {
    s = with_waves(particle_tank());
    s.sea.tank->sides_y = "periodic", s.sea.damping_zones = {{.from_m = 3.0, .to_m = 4.0, .rate_1_s = 20.0, .towards = "waves"}};
    CHECK_THAT(s.doubted(), !Contains("sea.tank.y_m"));
    s.waves.model = "jonswap", s.waves.spreading_exponent = 4.0;
    CHECK_THAT(s.doubted(), Contains("sea.tank.y_m"));
  }
}
