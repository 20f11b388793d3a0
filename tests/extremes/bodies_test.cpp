// Bodies beyond their usual range: stiff lines with an explicit step, lines that go slack and snap, tops leaning to the ground.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "kernels/mooring/line_spring_damper.hpp"
#include "kernels/rigid/rotation.hpp"
#include "src/bodies/linearise.hpp"
#include "tests/src/bodies/platform.hpp"

using namespace spindrift;
using namespace spindrift::bodies;
using namespace spindrift::bodies::examples;

namespace {

bool finite(const BodiesState& state) {
  for (const Motion& m : state.motions)
    if (!m.position.allFinite() || !m.attitude.coeffs().allFinite() || !m.velocity.allFinite() || !m.omega.allFinite())
      return false;
  return true;
}

}  // namespace

TEST_CASE("lines of any stiffness: below the computed limit the step is stable, above it the run stops by name",
          "[extremes][fast]") {
  const double stiffness = GENERATE(3.4e6, 4e8, 4e10, 4e12);
  const auto integrator = GENERATE(Integrator::rk4, Integrator::symplectic);
  System system = Platform{.line_stiffness = stiffness, .line_damping = 0.0}.system(integrator);
  BodiesState state = start(system);
  state.motions[0].velocity.x() = 0.01;
  const double limit = step_limit(integrator, linearise(system, start(system), 0.0)).step_s;
  INFO(name(integrator) << ", " << stiffness << " N/m, limit " << limit << " s");
  BodiesState stable = state;
  run(system, stable, 0.9 * limit, 2000);
  CHECK(finite(stable));
  CHECK(stable.motions[0].velocity.norm() < 10.0);

  StepReport report;
  long steps = 0;
  while ((report = system.advance(state, 3.0 * limit, 1)).ok() && ++steps < 100000) {}
  CHECK_FALSE(report.ok());
  CHECK(finite(state));  // the last good state, for the checkpoint
  CHECK(system.describe(report).size() > 20);
}

TEST_CASE("a weight on a slack line falls, snaps and bounces with its energy", "[extremes][fast]") {
  const double stiffness = GENERATE(1e4, 1e6, 1e8);
  const auto integrator = GENERATE(Integrator::rk4, Integrator::symplectic);
  const std::vector<Body> bodies{body("weight", 100.0, {1, 1, 1}, {0, 0, -0.5})};
  const LoadSource line{"line",
                        [stiffness](double, std::span<const Motion> m, std::span<Wrench> w) {
                          const LineSpringDamper spring{1.0, stiffness, 0.0, true};
                          const double length = m[0].position.norm();
                          w[0].force -= spring.tension(length, 0.0) / length * m[0].position;
                        },
                        {}};
  System system(bodies, {}, {gravity_source(bodies, 9.81), line}, integrator);
  BodiesState state = start(system);
  const double step = 0.02 / std::sqrt(stiffness / 100.0), energy = 100.0 * 9.81 * -0.5;
  double lowest = 0.0;
  for (int n = 0; n < 20000; ++n) {
    run(system, state, step, 1);
    lowest = std::min(lowest, state.motions[0].position.z());
  }
  // Lowest point: the fall's energy in the line.
  const double stretch = 100 * 9.81 / stiffness * (1 + std::sqrt(1 + stiffness / (100 * 9.81)));
  const bool reached = 20000 * step > 0.4;  // 0.32 s of fall
  if (reached) CHECK(lowest == Approx(-1.0 - stretch).epsilon(1e-3));
  const double slack = std::max(0.0, state.motions[0].position.norm() - 1.0);
  const double now = system.kinetic_energy(state) + 100 * 9.81 * state.motions[0].position.z() + 0.5 * stiffness * slack * slack;
  CHECK(now == Approx(energy).margin(0.02 * 100 * 9.81));  // of the height fallen; a snap inside a step costs a little
}

TEST_CASE("a heavy top leaning 10 to 85 degrees keeps its energy and its vertical angular momentum", "[extremes][fast]") {
  const double lean = GENERATE(10.0, 45.0, 80.0, 85.0) * radians_per_degree;
  Body top = body("top", 2.0, {0.05, 0.05, 0.02}, {std::sin(lean), 0, std::cos(lean)});
  top.initial.attitude = attitude({0, lean, 0});
  top.initial.omega = {0, 0, 200};
  const std::vector<Body> bodies{top};
  System system(bodies, {joint("tip", JointType::spherical, earth, 0, {0, 0, 0})}, {gravity_source(bodies, 9.81)});
  BodiesState state = start(system);
  const auto energy = [&] { return system.kinetic_energy(state) + 2 * 9.81 * state.motions[0].position.z(); };
  const auto momentum = [&] {
    const Motion& m = state.motions[0];
    return (m.attitude * (top.inertia * m.omega)).z() + 2.0 * m.position.cross(m.velocity).z();
  };
  const double energy_before = energy(), momentum_before = momentum();
  run(system, state, 1e-4, 10000);  // spin times step 0.02: RK4 loses 1e-9 of the energy in this second
  CHECK(energy() == Approx(energy_before).epsilon(1e-8));
  CHECK(momentum() == Approx(momentum_before).margin(1e-6));
  CHECK(system.constraint_residual(state, 1.0) < 1e-12);
}
