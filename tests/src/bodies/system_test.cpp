// Laws of src/bodies/system.hpp: conservation, constraints, added mass, gyroscopic moments, purity of a step.
// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/system.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "tests/order.hpp"
#include "tests/src/bodies/examples.hpp"

using namespace spindrift;
using namespace spindrift::bodies;
using Eigen::Vector3d;

TEST_CASE("a free body with three distinct inertias keeps energy and angular momentum to 1e-10 over 1e5 steps",
          "[bodies][fast]") {
  Body b = examples::body("top", 2.0, {1.0, 2.0, 3.0}, {1, 2, 3});
  b.initial.omega = {0.3, 1.0, 0.2};  // near the middle axis, so that it tumbles
  b.initial.omega.normalize();
  b.initial.velocity = {1, -1, 0.5};
  System system({b}, {}, {});
  BodiesState state = examples::start(system);
  const double energy = system.kinetic_energy(state);
  const Vector3d momentum = b.initial.attitude * (b.inertia * b.initial.omega);
  double energy_error = 0.0, momentum_error = 0.0;
  for (int n = 0; n < 100; ++n) {
    examples::run(system, state, 1e-3, 1000);
    const Motion& m = state.motions[0];
    energy_error = std::max(energy_error, std::abs(system.kinetic_energy(state) / energy - 1.0));
    momentum_error = std::max(momentum_error, (m.attitude * (b.inertia * m.omega) - momentum).norm() / momentum.norm());
  }
  CHECK(energy_error < 1e-10);
  CHECK(momentum_error < 1e-10);
  CHECK(state.motions[0].omega.x() != Approx(b.initial.omega.x()).margin(0.1));  // it did tumble
  CHECK((state.motions[0].position - Vector3d(101, -98, 53)).norm() < 1e-9);
}

TEST_CASE("a simple pendulum swings with the period of the elliptic integral", "[bodies][fast]") {
  const double length = 1.0, g = 9.81, amplitude = 1.2;
  const Vector3d tip(std::sin(amplitude) * length, 0, -std::cos(amplitude) * length);
  Body bob = examples::body("bob", 1.0, {1e-9, 1e-9, 1e-9}, tip);
  const std::vector<Body> bodies{bob};
  System system(bodies, {examples::joint("pivot", JointType::revolute, earth, 0, {0, 0, 0}, {0, 1, 0})},
                {gravity_source(bodies, g)});
  BodiesState state = examples::start(system);
  const double period = 4.0 * std::sqrt(length / g) * std::comp_ellint_1(std::sin(0.5 * amplitude));  // inertia adds 1e-9
  const int steps = 4000;
  examples::run(system, state, period / steps, steps);
  CHECK((state.motions[0].position - tip).norm() < 1e-8);
  CHECK(state.motions[0].velocity.norm() < 1e-7);
  CHECK(system.constraint_residual(state, 0.0) < 1e-12);
}

TEST_CASE("with added mass on the left-hand side a body accelerates by F / (m + A), however large A is", "[bodies][fast]") {
  const double added = GENERATE(0.0, 5.0, 1e4);
  Body b = examples::body("float", 2.0, {1, 1, 1}, {0, 0, 0});
  b.initial.attitude = Eigen::AngleAxisd(0.5, Vector3d(1, 2, 3).normalized());  // added mass is in earth axes
  std::vector<LoadSource> loads{{"push", [](double, auto, std::span<Wrench> w) { w[0].force += Vector3d(6, 0, 12); }, {}},
                                {"water", {}, [=](double, auto, std::span<Matrix6> a) {
                                   a[0](2, 2) += added;
                                   a[0](2, 4) += 0.1 * added;  // heave-pitch coupling
                                   a[0](4, 2) += 0.1 * added;
                                   a[0](4, 4) += added;
                                 }}};
  System system({b}, {}, loads);
  BodiesState state = examples::start(system);
  const Evaluation& now = system.evaluate(state, 0.0);
  Eigen::Matrix2d mass;
  mass << 2.0 + added, 0.1 * added, 0.1 * added, 1.0 + added;
  const Eigen::Vector2d expected = mass.inverse() * Eigen::Vector2d(12, 0);
  CHECK(now.acceleration[0].x() == Approx(3.0));
  CHECK(now.acceleration[0].z() == Approx(expected[0]));
  CHECK(now.angular_acceleration[0].y() == Approx(expected[1]).margin(1e-12));
  CHECK(now.by_source[1][0].force.z() == Approx(-added * expected[0] - 0.1 * added * expected[1]).margin(1e-12));
  examples::run(system, state, 0.01, 100);
  CHECK(state.motions[0].position.x() == Approx(1.5));
}

TEST_CASE("a spinning rotor turns its tilting support sideways, unless its gyroscopic moments are left out", "[bodies][fast]") {
  // Support free to turn about every axis through the origin and pitching; rotor spinning on it about x.
  const double pitch_rate = 0.1, spin = 20.0;
  const auto yaw_acceleration = [&](bool gyroscopic, const Vector3d& rotor_inertia) {
    std::vector<Body> bodies{examples::body("support", 10.0, {50, 50, 50}, {0, 0, 0}),
                             examples::body("rotor", 1.0, rotor_inertia, {0, 0, 0})};
    bodies[0].initial.omega = {0, pitch_rate, 0};
    bodies[0].gyroscopic = bodies[1].gyroscopic = gyroscopic;
    Joint bearing = examples::joint("bearing", JointType::revolute, 0, 1, {0, 0, 0}, {1, 0, 0});
    bearing.rotation = PrescribedMotion{.rate = spin};
    System system(bodies, {examples::joint("pivot", JointType::spherical, earth, 0, {0, 0, 0}), bearing}, {});
    const BodiesState state = examples::start(system);
    CHECK(state.motions[0].omega.y() == Approx(pitch_rate));
    return system.evaluate(state, 0.0).angular_acceleration[0].z();
  };
  const Vector3d disc(2.0, 1.0, 1.0), ball(2.0, 2.0, 2.0);
  for (const Vector3d& inertia : {disc, ball}) {
    // H = Ixx spin along x, turned by the pitch rate: moment on the support +Ixx spin pitch_rate about z (right-hand rule).
    CHECK(yaw_acceleration(true, inertia) == Approx(inertia.x() * spin * pitch_rate / (50.0 + inertia.z())));
    CHECK(yaw_acceleration(false, inertia) == Approx(0.0).margin(1e-12));
  }
}

TEST_CASE("a step is a pure function of the state: saved, restored and repeated it gives the same bits", "[bodies][fast]") {
  std::vector<Body> bodies{examples::body("a", 1.0, {1, 2, 2.5}, {0.5, 0, 0}),
                           examples::body("b", 2.0, {1, 1.5, 2}, {1.5, 0, 0})};
  bodies[1].initial.omega = {3, -2, 5};
  std::vector<Joint> joints{examples::joint("pivot", JointType::revolute, earth, 0, {0, 0, 0}, {0, 1, 0}),
                            examples::joint("cross", JointType::universal, 0, 1, {1, 0, 0}, {1, 0, 0})};
  joints[1].second_axis = {0, 1, 0};
  System system(bodies, joints, {gravity_source(bodies, 9.81)});
  BodiesState state = examples::start(system);
  examples::run(system, state, 2e-3, 777);
  std::vector<double> saved(state.packed_size()), straight(state.packed_size()), repeated(state.packed_size());
  state.pack(saved);
  BodiesState other = examples::start(system);
  examples::run(system, other, 1e-3, 50);  // another past must not show
  other.unpack(saved);
  examples::run(system, state, 2e-3, 500);
  System fresh(bodies, joints, {gravity_source(bodies, 9.81)});
  examples::run(fresh, other, 2e-3, 500);
  state.pack(straight);
  other.pack(repeated);
  CHECK(std::memcmp(straight.data(), repeated.data(), straight.size() * sizeof(double)) == 0);
  CHECK(state.tick == 1277);
}

TEST_CASE("a state that was evaluated costs its step one evaluation less and changes no bit of it", "[bodies][fast]") {
  const Integrator integrator = GENERATE(Integrator::rk4, Integrator::symplectic, Integrator::explicit_euler);
  int calls = 0;
  double push = 1.0;  // set from outside
  const auto make = [&] {
    Body arm = examples::body("arm", 3.0, {1, 2, 3}, {1, 0, 0});
    arm.initial.attitude = Eigen::AngleAxisd(0.4, Vector3d(1, 2, 3).normalized());
    std::vector<LoadSource> loads{
        gravity_source(std::vector<Body>{arm}, 9.81),
        {"push",
         [&](double t, std::span<const Motion> m, std::span<Wrench> w) {
           ++calls;
           w[0].force += push * Vector3d(std::cos(t), 0.1 * m[0].velocity.x(), -m[0].position.z());
         },
         {}},
        {"water", {}, [](double, auto, std::span<Matrix6> a) { a[0](0, 0) += 2.0, a[0](2, 2) += 0.5; }}};
    return System({arm}, {examples::joint("pivot", JointType::spherical, earth, 0, {0, 0, 0}, {0, 1, 0})}, loads, integrator);
  };
  System plain = make(), told = make();
  BodiesState a = examples::start(plain), b = examples::start(told);
  plain.begin(a, 0.0), told.begin(b, 0.0);
  const int in_a_step = int(evaluation_weights(integrator).size());
  for (int n = 0; n < 20; ++n) {
    REQUIRE(plain.advance(a, 0.01, 1).ok());
    calls = 0;
    REQUIRE(told.evaluate(b, 0.01 * double(b.tick)).report.ok());
    REQUIRE(told.advance(b, 0.01, 1).ok());
    CHECK(calls == in_a_step);
    CHECK(a == b);
  }
  // Loads that change between steps are asked for anew, if it was said that they do.
  told.set_loads_from_outside(true);
  BodiesState c = b;
  static_cast<void>(told.evaluate(b, 0.01 * double(b.tick)));
  push = 2.0;
  REQUIRE(told.advance(b, 0.01, 1).ok());
  REQUIRE(plain.advance(c, 0.01, 1).ok());
  CHECK(b == c);
}

TEST_CASE("a load that is not a number stops the step, names the body and leaves the state as it was", "[bodies][fast]") {
  std::vector<Body> bodies{examples::body("good", 1, {1, 1, 1}, {0, 0, 0}), examples::body("bad", 1, {1, 1, 1}, {1, 0, 0})};
  System system(bodies, {}, {{"broken", [](double t, auto, std::span<Wrench> w) { w[1].force.x() += t > 0.5 ? NAN : 0.0; }, {}}});
  BodiesState state = examples::start(system);
  examples::run(system, state, 0.1, 5);
  const StepReport report = system.advance(state, 0.1, 1);
  CHECK(report.trouble == StepReport::Trouble::not_finite);
  CHECK_THAT(system.describe(report), Catch::Matchers::Contains("'bad'"));
  CHECK(state.tick == 5);
  CHECK(state.motions[1].position.x() == 1.0);
}

TEST_CASE("a body whose added mass takes more than it has is named", "[bodies][fast]") {
  std::vector<Body> bodies{examples::body("good", 1, {1, 1, 1}, {0, 0, 0}), examples::body("bad", 1, {1, 2, 3}, {1, 0, 0})};
  System system(bodies, {}, {{"water", {}, [](double t, auto, std::span<Matrix6> a) { a[1](4, 4) -= t > 0.5 ? 2.5 : 0.0; }}});
  BodiesState state = examples::start(system);
  examples::run(system, state, 0.1, 5);
  const StepReport report = system.advance(state, 0.1, 1);
  CHECK(report.trouble == StepReport::Trouble::mass);
  CHECK_THAT(system.describe(report), Catch::Matchers::Contains("'bad': mass plus added mass"));
}

TEST_CASE("a load that is not a number is named on bodies that cannot move, too", "[bodies][fast]") {
  std::vector<Body> bodies{examples::body("held", 1, {1, 1, 1}, {0, 0, 0})};
  const std::vector<Joint> joints{examples::joint("foundation", JointType::fixed, earth, 0, {0, 0, 0}, {1, 0, 0})};
  System system(bodies, joints,
                {{"broken", [](double t, auto, std::span<Wrench> w) { w[0].force.x() = t > 0.5 ? NAN : 1.0; }, {}}});
  BodiesState state = examples::start(system);
  examples::run(system, state, 0.1, 5);
  CHECK(system.evaluate(state, 0.5).report.ok());
  CHECK_THAT(system.describe(system.evaluate(state, 0.6).report), Catch::Matchers::Contains("'held'"));
  CHECK(system.advance(state, 0.1, 1).trouble == StepReport::Trouble::not_finite);
}

TEST_CASE("each integrator shows its order on a constrained spinning system", "[bodies][fast]") {
  const auto [integrator, order] = GENERATE(
      table<Integrator, double>({{Integrator::rk4, 4.0}, {Integrator::explicit_euler, 1.0}, {Integrator::symplectic, 2.0}}));
  std::vector<Body> bodies{examples::body("top", 1.0, {0.3, 0.4, 0.2}, {0.2, 0, 1}),
                           examples::body("arm", 0.5, {0.1, 0.2, 0.2}, {0.7, 0, 1})};
  bodies[0].initial.omega = {0, 0, 9};
  bodies[1].initial.omega = {0, 2, 9};
  System system(bodies,
                {examples::joint("tip", JointType::spherical, earth, 0, {0, 0, 0}),
                 examples::joint("hinge", JointType::revolute, 0, 1, {0.5, 0, 1}, {0, 1, 0})},
                {gravity_source(bodies, 9.81)}, integrator);
  System exact(bodies, std::vector<Joint>(system.joints().begin(), system.joints().end()), {gravity_source(bodies, 9.81)});
  BodiesState reference = examples::start(exact);
  examples::run(exact, reference, 0.5 / 8000, 8000);
  std::vector<double> h, error;
  const int coarsest = integrator == Integrator::explicit_euler ? 1000 : 100;
  for (int steps : {coarsest, 2 * coarsest, 4 * coarsest}) {
    BodiesState state = examples::start(system);
    examples::run(system, state, 0.5 / steps, steps);
    h.push_back(0.5 / steps);
    error.push_back((state.motions[1].position - reference.motions[1].position).norm());
  }
  INFO(name(integrator) << " errors " << error[0] << " " << error[1] << " " << error[2]);
  CHECK(observed_order(h, error) == Approx(order).margin(0.3));
}

TEST_CASE("constraints hold to 1e-12 of the length over a million steps", "[bodies][nightly]") {
  // Thick enough that their spin about themselves stays slow beside the step: thinner ones ask for shorter steps at times.
  std::vector<Body> bodies{examples::rod("first", 1.0, {0, 0, 0}, {1, 0, 0}, 0.05),
                           examples::rod("second", 1.0, {1, 0, 0}, {1, 1, 0}, 0.05)};
  System system(bodies,
                {examples::joint("top", JointType::spherical, earth, 0, {0, 0, 0}),
                 examples::joint("middle", JointType::revolute, 0, 1, {1, 0, 0}, {0, 0, 1})},
                {gravity_source(bodies, 9.81)});
  BodiesState state = examples::start(system);
  double worst = 0.0;
  for (int n = 0; n < 1000; ++n) {
    examples::run(system, state, 1e-3, 1000);
    worst = std::max(worst, system.constraint_residual(state, double(state.tick) * 1e-3));
  }
  CHECK(worst < 1e-12);
}
