// Spatial mechanisms of the IFToMM library of computational benchmark problems (Gonzalez, Dopico, Lugris & Cuadrado 2006,
// Multibody System Dynamics 16): A04 Bricard (over-constrained, one redundant condition) and A05 stiff flyball governor. Bricard:
// energy, and the same motion without the redundant condition. Governor: its four degrees of freedom written down directly.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "kernels/mooring/line_spring_damper.hpp"
#include "src/bodies/linearise.hpp"
#include "tests/order.hpp"
#include "tests/src/bodies/examples.hpp"

using namespace spindrift;
using namespace spindrift::bodies;
using namespace spindrift::bodies::examples;

namespace {

/// Five rods along six edges of a unit cube (the sixth is the ground); every axis is perpendicular to the two edges it joins.
/// A cylindrical last hinge leaves out exactly the condition that follows from the others.
System bricard(JointType last) {
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  const std::array<Vector3d, 6> corner{Vector3d(0, 0, 0), {1, 0, 0}, {1, -1, 0}, {1, -1, 1}, {0, -1, 1}, {0, 0, 1}};
  const std::array<Vector3d, 6> axis{y, z, x, y, z, x};
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  for (std::size_t k = 0; k < 5; ++k) bodies.push_back(rod("rod " + std::to_string(k + 1), 1.0, corner[k], corner[k + 1], 0.02));
  for (int k = 0; k < 6; ++k)
    joints.push_back(joint("hinge " + std::to_string(k), k == 5 ? last : JointType::revolute, k == 0 ? earth : k - 1,
                           k == 5 ? earth : k, corner[std::size_t(k)], axis[std::size_t(k)]));
  LoadSource gravity = gravity_source(bodies, 9.81, -y);
  return System(std::move(bodies), std::move(joints), {gravity});
}

double energy(const System& system, const BodiesState& state, const Vector3d& up) {
  double sum = system.kinetic_energy(state);
  for (std::size_t b = 0; b < state.motions.size(); ++b)
    sum += 9.81 * system.bodies()[b].mass * up.dot(state.motions[b].position);
  return sum;
}

/// Governor: shaft along z with two arms hinged on its axis at the top, a ball at each arm's end, springs with dampers from the
/// arms' middles to a slider on the shaft.
struct Governor {
  static constexpr double arm = 1.0, arm_mass = 0.3, ball = 5.0, stiffness = 8e5, damping = 4e4, rest = 0.5, spin = 2 * pi;
  static constexpr double shaft_mass = 0.3, slider_mass = 3.0, start_angle = pi / 6, g = 9.81;
  static constexpr double shaft_inertia = 5e-6, slider_inertia = 5e-3, along_arm = 5e-6;
  static constexpr double mass() { return arm_mass + ball; }
  static constexpr double centre() { return (arm_mass * 0.5 + ball * arm) / mass(); }       // from the hinge
  static constexpr double across() { return arm_mass * arm * arm / 3 + ball * arm * arm; }  // about the hinge
  static double slider_start() { return -2 * 0.5 * arm * std::cos(start_angle); }

  static System system(Integrator integrator) {
    const double about_centre = across() - mass() * centre() * centre();
    std::vector<Body> bodies{
        body("shaft", shaft_mass, {0.025, 0.025, shaft_inertia}, {0, 0, -0.5}),
        body("slider", slider_mass, {slider_inertia, slider_inertia, slider_inertia}, {0, 0, slider_start()})};
    for (double side : {1.0, -1.0}) {
      const Vector3d outwards(side * std::sin(start_angle), 0, -std::cos(start_angle));
      bodies.push_back(
          body(side > 0 ? "right arm" : "left arm", mass(), {about_centre, about_centre, along_arm}, centre() * outwards));
      bodies.back().initial.attitude = Eigen::Quaterniond::FromTwoVectors(-Vector3d::UnitZ(), outwards);
    }
    for (Body& b : bodies) {
      b.initial.omega = b.initial.attitude.conjugate() * Vector3d(0, 0, spin);
      b.initial.velocity = Vector3d(0, 0, spin).cross(b.initial.position);
    }
    const Vector3d top(0, 0, 0), z = Vector3d::UnitZ(), y = Vector3d::UnitY();
    std::vector<Joint> joints{joint("bearing", JointType::revolute, earth, 0, top, z),
                              joint("guide", JointType::translational, 0, 1, bodies[1].initial.position, z),
                              joint("right hinge", JointType::revolute, 0, 2, top, y),
                              joint("left hinge", JointType::revolute, 0, 3, top, y)};
    LoadSource springs{"springs",
                       [](double, std::span<const Motion> m, std::span<Wrench> w) {
                         const LineSpringDamper spring{rest, stiffness, damping, false};
                         const Vector3d on_arm(0, 0, centre() - 0.5 * arm);  // body axes: arm's end towards -z
                         for (std::size_t b : {2u, 3u}) {
                           const Vector3d at = m[b].point(on_arm), to = m[1].position, apart = to - at;
                           const double length = apart.norm(),
                                        rate = (m[1].velocity - m[b].point_velocity(on_arm)).dot(apart) / length;
                           const Vector3d pull = spring.tension(length, rate) / length * apart;
                           w[b].add_force(pull, at);
                           w[1].add_force(-pull, to);
                         }
                       },
                       {}};
    LoadSource gravity = gravity_source(bodies, g);
    return System(std::move(bodies), std::move(joints), {gravity, springs}, integrator);
  }

  using State = std::array<double, 4>;  // arm angle, slider height, their rates; the spin follows from the angular momentum
  static double turning_inertia(double angle) {
    const double s = std::sin(angle), c = std::cos(angle);
    return shaft_inertia + slider_inertia + 2 * (across() * s * s + along_arm * c * c);
  }
  static State rates(const State& q) {
    const double a = 0.5 * arm, sine = std::sin(q[0]), cosine = std::cos(q[0]);
    const double rate = turning_inertia(start_angle) * spin / turning_inertia(q[0]);
    const double dx = a * sine, dz = q[1] + a * cosine, length = std::hypot(dx, dz);
    const double by_angle = -q[1] * a * sine / length, by_slider = dz / length;
    const double tension = stiffness * (length - rest) + damping * (by_angle * q[2] + by_slider * q[3]);
    const double arms =
        2 * (across() - along_arm) * sine * cosine * rate * rate - 2 * mass() * g * centre() * sine - 2 * tension * by_angle;
    return {q[2], q[3], arms / (2 * across()), -2 * tension * by_slider / slider_mass - g};
  }
  static State reference(double end, double step) {
    State q{start_angle, slider_start(), 0, 0};
    for (long n = std::lround(end / step); n > 0; --n) {
      const auto moved = [&](const State& k, double h) {
        State r = q;
        for (std::size_t i = 0; i < 4; ++i) r[i] += h * k[i];
        return r;
      };
      const State k1 = rates(q), k2 = rates(moved(k1, step / 2)), k3 = rates(moved(k2, step / 2)), k4 = rates(moved(k3, step));
      for (std::size_t i = 0; i < 4; ++i) q[i] += step / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    }
    return q;
  }
};

}  // namespace

TEST_CASE("Bricard's mechanism moves although its joints count to no freedom, and the joint to blame is named",
          "[bodies][fast]") {
  std::array<Vector3d, 2> tip;
  for (const JointType last : {JointType::revolute, JointType::cylindrical}) {
    System system = bricard(last);
    const Assembly assembly = system.assemble();
    REQUIRE(assembly.contradiction == "");
    CHECK(assembly.degrees_of_freedom == 1);
    const bool over_constrained = last == JointType::revolute;
    REQUIRE(assembly.redundant.size() == (over_constrained ? 1u : 0u));
    if (over_constrained) CHECK_THAT(assembly.redundant[0], Catch::Matchers::Contains("'hinge"));
    BodiesState state = assembly.state;
    const double before = energy(system, state, Vector3d::UnitY());
    run(system, state, 2e-3, 5000);
    CHECK(energy(system, state, Vector3d::UnitY()) == Approx(before).margin(1e-6));  // measured: 4e-8 J of 24.5 J swung
    CHECK(system.constraint_residual(state, 0.0) < 1e-12);
    tip[over_constrained] = state.motions[2].point({0.5, 0, 0});
  }
  CHECK((tip[0] - tip[1]).norm() < 1e-7);
}

TEST_CASE("the stiff flyball governor follows its equations in minimal coordinates", "[bodies][fast]") {
  System system = Governor::system(Integrator::rk4);
  const Assembly assembly = system.assemble();
  REQUIRE(assembly.contradiction == "");
  CHECK(assembly.degrees_of_freedom == 4);
  BodiesState state = assembly.state;
  const double step = 5e-5, end = 0.5;
  run(system, state, step, std::lround(end / step));
  const Governor::State q = Governor::reference(end, 2e-5);
  CHECK(-state.joint_angles[2] == Approx(q[0] - Governor::start_angle).margin(1e-8));
  CHECK(state.joint_angles[3] == Approx(q[0] - Governor::start_angle).margin(1e-8));
  CHECK(state.motions[1].position.z() == Approx(q[1]).margin(1e-8));
  const double spin = Governor::turning_inertia(Governor::start_angle) * Governor::spin / Governor::turning_inertia(q[0]);
  CHECK(state.motions[0].omega.z() == Approx(spin).epsilon(1e-8));
  CHECK(std::abs(q[0] - Governor::start_angle) > 0.01);  // the governor did open or close

  const StepLimit limit = step_limit(Integrator::rk4, linearise(system, assembly.state, 0.0));
  CHECK(limit.mode == "heave of slider");
  state = assembly.state;
  BodiesState beyond = assembly.state;
  run(system, state, 0.95 * limit.step_s, 2000);
  CHECK(state.motions[1].velocity.norm() < 10.0);
  bool diverged = false;
  for (int n = 0; n < 2000 && !diverged; ++n)
    diverged = !system.advance(beyond, 1.05 * limit.step_s, 1).ok() || beyond.motions[1].velocity.norm() > 100.0;
  CHECK(diverged);
}
