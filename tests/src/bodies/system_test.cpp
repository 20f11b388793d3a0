// Laws of src/bodies/system.hpp: conservation, constraints, added mass, gyroscopic moments, purity of a step.
// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/system.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/src/bodies/examples.hpp"

using namespace spindrift;
using namespace spindrift::bodies;
using Eigen::Vector3d;

TEST_CASE("a free body with three distinct inertias keeps energy and angular momentum to 1e-10 over 1e5 steps", "[bodies][fast]") {
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
