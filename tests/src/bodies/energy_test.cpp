// The balance of energy that a step keeps (EnergyBalance in src/bodies/state.hpp): work by source against exact values, and what
// the steps themselves make. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <span>

#include "src/bodies/system.hpp"
#include "tests/order.hpp"
#include "tests/src/bodies/examples.hpp"

using namespace spindrift;
using namespace spindrift::bodies;
using Eigen::Vector3d;

namespace {

constexpr double g = 9.81;

BodiesState begin(System& system) {
  BodiesState state = examples::start(system);
  system.begin(state, 0.0);
  return state;
}

double after_sources(const System& system, const BodiesState& state, EnergyBalance::AfterSources slot) {
  return state.work[system.loads().size() + slot];
}

/// A rod that swings from its end, released at the angle [rad] from below.
struct Swing {
  std::vector<Body> bodies;
  System system;
  explicit Swing(double angle, Integrator integrator = Integrator::rk4)
      : bodies{examples::rod("rod", 3.0, {0, 0, 0}, 2.0 * Vector3d(std::sin(angle), 0, -std::cos(angle)))},
        system(bodies, {examples::joint("pivot", JointType::revolute, earth, 0, {0, 0, 0}, {0, 1, 0})},
               {gravity_source(bodies, g)}, integrator) {}
};

}  // namespace

TEST_CASE("gravity's work on a swinging rod is its fall, joints do none, and steps of rk4 make energy by their fourth order",
          "[bodies][fast]") {
  std::vector<double> made;
  for (const int steps : {50, 100, 200}) {
    Swing swing(1.5);
    BodiesState state = begin(swing.system);
    const double z = state.motions[0].position.z();
    examples::run(swing.system, state, 1.0 / steps, steps);
    const double kinetic = swing.system.kinetic_energy(state), work = state.work[0];
    made.push_back(std::abs(after_sources(swing.system, state, EnergyBalance::error)) / kinetic);
    CHECK(work == Approx(3.0 * g * (z - state.motions[0].position.z())).epsilon(1e-4));
    CHECK(std::abs(after_sources(swing.system, state, EnergyBalance::joints)) < 1e-3 * made.back() * kinetic + 1e-12 * kinetic);
    CHECK(kinetic == Approx(work + after_sources(swing.system, state, EnergyBalance::joints) +
                            after_sources(swing.system, state, EnergyBalance::error))
                         .epsilon(1e-12));
  }
  INFO(made[0] << ' ' << made[1] << ' ' << made[2]);
  CHECK(std::log2(made[1] / made[2]) > 3.8);
}

TEST_CASE("a driver's work is what it gives to what it turns", "[bodies][fast]") {
  std::vector<Body> bodies{examples::rod("rod", 3.0, {0, 0, 0}, {0, 0, -2})};
  Joint motor = examples::joint("motor", JointType::revolute, earth, 0, {0, 0, 0}, {0, 1, 0});
  motor.rotation = PrescribedMotion{.rate = 1.0};  // rad/s
  System system(bodies, {motor}, {gravity_source(bodies, g)});
  BodiesState state = begin(system);
  const double z = state.motions[0].position.z();
  examples::run(system, state, 0.01, 100);
  const double rise = state.motions[0].position.z() - z;
  REQUIRE(rise > 0.4);
  CHECK(after_sources(system, state, EnergyBalance::joints) == Approx(3.0 * g * rise).epsilon(1e-6));  // at constant speed
}

TEST_CASE("a force that also moves added mass does work on both", "[bodies][fast]") {
  const double mass = 2.0, added = 5.0, force = 6.0;
  const Body body = examples::body("float", mass, {1, 1, 1}, {0, 0, 0});
  System system({body}, {},
                {{"push", [=](double, auto, std::span<Wrench> w) { w[0].force.x() += force; }, {}},
                 {"water", {}, [=](double, auto, std::span<Matrix6> a) { a[0](0, 0) += added; }}});
  BodiesState state = begin(system);
  examples::run(system, state, 0.01, 100);
  const double speed = force / (mass + added);
  CHECK(state.work[0] == Approx(force * 0.5 * speed));
  CHECK(after_sources(system, state, EnergyBalance::added_mass) == Approx(-0.5 * added * speed * speed));
  CHECK(std::abs(after_sources(system, state, EnergyBalance::joints)) < 1e-12);
  CHECK(std::abs(after_sources(system, state, EnergyBalance::error)) < 1e-12);
}

TEST_CASE("a step that makes energy of its own stops the run before it shows", "[bodies][fast]") {
  // A mass on a spring, steps a tenth beyond the symplectic step's limit of 2 / omega: the amplitude grows 2.4 times a step.
  const double mass = 1.0, stiffness = 1e4, omega = std::sqrt(stiffness / mass), amplitude = 0.01;
  Body body = examples::body("mass", mass, {1, 1, 1}, {amplitude, 0, 0});
  System system(
      {body}, {},
      {{"spring",
        [=](double, std::span<const Motion> m, std::span<Wrench> w) { w[0].force.x() -= stiffness * m[0].position.x(); },
        {}}},
      Integrator::symplectic);
  BodiesState state = begin(system);
  const double step = 2.2 / omega, put_in = 0.5 * stiffness * amplitude * amplitude;
  StepReport report;
  int steps = 0;
  for (; steps < 100 && (report = system.advance(state, step, 1)).ok(); ++steps) {}
  CHECK(report.trouble == StepReport::Trouble::energy);
  CHECK(steps < 10);
  INFO(steps << " steps, " << system.kinetic_energy(state) << " J");
  CHECK_THAT(system.describe(report), Catch::Matchers::Contains("time.step_s"));
  CHECK(system.kinetic_energy(state) < 100.0 * put_in);
}
