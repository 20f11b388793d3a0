// Modes and step limits of the loaded system: src/bodies/linearise.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/linearise.hpp"

#include <catch2/catch.hpp>

#include "kernels/rigid/stability.hpp"
#include "src/bodies/statics.hpp"
#include "tests/src/bodies/platform.hpp"

using namespace spindrift;
using namespace spindrift::bodies;
using namespace spindrift::bodies::examples;

namespace {

/// A body on springs and dampers to the earth, all six directions; added mass on the left-hand side where asked for.
System on_springs(Integrator integrator, double stiffness, double damping, double added_mass = 0.0) {
  std::vector<LoadSource> loads{{"springs",
                                 [=](double, std::span<const Motion> m, std::span<Wrench> w) {
                                   w[0].force += -stiffness * m[0].position - damping * m[0].velocity;
                                   w[0].moment += -0.1 * stiffness * m[0].attitude.vec() * 2 - 0.1 * damping * m[0].omega_earth();
                                 },
                                 {}}};
  if (added_mass > 0.0)
    loads.push_back({"water", {}, [=](double, std::span<const Motion>, std::span<Matrix6> a) { a[0](2, 2) += added_mass; }});
  return System({body("buoy", 10.0, {5, 6, 7}, {0, 0, 0})}, {}, std::move(loads), integrator);
}

const Mode& mode_named(const Linearisation& l, const std::string& name) {
  for (const Mode& m : l.modes)
    if (m.name == name) return m;
  FAIL("no mode " << name);
  return l.modes[0];
}

}  // namespace

TEST_CASE("frequencies and damping of a body on springs, added mass included", "[bodies][fast]") {
  System system = on_springs(Integrator::rk4, 1000.0, 8.0, 30.0);
  const Linearisation l = linearise(system, start(system), 0.0);
  REQUIRE(l.modes.size() == 6);
  CHECK(l.freedoms_without_stiffness() == 0);
  const Mode& surge = mode_named(l, "surge of buoy");
  CHECK(std::abs(surge.eigenvalue) == Approx(10.0).epsilon(1e-7));
  CHECK(surge.damping_ratio() == Approx(0.04).epsilon(1e-6));
  CHECK(std::abs(mode_named(l, "heave of buoy").eigenvalue) == Approx(5.0).epsilon(1e-7));
  CHECK(std::abs(mode_named(l, "yaw of buoy").eigenvalue) == Approx(std::sqrt(100.0 / 7)).epsilon(1e-7));
}

TEST_CASE("a hanging top that spins precesses and nutates in its modes as theory has it", "[bodies][fast]") {
  // A s^2 - C W s - m g l = 0 about the pivot, for what is seen from the earth: s [rad/s].
  constexpr double mass = 100.0, arm = 1.0, along = 100.0, across = 80.0 + mass * arm * arm, spin = 6.0, g = 9.80665;
  std::vector<Body> bodies{body("top", mass, {80.0, 80.0, along}, {0, 0, -arm})};
  bodies[0].initial.omega = {0, 0, spin};
  System system(bodies, {joint("pin", JointType::spherical, earth, 0, {0, 0, 0})}, {gravity_source(bodies, g)});
  const Linearisation l = linearise(system, start(system), 0.0);
  REQUIRE(l.modes.size() >= 2);
  const double half = along * spin / (2.0 * across), root = std::sqrt(half * half + mass * g * arm / across);
  CHECK(l.modes[0].eigenvalue.imag() == Approx(root + half).epsilon(1e-6));
  CHECK(l.modes[1].eigenvalue.imag() == Approx(root - half).epsilon(1e-6));
}

TEST_CASE("freedoms without stiffness are counted once, damped or not", "[bodies][fast]") {
  const double damping = GENERATE(0.0, 5.0);
  System system({body("buoy", 10.0, {5, 6, 7}, {0, 0, 0})}, {},
                {{"spring",
                  [=](double, std::span<const Motion> m, std::span<Wrench> w) {
                    w[0].force += -1000.0 * m[0].position.z() * Eigen::Vector3d::UnitZ() - damping * m[0].velocity;
                  },
                  {}}},
                Integrator::rk4);
  CHECK(linearise(system, start(system), 0.0).freedoms_without_stiffness() == 5);
}

TEST_CASE("rates that round-off leaves hold no body and limit no step", "[bodies][fast]") {
  for (const auto& [stiffness, held] : {std::pair{1e-8, false}, std::pair{1e-4, true}}) {  // 3e-5 and 3e-3 1/s
    System system = on_springs(Integrator::rk4, stiffness, 0.0);
    const Linearisation l = linearise(system, start(system), 0.0);
    CHECK((l.modes.front().eigenvalue != 0.0) == held);
    CHECK(l.freedoms_without_stiffness() == (held ? 0 : 6));
    CHECK(std::isinf(step_limit(Integrator::rk4, l).step_s) == !held);
  }
}

TEST_CASE("the limit of the scene holds: 0.95 of it is stable, 1.05 is not", "[bodies][fast]") {
  const auto integrator = GENERATE(Integrator::rk4, Integrator::explicit_euler, Integrator::symplectic);
  System system = on_springs(integrator, 1000.0, 8.0);
  BodiesState state = start(system);
  state.motions[0].position = {1e-3, 0, 0};
  const StepLimit limit = step_limit(integrator, linearise(system, start(system), 0.0));
  INFO(name(integrator) << " limit " << limit.step_s);
  BodiesState below = state, above = state;
  run(system, below, 0.95 * limit.step_s, 20000);
  CHECK(below.motions[0].position.norm() < 2e-3);
  double largest = 0.0;
  for (int n = 0; n < 20000 && largest < 1e-2; ++n) {
    if (!system.advance(above, 1.05 * limit.step_s, 1).ok())
      largest = INFINITY;
    else
      largest = std::max(largest, above.motions[0].position.norm());
  }
  CHECK(largest >= 1e-2);
}

TEST_CASE("explicit Euler has no stable step where a mode is undamped", "[bodies][fast]") {
  System system = on_springs(Integrator::explicit_euler, 1000.0, 0.0);
  const Linearisation l = linearise(system, start(system), 0.0);
  CHECK(step_limit(Integrator::explicit_euler, l).step_s == 0.0);
  CHECK(step_limit(Integrator::rk4, l).step_s == Approx(std::sqrt(8.0) / 10.0).epsilon(1e-6));
}

TEST_CASE("explicit Euler on the paper's platform: limits by mode, undamped yaw refused", "[bodies][fast]") {
  const auto limit_of = [](const Platform& platform, const std::string& mode) {
    System system = platform.system(Integrator::explicit_euler);
    return stability_limit(Integrator::explicit_euler, mode_named(linearise(system, start(system), 0.0), mode).eigenvalue);
  };
  const Platform by_ea, by_length{.line_stiffness = 4e8};
  CHECK(limit_of(by_ea, "heave of platform") == Approx(5.2e-4).epsilon(0.01));  // 1.63e3 N s/m over 3.14e6 N/m
  CHECK(limit_of(by_ea, "surge of platform") == Approx(1.16e-2).epsilon(0.01));
  CHECK(limit_of(by_length, "surge of platform") == Approx(1e-4).epsilon(0.01));  // 4e4 N s/m over 4e8 N/m
  CHECK(limit_of(by_length, "heave of platform") == Approx(8.4e-5).epsilon(0.01));

  // The lines hardly damp roll and pitch: they, not heave, limit the scene. Untensioned lines leave yaw undamped: no step at all.
  System system = by_ea.system(Integrator::explicit_euler);
  const Linearisation l = linearise(system, start(system), 0.0);
  CHECK(mode_named(l, "pitch of platform").period_s() == Approx(21.9).margin(0.2));
  const StepLimit limit = step_limit(Integrator::explicit_euler, l);
  CHECK(limit.step_s == 0.0);
  CHECK(limit.mode == "yaw of platform");
  CHECK(step_limit(Integrator::rk4, l).step_s == Approx(std::sqrt(8.0) / 1.127).epsilon(0.02));
  CHECK(step_limit(Integrator::symplectic, l).step_s == Approx(2.0 / 1.127).epsilon(0.02));
}

TEST_CASE("two-way lines that a sunk platform shortens push, and pushing lines do not hold it in yaw", "[bodies][fast]") {
  System system = Platform{}.system();
  const Equilibrium rest = find_equilibrium(system, start(system), 0.0);
  CHECK(rest.problem == "");
  CHECK(rest.unstable == "yaw of platform");
}
