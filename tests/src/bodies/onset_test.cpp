// Loads that set in at once (src/bodies/system.hpp, watch): a weight that falls on a stiff one-sided spring keeps its energy with
// steps far too long for the spring.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "src/bodies/system.hpp"
#include "tests/src/bodies/examples.hpp"

using namespace spindrift;
using namespace spindrift::bodies;

namespace {

constexpr double weight_kg = 1000.0, pull = 9.81, drop = 1.0, step_s = 0.01;

/// Falls from z = 0 on a spring that begins at z = -drop.
System weight_on(double stiffness, Integrator integrator) {
  const std::vector<Body> bodies{examples::body("weight", weight_kg, {100, 100, 100}, {0, 0, 0})};
  const auto push = [stiffness](double, std::span<const Motion> m, std::span<Wrench> w) {
    w[0].force.z() += stiffness * std::max(0.0, -drop - m[0].position.z());
  };
  System system(bodies, {}, {gravity_source(bodies, pull), {"spring", push, {}}}, integrator);
  system.watch(
      {{"spring", [](std::span<const Motion> m) { return m[0].position.z() < -drop; }, std::sqrt(stiffness / weight_kg)}});
  return system;
}

}  // namespace

TEST_CASE("a weight that bounces on a spring far too stiff for the step keeps its height", "[bodies][fast]") {
  const Integrator integrator = GENERATE(Integrator::rk4, Integrator::symplectic);
  const double turning = GENERATE(0.7, 3.0, 8.6, 31.0);  // radians per step: rk4 is unstable from 2.83, leapfrog from 2
  CAPTURE(name(integrator), turning);
  System system = weight_on(weight_kg * std::pow(turning / step_s, 2), integrator);
  BodiesState state = examples::start(system);
  double highest = -drop, lowest = 0.0, last_highest = -drop;
  for (int n = 0; n < 2000; ++n) {
    examples::run(system, state, step_s, 1);
    const double z = state.motions[0].position.z();
    lowest = std::min(lowest, z);
    if (n < 20) continue;
    highest = std::max(highest, z);
    if (n > 1900) last_highest = std::max(last_highest, z);
  }
  CHECK(highest < 0.01 * drop);        // one per cent of the energy put in
  CHECK(last_highest > -0.01 * drop);  // after 22 bounces, and a step in which it is not seen at its highest
  CHECK(lowest < -drop);
}

TEST_CASE("sources remember the pieces of a step once these are settled, and nothing where no step follows", "[bodies][fast]") {
  const std::vector<Body> bodies{examples::body("weight", weight_kg, {100, 100, 100}, {0, 0, 0})};
  int calls = 0;
  LoadSource counter{.name = "counter", .loads = {}, .added_mass = {}};
  counter.memory =
      Memory{1, [](double, std::span<const Motion>, std::span<double> m) { m[0] = 0.0; }, [](std::span<const double>) {},
             [&](double, double, std::span<const Motion>, std::span<double> m) { ++calls, ++m[0]; }};
  System system(bodies, {}, {gravity_source(bodies, pull), counter});
  system.watch({{"line", [](std::span<const Motion> m) { return m[0].position.z() < -drop; }, 31.0 / step_s}});
  BodiesState state = examples::start(system);
  system.begin(state, 0.0);
  double most = 0.0;
  for (int n = 0; n < 60; ++n) {
    const double before = state.memory[0];
    REQUIRE(system.advance(state, step_s, 1).ok());
    most = std::max(most, state.memory[0] - before);
  }
  CHECK(most > 10.0);  // a step in pieces
  CHECK(calls == int(state.memory[0]));
  state = examples::start(system);
  system.begin(state, 0.0);
  calls = 0;
  REQUIRE(system.advance(state, step_s, 1, 1, Remember::nothing).ok());
  CHECK(calls == 0);
}

TEST_CASE("a step that meets nothing that is watched is the step it was", "[bodies][fast]") {
  System watched = weight_on(1e9, Integrator::rk4), alone = weight_on(1e9, Integrator::rk4);
  alone.watch({});
  BodiesState a = examples::start(watched), b = examples::start(alone);
  examples::run(watched, a, step_s, 40), examples::run(alone, b, step_s, 40);
  CHECK((a == b));
}

TEST_CASE("a spring that acts from the start has the scene's steps until it lets go", "[bodies][fast]") {
  const auto pushed = [](std::vector<Onset> onsets) {
    std::vector<Body> bodies{examples::body("weight", weight_kg, {100, 100, 100}, {0, 0, -drop - 1e-3})};
    const auto push = [](double, std::span<const Motion> m, std::span<Wrench> w) {
      w[0].force.z() += 1e7 * std::max(0.0, -drop - m[0].position.z());
    };
    System system(bodies, {}, {gravity_source(bodies, pull), {"spring", push, {}}});
    system.watch(std::move(onsets));
    BodiesState state = examples::start(system);
    examples::run(system, state, step_s, 10);
    return state.motions[0].position.z();
  };
  Onset onset{"spring", [](std::span<const Motion> m) { return m[0].position.z() < -drop; }, 100.0};
  const double without = pushed({}), in_pieces = pushed({onset});
  onset.from_start = true;
  CHECK(pushed({onset}) == without);
  CHECK(in_pieces != without);
}

TEST_CASE("a spring that no number of pieces follows is named, and the state stays", "[bodies][fast]") {
  System system = weight_on(weight_kg * 1e14, Integrator::rk4);
  BodiesState state = examples::start(system);
  StepReport report;
  while (report.ok() && state.tick < 60) report = system.advance(state, step_s, 1);
  CHECK(report.trouble == StepReport::Trouble::onset);
  CHECK(state.motions[0].position.z() > -drop);
  CHECK_THAT(system.describe(report), Catch::Contains("spring") && Catch::Contains("pieces"));
  CHECK(report.value == Approx(System::most_pieces * 0.1 / 1e7).epsilon(0.01));
}
