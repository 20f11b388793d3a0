// Flexible beams between bodies in motion: frequencies against an independent eigen-analysis, energy, damping, loads at the ends,
// the tower of the DTU 10 MW turbine. SPDX-License-Identifier: Apache-2.0
#include "src/bodies/beams.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <string>

#include "kernels/base/constants.hpp"
#include "src/bodies/linearise.hpp"
#include "src/bodies/mode_names.hpp"
#include "src/bodies/statics.hpp"
#include "tests/src/bodies/examples.hpp"

using namespace spindrift;
using namespace spindrift::bodies;
using Eigen::Vector3d;

namespace {

/// 100 m of a uniform tower of 400 t.
const beam::Properties uniform_tower{{0.0, 100.0}, {4e3, 4e3}, {1e12, 1e12}, {1e12, 1e12}, {1e11, 1e11}, {8e11, 8e11}};
constexpr double top_mass = 600e3, top_inertia = 4e7;

Body nacelle_body() { return examples::body("nacelle", top_mass, {top_inertia, top_inertia, top_inertia}, {0, 0, 102.0}); }
Body support_body(double mass = 8e6) { return examples::body("platform", mass, {6e9, 6e9, 3e9}, {0, 0, -20.0}); }

Beam on_earth(const std::vector<Body>& bodies, std::array<double, 2> damping = {0, 0}) {
  return make_beams({{.name = "tower", .end = {0, 0, 100}, .properties = uniform_tower, .damping = damping}}, bodies, {})[0];
}
Beam afloat(const std::vector<Body>& bodies) {
  return make_beams({{.name = "tower", .i = 0, .j = 1, .end = {0, 0, 100}, .properties = uniform_tower}}, bodies, {})[0];
}

/// Relative distance from omega to the nearest frequency among the modes.
double nearest(const Linearisation& l, double omega) {
  double best = 1e300;
  for (const Mode& mode : l.modes) best = std::min(best, std::abs(std::abs(mode.eigenvalue.imag()) / omega - 1.0));
  return best;
}

beam::EndBody end_of_tower() { return {top_mass, 2.0 * top_mass, top_inertia + 4.0 * top_mass}; }

}  // namespace

TEST_CASE("a mass on a tower from the earth vibrates in the tower's first two modes, each plane", "[bodies][fast]") {
  const std::vector<Body> bodies{nacelle_body()};
  System system(bodies, {}, {beam_source({on_earth(bodies)}, Vector3d::Zero())});
  const Linearisation modes = linearise(system, examples::start(system), 0.0);
  REQUIRE(modes.modes.size() == 6);
  const beam::Modes exact = beam::modes(uniform_tower.plane_x(), {.tip = end_of_tower(), .base = {}, .elements = 80}, 2);
  CHECK(nearest(modes, exact.omega[0]) < 1e-4);
  CHECK(nearest(modes, exact.omega[1]) < 1e-3);
}

TEST_CASE("a tower in two pieces vibrates as in one, from the earth or afloat", "[bodies][fast]") {
  const bool floats = GENERATE(false, true);
  const double cut = GENERATE(30.0, 50.0, 70.0);
  const Body flange = examples::body("flange", 1e3, {5e3, 5e3, 1e4}, {0, 0, cut});
  std::vector<Body> bodies{nacelle_body(), flange};
  if (floats) bodies.push_back(support_body());
  const int foot = floats ? 2 : earth;
  const auto piece = [&](double from, double to, int i, int j) {
    BeamPlan plan{.name = "", .i = i, .j = j, .start = {0, 0, from}, .end = {0, 0, to}, .properties = uniform_tower};
    plan.properties.position = {0.0, to - from};
    return plan;
  };
  System system(bodies, {},
                {beam_source(make_beams({piece(0, cut, foot, 1), piece(cut, 100, 1, 0)}, bodies, {}), Vector3d::Zero())});
  const Linearisation modes = linearise(system, examples::start(system), 0.0);
  const beam::EndBody base{8e6, -20.0 * 8e6, 6e9 + 400.0 * 8e6};
  const beam::Modes exact = floats
                                ? beam::modes(uniform_tower.plane_x(), {.tip = end_of_tower(), .base = base, .elements = 80}, 3)
                                : beam::modes(uniform_tower.plane_x(), {.tip = end_of_tower(), .base = {}, .elements = 80}, 1);
  INFO(cut << " m, " << nearest(modes, exact.omega[floats ? 2 : 0]));
  CHECK(nearest(modes, exact.omega[floats ? 2 : 0]) < 1e-3);
}

TEST_CASE("weight on top and the tower's own soften it as its geometric stiffness does", "[bodies][fast]") {
  // Heavy gravity, so that the change is large: about a tenth of the first frequency.
  const double g = GENERATE(9.81, 60.0);
  const std::vector<Body> bodies{nacelle_body()};
  System system(bodies, {}, {gravity_source(bodies, g), beam_source({on_earth(bodies)}, {0, 0, -g})});
  const Equilibrium rest = find_equilibrium(system, examples::start(system), 0.0);
  REQUIRE(rest.problem == "");
  const Linearisation modes = linearise(system, rest.state, 0.0);
  // The top's centre of mass is 2 m above the end: turning it has the moment of its weight.
  const beam::Problem problem{.tip = end_of_tower(), .base = {}, .tension = -top_mass * g, .weight = g, .elements = 60};
  const beam::Matrices m = matrices(uniform_tower.plane_x(), problem);
  Eigen::MatrixXd mass = m.mass, stiffness = m.stiffness + m.geometric;
  const Eigen::Index n = mass.rows() - 2;
  mass.bottomRightCorner<2, 2>() +=
      (Eigen::Matrix2d() << top_mass, 2 * top_mass, 2 * top_mass, top_inertia + 4 * top_mass).finished();
  stiffness(n + 1, n + 1) -= top_mass * g * 2.0;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(stiffness.bottomRightCorner(n, n),
                                                                        mass.bottomRightCorner(n, n));
  const double straight = beam::modes(uniform_tower.plane_x(), {.tip = end_of_tower(), .base = {}}, 1).omega[0];
  const double softened = std::sqrt(eigen.eigenvalues()[0]);
  CHECK(softened < (1.0 - 0.0009 * g) * straight);
  CHECK(nearest(modes, softened) < 2e-3);
}

TEST_CASE("on a floating platform the tower's frequencies rise to those of the free-free system", "[bodies][fast]") {
  const std::vector<Body> bodies{support_body(), nacelle_body()};
  System system(bodies, {}, {beam_source({afloat(bodies)}, Vector3d::Zero())});
  const Linearisation modes = linearise(system, examples::start(system), 0.0);
  REQUIRE(modes.modes.size() >= 6);
  const beam::EndBody base{8e6, -20.0 * 8e6, 6e9 + 400.0 * 8e6};
  const beam::Modes free = beam::modes(uniform_tower.plane_x(), {.tip = end_of_tower(), .base = base, .elements = 80}, 4);
  const beam::Modes clamped = beam::modes(uniform_tower.plane_x(), {.tip = end_of_tower(), .base = {}}, 1);
  CHECK(free.omega[2] > 1.05 * clamped.omega[0]);
  CHECK(nearest(modes, free.omega[2]) < 2e-3);
  CHECK(nearest(modes, free.omega[3]) < 2e-2);  // two clamped modes make up the second free one
}

TEST_CASE("modes in which a tower bends, twists or stretches are named after it, those of the whole after what carries it",
          "[bodies][fast]") {
  std::vector<Body> bodies{support_body(), nacelle_body()};
  if (GENERATE(false, true))
    bodies[0].mass = 5e6, bodies[0].inertia = Vector3d(7e8, 7e8, 1.4e9).asDiagonal();  // a barge rolls under its tower
  const Beam beam = afloat(bodies);
  // A soft spring rights the platform: it pitches as one with what it carries.
  LoadSource spring{.name = "spring", .loads = {}, .added_mass = {}};
  spring.loads = [](double, std::span<const Motion> motions, std::span<Wrench> loads) {
    const Vector3d up = motions[0].attitude * Vector3d::UnitZ();
    loads[0].moment += 2e8 * up.cross(Vector3d::UnitZ());
  };
  System system(bodies, {}, {beam_source({beam}, Vector3d::Zero()), spring});
  const BodiesState state = examples::start(system);
  Linearisation found = linearise(system, state, 0.0);
  name_modes(found, system, state, std::span(&beam, 1));
  std::map<std::string, int> named;
  for (const Mode& mode : found.modes)
    if (mode.eigenvalue != 0.0) ++named[mode.name];
  CHECK(named["bending in x of tower"] + named["bending in y of tower"] == 4);
  CHECK(named["torsion of tower"] == 1);
  CHECK(named["stretching of tower"] == 1);
  CHECK(named["pitch of platform"] + named["roll of platform"] == 2);
}

TEST_CASE("modes of a tower in two pieces have the same names whichever piece is given first", "[bodies][fast]") {
  const std::vector<Body> bodies{support_body(), nacelle_body(), examples::body("flange", 1e3, {5e3, 5e3, 1e4}, {0, 0, 50.0})};
  BeamPlan lower{.name = "lower", .i = 0, .j = 2, .end = {0, 0, 50.0}, .properties = uniform_tower};
  BeamPlan upper{.name = "upper", .i = 2, .j = 1, .start = {0, 0, 50.0}, .end = {0, 0, 100.0}, .properties = uniform_tower};
  lower.properties.position = upper.properties.position = {0.0, 50.0};
  const auto names = [&](const std::vector<BeamPlan>& plans) {
    const std::vector<Beam> beams = make_beams(plans, bodies, {});
    System system(bodies, {}, {beam_source(beams, Vector3d::Zero())});
    const BodiesState state = examples::start(system);
    Linearisation found = linearise(system, state, 0.0);
    name_modes(found, system, state, beams);
    std::map<std::string, int> named;
    for (const Mode& mode : found.modes)
      if (mode.eigenvalue != 0.0) ++named[mode.name];
    return named;
  };
  const std::map<std::string, int> from_below = names({lower, upper});
  CHECK(from_below == names({upper, lower}));
  CHECK(from_below.count("stretching of upper") == 1);
}

TEST_CASE("the energy of a tower's free vibration is kept to the order of rk4", "[bodies][fast]") {
  const Vector3d gravity(0, 0, -9.81);
  std::vector<Body> bodies{support_body(), nacelle_body()};
  bodies[1].initial.velocity = {1.5, -1.0, 0.1};
  bodies[1].initial.omega = {0.02, 0.03, 0.01};
  bodies[0].initial.omega = {0.01, 0.02, 0.05};
  const Beam beam = afloat(bodies);
  System system(bodies, {}, {gravity_source(bodies, 9.81), beam_source({beam}, gravity)});
  const auto energy = [&](const BodiesState& s) {
    double e = system.kinetic_energy(s) + beam_energy(beam, s.motions, gravity);
    for (std::size_t b = 0; b < bodies.size(); ++b) e += bodies[b].mass * 9.81 * s.motions[b].position.z();
    return e;
  };
  std::vector<double> lost;
  for (const int steps : {400, 800, 1600}) {
    BodiesState state = examples::start(system);
    const double before = energy(state);
    examples::run(system, state, 8.0 / steps, steps);
    lost.push_back(std::abs(energy(state) - before));
  }
  INFO(lost[0] << ' ' << lost[1] << ' ' << lost[2]);
  CHECK(lost[2] < 1e-5 * 1e6);
  CHECK(std::log2(lost[0] / lost[1]) > 3.7);
  CHECK(std::log2(lost[1] / lost[2]) > 3.7);
}

TEST_CASE("momentum of a free platform, tower and nacelle is kept", "[bodies][fast]") {
  std::vector<Body> bodies{support_body(), nacelle_body()};
  bodies[1].initial.velocity = {1.5, -1.0, 0.3};
  bodies[0].initial.omega = {0.01, 0.02, 0.05};
  const Beam beam = afloat(bodies);
  System system(bodies, {}, {beam_source({beam}, Vector3d::Zero())});
  const auto momentum = [&](const BodiesState& s) {
    const auto end = [&](int b, const Vector3d& point) {
      const Motion& m = s.motions[std::size_t(b)];
      return beam::End{m.position, m.point(point), m.attitude.toRotationMatrix(), m.velocity, m.omega_earth()};
    };
    const beam::End a = end(0, beam.start), b = end(1, beam.end);
    beam::Vector12 motion;
    motion << a.velocity, a.spin, b.velocity, b.spin;
    const beam::Vector12 own = dynamics(beam.link, a, b, Vector3d::Zero()).mass * motion;
    return Vector3d(bodies[0].mass * a.velocity + bodies[1].mass * b.velocity + own.segment<3>(0) + own.segment<3>(6));
  };
  BodiesState state = examples::start(system);
  const Vector3d before = momentum(state);
  examples::run(system, state, 0.01, 400);
  CHECK((momentum(state) - before).norm() < 1e-6 * before.norm());
}

TEST_CASE("damping of a tower's mode is the given ratio", "[bodies][fast]") {
  const std::vector<Body> bodies{nacelle_body()};
  System system(bodies, {}, {beam_source({on_earth(bodies, {0.01, 0.03})}, Vector3d::Zero())});
  const Linearisation modes = linearise(system, examples::start(system), 0.0);
  const beam::Modes exact = beam::modes(uniform_tower.plane_x(), {.tip = end_of_tower(), .base = {}}, 2);
  for (int k = 0; k < 2; ++k)
    for (const Mode& mode : modes.modes)
      if (std::abs(std::abs(mode.eigenvalue) / exact.omega[std::size_t(k)] - 1.0) < 2e-3)
        CHECK(mode.damping_ratio() == Approx(k == 0 ? 0.01 : 0.03).epsilon(0.01));
}

TEST_CASE("at rest a tower's foot carries the weight and the moment of what is above, its top that of the nacelle",
          "[bodies][fast]") {
  const double g = 9.81;
  std::vector<Body> bodies{nacelle_body()};
  bodies[0].initial.position.x() = -3.0;
  const Beam beam = on_earth(bodies);
  const Vector3d gravity(0, 0, -g), push(4e5, 0, 0);
  System system(
      bodies, {},
      {gravity_source(bodies, g), beam_source({beam}, gravity), point_load_source("thrust", {{.body = 0, .force = push}})});
  const Equilibrium rest = find_equilibrium(system, examples::start(system), 0.0);
  REQUIRE(rest.problem == "");
  const Evaluation& now = system.evaluate(rest.state, 0.0);
  const BeamReading r = read_beam(beam, rest.state.motions, now.acceleration, now.angular_acceleration, gravity);
  const Vector3d centre = rest.state.motions[0].position;
  CHECK(r.displacement.x() > 0.05);
  CHECK(r.start_force.x() == Approx(4e5).epsilon(1e-6));
  CHECK(r.start_force.z() == Approx(-(top_mass + 4e5) * g).epsilon(1e-6));
  double own = 0.0;  // moment of the tower's own weight: its bent shape
  const beam::End foot{},
      head{centre, rest.state.motions[0].point(beam.end), rest.state.motions[0].attitude.toRotationMatrix() * beam.end_axes};
  const beam::Deformation d = deformation(beam.link, foot, head);
  for (const beam::Station& s : beam.link.stations)
    own += s.mass * g * station_place(beam.link, s, d, extension(beam.link, d)).place.x();
  CHECK(r.start_moment.y() == Approx(centre.z() * 4e5 + centre.x() * top_mass * g + own).epsilon(1e-6));
  // At the top in its turned axes: back to those of the earth.
  const Vector3d top_force = head.axes * r.end_force, top_moment = head.axes * r.end_moment;
  CHECK(top_force.x() == Approx(4e5).epsilon(1e-5));
  CHECK(top_force.z() == Approx(-top_mass * g).epsilon(1e-5));
  const Vector3d arm = centre - head.point;
  CHECK(top_moment.y() == Approx(arm.z() * 4e5 + arm.x() * top_mass * g).epsilon(1e-5));
}

TEST_CASE("steps with a beam do not depend on how often they were tried", "[bodies][fast]") {
  std::vector<Body> bodies{support_body(), nacelle_body()};
  bodies[1].initial.velocity = {1.5, -1.0, 0.1};
  System system(bodies, {}, {beam_source({afloat(bodies)}, {0, 0, -9.81})});
  BodiesState state = examples::start(system), again = state;
  examples::run(system, state, 0.02, 20);
  examples::run(system, again, 0.02, 20);
  for (std::size_t b = 0; b < 2; ++b) CHECK(state.motions[b].position == again.motions[b].position);
}
